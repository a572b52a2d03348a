//! Progress bars on terminals.

use std::ops::ControlFlow;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use roughcast_pipeline::{Progress, Stage, Watch};

/// Shorter jobs show no bar, since it would only flicker.
const QUIET_FOR: Duration = Duration::from_millis(400);

/// A bar over `steps` steps; it shows nothing unless stderr is a terminal.
pub fn bar(steps: u64) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(steps), ProgressDrawTarget::stderr());
    let style = ProgressStyle::with_template("{bar:24} {pos}/{len} {wide_msg} {elapsed}")
        .expect("the template is a constant");
    bar.set_style(style);
    bar
}

/// A bar for long work, which shows the remaining time.
pub fn timed_bar(steps: u64) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(steps), ProgressDrawTarget::stderr());
    let style = ProgressStyle::with_template("{bar:24} {percent}% {wide_msg} {eta} left")
        .expect("the template is a constant");
    bar.set_style(style);
    bar
}

/// The stages of one job, shown on a bar while it runs.
pub struct StageBar {
    bar: ProgressBar,
    started: Instant,
    stage: Mutex<Option<Stage>>,
}

impl StageBar {
    /// A job that has just begun.
    pub fn new() -> Self {
        /// All stages except the last.
        const STAGES: u64 = Stage::ALL.len() as u64 - 1;
        Self { bar: bar(STAGES), started: Instant::now(), stage: Mutex::new(None) }
    }
}

impl Watch for StageBar {
    fn progress(&self, progress: &Progress<'_>) -> ControlFlow<()> {
        let mut stage = self.stage.lock().expect("no panic while it is held");
        let before = stage.replace(progress.stage);
        if before == Some(progress.stage) {
            return ControlFlow::Continue(());
        }
        if before.is_some() {
            self.bar.inc(1);
        }
        match progress.stage {
            Stage::Ended => self.bar.finish_and_clear(),
            begun if before.is_none() || self.started.elapsed() > QUIET_FOR => {
                self.bar.set_message(begun.name());
            }
            _ => {}
        }
        ControlFlow::Continue(())
    }
}

/// A bar for the maps of a folder.
pub struct FolderBar {
    bar: ProgressBar,
}

impl FolderBar {
    /// A folder that has just begun; the number of maps is not known yet.
    pub fn new() -> Self {
        Self { bar: bar(0) }
    }
}

impl Watch for FolderBar {
    fn progress(&self, progress: &Progress<'_>) -> ControlFlow<()> {
        self.bar.set_length(progress.count as u64);
        match (progress.stage, progress.fraction) {
            (Stage::Reading, _) => self.bar.set_message(progress.input.display().to_string()),
            (Stage::Ended, _) => self.bar.inc(1),
            _ => {}
        }
        ControlFlow::Continue(())
    }
}

impl Drop for FolderBar {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
