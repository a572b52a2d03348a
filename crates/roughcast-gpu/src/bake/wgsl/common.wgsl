// The parameters of every pass of a bake.

struct Params {
    // Size of the level that is read.
    size: vec2u,
    zero: u32,
    // 0: the map repeats beyond its edges; otherwise the edge texels are repeated.
    wrap: u32,
    // The largest slope as known before the map is read; slope_limit() returns the one that applies.
    max_slope: f32,
    // The factor from a stored height to texels.
    height_scale: f32,
    // Slope variance of a base roughness that is folded in (LEAN Eq. 6); zero if there is none.
    base_variance: f32,
    // Factor that scales the x and y of a normal.
    normal_factor_x: f32,
    normal_factor_y: f32,
    // Distance in columns between the texels that an automatic slope limit samples in a row; zero if the limit is
    // known.
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
