//! roughcast on the GPU, by wgpu.
//!
//! - A [`Gpu`] is a device, made here or taken from a host by [`Gpu::from_device`].
//! - [`bake::GpuBake`] bakes LEAN and CLEAN textures from a map in memory or from a texture that a program draws every
//!   frame.
//! - [`render`] draws a scene of `roughcast-scene` into a window or into a picture: a [`render::GpuDetail`] is a source
//!   of bumps (baked textures of any layout, or WGSL of yours) with the model that shades it. Its documentation has an
//!   example.
//! - [`Timestamps`] measures passes by the GPU's own clock.
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
