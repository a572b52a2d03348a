fn noise_gradient(at: DetailPoint) -> vec3f {
    return noise_sample(noise_options.noise, at.position).xyz;
}
