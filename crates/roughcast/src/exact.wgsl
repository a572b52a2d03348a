// Quotients and roots rounded as in IEEE 754, like on the CPU.
// Source: T. J. Dekker, "A floating-point technique for extending the available precision", 1971.
//
// A GPU may miss the nearest float of a quotient or a root by a few steps, and may fuse a product and a sum into one
// operation with one rounding. Both are harmless but where numbers nearly cancel: there they would be the whole result.

// Always zero; the host sets it from a buffer, so that no compiler knows it.
var<private> opaque_zero: u32;

// A product that no sum can be fused with.
fn rounded(product: f32) -> f32 {
    return bitcast<f32>(bitcast<u32>(product) ^ opaque_zero);
}

fn rounded2(product: vec2f) -> vec2f {
    return bitcast<vec2f>(bitcast<vec2u>(product) ^ vec2u(opaque_zero));
}

fn rounded3(product: vec3f) -> vec3f {
    return bitcast<vec3f>(bitcast<vec3u>(product) ^ vec3u(opaque_zero));
}

// What `product`, the nearest float to `a * b`, lacks of it. Every product in here is exact: its factors have 12 bits.
fn product_error(a: f32, b: f32, product: f32) -> f32 {
    let a_high = bitcast<f32>(bitcast<u32>(a) & 0xfffff000u);
    let b_high = bitcast<f32>(bitcast<u32>(b) & 0xfffff000u);
    let a_low = a - a_high;
    let b_low = b - b_high;
    return ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
}

// Whether `v` is so far from the ends of the range of floats that errors of products can be held.
fn is_moderate(v: f32) -> bool {
    return (abs(v) > 1e-18) & (abs(v) < 1e18);
}

fn is_finite(v: f32) -> bool {
    return (bitcast<u32>(v) & 0x7f800000u) != 0x7f800000u;
}

// a / b.
fn quotient(a: f32, b: f32) -> f32 {
    let estimate = rounded(a / b);
    let product = rounded(estimate * b);
    let rest = (a - product) - product_error(estimate, b, product);
    let usable = is_moderate(estimate) & is_moderate(b) & is_moderate(product);
    return select(estimate, estimate + rest / b, usable);
}

// The square root of v >= 0.
fn square_root(v: f32) -> f32 {
    let estimate = rounded(sqrt(v));
    let product = rounded(estimate * estimate);
    let rest = (v - product) - product_error(estimate, estimate, product);
    return select(estimate, estimate + rest / (2.0 * estimate), is_moderate(product));
}
