// The parameters of every pass of a bake.

struct Params {
    // Of the level that is read.
    size: vec2u,
    zero: u32,
    // 0: the map repeats beyond its edges; otherwise the edge texels do.
    wrap: u32,
    // The largest slope before anything is known of the map; slope_limit() is the one that counts.
    max_slope: f32,
    // The factor from a stored height to texels.
    height_scale: f32,
    // Slope variance of a base roughness that is folded in (LEAN Eq. 6), otherwise zero.
    base_variance: f32,
    // The factor of x and y of a normal.
    normal_factor_x: f32,
    normal_factor_y: f32,
    // Columns between the texels of a row that an automatic limit of slopes samples; zero if the limit is known.
    survey_stride: u32,
}

// `Stores`, followed by the scale and the largest slope.
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
