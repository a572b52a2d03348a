//! Tests with a mock device that counts its polls, and a waker that counts its wakes.

use std::pin::pin;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::task::Wake;
use std::thread::Thread;

use super::*;

/// Long enough for a busy loop to run thousands of times.
const A_WHILE: Duration = Duration::from_millis(50);

/// A mock of the device's work, which ends as the test specifies.
#[derive(Clone)]
struct Work {
    polls: Arc<AtomicUsize>,
    ends: Arc<Mutex<Receiver<End>>>,
}

enum End {
    Calls(Answer<u32>),
    /// Calls back, but returns from the poll a while later.
    CallsAndLingers(Answer<u32>),
    FailsWith(&'static str),
    Panics,
    StaysSilent,
}

impl Work {
    fn new() -> (Self, Sender<End>) {
        let (sender, receiver) = channel();
        (Self { polls: Arc::default(), ends: Arc::new(Mutex::new(receiver)) }, sender)
    }

    fn polls(&self) -> usize {
        self.polls.load(Ordering::SeqCst)
    }
}

impl Device for Work {
    fn finish_work(&self) -> Result<(), String> {
        self.polls.fetch_add(1, Ordering::SeqCst);
        match self.ends.lock().expect("one thread polls at a time").recv() {
            Ok(End::Calls(answer)) => answer.send(7),
            Ok(End::CallsAndLingers(answer)) => {
                answer.send(7);
                std::thread::sleep(A_WHILE);
            }
            Ok(End::FailsWith(reason)) => return Err(reason.to_owned()),
            Ok(End::Panics) => panic!("as wgpu does where a device is lost"),
            // The test has ended, so there is nothing left to do.
            Ok(End::StaysSilent) | Err(_) => {}
        }
        Ok(())
    }
}

struct CountedWaker {
    wakes: AtomicUsize,
    thread: Thread,
}

impl Wake for CountedWaker {
    fn wake(self: Arc<Self>) {
        self.wakes.fetch_add(1, Ordering::SeqCst);
        self.thread.unpark();
    }
}

/// Runs a future to completion and returns how often it was polled and woken.
fn counted<T>(future: impl Future<Output = T>) -> (T, usize, usize) {
    let waker = Arc::new(CountedWaker { wakes: AtomicUsize::new(0), thread: std::thread::current() });
    let mut future = pin!(future);
    for polls in 1.. {
        match future.as_mut().poll(&mut Context::from_waker(&Arc::clone(&waker).into())) {
            Poll::Ready(value) => return (value, polls, waker.wakes.load(Ordering::SeqCst)),
            Poll::Pending => std::thread::park(),
        }
    }
    unreachable!("the loop has no end")
}

/// Waits for a device whose work ends after a while.
fn answer_of(end: impl FnOnce(Answer<u32>) -> End) -> (Result<u32, String>, usize, usize, usize) {
    let (work, ends) = Work::new();
    let ask = |answer| {
        let end = end(answer);
        std::thread::spawn(move || {
            std::thread::sleep(A_WHILE);
            let _ = ends.send(end);
        });
    };
    let (result, polls, wakes) = counted(called_back(&work, ask));
    (result, polls, wakes, work.polls())
}

#[test]
fn a_wait_costs_one_wake_and_one_poll_of_the_device() {
    // The future is polled once when the wait starts and once when it has ended, however long that takes.
    assert_eq!(answer_of(End::Calls), (Ok(7), 2, 1, 1));
}

#[test]
fn no_thread_holds_the_device_after_the_wait() {
    let (work, ends) = Work::new();
    let ask = |answer| ends.send(End::CallsAndLingers(answer)).expect("the device is there");
    assert_eq!(counted(called_back(&work, ask)), (Ok(7), 2, 1));
    assert_eq!(Arc::strong_count(&work.polls), 1);
}

#[test]
fn an_executor_that_polls_within_its_waker_does_not_wait_for_itself() {
    type Wait = Pin<Box<dyn Future<Output = Result<u32, String>> + Send>>;
    struct Inline(Mutex<Wait>, Sender<Result<u32, String>>);
    impl Wake for Inline {
        fn wake(self: Arc<Self>) {
            let waker = Arc::clone(&self).into();
            let mut future = self.0.lock().expect("no poll panics");
            if let Poll::Ready(result) = future.as_mut().poll(&mut Context::from_waker(&waker)) {
                self.1.send(result).expect("the test receives it");
            }
        }
    }
    let (work, ends) = Work::new();
    let (results, result) = channel();
    let device = work.clone();
    let (asked, answer) = channel();
    let future =
        async move { called_back(&device, |answer| asked.send(answer).expect("it is received below")).await };
    Arc::new(Inline(Mutex::new(Box::pin(future)), results)).wake();
    ends.send(End::Calls(answer.recv().expect("it was asked"))).expect("the device polls");
    assert_eq!(result.recv(), Ok(Ok(7)));
}

#[test]
fn an_executor_that_polls_without_reason_starts_no_more_threads() {
    let (work, ends) = Work::new();
    let (keep, kept) = channel();
    let mut future = pin!(called_back(&work, |answer| keep.send(answer).expect("it is kept below")));
    for _ in 0..100 {
        assert!(future.as_mut().poll(&mut Context::from_waker(Waker::noop())).is_pending());
    }
    std::thread::sleep(A_WHILE);
    assert_eq!(work.polls(), 1);
    ends.send(End::Calls(kept.recv().expect("it was asked"))).expect("the device polls");
    assert_eq!(counted(future).0, Ok(7));
    assert_eq!(work.polls(), 1);
}

#[test]
fn a_ready_answer_needs_no_thread() {
    let (work, _ends) = Work::new();
    assert_eq!(counted(called_back(&work, |answer| answer.send(3))), (Ok(3), 1, 0));
    assert_eq!(work.polls(), 0);
}

#[test]
fn an_error_of_the_poll_ends_the_wait() {
    let mut kept = None;
    let (result, ..) = answer_of(|answer| {
        kept = Some(answer);
        End::FailsWith("the device was lost")
    });
    assert_eq!(result, Err("the device was lost".to_owned()));
    drop(kept);
}

#[test]
fn a_panic_of_the_poll_ends_the_wait() {
    let mut kept = None;
    let (result, ..) = answer_of(|answer| {
        kept = Some(answer);
        End::Panics
    });
    assert_eq!(result, Err("the device does not answer".to_owned()));
    drop(kept);
}

#[test]
fn a_callback_that_is_dropped_ends_the_wait() {
    let (work, _ends) = Work::new();
    let (result, ..) = counted(called_back::<u32>(&work, drop));
    assert_eq!(result, Err("the device dropped the request".to_owned()));
}

#[test]
fn a_device_that_never_answers_ends_the_wait() {
    let (work, ends) = Work::new();
    let signal = Signal::<u32>::default();
    let patience = Patience { polls: 3, pause: Duration::from_millis(1) };
    (0..4).for_each(|_| ends.send(End::StaysSilent).expect("the device is there"));
    assert!(finish(&work, &signal, patience).is_err());
    assert_eq!(work.polls(), 3);
}

#[test]
fn a_callback_that_another_thread_has_taken_is_waited_for() {
    let (work, ends) = Work::new();
    ends.send(End::StaysSilent).expect("the device is there");
    let ask = |answer: Answer<u32>| {
        std::thread::spawn(move || {
            std::thread::sleep(A_WHILE);
            answer.send(5);
        });
    };
    assert_eq!(counted(called_back(&work, ask)), (Ok(5), 2, 1));
}
