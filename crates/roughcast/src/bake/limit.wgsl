// The automatic limit of slopes. Twin of limit.rs and of the histogram of survey.rs.

// Squared lengths are binned by the exponent and the leading five mantissa bits of their float, from the square of
// the smallest scale to that of the largest slope of any map.
const SLOPE_BIN_SHIFT: u32 = 18u;
const FIRST_SLOPE_BIN: u32 = 3424u;
const SLOPE_BINS: u32 = 1089u;

// One in this many texels counts as steep.
const STEEP_ONE_IN: u32 = 1000u;
// The loss of usable specular power, as a factor, above which slopes are limited.
const STEEP_COST: f32 = 4.0;
// MaxSlope::LEAST_AUTOMATIC.
const LEAST_AUTOMATIC_LIMIT: f32 = 1.0;

fn slope_bin(length_squared: f32) -> u32 {
    let bin = bitcast<u32>(length_squared) >> SLOPE_BIN_SHIFT;
    return clamp(bin, FIRST_SLOPE_BIN, FIRST_SLOPE_BIN + SLOPE_BINS - 1u) - FIRST_SLOPE_BIN;
}

// The length of the longest slope of a bin.
fn upper_edge_of_slope_bin(bin: u32) -> f32 {
    return square_root(bitcast<f32>(((FIRST_SLOPE_BIN + bin + 1u) << SLOPE_BIN_SHIFT) - 1u));
}

// The automatic limit of the slope. Only the steep texels exceed `exceeded`; `peak` is the largest component of any
// slope.
fn automatic_limit(exceeded: f32, peak: f32, base_variance: f32, otherwise: f32) -> f32 {
    let limit = max(exceeded, LEAST_AUTOMATIC_LIMIT);
    let before = smallest_scale(peak, base_variance);
    let after = smallest_scale(min(peak, limit), base_variance);
    return select(otherwise, limit, before * before > STEEP_COST * after * after);
}
