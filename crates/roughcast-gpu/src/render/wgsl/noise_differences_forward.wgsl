// Forward differences, a pixel apart: Listing 2.
fn noise_differences(at: DetailPoint) -> vec2f {
    let here = vec3f(0.0);
    return vec2f(noise_change(at, dpdxFine(at.position), here), noise_change(at, dpdyFine(at.position), here));
}
