// The change of the height to the adjacent pixels, of the plane with the gradient.
fn noise_differences(at: DetailPoint) -> vec2f {
    let gradient = noise_gradient(at);
    return vec2f(dot(gradient, dpdxFine(at.position)), dot(gradient, dpdyFine(at.position)));
}
