//! Laws of layers, against an oracle in f64 that mixes slopes texel by texel, and then filters.

#[path = "../common/mod.rs"]
mod common;

mod blends;
mod figure_10;
mod masks;
mod mixes;
mod moving;
mod refusals;
mod support;
mod weights;
