//! The report of a job for scripts.

use roughcast::Kind;
use serde_json::{Value, json};

use crate::JobReport;

impl JobReport {
    /// The report as JSON: `bake --json` prints this with the program's messages, and docs/reports.md explains the keys. The
    /// findings, the limits of readers and the times are not in it: each program has its own words for them.
    pub fn to_json(&self) -> Value {
        let report = &self.report;
        let of_normals = self.source.kind == Kind::Normal;
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
        json!({
            "input": self.input.display().to_string(),
            "outputs": self.files.iter().map(|file| file.display().to_string()).collect::<Vec<_>>(),
            "kind": self.source.kind.name(),
            "green": of_normals.then(|| self.source.green.name()),
            "red": of_normals.then(|| self.source.red.name()),
            "normal_scale": of_normals.then_some(self.source.normal_scale),
            "green_correlation": self.green_correlation,
            "range": self.source.range.name(),
            "normal_channels": self.source.normal_channels.name(),
            "width": self.info.width,
            "height": self.info.height,
            "layout": self.options.layout.name(),
            "bits": self.options.sample_type.name(),
            "base": self.options.base.name(),
            "filter": self.options.filter.name(),
            "wrap": self.source.wrap.name(),
            "max_slope": report.max_slope,
            "scale": self.scale(),
            "variance_scale": self.spread_scale(),
            "texels": report.texels,
            "clamped": report.counts.clamped,
            "behind": report.counts.behind,
            "invalid": report.counts.invalid,
            "non_finite": report.counts.non_finite,
            "steepest_slope": report.maximum_slope,
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
        })
    }
}
