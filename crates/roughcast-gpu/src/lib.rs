//! roughcast on the GPU.
