//! Progress and cancellation of a bake.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Receives the fraction of a bake that is done, 0 ..= 1, and may stop the bake. It is called from any thread that
/// works on the bake, possibly from several at once and out of order.
pub type BakeWatch<'a> = dyn Fn(f32) -> ControlFlow<()> + Sync + 'a;

/// The bake was stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Stopped;

/// Counts the texels that are done. It is called once per band of rows, so its cost is negligible.
pub(crate) struct Progress<'a> {
    watch: Option<&'a BakeWatch<'a>>,
    total: u64,
    done: AtomicU64,
    stopped: AtomicBool,
}

impl<'a> Progress<'a> {
    /// Progress of work on `total` texels.
    pub fn of(total: u64, watch: Option<&'a BakeWatch<'a>>) -> Self {
        Self { watch, total, done: AtomicU64::new(0), stopped: AtomicBool::new(false) }
    }

    /// Counts texels as done and notifies the watch.
    pub fn advance(&self, texels: usize) {
        let Some(watch) = self.watch else { return };
        let texels = texels as u64;
        let done = self.done.fetch_add(texels, Ordering::Relaxed) + texels;
        if watch((done as f64 / self.total as f64).min(1.0) as f32).is_break() {
            self.stopped.store(true, Ordering::Relaxed);
        }
    }

    /// Counts work that turned out to be unnecessary as done, so that `left` texels remain.
    pub fn skip_to_last(&self, left: u64) {
        self.done.fetch_max(self.total.saturating_sub(left), Ordering::Relaxed);
    }

    /// Whether the remaining work should be skipped.
    pub fn is_stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }

    /// Returns an error if the work was stopped.
    pub fn check(&self) -> Result<(), Stopped> {
        if self.is_stopped() { Err(Stopped) } else { Ok(()) }
    }
}
