// Forward differences: three taps. Listing 2.
fn height_differences(at: DetailPoint) -> vec2f {
    let here = filtered(map0, at.uv).x;
    let right = filtered(map0, at.uv + dpdxFine(at.uv)).x;
    let below = filtered(map0, at.uv + dpdyFine(at.uv)).x;
    return vec2f(right - here, below - here);
}

fn finest_height_gradient(uv: vec2f) -> vec2f {
    return bilinear_height_gradient(uv);
}
