// The normal of the displaced facet, for comparison only: it shows the edges of triangles.
fn perturbed(at: DetailPoint, normal: vec3f) -> vec3f {
    let differences = noise_differences(at);
    return displaced_normal(dpdxFine(at.position), dpdyFine(at.position), normal, differences.x, differences.y);
}

fn perturbed_by_gradient(at: DetailPoint, normal: vec3f, gradient: vec3f) -> vec3f {
    let dx = dpdxFine(at.position);
    let dy = dpdyFine(at.position);
    return displaced_normal(dx, dy, normal, dot(gradient, dx), dot(gradient, dy));
}
