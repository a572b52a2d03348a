// How bumps are placed on the surface.
struct SurfaceOptions {
    height_per_uv: vec2f,   // world height of a slope of one along a unit of u and of v
    has_height: u32,        // 1 if bumps have such a height, 0 if their size is that of their texture
    sharpness: f32,         // of the blend of triplanar projections
    curvature_pixel_variance: f32,  // of geometric specular antialiasing
    curvature_largest_variance: f32,
    padding: vec2f,
}

@group(1) @binding(4) var<uniform> surface_options: SurfaceOptions;
