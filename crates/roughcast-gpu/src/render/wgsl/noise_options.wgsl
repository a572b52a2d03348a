// Procedural noise in world space. The host describes it where textures have their packing.
struct NoiseOptions {
    noise: Noise,
    octaves: u32,       // NOISE_OCTAVES_...: what becomes of octaves that are finer than the pixel
    numeric_step: f32,  // of numeric derivatives, in the unit of length
}

@group(1) @binding(0) var<uniform> noise_options: NoiseOptions;
