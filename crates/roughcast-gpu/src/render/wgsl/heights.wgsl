// Bump mapping from heights alone: Mikkelsen, Bump Mapping Unparametrized Surfaces on the GPU, 2010. The heights are in
// texels of level 0. `height_differences` is one of several.

// The change of the height with u and v at level 0, of the bilinear surface between texels.
fn bilinear_height_gradient(uv: vec2f) -> vec2f {
    let size = vec2f(textureDimensions(map0));
    let at = uv * size - 0.5;
    let cell = floor(at);
    let part = at - cell;
    // Sampled at the centres of texels, so that the sampler wraps them and does not interpolate.
    let a = finest(map0, (cell + vec2f(0.5, 0.5)) / size).x;
    let b = finest(map0, (cell + vec2f(1.5, 0.5)) / size).x;
    let c = finest(map0, (cell + vec2f(0.5, 1.5)) / size).x;
    let d = finest(map0, (cell + vec2f(1.5, 1.5)) / size).x;
    return vec2f(mix(b - a, d - c, part.y), mix(c - a, d - b, part.x)) * size;
}

// The world height of one texel of height: the given one, or one texel in the direction in which it is smallest.
fn world_height_per_texel(gradients: mat2x3f) -> f32 {
    let size = vec2f(textureDimensions(map0));
    if source_options.has_height != 0u {
        return source_options.height_per_uv.x / size.x;
    }
    let longest = max(size.x * length(gradients[0]), size.y * length(gradients[1]));
    return select(0.0, 1.0 / longest, longest > 0.0);
}

fn height_gradients(at: DetailPoint) -> mat2x3f {
    let basis = surface_basis(dpdxFine(at.position), dpdyFine(at.position), at.frame[2]);
    return texture_gradients(basis, dpdxFine(at.uv), dpdyFine(at.uv));
}

fn detail_slope(at: DetailPoint) -> vec2f {
    let gradients = height_gradients(at);
    let gradient = finite_or_flat(gradients * (finest_height_gradient(at.uv) * world_height_per_texel(gradients)));
    return at.side * slope_of_gradient(at.frame[0], at.frame[1], gradient);
}

// Listing 1, without a spread: bumps that the filter of the heights removes are lost.
fn detail_distribution(at: DetailPoint) -> Distribution {
    let differences = world_height_per_texel(height_gradients(at)) * height_differences(at);
    let gradient = surface_gradient(
        dpdxFine(at.position), dpdyFine(at.position), at.frame[2], differences.x, differences.y,
    );
    return distribution_of_slope(at.side * slope_of_gradient(at.frame[0], at.frame[1], gradient));
}
