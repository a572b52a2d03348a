//! Waits for wgpu's callbacks: nothing spins, the caller's thread does not block, and an error ends the wait.
//!
//! In a browser callbacks come by themselves. Natively they come only from [`wgpu::Device::poll`], so a thread that lives as
//! long as the wait blocks in it. All other threads sleep.

use std::future::Future;
use std::pin::Pin;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::task::{Context, Poll, Waker};
#[cfg(not(target_arch = "wasm32"))]
use std::time::Duration;

#[cfg(not(target_arch = "wasm32"))]
use crate::error::one_line;

/// Something that calls back.
pub(crate) trait Device: Clone + Unpin + wgpu::WasmNotSend + 'static {
    /// Blocks until the work submitted so far is done, and calls back.
    ///
    /// # Errors
    /// The reason why it cannot.
    #[cfg(not(target_arch = "wasm32"))]
    fn finish_work(&self) -> Result<(), String>;
}

impl Device for wgpu::Device {
    #[cfg(not(target_arch = "wasm32"))]
    fn finish_work(&self) -> Result<(), String> {
        self.poll(wgpu::PollType::wait_indefinitely()).map(|_| ()).map_err(|error| one_line(&error))
    }
}

/// Waits for a callback. `ask` requests it and moves the [`Answer`] into it.
///
/// # Errors
/// The reason why the callback will not come.
pub(crate) async fn called_back<T: Send + 'static>(
    device: &impl Device,
    ask: impl FnOnce(Answer<T>),
) -> Result<T, String> {
    let signal = Signal::default();
    ask(Answer(signal.clone()));
    Wait { device: Some(device.clone()), signal }.await
}

/// A callback's end of the wait. If dropped without an answer, it ends the wait with an error.
pub(crate) struct Answer<T>(Signal<T>);

impl<T> Answer<T> {
    pub fn send(self, value: T) {
        self.0.send(Ok(value));
    }
}

impl<T> Drop for Answer<T> {
    fn drop(&mut self) {
        self.0.send(Err("the device dropped the request".to_owned()));
    }
}

/// State shared by the callback, the polling thread and the future.
struct Signal<T>(Arc<Shared<T>>);

struct Shared<T> {
    state: Mutex<State<T>>,
    answered: Condvar,
}

enum State<T> {
    Waiting(Option<Waker>),
    Answered(Result<T, String>),
    Taken,
}

impl<T> Default for Signal<T> {
    fn default() -> Self {
        Self(Arc::new(Shared { state: Mutex::new(State::Waiting(None)), answered: Condvar::new() }))
    }
}

impl<T> Clone for Signal<T> {
    fn clone(&self) -> Self {
        Self(Arc::clone(&self.0))
    }
}

impl<T> Signal<T> {
    /// Ends the wait. Only the first answer counts.
    fn send(&self, answer: Result<T, String>) {
        let mut state = self.state();
        let State::Waiting(waker) = &mut *state else { return };
        let waker = waker.take();
        *state = State::Answered(answer);
        drop(state);
        self.0.answered.notify_all();
        if let Some(waker) = waker {
            waker.wake();
        }
    }

    /// Whether the answer comes within this time.
    #[cfg(not(target_arch = "wasm32"))]
    fn is_answered_within(&self, time: Duration) -> bool {
        let waiting = |state: &mut State<T>| matches!(state, State::Waiting(_));
        let result = self.0.answered.wait_timeout_while(self.state(), time, waiting);
        !result.unwrap_or_else(PoisonError::into_inner).1.timed_out()
    }

    /// No code that holds the lock can panic, so the state behind a poisoned lock is valid.
    fn state(&self) -> MutexGuard<'_, State<T>> {
        self.0.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

struct Wait<T, D> {
    /// Taken when a thread begins to poll it.
    device: Option<D>,
    signal: Signal<T>,
}

impl<T: Send + 'static, D: Device> Future for Wait<T, D> {
    type Output = Result<T, String>;

    fn poll(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<Self::Output> {
        let mut state = self.signal.state();
        match std::mem::replace(&mut *state, State::Taken) {
            State::Answered(answer) => return Poll::Ready(answer),
            State::Waiting(_) => *state = State::Waiting(Some(context.waker().clone())),
            State::Taken => return Poll::Ready(Err("the answer was taken already".to_owned())),
        }
        drop(state);
        let signal = self.signal.clone();
        if let Some(device) = self.device.take()
            && let Err(reason) = watch(device, signal)
        {
            return Poll::Ready(Err(reason));
        }
        Poll::Pending
    }
}

/// In a browser callbacks need no help.
#[cfg(target_arch = "wasm32")]
fn watch<T>(_: impl Device, _: Signal<T>) -> Result<(), String> {
    Ok(())
}

/// Starts a thread that polls the device until the answer arrives.
#[cfg(not(target_arch = "wasm32"))]
fn watch<T: Send + 'static>(device: impl Device, signal: Signal<T>) -> Result<(), String> {
    let thread = std::thread::Builder::new().name("roughcast-gpu wait".to_owned());
    let spawned = thread.spawn(move || {
        // wgpu panics if the device was lost; then this is dropped too, and ends the wait.
        let end = Answer(signal.clone());
        if let Err(reason) = finish(&device, &signal, Patience::default()) {
            end.0.send(Err(reason));
        }
    });
    spawned.map(|_| ()).map_err(|error| format!("no thread can wait for the device: {}", one_line(&error)))
}

/// How long an answer may take once the device's work is done. Another thread that polls the same device may have taken
/// the callback, and calls it after a few others.
#[cfg(not(target_arch = "wasm32"))]
#[derive(Clone, Copy)]
struct Patience {
    polls: u32,
    pause: Duration,
}

#[cfg(not(target_arch = "wasm32"))]
impl Default for Patience {
    /// Ten seconds.
    fn default() -> Self {
        Self { polls: 100, pause: Duration::from_millis(100) }
    }
}

#[cfg(not(target_arch = "wasm32"))]
fn finish<T>(device: &impl Device, signal: &Signal<T>, patience: Patience) -> Result<(), String> {
    for _ in 0..patience.polls {
        device.finish_work()?;
        if signal.is_answered_within(patience.pause) {
            return Ok(());
        }
    }
    Err("the device has finished its work but does not answer".to_owned())
}

#[cfg(all(test, not(target_arch = "wasm32")))]
mod tests;
