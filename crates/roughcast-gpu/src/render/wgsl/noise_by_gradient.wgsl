// The surface gradient of a gradient in space: Listing 3.
fn perturbed(at: DetailPoint, normal: vec3f) -> vec3f {
    return perturbed_by_gradient(at, normal, noise_gradient(at));
}

fn perturbed_by_gradient(at: DetailPoint, normal: vec3f, gradient: vec3f) -> vec3f {
    return perturbed_normal(normal, surface_gradient_of_volume(normal, gradient));
}
