// How a source of bumps is sampled, placed on the surface, and strengthened. Its textures follow from binding 3 on.
struct SourceOptions {
    level: f32,             // bias added to the hardware's level; or the level itself, if it is fixed
    roughness_channel: u32, // roughness channel of the second texture
    max_anisotropy: f32,    // taps along the footprint; 0 for nearest sampling
    strength: f32,          // factor of the heights
    height_per_uv: vec2f,   // world height of a slope of one along a unit of u and of v
    has_height: u32,        // 1 if bumps have such a height, 0 if their size is that of their texture
    sharpness: f32,         // of the blend of triplanar projections
    box_x: vec4f,           // rows of the matrix from world space to the box of a decal
    box_y: vec4f,
    box_z: vec4f,
}

@group(1) @binding(1) var<uniform> source_options: SourceOptions;
@group(1) @binding(2) var map_sampler: sampler;
