// Perlin's older way, for comparison only.
fn perturbed(at: DetailPoint, normal: vec3f) -> vec3f {
    return perturbed_by_gradient(at, normal, noise_gradient(at));
}

fn perturbed_by_gradient(at: DetailPoint, normal: vec3f, gradient: vec3f) -> vec3f {
    return perlin_normal(normal, gradient);
}
