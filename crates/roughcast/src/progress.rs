//! How far a bake is, and whether it is to stop.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Hears which fraction of a bake is done, 0 ..= 1, and may stop it. It is called from any thread that works on the bake, also from
/// several at once, and then perhaps out of order.
pub type BakeWatch<'a> = dyn Fn(f32) -> ControlFlow<()> + Sync + 'a;

/// The bake was stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Stopped;

/// Counts the texels that are done. It is asked once for each band of rows, so that it costs nothing beside the work.
pub(crate) struct Progress<'a> {
    watch: Option<&'a BakeWatch<'a>>,
    total: u64,
    done: AtomicU64,
    stopped: AtomicBool,
}

impl<'a> Progress<'a> {
    /// The progress of work on so many texels.
    pub fn of(total: u64, watch: Option<&'a BakeWatch<'a>>) -> Self {
        Self { watch, total, done: AtomicU64::new(0), stopped: AtomicBool::new(false) }
    }

    /// Counts texels as done, and tells the watch.
    pub fn advance(&self, texels: usize) {
        let Some(watch) = self.watch else { return };
        let texels = texels as u64;
        let done = self.done.fetch_add(texels, Ordering::Relaxed) + texels;
        if watch((done as f64 / self.total as f64).min(1.0) as f32).is_break() {
            self.stopped.store(true, Ordering::Relaxed);
        }
    }

    /// Counts as done what turned out not to be needed, so that `left` texels remain.
    pub fn skip_to_last(&self, left: u64) {
        self.done.fetch_max(self.total.saturating_sub(left), Ordering::Relaxed);
    }

    /// Whether the rest of the work is to be left undone.
    pub fn is_stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }

    /// The same as an error.
    pub fn check(&self) -> Result<(), Stopped> {
        if self.is_stopped() { Err(Stopped) } else { Ok(()) }
    }
}
