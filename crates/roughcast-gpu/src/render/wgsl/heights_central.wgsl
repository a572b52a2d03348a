// Central differences: four taps. Section 4.
fn height_differences(at: DetailPoint) -> vec2f {
    let along = 0.5 * dpdxFine(at.uv);
    let down = 0.5 * dpdyFine(at.uv);
    return vec2f(
        filtered(map0, at.uv + along).x - filtered(map0, at.uv - along).x,
        filtered(map0, at.uv + down).x - filtered(map0, at.uv - down).x,
    );
}

fn finest_height_gradient(uv: vec2f) -> vec2f {
    return bilinear_height_gradient(uv);
}
