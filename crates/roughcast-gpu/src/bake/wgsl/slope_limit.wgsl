// The largest slope, once it is known.
fn slope_limit() -> f32 {
    return packed_stores.unit_scale_limit.w;
}
