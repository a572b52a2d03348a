//! `roughcast bench gpu`: LEAN Figure 12 on this machine, and the bandwidth of the bake against a plain copy.

use std::process::ExitCode;

use anyhow::{Result, bail};
use pollster::block_on;
use roughcast::shading::Shading;
use roughcast_gpu::bake::{BakePath, Bandwidth, bake_bandwidth, copy_bandwidth};
use roughcast_gpu::{Gpu, GpuOptions};
use serde_json::{Value, json};

use super::figure_12::{Row, SIDE, bake_options, measure};
use crate::args::REPORT;
use crate::scene_args::{Size, size};
use crate::{say, say_json};

/// Measure shading and baking on the graphics card.
///
/// A plane that covers the whole picture is drawn with Blinn-Phong, with a LEAN map, with a LEAN map that is baked
/// for every frame, with a CLEAN map, and with a LEAN map without tangents, along three axes and below noise. The card's own
/// clock measures the times.
#[derive(clap::Args)]
pub struct Args {
    /// Width and height of the picture in pixels
    #[arg(long, value_name = "WxH", default_value = "1600x1200", value_parser = size)]
    size: Size,

    /// Frames per method; the median is reported [default: 200; 10 on a software driver]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=MOST_FRAMES))]
    frames: Option<u32>,

    /// Print the report as JSON
    #[arg(long, help_heading = REPORT)]
    json: bool,
}

const MOST_FRAMES: i64 = 100_000;

/// Defaults for graphics hardware and for a software driver, which is thousands of times slower: frames to measure,
/// and texels along each side of the map whose bake is compared with a copy.
const HARDWARE: (u32, u32) = (200, 4096);
const SOFTWARE: (u32, u32) = (10, 2048);

/// Measures and prints.
pub fn run(args: &Args) -> Result<ExitCode> {
    let gpu = block_on(Gpu::new(&GpuOptions::default()))?;
    if !gpu.has_timestamps() {
        bail!("'{}' has no clock (timestamp queries) to measure by: update its driver", gpu.info().name);
    }
    let (frames, side) = if gpu.is_software() { SOFTWARE } else { HARDWARE };
    let frames = args.frames.unwrap_or(frames);
    let size = (args.size.width, args.size.height);
    let rows = block_on(measure(&gpu, size, frames))?;
    let generation = block_on(Generation::measure(&gpu, side))?;
    let report = Report { gpu: &gpu, size, frames, rows, generation };
    if args.json {
        say_json(&report.json())?
    } else {
        say(&report.text())?
    }
    Ok(ExitCode::SUCCESS)
}

/// Baking a LEAN map with all its levels compared with copying the same number of bytes.
struct Generation {
    side: u32,
    bake: Bandwidth,
    copy: Bandwidth,
}

impl Generation {
    async fn measure(gpu: &Gpu, side: u32) -> Result<Self> {
        let options = bake_options(Shading::Lean);
        let bake = bake_bandwidth(gpu, side, &options, BakePath::default()).await?;
        let copy = copy_bandwidth(gpu, bake.bytes).await?;
        Ok(Self { side, bake, copy })
    }

    /// The bake's bandwidth as a fraction of the copy's.
    fn part(&self) -> f64 {
        self.bake.bytes_per_second() / self.copy.bytes_per_second()
    }
}

struct Report<'a> {
    gpu: &'a Gpu,
    size: (u32, u32),
    frames: u32,
    rows: Vec<Row>,
    generation: Generation,
}

const GIGA: f64 = 1e9;
const MEGA: f64 = 1e6;

impl Report<'_> {
    fn json(&self) -> Value {
        let row = |row: &Row| {
            json!({
                "name": row.name,
                "alu": row.instructions.alu,
                "texture": row.instructions.texture,
                "milliseconds": row.milliseconds,
                "ratio": row.ratio,
                "generated_bytes": row.generated_bytes,
            })
        };
        let Generation { side, bake, copy } = &self.generation;
        json!({
            "adapter": self.gpu.info().name,
            "driver": self.driver(),
            "software": self.gpu.is_software(),
            "size": [self.size.0, self.size.1],
            "frames": self.frames,
            "rows": self.rows.iter().map(row).collect::<Vec<_>>(),
            "generation": {
                "side": side,
                "bytes": bake.bytes,
                "bake_gb_per_s": bake.bytes_per_second() / GIGA,
                "copy_gb_per_s": copy.bytes_per_second() / GIGA,
                "part": self.generation.part(),
            },
        })
    }

    fn text(&self) -> String {
        let mut lines =
            vec![format!("adapter     {}", self.gpu.info().name), format!("driver      {}", self.driver())];
        if self.gpu.is_software() {
            lines.push(
                "            a software driver: its times are not those of graphics hardware".to_owned(),
            );
        }
        let (width, height) = self.size;
        lines.push(format!(
            "picture     {width}x{height}, covered by a plane; median of {} frames",
            self.frames
        ));
        lines.push(format!(
            "maps        half floats, {SIDE}x{SIDE} unless the name gives a side; anisotropic filter"
        ));
        lines.push(String::new());
        lines.push(format!(
            "{:<22} {:>5} {:>8} {:>10} {:>7} {:>13}",
            "method", "ALU", "texture", "ms/frame", "ratio", "MB generated"
        ));
        lines.extend(self.rows.iter().map(line));
        lines.push(
            "ALU and texture: instructions of the fragment shader's SPIR-V; what a driver makes of them differs"
                .to_owned(),
        );
        lines.push(String::new());
        let Generation { side, bake, copy } = &self.generation;
        lines.push(format!(
            "A LEAN map of {side}x{side} with all levels moves {:.0} MB at {:.2} GB/s, {:.0} % of a copy's {:.2} GB/s",
            bake.bytes as f64 / MEGA,
            bake.bytes_per_second() / GIGA,
            100.0 * self.generation.part(),
            copy.bytes_per_second() / GIGA,
        ));
        lines.join("\n")
    }

    fn driver(&self) -> String {
        let info = self.gpu.info();
        let words = [info.driver.as_str(), info.driver_info.as_str(), info.backend.to_str()];
        words.into_iter().filter(|word| !word.is_empty()).collect::<Vec<_>>().join(", ")
    }
}

fn line(row: &Row) -> String {
    let generated = match row.generated_bytes {
        0 => String::new(),
        bytes => format!("{:.1}", bytes as f64 / MEGA),
    };
    let Row { name, instructions, milliseconds, ratio, .. } = row;
    let line = format!(
        "{name:<22} {:>5} {:>8} {milliseconds:>10.4} {ratio:>7.3} {generated:>13}",
        instructions.alu, instructions.texture
    );
    line.trim_end().to_owned()
}
