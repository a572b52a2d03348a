// What every pass of a bake is told.

struct Params {
    // Of the level that is read.
    size: vec2u,
    zero: u32,
    // 0: what lies beyond the edge is the other side of the map; else the edge goes on.
    wrap: u32,
    // The largest slope before anything is known of the map; slope_limit() is the one that counts.
    max_slope: f32,
    // What a stored height is multiplied by to give texels.
    height_scale: f32,
    // Slope variance of a base roughness that is folded in (LEAN Eq. 6), else zero.
    base_variance: f32,
    // What x and y of a normal are multiplied by.
    normal_factor_x: f32,
    normal_factor_y: f32,
    // Columns between the texels of a row that an automatic limit of slopes samples; zero where the limit is known.
    survey_stride: u32,
}

// `Stores`, the scale and the largest slope behind them.
struct PackedStores {
    slope_second: vec4f,
    mixed_trace: vec4f,
    unit_scale_limit: vec4f,
}

fn unpacked_stores(packed: PackedStores) -> Stores {
    return Stores(
        packed.slope_second.xy,
        packed.slope_second.zw,
        packed.mixed_trace.xy,
        packed.mixed_trace.zw,
        packed.unit_scale_limit.xy,
    );
}

fn level_size(halvings: u32) -> vec2u {
    return max(params.size >> vec2u(halvings), vec2u(1u));
}
