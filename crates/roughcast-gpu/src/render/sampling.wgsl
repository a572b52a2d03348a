// How the textures of a scene are sampled: maps of bumps and of colours alike.

struct Sampling {
    detail: f32,            // bias added to the hardware's level; or the level itself, if it is fixed
    roughness_channel: u32, // roughness channel of the second texture
    max_anisotropy: f32,    // taps along the footprint; 0 for nearest sampling
}

@group(1) @binding(2) var<uniform> sampling: Sampling;
@group(1) @binding(3) var map_sampler: sampler;
