// Central differences, at half a pixel on either side: section 4.
fn noise_differences(at: DetailPoint) -> vec2f {
    let along = 0.5 * dpdxFine(at.position);
    let down = 0.5 * dpdyFine(at.position);
    return vec2f(noise_change(at, along, -along), noise_change(at, down, -down));
}
