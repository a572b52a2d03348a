// Procedural bumps: octaves of gradient noise, and the distribution of their slopes under a footprint.
//
// In a fragment shader, with the position on the surface and the axes of its tangent plane:
//   let slopes = noise_distribution(noise, p, tangent, bitangent, dpdx(p), dpdy(p), NOISE_OCTAVES_FADE);

// Positions this many cells or more from the origin, 2^30, are flat. These are the bits of that number.
const NOISE_REACH_BITS: u32 = 0x4e800000u;

const MAX_OCTAVES: u32 = 24u;

// The variance of the slopes of noise with one cell per unit, along any axis.
const NOISE_SLOPE_VARIANCE: f32 = 0.49619672715191915;

// The variance of the pixel filter, in squared pixels.
const NOISE_PIXEL_VARIANCE: f32 = 0.25;

// The bits of 2^20: changes of the position by this many cells of the first octave or more count as infinite.
const NOISE_LONGEST_BITS: u32 = 0x49800000u;

// Stands for the variance of an infinite footprint, in squared cells.
const NOISE_INFINITE: f32 = 1e20;

// cos of twice 11.25 and 33.75 degrees.
const NOISE_DOUBLE_ANGLES: vec2f = vec2f(0.9238795325112867, 0.3826834323650898);

// Coefficients of s, s^2, s^4 and s^5 in the reciprocal of what remains of the slopes of an octave under a round Gaussian
// footprint of s cells of standard deviation, minus one: fractal noise, and its absolute value.
const NOISE_FADE_FBM: vec4f = vec4f(0.0, 11.553, 28.757, 35.358);
const NOISE_FADE_TURBULENCE: vec4f = vec4f(3.061, 26.969, 393.06, 0.0);
// From this standard deviation on nothing remains.
const NOISE_FADE_LAST: f32 = 1.2;

struct NoiseFootprint {
    double_angle: vec2f,    // cosine and sine of twice the angle of the longer axis from the tangent, or zero
    centre: f32,            // variance, in squared cells of the first octave: centre + radius along the longer axis
    radius: f32,            // and centre - radius along the shorter one
}

// Mixes all bits of each word: the last step of MurmurHash3.
fn noise_hash(key: vec4u) -> vec4u {
    let first = (key ^ (key >> vec4u(16u))) * 0x85ebca6bu;
    let second = (first ^ (first >> vec4u(13u))) * 0xc2b2ae35u;
    return second ^ (second >> vec4u(16u));
}

// Whether a position in cells has noise; compares bits, since comparisons with NaN are undefined.
fn noise_within_reach(p: vec3f) -> bool {
    return all((bitcast<vec3u>(p) & vec3u(0x7fffffffu)) < vec3u(NOISE_REACH_BITS));
}

// The linear function of a lattice point with this hash, at an offset from it: gradient and value.
fn noise_corner(hash: u32, offset: vec3f) -> vec4f {
    let direction = ((hash >> 16u) * 12u) >> 16u;
    let signs = vec2f(1.0) - 2.0 * vec2f(vec2u(direction, direction >> 1u) & vec2u(1u));
    let in_plane = select(vec3f(signs, 0.0), vec3f(signs.x, 0.0, signs.y), direction >= 4u);
    let gradient = select(in_plane, vec3f(0.0, signs), direction >= 8u);
    return vec4f(gradient, dot(gradient, offset));
}

// Linear interpolation of gradients and values, with a weight that has the gradient `change`.
fn noise_blend(a: vec4f, b: vec4f, weight: f32, change: vec3f) -> vec4f {
    return mix(a, b, weight) + vec4f((b.w - a.w) * change, 0.0);
}

// Gradient noise at a position in cells: gradient in xyz, value in w.
fn gradient_noise(p: vec3f, seed: u32) -> vec4f {
    if !noise_within_reach(p) {
        return vec4f(0.0);
    }
    let cell = floor(p);
    let t = p - cell;
    let weight = t * t * t * (t * (6.0 * t - 15.0) + 10.0);
    let hump = t * (1.0 - t);
    let change = 30.0 * hump * hump;
    let lattice = bitcast<vec3u>(vec3i(cell));
    // The rows of corners along x: y changes fastest, then z.
    let planes = noise_hash(noise_hash(vec4u(seed)) + lattice.z + vec4u(0u, 0u, 1u, 1u));
    let rows = noise_hash(planes + lattice.y + vec4u(0u, 1u, 0u, 1u));
    let left = noise_hash(rows + lattice.x);
    let right = noise_hash(rows + lattice.x + 1u);

    let x = vec3f(change.x, 0.0, 0.0);
    let u = t - vec3f(1.0, 0.0, 0.0);
    let near_low = noise_blend(noise_corner(left.x, t), noise_corner(right.x, u), weight.x, x);
    let one_y = vec3f(0.0, 1.0, 0.0);
    let near_high = noise_blend(noise_corner(left.y, t - one_y), noise_corner(right.y, u - one_y), weight.x, x);
    let one_z = vec3f(0.0, 0.0, 1.0);
    let far_low = noise_blend(noise_corner(left.z, t - one_z), noise_corner(right.z, u - one_z), weight.x, x);
    let both = vec3f(0.0, 1.0, 1.0);
    let far_high = noise_blend(noise_corner(left.w, t - both), noise_corner(right.w, u - both), weight.x, x);

    let y = vec3f(0.0, change.y, 0.0);
    let near = noise_blend(near_low, near_high, weight.y, y);
    let far = noise_blend(far_low, far_high, weight.y, y);
    return noise_blend(near, far, weight.z, vec3f(0.0, 0.0, change.z));
}

// Cells of an octave per cell of the first: a power of two, made of its bits, so that it is exact.
fn noise_scale(octave: u32) -> f32 {
    return bitcast<f32>((octave + 127u) << 23u);
}

// One octave without its amplitude, of a position in cells of the first octave.
fn noise_octave(noise: Noise, cells: vec3f, octave: u32) -> vec4f {
    let value = gradient_noise(cells * noise_scale(octave), noise.seed + octave);
    return select(value, sign(value.w) * value, noise.kind == NOISE_TURBULENCE);
}

// The height at a position, in w, and its gradient.
fn noise_sample(noise: Noise, p: vec3f) -> vec4f {
    let cells = p * noise.frequency;
    let steepness = noise.amplitude * noise.frequency;
    var sum = vec4f(0.0);
    for (var octave = 0u; octave < min(noise.octaves, MAX_OCTAVES); octave++) {
        let height = noise.amplitude / noise_scale(octave);
        sum += vec4f(vec3f(steepness), height) * noise_octave(noise, cells, octave);
    }
    return sum;
}

// The height at a position.
fn noise_height(noise: Noise, p: vec3f) -> f32 {
    return noise_sample(noise, p).w;
}

// The part of an octave's slopes that a round footprint of variance q, in squared cells of the octave, keeps.
fn noise_fade(kind: u32, q: f32) -> f32 {
    let fit = select(NOISE_FADE_FBM, NOISE_FADE_TURBULENCE, kind == NOISE_TURBULENCE);
    let sigma = sqrt(q);
    let fade = 1.0 / (1.0 + sigma * fit.x + q * (fit.y + q * (fit.z + sigma * fit.w)));
    return select(0.0, fade, sigma < NOISE_FADE_LAST);
}

// The footprint of a pixel, given the changes of the position to the adjacent pixels, in cells of the first octave.
fn noise_footprint(cells_dx: vec2f, cells_dy: vec2f) -> NoiseFootprint {
    let bits = bitcast<vec4u>(vec4f(cells_dx, cells_dy)) & vec4u(0x7fffffffu);
    if !all(bits < vec4u(NOISE_LONGEST_BITS)) {
        return NoiseFootprint(vec2f(0.0), NOISE_INFINITE, 0.0);
    }
    let variances = NOISE_PIXEL_VARIANCE * (cells_dx * cells_dx + cells_dy * cells_dy);
    let mixed = NOISE_PIXEL_VARIANCE * (cells_dx.x * cells_dx.y + cells_dy.x * cells_dy.y);
    let axis = vec2f(0.5 * (variances.x - variances.y), mixed);
    let radius = length(axis);
    return NoiseFootprint(axis / max(radius, 1e-30), 0.5 * (variances.x + variances.y), radius);
}

// The part of an octave that a footprint keeps: x + y along its longer axis and x - y along the shorter one.
fn noise_kept(footprint: NoiseFootprint, kind: u32, squared_scale: f32) -> vec2f {
    let swing = footprint.radius * NOISE_DOUBLE_ANGLES;
    let along = squared_scale * (footprint.centre + swing);
    let across = squared_scale * max(footprint.centre - swing, vec2f(0.0));
    let kept_along = vec2f(noise_fade(kind, along.x), noise_fade(kind, along.y));
    let kept_across = vec2f(noise_fade(kind, across.x), noise_fade(kind, across.y));
    let sum = kept_along + kept_across;
    return 0.25 * vec2f(sum.x + sum.y, dot(NOISE_DOUBLE_ANGLES, kept_along - kept_across));
}

// Mean and covariance of the slopes under the footprint of a pixel at p, along tangent and bitangent, which are
// orthonormal. The changes of the position to the adjacent pixels may be zero or of any size.
fn noise_distribution(noise: Noise, p: vec3f, tangent: vec3f, bitangent: vec3f, position_dx: vec3f,
    position_dy: vec3f, octave_filter: u32) -> WeightedGaussian {
    let cells = p * noise.frequency;
    let cells_dx = vec2f(dot(position_dx, tangent), dot(position_dx, bitangent)) * noise.frequency;
    let cells_dy = vec2f(dot(position_dy, tangent), dot(position_dy, bitangent)) * noise.frequency;
    let footprint = noise_footprint(cells_dx, cells_dy);
    let c = footprint.double_angle;
    var gradient = vec2f(0.0);
    var hidden = vec3f(0.0);
    for (var octave = 0u; octave < min(noise.octaves, MAX_OCTAVES); octave++) {
        let scale = noise_scale(octave);
        if !noise_within_reach(cells * scale) {
            break;
        }
        var kept = vec2f(1.0, 0.0);
        if octave_filter != NOISE_OCTAVES_KEEP {
            kept = noise_kept(footprint, noise.kind, scale * scale);
        }
        // One minus the square of the matrix that is applied to the gradient.
        let mean_hidden = 1.0 - dot(kept, kept);
        let swing = 2.0 * kept.x * kept.y;
        hidden += vec3f(mean_hidden - swing * c.x, mean_hidden + swing * c.x, -swing * c.y);
        if kept.x > 0.0 {
            let exact = noise_octave(noise, cells, octave).xyz;
            let g = vec2f(dot(exact, tangent), dot(exact, bitangent));
            gradient += kept.x * g + kept.y * vec2f(c.x * g.x + c.y * g.y, c.y * g.x - c.x * g.y);
        }
    }
    let steepness = noise.amplitude * noise.frequency;
    let variance = select(0.0, steepness * steepness * NOISE_SLOPE_VARIANCE, octave_filter == NOISE_OCTAVES_FADE);
    return WeightedGaussian(-steepness * gradient, variance * hidden.xy, variance * hidden.z, 1.0);
}
