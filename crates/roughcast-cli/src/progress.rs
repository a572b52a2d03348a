//! Progress bars on terminals, and the time that each stage took.

use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Work on shorter jobs would only flicker.
const QUIET_FOR: Duration = Duration::from_millis(400);

/// A bar over `steps` steps; it shows nothing unless stderr is a terminal.
pub fn bar(steps: u64) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(steps), ProgressDrawTarget::stderr());
    let style = ProgressStyle::with_template("{bar:24} {pos}/{len} {wide_msg} {elapsed}")
        .expect("the template is a constant");
    bar.set_style(style);
    bar
}

/// A bar over long work, which tells the time that is left.
pub fn timed_bar(steps: u64) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(steps), ProgressDrawTarget::stderr());
    let style = ProgressStyle::with_template("{bar:24} {percent}% {wide_msg} {eta} left")
        .expect("the template is a constant");
    bar.set_style(style);
    bar
}

/// The stages of one job: shown on a bar while it lasts, and listed with their times afterwards.
pub struct Stages {
    bar: ProgressBar,
    started: Instant,
    stage: Option<(&'static str, Instant)>,
    done: Vec<(&'static str, Duration)>,
}

impl Stages {
    /// A job of so many stages, with a bar of its own.
    pub fn new(count: u64) -> Self {
        Self::on(bar(count))
    }

    /// A job without a bar, for jobs that run side by side.
    pub fn silent() -> Self {
        Self::on(ProgressBar::hidden())
    }

    fn on(bar: ProgressBar) -> Self {
        Self { bar, started: Instant::now(), stage: None, done: Vec::new() }
    }

    /// Ends the stage before and begins this one.
    pub fn begin(&mut self, name: &'static str) {
        self.end_stage();
        self.stage = Some((name, Instant::now()));
        if self.started.elapsed() > QUIET_FOR || self.done.is_empty() {
            self.bar.set_message(name);
        }
    }

    fn end_stage(&mut self) {
        if let Some((name, since)) = self.stage.take() {
            self.done.push((name, since.elapsed()));
            self.bar.inc(1);
        }
    }

    /// Ends the job: the bar goes, the times stay.
    pub fn finish(&mut self) -> &[(&'static str, Duration)] {
        self.end_stage();
        self.bar.finish_and_clear();
        &self.done
    }
}
