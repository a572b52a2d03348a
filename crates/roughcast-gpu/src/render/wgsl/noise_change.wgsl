// The change of the height between two offsets.
fn noise_change(at: DetailPoint, to: vec3f, away: vec3f) -> f32 {
    return noise_height(noise_options.noise, at.position + to) - noise_height(noise_options.noise, at.position + away);
}
