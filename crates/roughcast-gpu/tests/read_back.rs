//! The cost of waiting for a real device, and the errors of a lost one.

mod common;

use std::future::Future;
use std::pin::pin;
use std::sync::Arc;
use std::task::{Context, Poll, Wake};
use std::thread::Thread;

use common::compute::submit;
use common::gpu;
use roughcast_gpu::{Gpu, GpuError, read_back};

struct Unpark(Thread);

impl Wake for Unpark {
    fn wake(self: Arc<Self>) {
        self.0.unpark();
    }
}

/// Runs a future to completion and returns its output with the number of polls.
fn counted<T>(future: impl Future<Output = T>) -> (T, usize) {
    let waker = Arc::new(Unpark(std::thread::current())).into();
    let mut future = pin!(future);
    let mut polls = 1;
    loop {
        match future.as_mut().poll(&mut Context::from_waker(&waker)) {
            Poll::Ready(value) => return (value, polls),
            Poll::Pending => std::thread::park(),
        }
        polls += 1;
    }
}

/// Work that takes some tens of milliseconds on a software driver, and the buffer that it writes.
fn slow_work(gpu: &Gpu) -> wgpu::Buffer {
    let buffer = gpu.device().create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: 4 * 65_536,
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    });
    let source = "@group(0) @binding(0) var<storage, read_write> values: array<u32>;
        @compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3u) {
            var value = id.x;
            for (var i = 0u; i < 10000u; i++) { value = value * 1664525u + 1013904223u; }
            values[id.x] = value | 1u;
        }";
    submit(gpu, source, &[&buffer], 65_536 / 64);
    buffer
}

/// Maximum polls of a future that waits once: one when the wait begins, one when it has ended, and one more in case an
/// executor's thread wakes for another reason. A loop that asks to be polled again needs thousands.
const MOST_POLLS: usize = 3;

#[test]
fn a_future_that_waits_for_the_device_sleeps() {
    let gpu = gpu();
    let buffer = slow_work(&gpu);
    let (bytes, polls) = counted(read_back::read_buffer(&gpu, &buffer));
    assert!(bytes.expect("results").iter().step_by(4).all(|byte| byte & 1 == 1));
    assert!(polls <= MOST_POLLS, "the future was polled {polls} times");
    slow_work(&gpu);
    let (done, polls) = counted(read_back::submitted_work_done(&gpu));
    assert_eq!(done, Ok(()));
    assert!(polls <= MOST_POLLS, "the future was polled {polls} times");
}

#[test]
fn several_waits_for_one_device_all_end() {
    let gpu = gpu();
    let buffer = slow_work(&gpu);
    std::thread::scope(|scope| {
        let threads: Vec<_> = (0..8)
            .map(|_| scope.spawn(|| pollster::block_on(read_back::read_buffer(&gpu, &buffer))))
            .collect();
        for thread in threads {
            assert_eq!(thread.join().expect("no panic").expect("results").len(), 4 * 65_536);
        }
    });
}

#[test]
fn a_destroyed_device_is_an_error() {
    let gpu = gpu();
    let buffer = slow_work(&gpu);
    gpu.device().destroy();
    let error = pollster::block_on(read_back::read_buffer(&gpu, &buffer)).expect_err("nothing is left");
    assert!(matches!(error, GpuError::ReadBack { .. }), "{error:?}");
}
