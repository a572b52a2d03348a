//! Waits for wgpu's callbacks without spinning or blocking the caller's thread. An error ends the wait.
//!
//! In a browser, callbacks arrive on their own. Natively they are only called by [`wgpu::Device::poll`], so a thread
//! blocks in it for as long as the wait lasts. All other threads sleep.

use std::future::Future;
use std::pin::Pin;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::task::{Context, Poll, Waker};
#[cfg(not(target_arch = "wasm32"))]
use std::{thread::JoinHandle, time::Duration};

#[cfg(not(target_arch = "wasm32"))]
use crate::error::one_line;

/// A device that calls back.
pub(crate) trait Device: Clone + Unpin + wgpu::WasmNotSend + 'static {
    /// Blocks until the work submitted so far is done, and runs the callbacks.
    ///
    /// # Errors
    /// The reason why the device cannot finish its work.
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
    let wait = Wait {
        device: Some(device.clone()),
        signal,
        #[cfg(not(target_arch = "wasm32"))]
        thread: None,
    };
    wait.await
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

struct State<T> {
    answer: Option<Result<T, String>>,
    waker: Option<Waker>,
    /// Whether a thread still holds the device. The wait lasts until the thread lets go of it: a program may exit right
    /// after the wait, and destroying the device on a thread during exit can crash the driver.
    polled: bool,
}

impl<T> Default for Signal<T> {
    fn default() -> Self {
        let state = State { answer: None, waker: None, polled: false };
        Self(Arc::new(Shared { state: Mutex::new(state), answered: Condvar::new() }))
    }
}

impl<T> Clone for Signal<T> {
    fn clone(&self) -> Self {
        Self(Arc::clone(&self.0))
    }
}

impl<T> Signal<T> {
    /// Only the first answer counts.
    fn send(&self, answer: Result<T, String>) {
        let mut state = self.state();
        if state.answer.is_none() {
            state.answer = Some(answer);
            self.0.answered.notify_all();
            wake(state);
        }
    }

    /// Whether the answer arrives within this time.
    #[cfg(not(target_arch = "wasm32"))]
    fn is_answered_within(&self, time: Duration) -> bool {
        let waiting = |state: &mut State<T>| state.answer.is_none();
        let result = self.0.answered.wait_timeout_while(self.state(), time, waiting);
        !result.unwrap_or_else(PoisonError::into_inner).1.timed_out()
    }

    /// Locks the state. No code that holds the lock can panic, so the state behind a poisoned lock is valid.
    fn state(&self) -> MutexGuard<'_, State<T>> {
        self.0.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Wakes the future if its wait is over.
fn wake<T>(mut state: MutexGuard<'_, State<T>>) {
    if state.polled || state.answer.is_none() {
        return;
    }
    let waker = state.waker.take();
    drop(state);
    if let Some(waker) = waker {
        waker.wake();
    }
}

struct Wait<T, D> {
    /// Taken when a thread starts to poll it.
    device: Option<D>,
    signal: Signal<T>,
    #[cfg(not(target_arch = "wasm32"))]
    thread: Option<JoinHandle<()>>,
}

impl<T: Send + 'static, D: Device> Future for Wait<T, D> {
    type Output = Result<T, String>;

    fn poll(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<Self::Output> {
        let mut state = self.signal.state();
        if !state.polled
            && let Some(answer) = state.answer.take()
        {
            drop(state);
            self.end();
            return Poll::Ready(answer);
        }
        state.waker = Some(context.waker().clone());
        drop(state);
        if let Some(device) = self.device.take()
            && let Err(reason) = self.watch(device)
        {
            return Poll::Ready(Err(reason));
        }
        Poll::Pending
    }
}

/// In a browser, callbacks need no polling.
#[cfg(target_arch = "wasm32")]
impl<T, D> Wait<T, D> {
    fn watch(&mut self, _: D) -> Result<(), String> {
        Ok(())
    }

    fn end(&mut self) {}
}

#[cfg(not(target_arch = "wasm32"))]
impl<T: Send + 'static, D: Device> Wait<T, D> {
    /// Starts a thread that polls the device until the answer arrives.
    fn watch(&mut self, device: D) -> Result<(), String> {
        let poller = Poller::new(device, self.signal.clone());
        let thread = std::thread::Builder::new().name("roughcast-gpu wait".to_owned());
        let spawned = thread.spawn(move || poller.run());
        let thread =
            spawned.map_err(|error| format!("no thread can wait for the device: {}", one_line(&error)))?;
        self.thread = Some(thread);
        Ok(())
    }

    /// Joins the thread, which has nothing left to do but return.
    fn end(&mut self) {
        let this_thread = std::thread::current().id();
        // An executor may poll the future from within its waker, and the thread itself calls the waker.
        if let Some(thread) = self.thread.take_if(|thread| thread.thread().id() != this_thread) {
            // A panic has already ended the wait with an error.
            let _ = thread.join();
        }
    }
}

/// Polls the device on its own thread. When dropped, it releases the device first and then ends the wait.
#[cfg(not(target_arch = "wasm32"))]
struct Poller<T, D> {
    device: Option<D>,
    signal: Signal<T>,
}

#[cfg(not(target_arch = "wasm32"))]
impl<T, D: Device> Poller<T, D> {
    fn new(device: D, signal: Signal<T>) -> Self {
        signal.state().polled = true;
        Self { device: Some(device), signal }
    }

    /// wgpu panics if the device was lost; that drops `self` as well.
    fn run(self) {
        if let Some(device) = &self.device
            && let Err(reason) = finish(device, &self.signal, Patience::default())
        {
            self.signal.send(Err(reason));
        }
    }
}

#[cfg(not(target_arch = "wasm32"))]
impl<T, D> Drop for Poller<T, D> {
    fn drop(&mut self) {
        self.device = None;
        let mut state = self.signal.state();
        state.polled = false;
        state.answer.get_or_insert_with(|| Err("the device does not answer".to_owned()));
        wake(state);
    }
}

/// How long an answer may take once the device's work is done. Another thread that polls the same device may have taken
/// the callback, and may run a few others before it.
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
