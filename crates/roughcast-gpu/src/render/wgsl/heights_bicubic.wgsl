// The derivative of a bicubic B-spline through the texels: sixteen taps, smooth where the map is magnified.

fn cubic_weights(t: f32) -> vec4f {
    let s = 1.0 - t;
    return vec4f(s * s * s, 4.0 - 6.0 * t * t + 3.0 * t * t * t, 4.0 - 6.0 * s * s + 3.0 * s * s * s, t * t * t) / 6.0;
}

fn cubic_derivatives(t: f32) -> vec4f {
    let s = 1.0 - t;
    return 0.5 * vec4f(-s * s, t * (3.0 * t - 4.0), -s * (3.0 * s - 4.0), t * t);
}

// Four texels of a row, from one left of the cell. Sampled at their centres, so that the sampler wraps them.
fn height_row(cell: vec2f, size: vec2f, level: f32) -> vec4f {
    return vec4f(
        textureSampleLevel(map0, map_sampler, (cell + vec2f(-0.5, 0.5)) / size, level).x,
        textureSampleLevel(map0, map_sampler, (cell + vec2f(0.5, 0.5)) / size, level).x,
        textureSampleLevel(map0, map_sampler, (cell + vec2f(1.5, 0.5)) / size, level).x,
        textureSampleLevel(map0, map_sampler, (cell + vec2f(2.5, 0.5)) / size, level).x,
    );
}

// The change of the height with u and v at a level.
fn bicubic_level_gradient(uv: vec2f, level: f32) -> vec2f {
    let size = vec2f(textureDimensions(map0, u32(level)));
    let at = uv * size - 0.5;
    let cell = floor(at);
    let part = at - cell;
    let rows = mat4x4f(
        height_row(cell + vec2f(0.0, -1.0), size, level),
        height_row(cell, size, level),
        height_row(cell + vec2f(0.0, 1.0), size, level),
        height_row(cell + vec2f(0.0, 2.0), size, level),
    );
    let along_x = dot(cubic_derivatives(part.x) * rows, cubic_weights(part.y));
    let along_y = dot(cubic_weights(part.x) * rows, cubic_derivatives(part.y));
    return vec2f(along_x, along_y) * size;
}

fn height_differences(at: DetailPoint) -> vec2f {
    let uv_dx = dpdxFine(at.uv);
    let uv_dy = dpdyFine(at.uv);
    let level = height_level(uv_dx, uv_dy);
    let finer = floor(level);
    let gradient = mix(
        bicubic_level_gradient(at.uv, finer), bicubic_level_gradient(at.uv, ceil(level)), level - finer,
    );
    return vec2f(dot(gradient, uv_dx), dot(gradient, uv_dy));
}

fn finest_height_gradient(uv: vec2f) -> vec2f {
    return bicubic_level_gradient(uv, 0.0);
}
