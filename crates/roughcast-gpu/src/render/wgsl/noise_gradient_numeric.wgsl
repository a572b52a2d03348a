// Central differences in space.
fn noise_gradient(at: DetailPoint) -> vec3f {
    let h = noise_options.numeric_step;
    let x = vec3f(h, 0.0, 0.0);
    let y = vec3f(0.0, h, 0.0);
    let z = vec3f(0.0, 0.0, h);
    return vec3f(noise_change(at, x, -x), noise_change(at, y, -y), noise_change(at, z, -z)) / (2.0 * h);
}
