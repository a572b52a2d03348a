// Differences to one neighbour in the quad: one tap.
fn height_differences(at: DetailPoint) -> vec2f {
    let height = texel0(at).x;
    return vec2f(dpdxFine(height), dpdyFine(height));
}

fn finest_height_gradient(uv: vec2f) -> vec2f {
    return bilinear_height_gradient(uv);
}
