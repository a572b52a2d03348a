// Procedural bumps: octaves of gradient noise in space, with their analytic gradient and the distribution of their slopes
// under a pixel.
//
// Sources: Perlin, An Image Synthesizer, 1985, and Improving Noise, 2002.

const NOISE_FBM: u32 = 0u;          // the sum of the octaves
const NOISE_TURBULENCE: u32 = 1u;   // the sum of their absolute values

const OCTAVES_FADE: u32 = 0u;   // octaves finer than the pixel fade out and become roughness
const OCTAVES_DROP: u32 = 1u;   // they fade out and are lost
const OCTAVES_KEEP: u32 = 2u;   // they stay, and shimmer

// Coordinates of this size or larger, in cells, are flat. Single floats have no fraction beyond 2^23.
const LARGEST_COORDINATE: f32 = 1073741824.0;

struct Noise {
    frequency: f32,     // cells per unit of length of the first octave; each further one has twice as many
    amplitude: f32,     // height of the first octave; each further one has half
    octaves: u32,       // 1 to 24
    kind: u32,          // NOISE_...
    seed: u32,
    padding_0: u32,
    padding_1: u32,
    padding_2: u32,
}

// The distribution of slopes under a pixel.
struct NoiseSlopes {
    mean: vec2f,
    variance: vec2f,    // along x and y
    covariance: f32,    // mixed term
}

// One coordinate mixed into a hash.
fn hash_step(hash: u32, coordinate: u32, factor: u32) -> u32 {
    let mixed = (hash ^ coordinate) * factor;
    return mixed ^ (mixed >> 15u);
}

// A hash of a point of the lattice, as on the CPU.
fn lattice_hash(point: vec3u, seed: u32) -> u32 {
    let x = hash_step(seed * 0x9e3779b9u, point.x, 0x85ebca6bu);
    let y = hash_step(x, point.y, 0xc2b2ae35u);
    let z = hash_step(y, point.z, 0x27d4eb2fu);
    let last = (z ^ (z >> 13u)) * 0x85ebca6bu;
    return last ^ (last >> 16u);
}

// The gradient at a point of the lattice: towards the middle of one of the twelve edges of a cube of side two.
fn lattice_gradient(point: vec3u, seed: u32) -> vec3f {
    let edge = ((lattice_hash(point, seed) >> 16u) * 12u) >> 16u;
    let a = 1.0 - 2.0 * f32(edge & 1u);
    let b = 1.0 - 2.0 * f32((edge >> 1u) & 1u);
    let along_x = vec3f(0.0, a, b);
    let along_y = vec3f(a, 0.0, b);
    let along_z = vec3f(a, b, 0.0);
    return select(select(along_x, along_y, (edge >> 2u) == 1u), along_z, (edge >> 2u) == 2u);
}

// Gradient noise at a point in cells, in w, and its gradient in xyz. Flat where it has no cell.
fn gradient_noise(p: vec3f, seed: u32) -> vec4f {
    let size = abs(p);
    // False for NaN.
    if max(size.x, max(size.y, size.z)) < LARGEST_COORDINATE {
        let whole = floor(p);
        let t = p - whole;
        let cell = bitcast<vec3u>(vec3i(whole));
        let fade = t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
        let slope = 30.0 * (t * (1.0 - t)) * (t * (1.0 - t));
        var sum = vec4f(0.0);
        for (var corner = 0u; corner < 8u; corner++) {
            let place = vec3u(corner & 1u, (corner >> 1u) & 1u, corner >> 2u);
            let far = vec3f(place);
            let direction = lattice_gradient(cell + place, seed);
            // Towards a corner on the far side the weight grows with the blend, towards one on the near side it falls.
            let side = 2.0 * far - 1.0;
            let weights = (1.0 - far) + side * fade;
            let ramp = dot(direction, t - far);
            let weight = weights.x * weights.y * weights.z;
            let weight_gradient = side * slope * (weights.yzx * weights.zxy);
            sum += vec4f(weight * direction + ramp * weight_gradient, weight * ramp);
        }
        return sum;
    }
    return vec4f(0.0);
}

// Height and gradient of one octave, counted from 0.
fn noise_octave(noise: Noise, octave: u32, p: vec3f) -> vec4f {
    // Powers of two are exact.
    let scale = f32(1u << octave);
    let frequency = noise.frequency * scale;
    let amplitude = noise.amplitude / scale;
    let sampled = gradient_noise(p * frequency, noise.seed + octave);
    let folded = select(sampled, sampled * sign(sampled.w), noise.kind == NOISE_TURBULENCE);
    return vec4f(folded.xyz * (amplitude * frequency), folded.w * amplitude);
}

// The height at a point, in w, and its gradient in xyz.
fn noise_sample(noise: Noise, p: vec3f) -> vec4f {
    var sum = vec4f(0.0);
    for (var octave = 0u; octave < noise.octaves; octave++) {
        sum += noise_octave(noise, octave, p);
    }
    return sum;
}

// How much of the slope of an octave is left in its mean under a pixel, whose footprint has this variance in squared
// cells.
fn octave_fade(kind: u32, variance: f32) -> f32 {
    let place = sqrt(max(variance, 0.0)) / FADE_STEP;
    // False for NaN.
    if place < f32(FADE_ENTRIES - 1u) {
        let first = u32(place);
        let before = fade_entry(kind, first);
        return before + (place - f32(first)) * (fade_entry(kind, first + 1u) - before);
    }
    return 0.0;
}

fn fade_entry(kind: u32, place: u32) -> f32 {
    var fades = NOISE_FADE;
    if kind == NOISE_TURBULENCE {
        fades = TURBULENCE_FADE;
    }
    return fades[place];
}

// The distribution of slopes under a pixel, along two perpendicular unit vectors in the tangent plane. `position_dx` and
// `position_dy` are the changes of the position to the adjacent pixels: dpdxFine(position) and dpdyFine(position).
fn noise_distribution(
    noise: Noise,
    p: vec3f,
    tangent: vec3f,
    bitangent: vec3f,
    position_dx: vec3f,
    position_dy: vec3f,
    octave_filter: u32,
) -> NoiseSlopes {
    let dx = vec2f(dot(position_dx, tangent), dot(position_dx, bitangent));
    let dy = vec2f(dot(position_dy, tangent), dot(position_dy, bitangent));
    // The covariance of the footprint, and its principal axes.
    let sum = 0.25 * (dx.xyx * dx.xyy + dy.xyx * dy.xyy);
    let half_difference = 0.5 * (sum.x - sum.y);
    let mean_variance = 0.5 * (sum.x + sum.y);
    let radius = sqrt(half_difference * half_difference + sum.z * sum.z);
    let tall = vec2f(sum.z, radius - half_difference);
    let raw = select(tall, vec2f(half_difference + radius, sum.z), half_difference >= 0.0);
    let squared = dot(raw, raw);
    let along = select(vec2f(1.0, 0.0), raw * inverseSqrt(squared), squared > 0.0);
    let across = vec2f(-along.y, along.x);
    // The slope along an axis is that of waves about it: they see 3/4 of its variance and 1/4 of the other's.
    let fading = vec2f(mean_variance + 0.5 * radius, mean_variance - 0.5 * radius);
    var mean = vec2f(0.0);
    var spread = vec2f(0.0);
    for (var octave = 0u; octave < noise.octaves; octave++) {
        let frequency = noise.frequency * f32(1u << octave);
        var fades = vec2f(1.0);
        if octave_filter != OCTAVES_KEEP {
            let cells = fading * (frequency * frequency);
            fades = vec2f(octave_fade(noise.kind, cells.x), octave_fade(noise.kind, cells.y));
        }
        // Octaves that are not resolved at all cost nothing.
        if fades.x + fades.y > 0.0 {
            let gradient = noise_octave(noise, octave, p).xyz;
            let in_plane = vec2f(dot(gradient, tangent), dot(gradient, bitangent));
            mean -= fades * vec2f(dot(in_plane, along), dot(in_plane, across));
        }
        spread += 1.0 - fades * fades;
    }
    // All octaves have slopes of the same size.
    let slope_size = noise.amplitude * noise.frequency;
    let kept = select(0.0, slope_size * slope_size * NOISE_SLOPE_VARIANCE, octave_filter == OCTAVES_FADE);
    let variance = kept * (spread.x * along * along + spread.y * across * across);
    let covariance = kept * (spread.x * along.x * along.y + spread.y * across.x * across.y);
    return NoiseSlopes(along * mean.x + across * mean.y, variance, covariance);
}

// The variance of the slopes of noise of frequency and amplitude one along any axis.
const NOISE_SLOPE_VARIANCE: f32 = 0.4961967;
// The distance between two entries of the tables, in the standard deviation of the footprint in cells; their number.
const FADE_STEP: f32 = 0.0625;
const FADE_ENTRIES: u32 = 17u;
// How octaves fade: noise, and its absolute value.
const NOISE_FADE: array<f32, 17> = array<f32, 17>(1.0, 0.9562, 0.8408, 0.6898, 0.535, 0.3989, 0.2897, 0.2063, 0.1473, 0.1048, 0.0755, 0.0545, 0.0405, 0.0307, 0.0227, 0.0177, 0.0);
const TURBULENCE_FADE: array<f32, 17> = array<f32, 17>(1.0, 0.7678, 0.5272, 0.3323, 0.2003, 0.1208, 0.073, 0.0458, 0.0294, 0.0194, 0.0133, 0.0094, 0.0071, 0.0056, 0.0038, 0.0031, 0.0);
