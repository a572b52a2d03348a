// Bumps inside a box, projected along its z axis; the surface is flat elsewhere. As in `Decal` of the CPU renderer.

// The fraction of the box's depth, at its front and back, over which a decal fades.
const DECAL_FADE: f32 = 0.1;

// The position in the box, which is the cube from -1/2 to 1/2.
fn position_in_box(position: vec3f) -> vec3f {
    let p = vec4f(position, 1.0);
    return vec3f(dot(source_options.box_x, p), dot(source_options.box_y, p), dot(source_options.box_z, p));
}

// The texture covers the square of the box once.
fn decal_point(at: DetailPoint, local: vec3f) -> DetailPoint {
    return DetailPoint(vec2f(local.x + 0.5, 0.5 - local.y), at.position, at.frame, at.side);
}

// Zero outside of the box.
fn decal_strength(at: DetailPoint, local: vec3f) -> f32 {
    let facing = max(dot(unit_vector_or(source_options.box_z.xyz, vec3f(0.0)), at.frame[2]), 0.0);
    let depth = min((0.5 - abs(local.z)) / DECAL_FADE, 1.0);
    return select(0.0, depth * facing, all(abs(local) <= vec3f(0.5)));
}

fn placed_slope(at: DetailPoint) -> vec2f {
    let local = position_in_box(at.position);
    let slope = projected_slope(decal_point(at, local));
    let strength = decal_strength(at, local);
    return select(vec2f(0.0), strength * slope, strength > 0.0);
}

fn placed_distribution(at: DetailPoint) -> Distribution {
    let local = position_in_box(at.position);
    // Textures are sampled everywhere: their derivatives need the neighbours.
    let inside = projected_distribution(decal_point(at, local));
    let strength = decal_strength(at, local);
    if strength > 0.0 {
        return scaled_bumps(inside, strength, 1.0 / options.specular_power);
    }
    return distribution_of_slope(vec2f(0.0));
}
