// Differences to one neighbour in the quad: Listing 1.
fn noise_differences(at: DetailPoint) -> vec2f {
    let height = noise_height(noise_options.noise, at.position);
    return vec2f(dpdxFine(height), dpdyFine(height));
}
