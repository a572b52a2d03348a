//! Progress and cancellation.

use std::ops::ControlFlow;
use std::path::Path;
use std::time::{Duration, Instant};

use roughcast::named_enum;

use crate::JobError;

named_enum! {
    /// The stages of a job, in order.
    #[derive(PartialOrd, Ord)]
    #[non_exhaustive]
    pub enum Stage: "stage" {
        /// Reading the map and the roughness, and deciding what they are.
        Reading = "reading",
        /// Making the textures and their levels.
        Baking = "baking",
        /// Compressing the textures into blocks, if requested.
        Compressing = "compressing",
        /// Writing the files. They are moved into place after the last report of this stage.
        Writing = "writing",
        /// The job has ended, successfully or not.
        Ended = "ended",
    }
}

/// The progress of a job.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Progress<'a> {
    /// The map.
    pub input: &'a Path,
    /// Its index among the files of a folder; 0 for a single job.
    pub index: usize,
    /// The number of these files; 1 for a single job.
    pub count: usize,
    /// The stage.
    pub stage: Stage,
    /// The completed fraction of the stage, 0 ..= 1, if known. Threads that share the work may report out of order.
    pub fraction: Option<f32>,
}

/// Receives the progress of jobs, and may stop them.
///
/// Any closure `Fn(&Progress) -> ControlFlow<()> + Sync` is a watch. It may be called from any thread, and from several
/// at once: at the beginning of each stage and, except in the first stage, also within it. After `ControlFlow::Break` a
/// job ends with [`JobError::Cancelled`] and leaves no file behind, and a folder starts no further job.
pub trait Watch: Sync {
    /// Receives the progress of a job.
    fn progress(&self, progress: &Progress<'_>) -> ControlFlow<()>;
}

impl<F: Fn(&Progress<'_>) -> ControlFlow<()> + Sync> Watch for F {
    fn progress(&self, progress: &Progress<'_>) -> ControlFlow<()> {
        self(progress)
    }
}

/// A watch that ignores progress and stops nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Unwatched;

impl Watch for Unwatched {
    fn progress(&self, _: &Progress<'_>) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

/// A watched job, with the time of each stage.
pub(crate) struct Watched<'a> {
    watch: &'a dyn Watch,
    input: &'a Path,
    index: usize,
    count: usize,
    stage: Option<(Stage, Instant)>,
    times: Vec<(Stage, Duration)>,
}

impl<'a> Watched<'a> {
    pub fn new(watch: &'a dyn Watch, input: &'a Path, index: usize, count: usize) -> Self {
        Self { watch, input, index, count, stage: None, times: Vec::new() }
    }

    /// Ends the previous stage and begins this one, unless the job is already in it.
    pub fn begin(&mut self, stage: Stage) -> Result<(), JobError> {
        if self.stage.is_none_or(|(current, _)| current != stage) {
            self.end_stage();
            self.stage = Some((stage, Instant::now()));
        }
        self.tell(None)
    }

    /// Reports the completed fraction of the stage.
    pub fn tell(&self, fraction: Option<f32>) -> Result<(), JobError> {
        match self.report(fraction) {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => Err(JobError::Cancelled),
        }
    }

    /// As [`Watched::tell`], for work that stops on `Break`.
    pub fn report(&self, fraction: Option<f32>) -> ControlFlow<()> {
        let Some((stage, _)) = self.stage else { return ControlFlow::Continue(()) };
        let Self { input, index, count, .. } = *self;
        self.watch.progress(&Progress { input, index, count, stage, fraction })
    }

    /// Ends the job. The watch can no longer stop it.
    pub fn end(&mut self) -> ControlFlow<()> {
        self.end_stage();
        self.stage = Some((Stage::Ended, Instant::now()));
        self.report(None)
    }

    fn end_stage(&mut self) {
        if let Some((stage, since)) = self.stage.take().filter(|(stage, _)| *stage != Stage::Ended) {
            self.times.push((stage, since.elapsed()));
        }
    }

    /// The completed stages, with the duration of each.
    pub fn times(&self) -> &[(Stage, Duration)] {
        &self.times
    }
}
