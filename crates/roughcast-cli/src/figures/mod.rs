//! `roughcast figures`: reproduces figures of the papers, each with the claim that it must show and the numbers that
//! prove it.

mod bumps;
mod curvature;
mod deformation;
mod deforming;
mod given;
mod lean_10;
mod lean_13;
mod lean_14;
mod lean_2;
mod lean_4;
mod lean_5;
mod mikkelsen_1;
mod mikkelsen_2;
mod mikkelsen_3;
mod mikkelsen_4;
mod octaves;
mod scene;

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, anyhow};
use clap::ValueHint;
use roughcast::Named;
use roughcast_io::mesh::FileNormals;
use roughcast_io::picture::{Srgb8Picture, write_png};
use roughcast_io::{AtomicFile, AtomicSet};
use serde_json::{Map, Value, json};

use crate::args::one_of;
use crate::html::{Chart, Page, Verdict};
use crate::progress;

/// Reproduce the figures of the LEAN paper and of Mikkelsen's, each with its claim and the numbers that prove it.
///
/// Writes index.html, which needs no other file; results.json, with claim, numbers and "holds" of each figure; and the
/// pictures as NAME.png. Exits with 1 if a claim does not hold.
#[derive(clap::Args)]
#[command(after_help = "\
Figures:
  lean-2   far away bumps become roughness, and ridges a highlight with a direction
  lean-4   Blinn-Phong and Beckmann approach each other as the exponent grows
  lean-5   four models that look the same where nothing is filtered
  lean-10  two layers that cancel, mixed in three ways
  lean-13  bumps with a direction, as the object moves away
  lean-14  a raised checkerboard: conventional bump maps alias, LEAN does not
  mikkelsen-1  the normal of displaced facets shows their edges, the surface gradient does not
  mikkelsen-2  Perlin's older perturbation turns normals inward
  mikkelsen-3  derivatives on the screen and in space agree where pixels are dense
  mikkelsen-4  heights on the screen against normal mapping, and under magnification
  deforming  a mesh that bends: tangents of the rest pose, derivatives, new tangents
  octaves  octaves of noise finer than a pixel, which become roughness
  geometric-aa  geometric specular antialiasing")]
pub struct Args {
    /// Which figures [default: all]
    #[arg(value_name = "NAME", value_parser = one_of::<Name>())]
    names: Vec<Name>,

    /// The folder to write to; it is created if missing
    #[arg(short, long, value_name = "FOLDER", value_hint = ValueHint::DirPath)]
    output: PathBuf,

    /// The mesh of mikkelsen-4 and deforming (.obj, .gltf, .glb), with texture coordinates, and of geometric-aa
    /// [default: shapes of its own]
    #[arg(long, value_name = "MESH", value_hint = ValueHint::FilePath)]
    mesh: Option<PathBuf>,

    /// Normals of that mesh: those of the file, or computed ones, smooth or flat
    #[arg(long, default_value = "file", value_parser = one_of::<FileNormals>(), requires = "mesh")]
    normals: FileNormals,

    /// The height map of mikkelsen-4 and deforming [default: patterns of its own]
    #[arg(long, value_name = "MAP", value_hint = ValueHint::FilePath)]
    height_map: Option<PathBuf>,

    /// Treat white as deep in that map
    #[arg(long, requires = "height_map")]
    invert_height: bool,
}

/// The figures that can be reproduced, by paper and number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Name {
    Lean2,
    Lean4,
    Lean5,
    Lean10,
    Lean13,
    Lean14,
    Mikkelsen1,
    Mikkelsen2,
    Mikkelsen3,
    Mikkelsen4,
    Deforming,
    Octaves,
    GeometricAa,
}

impl Named for Name {
    fn all() -> &'static [Self] {
        &[
            Self::Lean2,
            Self::Lean4,
            Self::Lean5,
            Self::Lean10,
            Self::Lean13,
            Self::Lean14,
            Self::Mikkelsen1,
            Self::Mikkelsen2,
            Self::Mikkelsen3,
            Self::Mikkelsen4,
            Self::Deforming,
            Self::Octaves,
            Self::GeometricAa,
        ]
    }

    fn name(self) -> &'static str {
        match self {
            Self::Lean2 => "lean-2",
            Self::Lean4 => "lean-4",
            Self::Lean5 => "lean-5",
            Self::Lean10 => "lean-10",
            Self::Lean13 => "lean-13",
            Self::Lean14 => "lean-14",
            Self::Mikkelsen1 => "mikkelsen-1",
            Self::Mikkelsen2 => "mikkelsen-2",
            Self::Mikkelsen3 => "mikkelsen-3",
            Self::Mikkelsen4 => "mikkelsen-4",
            Self::Deforming => "deforming",
            Self::Octaves => "octaves",
            Self::GeometricAa => "geometric-aa",
        }
    }
}

impl Name {
    fn make(self, args: &Args) -> Result<Figure> {
        match self {
            Self::Lean2 => lean_2::make(),
            Self::Lean4 => Ok(lean_4::make()),
            Self::Lean5 => lean_5::make(),
            Self::Lean10 => lean_10::make(),
            Self::Lean13 => lean_13::make(),
            Self::Lean14 => lean_14::make(),
            Self::Mikkelsen1 => mikkelsen_1::make(),
            Self::Mikkelsen2 => mikkelsen_2::make(),
            Self::Mikkelsen3 => mikkelsen_3::make(),
            Self::Mikkelsen4 => mikkelsen_4::make(args),
            Self::Deforming => deforming::make(args),
            Self::Octaves => octaves::make(),
            Self::GeometricAa => curvature::make(args),
        }
    }
}

/// A figure with its claim.
struct Figure {
    title: &'static str,
    /// The claim of the paper's figure, stated precisely.
    claim: String,
    /// The numbers that decide the claim, with their limits.
    numbers: Map<String, Value>,
    /// Whether the claim holds.
    holds: bool,
    /// How the figure was made: maps, their bits, exponent, sizes.
    making: String,
    panels: Vec<Panel>,
    charts: Vec<Chart>,
    table: Option<Table>,
}

/// One picture of a figure.
struct Panel {
    picture: Srgb8Picture,
    caption: String,
}

/// Numbers that do not fit into a sentence.
struct Table {
    header: Vec<&'static str>,
    rows: Vec<Vec<String>>,
}

/// Makes the figures, and reports which claims hold.
pub fn run(args: &Args) -> Result<ExitCode> {
    let names = if args.names.is_empty() { Name::all().to_vec() } else { args.names.clone() };
    let folder = || args.output.display().to_string();
    fs::create_dir_all(&args.output).with_context(folder)?;
    let bar = progress::bar(names.len() as u64);
    let mut figures = Vec::new();
    for name in names {
        bar.set_message(name.name());
        figures.push((name.name(), name.make(args).with_context(|| name.name())?));
        bar.inc(1);
    }
    bar.finish_and_clear();
    write(&args.output, &figures)?;
    for (name, figure) in &figures {
        let verdict = if figure.holds { "holds" } else { "DOES NOT HOLD" };
        crate::say(&format!("{name}: {verdict}: {}", figure.claim))?;
    }
    Ok(ExitCode::from(u8::from(figures.iter().any(|(_, figure)| !figure.holds))))
}

/// Writes all files, or none.
fn write(folder: &Path, figures: &[(&str, Figure)]) -> Result<()> {
    let mut set = AtomicSet::new();
    let mut add = |name: &str, write: &dyn Fn(&mut AtomicFile) -> Result<()>| -> Result<()> {
        let path = folder.join(name);
        let named = || path.display().to_string();
        let mut file = AtomicFile::create(&path).with_context(named)?;
        write(&mut file).with_context(named)?;
        set.push(file).with_context(named)
    };
    for (name, figure) in figures {
        let pictures = figure.panels.iter().map(|panel| &panel.picture);
        if let Some(picture) = Srgb8Picture::side_by_side(pictures, GAP, PAPER) {
            add(&format!("{name}.png"), &|file| Ok(write_png(&picture, file)?))?;
        }
    }
    let results = serde_json::to_string_pretty(&results(figures)).expect("plain data");
    add("results.json", &|file| Ok(writeln!(file, "{results}")?))?;
    let page = page(figures);
    add("index.html", &|file| Ok(file.write_all(page.as_bytes())?))?;
    set.commit().map_err(|error| anyhow!("{}: {error}", folder.display()))
}

fn results(figures: &[(&str, Figure)]) -> Value {
    let entry = |(name, figure): &(&str, Figure)| {
        let value = json!({ "claim": figure.claim, "numbers": figure.numbers, "holds": figure.holds });
        ((*name).to_owned(), value)
    };
    Value::Object(figures.iter().map(entry).collect())
}

fn page(figures: &[(&str, Figure)]) -> String {
    let mut page = Page::new("roughcast: figures of the papers, reproduced");
    for (name, figure) in figures {
        page.heading(2, &format!("{name}: {}", figure.title));
        page.verdict(Verdict::from(figure.holds), &figure.claim);
        page.paragraph(&figure.making);
        page.begin_row();
        figure.panels.iter().for_each(|panel| page.picture(&panel.picture, &panel.caption));
        figure.charts.iter().for_each(|chart| page.chart(chart));
        page.end_row();
        let numbers = figure.numbers.iter().map(|(name, value)| vec![name.clone(), shown(value)]);
        page.table(&["number", "value"], &numbers.collect::<Vec<_>>());
        if let Some(table) = &figure.table {
            page.table(&table.header, &table.rows);
        }
    }
    page.finish()
}

/// A number with four digits; results.json has all of them.
fn shown(value: &Value) -> String {
    match value.as_f64() {
        Some(number) if value.is_f64() => four_digits(number),
        _ => value.to_string(),
    }
}

fn four_digits(number: f64) -> String {
    let magnitude = number.abs().log10().floor();
    if number == 0.0 {
        "0".to_owned()
    } else if (-4.0..6.0).contains(&magnitude) {
        format!("{number:.*}", (3.0 - magnitude).max(0.0) as usize)
    } else {
        format!("{number:.3e}")
    }
}

/// Pixels between the panels of a figure's picture, and the grey level of the gap.
const GAP: u32 = 4;
const PAPER: u8 = 255;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_four_digits() {
        for (value, text) in [
            (json!(0.123_456_789_012_345_67), "0.1235"),
            (json!(-1.0 / 3.0), "-0.3333"),
            (json!(1.0), "1.000"),
            (json!(0.99996), "1.0000"),
            (json!(12.345_678), "12.35"),
            (json!(123_456.7), "123457"),
            (json!(1.234_567e-5), "1.235e-5"),
            (json!(9.876_543e7), "9.877e7"),
            (json!(0.0), "0"),
            (json!(16_384), "16384"),
        ] {
            assert_eq!(shown(&value), text);
        }
    }
}
