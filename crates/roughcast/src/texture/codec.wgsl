// The mapping of quantities to stored values, and of stored values to texels. Twin of codec.rs and pack.rs.

// The affine map from each quantity to its stored value: stored = value * x + y.
struct Stores {
    slope: vec2f,
    second: vec2f,
    mixed: vec2f,
    trace: vec2f,
    unit: vec2f,
}

// For float texels, which hold the values themselves.
fn float_stores() -> Stores {
    let identity = vec2f(1.0, 0.0);
    return Stores(identity, identity, identity, identity, identity);
}

// For unsigned texels, which hold slopes over -scale ..= scale.
fn unsigned_stores(scale: f32) -> Stores {
    let square = scale * scale;
    return Stores(
        vec2f(quotient(0.5, scale), 0.5),
        vec2f(quotient(1.0, square), 0.0),
        vec2f(quotient(0.5, square), 0.5),
        vec2f(quotient(1.0, 2.0 * scale * scale), 0.0),
        vec2f(0.5, 0.5),
    );
}

// A flat map has no slopes to scale by; smaller slopes are indistinguishable from it.
const SMALLEST_SCALE: f32 = 0.0009765625;

// The smallest scale that can represent every slope component up to `component`, and its square plus a base variance.
fn smallest_scale(component: f32, base_variance: f32) -> f32 {
    return max(square_root(rounded(component * component) + base_variance), SMALLEST_SCALE);
}

fn stored(value: f32, affine: vec2f) -> f32 {
    return rounded(value * affine.x) + affine.y;
}

// The nearest value that an unsigned texel with `steps` + 1 codes can hold, ties to even.
fn unorm_nearest(value: vec4f, steps: f32) -> vec4f {
    return round(clamp(value, vec4f(0.0), vec4f(1.0)) * steps) / steps;
}

// The nearest half float, ties to even, so that storing it cannot round a second time, whatever the device's rounding
// mode.
fn half_nearest(value: vec4f) -> vec4f {
    let bits = bitcast<vec4u>(value);
    let normal = (bits + vec4u(0x0fffu) + ((bits >> vec4u(13u)) & vec4u(1u))) & vec4u(0xffffe000u);
    // Below 2^-14 halves are multiples of 2^-24.
    let subnormal = round(value * 16777216.0) / 16777216.0;
    return select(bitcast<vec4f>(normal), subnormal, abs(value) < vec4f(6.103515625e-5));
}
