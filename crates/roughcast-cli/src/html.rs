//! Reports as one HTML file: styles, tables and pictures all inside, so that the file can be sent on alone.

use std::fmt::{Display, Write};

use base64::Engine;
use base64::engine::general_purpose::STANDARD as BASE64;
use roughcast_io::picture::{Srgb8Picture, write_animation, write_png};

/// A page that is being written.
pub struct Page {
    html: String,
}

const STYLE: &str = "\
:root{color-scheme:light dark}body{font:15px/1.5 system-ui,sans-serif;max-width:1500px;margin:2em auto;padding:0 1em}
h1,h2,h3{line-height:1.2}table{border-collapse:collapse;margin:.5em 0 1.5em}
th,td{padding:.2em .8em;border-bottom:1px solid #8884;text-align:right}th:first-child,td:first-child,.text{text-align:left}
.row{display:flex;flex-wrap:wrap;gap:12px;margin:.5em 0 1.5em}figure{margin:0}figcaption{font-size:13px;opacity:.8}
img{display:block;image-rendering:pixelated;max-width:100%}.holds{color:#178a3a}.fails{color:#c62828;font-weight:bold}
";

impl Page {
    /// A page with this title, which is also its heading.
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

    /// A list of names and what they stand for.
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

    /// Ends it.
    pub fn end_row(&mut self) {
        self.html.push_str("</div>\n");
    }

    /// A picture with a caption.
    pub fn picture(&mut self, picture: &Srgb8Picture, caption: &str) {
        let mut bytes = Vec::new();
        write_png(picture, &mut bytes).expect("memory takes a picture");
        self.png((picture.width, picture.height), &bytes, caption);
    }

    /// Pictures of equal size, one after the other, for ever.
    pub fn animation(&mut self, frames: &[Srgb8Picture], frames_per_second: u16, caption: &str) {
        let mut bytes = Vec::new();
        write_animation(frames, frames_per_second, &mut bytes).expect("memory takes frames of equal size");
        self.png((frames[0].width, frames[0].height), &bytes, caption);
    }

    fn png(&mut self, (width, height): (u32, u32), bytes: &[u8], caption: &str) {
        let (caption, data) = (escaped(caption), BASE64.encode(bytes));
        self.push(format_args!(
            "<figure style=\"width:max({width}px,10em)\"><img width=\"{width}\" height=\"{height}\" alt=\"{caption}\" src=\"data:image/png;base64,{data}\">\
             <figcaption>{caption}</figcaption></figure>\n"
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
    fn a_page_needs_no_other_file() {
        let mut page = Page::new("pictures");
        page.picture(&Srgb8Picture::black(3, 2), "black");
        page.animation(&[Srgb8Picture::black(3, 2), Srgb8Picture::black(3, 2)], 10, "twice");
        let html = page.finish();
        assert_eq!(html.matches("src=\"data:image/png;base64,").count(), 2);
        assert_eq!(html.matches("src=").count(), 2);
    }
}
