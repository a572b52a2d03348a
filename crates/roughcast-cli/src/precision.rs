//! `roughcast precision`: which sample type a map needs.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result};
use clap::ValueHint;
use roughcast::SampleType;
use roughcast::precision::{Precision, maximum_slope, measure, recommend};
use serde_json::{Value, json};

use crate::args::{REPORT, SourceArgs, specular_power};
use crate::bake::usage_where_options;
use crate::findings::warn_of;
use crate::input::read_map;
use crate::{say, say_json};

/// Show how precise a map's variance is in 8 bits, 16 bits, half and float, and which type is sufficient.
///
/// LEAN's variance is a small difference of large numbers; a highlight of specular power S is safe if 1/S is larger
/// than the error. The table shows the largest possible error, the error measured on this map, the specular powers that
/// they allow, and the maximum slope that each type represents at the specular power that you need.
#[derive(clap::Args)]
pub struct Args {
    /// A normal or height map
    #[arg(value_hint = ValueHint::FilePath)]
    input: PathBuf,

    /// The highest specular power (Blinn-Phong exponent) that the material will use
    #[arg(long, value_name = "S", default_value_t = 256.0, value_parser = specular_power)]
    specular_power: f32,

    /// Print the table as JSON
    #[arg(long, help_heading = REPORT)]
    json: bool,

    #[command(flatten)]
    source: SourceArgs,
}

pub fn run(args: &Args) -> Result<ExitCode> {
    let map = read_map(&args.input, &args.source)?;
    warn_of(&args.input, &map);
    let rows = measure(&map.image, &map.options)
        .map_err(usage_where_options)
        .with_context(|| args.input.display().to_string())?;
    let best = recommend(&rows, args.specular_power);
    if args.json {
        let report = json!({
            "input": args.input.display().to_string(),
            "specular_power": args.specular_power,
            "recommended": best.map(SampleType::name),
            "storage": rows.iter().map(|row| as_json(row, args.specular_power)).collect::<Vec<_>>(),
        });
        say_json(&report)?;
        return Ok(ExitCode::SUCCESS);
    }
    say(&format!(
        "{:<6} {:>9} {:>12} {:>12} {:>12} {:>12} {:>14}",
        "bits", "scale", "error <=", "measured", "usable S", "on this map", "maximum slope"
    ))?;
    for row in &rows {
        say(&format!(
            "{:<6} {:>9.4} {:>12.3e} {:>12.3e} {:>12.0} {:>12.0} {:>14.3}",
            row.sample_type,
            row.scale,
            row.bound.variance,
            row.measured_variance,
            row.usable_specular_power(),
            row.measured_specular_power(),
            maximum_slope(row.sample_type, args.specular_power),
        ))?;
    }
    if let Some(limit) = lowered(&rows) {
        say(&format!("For 8 and 16 bits, slopes are limited to {limit:.3} (--max-slope auto)"))?;
    }
    say(&advice(best, args.specular_power))?;
    Ok(ExitCode::SUCCESS)
}

/// The maximum slope of unsigned types, if it is lower than that of floats.
fn lowered(rows: &[Precision]) -> Option<f32> {
    let limit = |bits| rows.iter().find(|row| row.sample_type == bits).map(|row| row.max_slope);
    limit(SampleType::U16)
        .filter(|of_sixteen| limit(SampleType::F32).is_some_and(|of_floats| *of_sixteen < of_floats))
}

fn advice(best: Option<SampleType>, power: f32) -> String {
    match best {
        Some(bits) => format!("For a specular power of {power}: --bits {bits}"),
        None => format!(
            "No type represents a specular power of {power} with this map: lower --max-slope to the maximum slope above, or \
             store the variance itself with --as variance"
        ),
    }
}

fn as_json(row: &Precision, power: f32) -> Value {
    json!({
        "bits": row.sample_type.name(),
        "scale": row.scale,
        "max_slope": row.max_slope,
        "variance_error_bound": row.bound.variance,
        "variance_error_measured": row.measured_variance,
        "eigenvalue_error_bound": row.bound.eigenvalue,
        "eigenvalue_error_measured": row.measured_eigenvalue,
        "usable_specular_power": row.usable_specular_power(),
        "usable_specular_power_any_direction": row.bound.usable_specular_power_any_direction(),
        "usable_specular_power_measured": row.measured_specular_power(),
        "steepest_slope_for_specular_power": maximum_slope(row.sample_type, power),
    })
}
