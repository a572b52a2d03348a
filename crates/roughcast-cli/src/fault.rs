//! Bugs in the program itself: a panic ends the work on one file but not the run, and is reported in one line.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::Mutex;

use anyhow::{Context, Result, anyhow};

use crate::complain;

/// Number of jobs being guarded: while it is above zero, a panic is reported as their error.
static GUARDED: Mutex<usize> = Mutex::new(0);

/// Makes a panic print one line instead of a backtrace, or nothing if [`guarded`] or a caller of [`silenced`] reports it.
pub fn install_hook() {
    std::panic::set_hook(Box::new(|info| {
        if GUARDED.lock().is_ok_and(|jobs| *jobs == 0) {
            let line = info.to_string().split_whitespace().collect::<Vec<_>>().join(" ");
            complain(&format!("error: a fault of roughcast itself, please report it: {line}"));
        }
    }));
}

/// Runs work whose panics the caller catches and reports as errors, so that the hook stays silent.
pub fn silenced<T>(work: impl FnOnce() -> T) -> T {
    let count = |change: isize| {
        if let Ok(mut jobs) = GUARDED.lock() {
            *jobs = jobs.saturating_add_signed(change);
        }
    };
    count(1);
    let result = work();
    count(-1);
    result
}

/// Runs the work on one file. A panic becomes an error that names the file.
pub fn guarded<T>(path: &Path, job: impl FnOnce() -> Result<T>) -> Result<T> {
    let result = silenced(|| catch_unwind(AssertUnwindSafe(job)));
    result.unwrap_or_else(|payload| {
        let text = payload.downcast_ref::<String>().map(String::as_str);
        let what = text.or_else(|| payload.downcast_ref::<&str>().copied()).unwrap_or("a panic");
        Err(anyhow!("a fault of roughcast itself, please report it with this file: {what}"))
            .with_context(|| path.display().to_string())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_an_error_that_names_the_file() {
        install_hook();
        let result = guarded(Path::new("maps/odd.png"), || -> Result<()> { panic!("index {} of 3", 7) });
        let line = format!("{:#}", result.expect_err("it panicked"));
        assert!(line.starts_with("maps/odd.png: ") && line.ends_with("index 7 of 3"), "{line}");
        assert!(line.contains("please report it"), "{line}");
        assert_eq!(guarded(Path::new("a"), || Ok(5)).expect("no panic"), 5);
    }

    #[test]
    fn a_panic_on_another_thread_is_caught_too() {
        install_hook();
        let result = guarded(Path::new("a.png"), || -> Result<()> {
            rayon::join(|| panic!("in a worker"), || ());
            Ok(())
        });
        assert!(format!("{:#}", result.expect_err("it panicked")).contains("in a worker"));
    }
}
