//! Reports as one self-contained HTML file, with its styles, tables and pictures, so that it can be sent alone.

use std::fmt::{Display, Write};

use base64::Engine;
use base64::engine::general_purpose::STANDARD as BASE64;
use roughcast_io::picture::{Srgb8Picture, write_compact_png, write_jpeg};

/// A page under construction.
pub struct Page {
    html: String,
}

const STYLE: &str = "\
:root{color-scheme:light dark}body{font:15px/1.5 system-ui,sans-serif;max-width:1500px;margin:2em auto;padding:0 1em}
h1,h2,h3{line-height:1.2}table{border-collapse:collapse;margin:.5em 0 1.5em}
th,td{padding:.2em .8em;border-bottom:1px solid #8884;text-align:right}th:first-child,td:first-child,.text{text-align:left}
.row{display:flex;flex-wrap:wrap;gap:12px;margin:.5em 0 1.5em}figure{margin:0}figcaption{font-size:13px;opacity:.8}
img{display:block;image-rendering:pixelated;max-width:100%}
.film{display:grid}.film div{grid-area:1/1;opacity:0}.film div:first-child{opacity:1}
@media(prefers-reduced-motion){.film div{animation:none!important}}.holds{color:#178a3a}.fails{color:#c62828;font-weight:bold}
";

impl Page {
    /// A page with this title, which is also its main heading.
    pub fn new(title: &str) -> Self {
        let title = escaped(title);
        let html = format!(
            "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{title}</title>\n\
             <meta name=\"viewport\" content=\"width=device-width\"><style>{STYLE}</style></head><body>\n<h1>{title}</h1>\n"
        );
        Self { html }
    }

    /// A heading of level 2 or 3.
    pub fn heading(&mut self, level: u8, text: &str) {
        self.push(format_args!("<h{level}>{}</h{level}>\n", escaped(text)));
    }

    /// A paragraph of plain text.
    pub fn paragraph(&mut self, text: &str) {
        self.push(format_args!("<p>{}</p>\n", escaped(text)));
    }

    /// A paragraph that says whether a claim holds.
    pub fn verdict(&mut self, verdict: Verdict, text: &str) {
        let (class, word) = match verdict {
            Verdict::Holds => ("holds", "holds"),
            Verdict::Fails => ("fails", "does not hold"),
        };
        self.push(format_args!("<p>{} <b class=\"{class}\">{word}</b></p>\n", escaped(text)));
    }

    /// A list of names and their values.
    pub fn list(&mut self, entries: &[(&str, String)]) {
        let entry = |(name, text): &(&str, String)| {
            format!("<tr><th>{}</th><td class=\"text\">{}</td></tr>\n", escaped(name), escaped(text))
        };
        let entries: String = entries.iter().map(entry).collect();
        self.push(format_args!("<table>\n{entries}</table>\n"));
    }

    /// A table. The first column is text, the others are numbers.
    pub fn table(&mut self, header: &[&str], rows: &[Vec<String>]) {
        let cells = |tag: &str, cells: &[String]| {
            let cells: String =
                cells.iter().map(|cell| format!("<{tag}>{}</{tag}>", escaped(cell))).collect();
            format!("<tr>{cells}</tr>\n")
        };
        let header: Vec<String> = header.iter().map(|cell| (*cell).to_owned()).collect();
        let body: String = rows.iter().map(|row| cells("td", row)).collect();
        self.push(format_args!("<table>\n{}{body}</table>\n", cells("th", &header)));
    }

    /// Begins a row of pictures.
    pub fn begin_row(&mut self) {
        self.html.push_str("<div class=\"row\">\n");
    }

    /// Ends a row of pictures.
    pub fn end_row(&mut self) {
        self.html.push_str("</div>\n");
    }

    /// A losslessly compressed picture with a caption.
    pub fn picture(&mut self, picture: &Srgb8Picture, caption: &str) {
        self.figure(picture.width(), caption, &image("png", picture, &png(picture), caption));
    }

    /// A picture with a caption, as a JPEG without visible artefacts: a fraction of the bytes for a detailed picture.
    pub fn photograph(&mut self, picture: &Srgb8Picture, caption: &str) {
        self.figure(picture.width(), caption, &image("jpeg", picture, &jpeg(picture, STILL), caption));
    }

    /// Pictures of equal size, shown one after the other in a loop.
    pub fn film(&mut self, frames: &[Srgb8Picture], frames_per_second: u16, caption: &str) {
        let count = frames.len();
        let seconds = count as f64 / f64::from(frames_per_second);
        let frame = |(i, frame): (usize, &Srgb8Picture)| {
            let delay = i as f64 / f64::from(frames_per_second);
            let style = format!("animation:film{count} {seconds}s {delay}s steps(1) infinite");
            format!("<div style=\"{style}\">{}</div>", image("jpeg", frame, &jpeg(frame, MOVING), caption))
        };
        let shown = 100.0 / count as f64;
        let frames_html: String = frames.iter().enumerate().map(frame).collect();
        let film = format!(
            "<style>@keyframes film{count}{{0%{{opacity:1}}{shown:.4}%{{opacity:0}}}}</style><div class=\"film\">{frames_html}</div>"
        );
        self.figure(frames.first().map_or(0, |frame| frame.width()), caption, &film);
    }

    fn figure(&mut self, width: u32, caption: &str, content: &str) {
        let caption = escaped(caption);
        self.push(format_args!(
            "<figure style=\"width:max({width}px,10em)\">{content}<figcaption>{caption}</figcaption></figure>\n"
        ));
    }

    /// A chart of curves.
    pub fn chart(&mut self, chart: &Chart) {
        self.html.push_str(&chart.svg());
    }

    /// The whole page.
    pub fn finish(mut self) -> String {
        self.html.push_str("</body></html>\n");
        self.html
    }

    fn push(&mut self, text: impl Display) {
        write!(self.html, "{text}").expect("a string takes everything");
    }
}

/// Minimum quality of a still JPEG, and of one that is visible for a moment.
const STILL: u8 = 80;
const MOVING: u8 = 70;
/// The quality at which smooth pictures show no banding.
const SMOOTH: u8 = 95;
/// Pictures have the best quality within a limit of bytes per pixel: smooth ones, which show artefacts first, need few.
const CHEAP: f64 = 0.15;

fn png(picture: &Srgb8Picture) -> Vec<u8> {
    let mut bytes = Vec::new();
    write_compact_png(picture, &mut bytes).expect("memory takes a picture");
    bytes
}

fn jpeg(picture: &Srgb8Picture, least_quality: u8) -> Vec<u8> {
    let encoded = |quality| {
        let mut bytes = Vec::new();
        write_jpeg(picture, quality, &mut bytes).expect("memory takes a picture that could be rendered");
        bytes
    };
    let cheap = CHEAP * f64::from(picture.width()) * f64::from(picture.height());
    let better = (least_quality + 5..=SMOOTH).rev().step_by(5).map(encoded);
    better.into_iter().find(|bytes| bytes.len() as f64 <= cheap).unwrap_or_else(|| encoded(least_quality))
}

fn image(kind: &str, picture: &Srgb8Picture, bytes: &[u8], alt: &str) -> String {
    let (width, height) = (picture.width(), picture.height());
    let (alt, data) = (escaped(alt), BASE64.encode(bytes));
    format!(
        "<img width=\"{width}\" height=\"{height}\" alt=\"{alt}\" src=\"data:image/{kind};base64,{data}\">"
    )
}

/// Whether a claim holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    Holds,
    Fails,
}

impl From<bool> for Verdict {
    fn from(holds: bool) -> Self {
        if holds { Self::Holds } else { Self::Fails }
    }
}

/// A curve of a chart.
pub struct Curve {
    pub colour: &'static str,
    pub name: String,
    pub points: Vec<(f64, f64)>,
}

/// Curves over common axes, drawn as SVG. Both axes begin at zero.
pub struct Chart {
    pub title: String,
    pub x_axis: &'static str,
    pub curves: Vec<Curve>,
}

impl Chart {
    fn svg(&self) -> String {
        const WIDTH: f64 = 420.0;
        const HEIGHT: f64 = 240.0;
        const MARGIN: f64 = 34.0;
        let points = || self.curves.iter().flat_map(|curve| &curve.points);
        let right = points().fold(f64::MIN_POSITIVE, |most, (x, _)| most.max(*x));
        let top = points().fold(f64::MIN_POSITIVE, |most, (_, y)| most.max(*y));
        let at = |(x, y): &(f64, f64)| {
            let across = MARGIN + x / right * (WIDTH - 2.0 * MARGIN);
            format!("{across:.2},{:.2}", HEIGHT - MARGIN - y / top * (HEIGHT - 2.0 * MARGIN))
        };
        let mut svg = format!(
            "<figure><svg width=\"{WIDTH}\" height=\"{HEIGHT}\" font-size=\"12\" fill=\"currentColor\" role=\"img\">\
             <title>{title}</title><path d=\"M{MARGIN},{MARGIN}V{base}H{end}\" fill=\"none\" stroke=\"currentColor\"/>\
             <text x=\"{MARGIN}\" y=\"20\">{title}</text><text x=\"{MARGIN}\" y=\"{below}\">0</text>\
             <text x=\"{end}\" y=\"{below}\" text-anchor=\"end\">{right:.3} {x_axis}</text>\
             <text x=\"4\" y=\"{MARGIN}\">{top:.3}</text>\n",
            title = escaped(&self.title),
            x_axis = escaped(self.x_axis),
            base = HEIGHT - MARGIN,
            end = WIDTH - MARGIN,
            below = HEIGHT - MARGIN / 2.0,
        );
        for (i, curve) in self.curves.iter().enumerate() {
            let line: Vec<String> = curve.points.iter().map(at).collect();
            let (colour, name) = (curve.colour, escaped(&curve.name));
            writeln!(
                svg,
                "<polyline fill=\"none\" stroke=\"{colour}\" points=\"{}\"/>\
                 <text x=\"{}\" y=\"{}\" text-anchor=\"end\" fill=\"{colour}\">{name}</text>",
                line.join(" "),
                WIDTH - MARGIN,
                MARGIN + 16.0 * (i + 1) as f64,
            )
            .expect("a string takes everything");
        }
        svg + "</svg></figure>\n"
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_files_cannot_inject_markup() {
        let mut page = Page::new("a<script>&\"");
        page.table(&["<b>"], &[vec!["<i>\"x\"".to_owned()]]);
        let html = page.finish();
        assert!(!html.contains("<script>") && !html.contains("<b>") && !html.contains("<i>"), "{html}");
        assert!(html.contains("a&lt;script&gt;&amp;&quot;"));
    }

    #[test]
    fn smooth_pictures_lose_less_than_busy_ones() {
        let picture = |value: fn(usize) -> usize| {
            let pixels = (0..256 * 256).flat_map(|i| [value(i) as u8; 3]).collect();
            Srgb8Picture::new(256, 256, pixels).expect("whole pixels")
        };
        let with = |picture: &Srgb8Picture, quality| {
            let mut bytes = Vec::new();
            write_jpeg(picture, quality, &mut bytes).expect("memory takes it");
            bytes
        };
        let (smooth, busy) = (picture(|i| i % 256 / 2), picture(|i| i * i * 7919 % 251));
        assert_eq!(jpeg(&smooth, STILL), with(&smooth, SMOOTH));
        assert_eq!(jpeg(&busy, STILL), with(&busy, STILL));
    }

    #[test]
    fn a_page_needs_no_other_file() {
        let mut page = Page::new("pictures");
        page.picture(&Srgb8Picture::black(3, 2), "black");
        page.photograph(&Srgb8Picture::black(3, 2), "black, too");
        page.film(&[Srgb8Picture::black(3, 2), Srgb8Picture::black(3, 2)], 10, "twice");
        let html = page.finish();
        assert_eq!(html.matches("src=\"data:image/png;base64,").count(), 1);
        assert_eq!(html.matches("src=\"data:image/jpeg;base64,").count(), 3);
        assert_eq!(html.matches("src=").count(), 4);
    }
}
