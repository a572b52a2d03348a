//! The report of a bake: lines for people, JSON for scripts.

use std::time::Duration;

use anyhow::Result;
use roughcast::{BakeReport, SampleType};
use roughcast_pipeline::{JobReport, Stage};
use serde_json::{Value, json};

use crate::findings::{words_of, words_on_readers};
use crate::{complain, say, say_json, warn};

/// A map's report, and which parts of it are shown.
pub struct FileReport {
    job: Box<JobReport>,
    /// The common readers that reject such a file.
    reader_note: Option<String>,
    warnings: Vec<String>,
    times: Times,
}

/// Whether the times of the stages are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Times {
    Hidden,
    Shown,
}

impl FileReport {
    pub fn new(job: Box<JobReport>, times: Times) -> Self {
        let reader_note = words_on_readers(&job.reader_limits);
        let warnings = job.findings.iter().map(words_of).collect();
        Self { job, reader_note, warnings, times }
    }

    /// The stages with their times, if they are shown.
    fn times(&self) -> &[(Stage, Duration)] {
        match self.times {
            Times::Hidden => &[],
            Times::Shown => &self.job.times,
        }
    }

    /// Prints the report to stdout and the warnings to stderr.
    pub fn print(&self, as_json: bool) -> Result<()> {
        self.warn();
        if as_json {
            return say_json(&self.json());
        }
        self.lines().iter().try_for_each(|line| say(line))?;
        for (stage, time) in self.times() {
            let stage = stage.name();
            complain(&format!("  {stage:<12} {:>8.1} ms", time.as_secs_f64() * 1e3));
        }
        Ok(())
    }

    /// Prints the warnings to stderr.
    pub fn warn(&self) {
        self.warnings.iter().for_each(|warning| warn(&self.job.input, warning));
    }

    fn lines(&self) -> Vec<String> {
        let report = &self.job.report;
        let files: Vec<String> = self.job.files.iter().map(|file| file.display().to_string()).collect();
        let shown = if files.len() > 4 {
            format!("{} … {} ({} files)", files[0], files[files.len() - 1], files.len())
        } else {
            files.join(", ")
        };
        let mut lines = vec![
            format!("{} -> {shown}", self.job.input.display()),
            format!(
                "  {} map, {}x{} ({} {}), {} levels of '{}', {}",
                self.job.source.kind,
                self.job.info.width,
                self.job.info.height,
                self.job.info.container,
                self.job.info.format,
                report.levels.len(),
                self.job.options.layout,
                texels_in_words(self.job.options.sample_type),
            ),
            format!(
                "  slopes: rms {:.4}{}, maximum {:.3}{}; specular power up to {:.0} ({:.0} in any direction){}",
                report.rms_slope,
                self.with_base_in_words(),
                report.maximum_slope,
                self.scales_in_words(),
                self.job.bounds().usable_specular_power(),
                self.job.bounds().usable_specular_power_any_direction(),
                self.power_of_most_in_words(),
            ),
        ];
        if let Some((width, height)) = report.roughness_resampled_from {
            lines.push(format!(
                "  roughness map of {width}x{height} resampled to {}x{}, as slope variance",
                self.job.info.width, self.job.info.height
            ));
        }
        let counts = report.counts;
        if counts.total() > 0 {
            lines.push(format!(
                "  repaired {} of {} texels: {} too steep, {} pointing into the surface, {} without a direction, {} NaN or \
                 infinite",
                counts.total(), report.texels, counts.clamped, counts.behind, counts.invalid, counts.non_finite
            ));
        }
        if let Some(limit) = report.limit {
            lines.push(format!(
                "  slopes are limited to {:.3} ({} texels clamped): this gains a factor of {:.1} in specular power \
                 (--max-slope auto)",
                limit.max_slope, limit.texels, limit.factor
            ));
        }
        if let Some(advice) = report.advice {
            lines.push(format!(
                "  the steepest 0.1 % of the texels cost a factor of {:.1} in specular power: --max-slope {:.3} recovers \
                 it",
                advice.factor, advice.max_slope
            ));
        }
        if let Some(note) = &self.reader_note {
            lines.push(format!("  {note}"));
        }
        if let Some(error) = self.job.compression {
            lines.push(format!(
                "  block compression adds to sigma: {:.5} rms, {:.5} at most",
                error.sigma_rms, error.sigma_max
            ));
        }
        lines
    }

    /// The specular power without the steepest texels, if it differs clearly.
    fn power_of_most_in_words(&self) -> String {
        const CLEARLY: f32 = 1.5;
        let power = self.job.bounds_of_most().usable_specular_power();
        if power > CLEARLY * self.job.bounds().usable_specular_power() {
            format!(", {power:.0} on 99.9 % of the texels")
        } else {
            String::new()
        }
    }

    /// The root mean square including the base roughness, if it differs.
    fn with_base_in_words(&self) -> String {
        let BakeReport { rms_slope, rms_slope_with_base, .. } = self.job.report;
        if rms_slope_with_base > rms_slope {
            format!(" ({rms_slope_with_base:.4} with the base roughness)")
        } else {
            String::new()
        }
    }

    fn scales_in_words(&self) -> String {
        let scale = self.job.scale().map(|scale| format!("; scale {scale}"));
        let spread_scale = self.job.spread_scale().map(|scale| format!("; variance scale {scale}"));
        scale.into_iter().chain(spread_scale).collect()
    }

    /// The report as JSON, with the messages of the program; docs/reports.md explains its keys.
    pub fn json(&self) -> Value {
        let times = self.times().iter().map(|(stage, time)| (stage.name(), time.as_secs_f64()));
        let mut report = self.job.to_json();
        report["reader_note"] = json!(self.reader_note);
        report["warnings"] = json!(self.warnings);
        report["seconds"] = times.map(|(stage, seconds)| (stage.to_owned(), json!(seconds))).collect();
        report
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
