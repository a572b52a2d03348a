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
    /// The files that were written, in their order.
    pub files: Vec<PathBuf>,
    /// What the map's file says about itself.
    pub info: FileInfo,
    /// How its pixels were read.
    pub source: SourceOptions,
    /// How it was baked.
    pub options: BakeOptions,
    /// The report of the bake.
    pub report: BakeReport,
    /// The error of block compression, if there is any.
    pub compression: Option<CompressionError>,
    /// The correlation that the test of green measured, -1 ..= 1; `None` for heights and for too little evidence.
    pub green_correlation: Option<f64>,
    /// Common readers that refuse such files.
    pub reader_limits: Vec<ReaderLimit>,
    /// Findings for the user, in the order in which they were found.
    pub findings: Vec<Finding>,
    /// The stages, with the time that each took.
    pub times: Vec<(Stage, Duration)>,
}

impl JobReport {
    /// The largest errors of values decoded from the files, including those of the blocks.
    pub fn bounds(&self) -> Bounds {
        self.with_blocks(self.report.bounds)
    }

    /// The same without the steepest 0.1 % of the texels.
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
