//! roughcast on the GPU.
//!
//! All functions that wait are `async` and none blocks, so that the crate can be compiled for the web. Natively, any
//! executor works (`pollster::block_on` is the smallest), and a thread polls the device while a future waits for it.

#![forbid(unsafe_code)]

pub mod bake;
mod device;
mod error;
pub mod read_back;
pub mod render;
mod timestamps;
mod wait;

pub use device::{AdapterChoice, Gpu, GpuOptions, LimitChoice};
pub use error::{GpuError, OnlyOnCpu};
pub use timestamps::{Measured, Span, Timestamps};
pub use wgpu;
