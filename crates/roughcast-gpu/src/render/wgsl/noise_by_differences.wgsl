// The surface gradient of differences on the screen: Listing 1.
fn perturbed(at: DetailPoint, normal: vec3f) -> vec3f {
    let differences = noise_differences(at);
    let gradient = surface_gradient(
        dpdxFine(at.position), dpdyFine(at.position), normal, differences.x, differences.y,
    );
    return perturbed_normal(normal, gradient);
}

fn perturbed_by_gradient(at: DetailPoint, normal: vec3f, gradient: vec3f) -> vec3f {
    return perturbed_normal(normal, surface_gradient_of_volume(normal, gradient));
}
