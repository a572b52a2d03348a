//! What a bake says of itself: lines for people, JSON for scripts.

use std::path::PathBuf;
use std::time::Duration;

use anyhow::Result;
use roughcast::texture::{Bounds, TextureArray, decode};
use roughcast::{BakeOptions, BakeReport, Covariance, Kind, Moments, SampleType, SourceOptions};
use roughcast_io::FileInfo;
use serde_json::{Value, json};

use crate::{complain, say, say_json, warn};

/// A map's report.
pub struct FileReport {
    pub input: PathBuf,
    pub files: Vec<PathBuf>,
    pub info: FileInfo,
    pub source: SourceOptions,
    pub options: BakeOptions,
    pub report: BakeReport,
    pub compression: Option<CompressionError>,
    pub green_correlation: Option<f64>,
    /// Which common readers refuse such a file.
    pub reader_note: Option<String>,
    pub warnings: Vec<String>,
    /// Only filled where they are to be shown.
    pub times: Vec<(&'static str, Duration)>,
}

/// What block compression adds to the deviation of slopes, `σ = sqrt(tr Σ / 2)`, over all levels.
#[derive(Clone, Copy, Debug)]
pub struct CompressionError {
    pub sigma_rms: f64,
    pub sigma_max: f64,
    /// The largest error of the variance along an axis.
    pub variance: f32,
    /// The largest error of the variance along any direction.
    pub any_direction: f32,
}

impl CompressionError {
    pub fn between(before: &[TextureArray], after: &[TextureArray]) -> Result<Self> {
        let sigma = |moments: &Moments| f64::from(0.5 * moments.covariance().trace()).sqrt();
        let (mut squares, mut largest, mut texels) = (0.0, 0.0_f64, 0_u64);
        let (mut variance, mut any_direction) = (0.0_f32, 0.0_f32);
        for (before, after) in decode(before)?.iter().zip(&decode(after)?) {
            for (before, after) in before.moments.iter().zip(&after.moments) {
                let error = (sigma(before) - sigma(after)).abs();
                squares += error * error;
                largest = largest.max(error);
                texels += 1;
                let (a, b) = (before.covariance(), after.covariance());
                let off = Covariance { xx: a.xx - b.xx, yy: a.yy - b.yy, xy: a.xy - b.xy };
                variance = variance.max(off.xx.abs()).max(off.yy.abs());
                let (large, small) = off.eigenvalues();
                any_direction = any_direction.max(large.abs()).max(small.abs());
            }
        }
        let sigma_rms = (squares / texels.max(1) as f64).sqrt();
        Ok(Self { sigma_rms, sigma_max: largest, variance, any_direction })
    }
}

impl FileReport {
    /// What the files give back, the blocks' error included.
    fn bounds(&self) -> Bounds {
        self.with_blocks(self.report.bounds)
    }

    fn with_blocks(&self, stored: Bounds) -> Bounds {
        match self.compression {
            None => stored,
            Some(blocks) => Bounds {
                variance: stored.variance + blocks.variance,
                eigenvalue: stored.eigenvalue + blocks.any_direction,
                ..stored
            },
        }
    }

    /// Prints the report to stdout and the warnings to stderr.
    pub fn print(&self, as_json: bool) -> Result<()> {
        self.warn();
        if as_json {
            return say_json(&self.json());
        }
        self.lines().iter().try_for_each(|line| say(line))?;
        for (stage, time) in &self.times {
            complain(&format!("  {stage:<12} {:>8.1} ms", time.as_secs_f64() * 1e3));
        }
        Ok(())
    }

    /// Prints the warnings to stderr.
    pub fn warn(&self) {
        self.warnings.iter().for_each(|warning| warn(&self.input, warning));
    }

    fn lines(&self) -> Vec<String> {
        let report = &self.report;
        let files: Vec<String> = self.files.iter().map(|file| file.display().to_string()).collect();
        let shown = if files.len() > 4 {
            format!("{} … {} ({} files)", files[0], files[files.len() - 1], files.len())
        } else {
            files.join(", ")
        };
        let mut lines = vec![
            format!("{} -> {shown}", self.input.display()),
            format!(
                "  {} map, {}x{} ({} {}), {} levels of '{}', {}",
                self.source.kind,
                self.info.width,
                self.info.height,
                self.info.container,
                self.info.format,
                report.levels.len(),
                self.options.layout,
                texels_in_words(self.options.bits),
            ),
            format!(
                "  slopes: rms {:.4}{}, steepest {:.3}{}; specular power up to {:.0} ({:.0} in any direction){}",
                report.rms_slope,
                self.with_base_in_words(),
                report.steepest,
                self.scales_in_words(),
                self.bounds().usable_specular_power(),
                self.bounds().usable_specular_power_any_direction(),
                self.power_of_most_in_words(),
            ),
        ];
        if let Some((width, height)) = report.roughness_resampled_from {
            lines.push(format!(
                "  roughness map of {width}x{height} resampled to {}x{}, as slope variance",
                self.info.width, self.info.height
            ));
        }
        let counts = report.counts;
        if counts.total() > 0 {
            lines.push(format!(
                "  mended of {} texels: {} too steep, {} pointing into the surface, {} without a direction, {} NaN or \
                 infinite",
                report.texels, counts.clamped, counts.behind, counts.invalid, counts.non_finite
            ));
        }
        if let Some(limit) = report.limit {
            lines.push(format!(
                "  slopes are limited to {:.3}, which {} texels exceed: that wins a factor of {:.1} in specular power \
                 (--max-slope auto)",
                limit.max_slope, limit.texels, limit.factor
            ));
        }
        if let Some(advice) = report.advice {
            lines.push(format!(
                "  the steepest 0.1 % of the texels cost a factor of {:.1} in specular power: --max-slope {:.3} wins it \
                 back",
                advice.factor, advice.max_slope
            ));
        }
        if let Some(note) = &self.reader_note {
            lines.push(format!("  {note}"));
        }
        if let Some(error) = self.compression {
            lines.push(format!(
                "  block compression adds to sigma: {:.5} rms, {:.5} at most",
                error.sigma_rms, error.sigma_max
            ));
        }
        lines
    }

    /// What the texels give back but for the steepest 0.1 %, the blocks' error included.
    fn bounds_of_most(&self) -> Bounds {
        self.with_blocks(self.report.bounds_of_most)
    }

    /// The specular power without the steepest texels, where it is clearly another.
    fn power_of_most_in_words(&self) -> String {
        const CLEARLY: f32 = 1.5;
        let power = self.bounds_of_most().usable_specular_power();
        if power > CLEARLY * self.bounds().usable_specular_power() {
            format!(", {power:.0} on 99.9 % of the texels")
        } else {
            String::new()
        }
    }

    /// The root mean square with the base roughness, where it is another.
    fn with_base_in_words(&self) -> String {
        let BakeReport { rms_slope, rms_slope_with_base, .. } = self.report;
        if rms_slope_with_base > rms_slope {
            format!(" ({rms_slope_with_base:.4} with the base roughness)")
        } else {
            String::new()
        }
    }

    /// The scales that a shader needs to decode the texels.
    fn scales(&self) -> [Option<f32>; 2] {
        let BakeOptions { layout, bits, .. } = self.options;
        let sample_type = bits;
        [
            layout.uses_scale(sample_type).then_some(self.report.scale),
            layout.uses_variance_scale(sample_type).then_some(self.report.variance_scale),
        ]
    }

    fn scales_in_words(&self) -> String {
        let [scale, variance_scale] = self.scales();
        let scale = scale.map(|scale| format!("; scale {scale}"));
        let variance_scale = variance_scale.map(|scale| format!("; variance scale {scale}"));
        scale.into_iter().chain(variance_scale).collect()
    }

    /// The report as JSON; docs/reports.md explains its keys.
    pub fn json(&self) -> Value {
        let report = &self.report;
        let levels: Vec<Value> = report
            .levels
            .iter()
            .map(|((width, height), stats)| {
                json!({
                    "width": width,
                    "height": height,
                    "variance_x": stats.mean_variance_x,
                    "variance_y": stats.mean_variance_y,
                    "variance_max": stats.max_variance,
                })
            })
            .collect();
        let times: serde_json::Map<String, Value> =
            self.times.iter().map(|(stage, time)| ((*stage).to_owned(), json!(time.as_secs_f64()))).collect();
        json!({
            "input": self.input.display().to_string(),
            "outputs": self.files.iter().map(|file| file.display().to_string()).collect::<Vec<_>>(),
            "kind": self.source.kind.name(),
            "green": (self.source.kind == Kind::Normal).then(|| self.source.green.name()),
            "red": (self.source.kind == Kind::Normal).then(|| self.source.red.name()),
            "normal_scale": (self.source.kind == Kind::Normal).then_some(self.source.normal_scale),
            "green_correlation": self.green_correlation,
            "range": self.source.range.name(),
            "normal_channels": self.source.normal_channels.name(),
            "width": self.info.width,
            "height": self.info.height,
            "layout": self.options.layout.name(),
            "bits": self.options.bits.name(),
            "base": self.options.base.name(),
            "filter": self.options.filter.name(),
            "wrap": self.source.wrap.name(),
            "max_slope": report.max_slope,
            "scale": self.scales()[0],
            "variance_scale": self.scales()[1],
            "texels": report.texels,
            "clamped": report.counts.clamped,
            "behind": report.counts.behind,
            "invalid": report.counts.invalid,
            "non_finite": report.counts.non_finite,
            "steepest_slope": report.steepest,
            "rms_slope": report.rms_slope,
            "rms_slope_with_base": report.rms_slope_with_base,
            "slope_error": self.bounds().slope,
            "variance_error": self.bounds().variance,
            "usable_specular_power": self.bounds().usable_specular_power(),
            "usable_specular_power_any_direction": self.bounds().usable_specular_power_any_direction(),
            "limit": report.limit.map(|limit| json!({
                "max_slope": limit.max_slope,
                "texels": limit.texels,
                "specular_power_factor": limit.factor,
            })),
            "usable_specular_power_of_most": self.bounds_of_most().usable_specular_power(),
            "advice": report.advice.map(|advice| json!({
                "max_slope": advice.max_slope,
                "specular_power_factor": advice.factor,
            })),
            "compression": self.compression.map(|error| json!({
                "sigma_error_rms": error.sigma_rms,
                "sigma_error_max": error.sigma_max,
                "variance_error": error.variance,
            })),
            "roughness_resampled_from": report.roughness_resampled_from.map(|(width, height)| [width, height]),
            "levels": levels,
            "reader_note": self.reader_note,
            "warnings": self.warnings,
            "seconds": times,
        })
    }
}

fn texels_in_words(bits: SampleType) -> &'static str {
    match bits {
        SampleType::U8 => "8 bits",
        SampleType::U16 => "16 bits",
        SampleType::F16 => "half floats",
        SampleType::F32 => "floats",
    }
}
