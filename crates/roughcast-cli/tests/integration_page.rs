//! docs/integration.md: the radiances in its table are those that its commands produce.

mod common;

use std::path::Path;

use common::{run, scratch, text};
use roughcast::Samples;
use roughcast_io::{ReadOptions, read_image_file};

/// The table has five decimal places, and a compiler elsewhere may contract sums of f32 differently.
const TOLERANCE: f32 = 2e-4;

/// A row of the table.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Pixel {
    column: usize,
    row: usize,
    published: f32,
    corrected: f32,
}

fn page() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/integration.md");
    std::fs::read_to_string(path).expect("docs/integration.md is there")
}

/// The rows of the table of pixels, whose four cells are numbers.
fn pixels(page: &str) -> Vec<Pixel> {
    let numbers = |line: &str| -> Option<Pixel> {
        let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
        let [column, row, published, corrected] = cells[..] else { return None };
        Some(Pixel {
            column: column.parse().ok()?,
            row: row.parse().ok()?,
            published: published.parse().ok()?,
            corrected: corrected.parse().ok()?,
        })
    };
    page.lines().filter(|line| line.starts_with('|')).filter_map(numbers).collect()
}

/// Red channel of every pixel of a picture made with the page's commands.
fn rendered(page: &str, footprint: &str) -> (usize, Vec<f32>) {
    let folder = scratch();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let at = |word: &str| match word {
        "check.ktx2" | "check.exr" => text(&folder.path().join(word)).to_owned(),
        "examples/rock_normal.png" => text(&root.join(word)).to_owned(),
        "published" => footprint.to_owned(),
        other => other.to_owned(),
    };
    let commands = page.lines().filter_map(|line| line.strip_prefix("roughcast "));
    let mut count = 0;
    for command in commands {
        run(command.split_whitespace().map(at)).expect_success();
        count += 1;
    }
    assert_eq!(count, 2, "a bake and a picture");
    let decoded = read_image_file(&folder.path().join("check.exr"), &ReadOptions::default());
    let image = decoded.expect("the picture reads back").image;
    let Samples::F32(samples) = image.samples() else { panic!("not single floats") };
    let red = samples.chunks_exact(image.channels()).map(|pixel| pixel[0]).collect();
    (image.width(), red)
}

/// The listed pixels that differ from the rendered ones, as corrected rows of the table.
fn wrong(page: &str, listed: &[Pixel]) -> Vec<String> {
    let [published, corrected] = ["published", "corrected"].map(|footprint| rendered(page, footprint));
    let at = |(width, red): &(usize, Vec<f32>), pixel: &Pixel| red[pixel.row * width + pixel.column];
    let rows = listed.iter().filter_map(|pixel| {
        let (a, b) = (at(&published, pixel), at(&corrected, pixel));
        let close = |got: f32, wanted: f32| (got - wanted).abs() <= TOLERANCE * wanted.max(0.1);
        let right = close(a, pixel.published) && close(b, pixel.corrected);
        (!right).then(|| format!("| {} | {} | {a:.5} | {b:.5} |", pixel.column, pixel.row))
    });
    rows.collect()
}

#[test]
fn the_pixels_of_the_page_match_its_commands() {
    let page = page();
    let listed = pixels(&page);
    assert_eq!(listed.len(), 9, "{listed:?}");
    let wrong = wrong(&page, &listed);
    assert!(wrong.is_empty(), "docs/integration.md should have\n{}", wrong.join("\n"));
    // Equal pixels or equal columns would prove nothing.
    let brightest = listed.iter().map(|pixel| pixel.published).fold(0.0, f32::max);
    let darkest = listed.iter().map(|pixel| pixel.published).fold(f32::MAX, f32::min);
    assert!(brightest > 3.0 * darkest, "{darkest} to {brightest}");
    assert!(listed.iter().any(|pixel| (pixel.corrected / pixel.published - 1.0).abs() > 0.02));
}

#[test]
fn a_wrong_number_is_found() {
    let page = page();
    let mut listed = pixels(&page);
    listed[4].corrected *= 1.002;
    assert_eq!(wrong(&page, &listed).len(), 1);
}
