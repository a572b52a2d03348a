//! The rules of baking in WGSL: twins of the Rust files that they stand beside, with the same names. Functions only; whoever
//! runs them adds bindings and entry points. (The shading models' twins are in [`crate::shading`].)

/// Quotients and roots rounded as on the CPU. Needs nothing; everything else needs it.
pub const EXACT: &str = include_str!("exact.wgsl");
/// Slopes, normals, and the mending of bad ones. Needs [`EXACT`].
pub const SLOPE: &str = include_str!("slope.wgsl");
/// Slopes from texels of normal maps. Needs [`SLOPE`].
pub const NORMAL_MAP: &str = include_str!("source/normal_map.wgsl");
/// Slopes from neighbouring texels of height maps. Needs [`SLOPE`].
pub const HEIGHT_MAP: &str = include_str!("source/height_map.wgsl");
/// Averages of footprints. Needs [`EXACT`].
pub const COMBINE: &str = include_str!("pyramid/combine.wgsl");
/// Coverage weights for any size. Needs [`EXACT`].
pub const WEIGHTS: &str = include_str!("pyramid/weights.wgsl");
/// How quantities become texels. Needs [`EXACT`].
pub const CODEC: &str = include_str!("texture/codec.wgsl");
/// LEAN's texels. Needs [`COMBINE`] and [`CODEC`].
pub const LEAN: &str = include_str!("texture/lean.wgsl");
/// CLEAN's texels. Needs [`COMBINE`] and [`CODEC`].
pub const CLEAN: &str = include_str!("texture/clean.wgsl");
/// The automatic limit of slopes. Needs [`CODEC`].
pub const LIMIT: &str = include_str!("bake/limit.wgsl");

/// All of them, each after what it needs.
pub const ALL: [&str; 10] =
    [EXACT, SLOPE, NORMAL_MAP, HEIGHT_MAP, COMBINE, WEIGHTS, CODEC, LEAN, CLEAN, LIMIT];
