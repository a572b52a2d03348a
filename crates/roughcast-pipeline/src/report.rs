//! The report of a job, as data.

use std::path::PathBuf;
use std::time::Duration;

use roughcast::texture::Bounds;
use roughcast::{BakeOptions, BakeReport, SourceOptions};
use roughcast_io::{CompressionError, FileInfo};

use crate::findings::Finding;
use crate::target::ReaderLimit;
use crate::watch::Stage;

/// What was read, baked and written, in numbers.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct JobReport {
    /// The map.
    pub input: PathBuf,
    /// The files that were written, in the order of writing.
    pub files: Vec<PathBuf>,
    /// What the map's file says about itself.
    pub info: FileInfo,
    /// How the map's pixels were read.
    pub source: SourceOptions,
    /// How the map was baked.
    pub options: BakeOptions,
    /// The report of the bake.
    pub report: BakeReport,
    /// The error of block compression, if the textures are compressed.
    pub compression: Option<CompressionError>,
    /// The correlation that the green test measured, -1 ..= 1; `None` for heights and if there is too little evidence.
    pub green_correlation: Option<f64>,
    /// Common readers that refuse the written files.
    pub reader_limits: Vec<ReaderLimit>,
    /// Findings for the user, in the order in which they were found.
    pub findings: Vec<Finding>,
    /// The stages, with the duration of each.
    pub times: Vec<(Stage, Duration)>,
}

impl JobReport {
    /// The largest errors of values decoded from the files, including the errors of block compression.
    pub fn bounds(&self) -> Bounds {
        self.with_blocks(self.report.bounds)
    }

    /// The same as [`Self::bounds`], without the steepest 0.1 % of the texels.
    pub fn bounds_of_most(&self) -> Bounds {
        self.with_blocks(self.report.bounds_of_most)
    }

    fn with_blocks(&self, stored: Bounds) -> Bounds {
        self.compression.map_or(stored, |blocks| blocks.added_to(stored))
    }

    /// The range of the stored slopes, if a shader needs it to decode the texels.
    pub fn scale(&self) -> Option<f32> {
        let BakeOptions { layout, sample_type: bits, .. } = self.options;
        layout.uses_scale(bits).then_some(self.report.scale)
    }

    /// The range of the stored variances or standard deviations, if a shader needs it to decode the texels.
    pub fn spread_scale(&self) -> Option<f32> {
        let BakeOptions { layout, sample_type: bits, .. } = self.options;
        layout.uses_spread_scale(bits).then_some(self.report.spread_scale)
    }
}
