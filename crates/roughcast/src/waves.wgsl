// Travelling waves of water, and the distribution of their slopes under a footprint. Twin of waves.rs.
//
// A wave is a vec4f: its vector in radians per unit of length, its amplitude, and its phase at this moment. In a fragment
// shader, for each wave, with a position in the plane of the water:
//   let slopes = wave_distribution(wave, p, dpdx(p), dpdy(p));
// Means and covariances of several waves add.

const WAVE_TURN: f32 = 6.283185307179586;
// The variance of the pixel filter, in squared pixels.
const WAVE_PIXEL_VARIANCE: f32 = 0.25;
// Exponents below this count as this: nothing of the wave is left.
const WAVE_LEAST_EXPONENT: f32 = -80.0;
// The least part of the length of the water that Gerstner's waves leave of it: a slope of 512 times theirs.
const WAVE_LEAST_PINCH: f32 = 0.001953125;

// The phase at a position, in turns.
fn wave_turns(wave: vec4f, p: vec2f) -> f32 {
    return (dot(wave.xy, p) + wave.w) / WAVE_TURN;
}

// The height at a position.
fn wave_height(wave: vec4f, p: vec2f) -> f32 {
    return wave.z * sine_of_turns(wave_turns(wave, p));
}

// The slope at a position: minus the gradient of the height.
fn wave_slope(wave: vec4f, p: vec2f) -> vec2f {
    return -wave.z * cosine_of_turns(wave_turns(wave, p)) * wave.xy;
}

// Mean and covariance of the slopes under the footprint of a pixel, given the changes of p to the adjacent pixels.
fn wave_distribution(wave: vec4f, p: vec2f, p_dx: vec2f, p_dy: vec2f) -> WeightedGaussian {
    let across = vec2f(dot(wave.xy, p_dx), dot(wave.xy, p_dy));
    let kept = exp(max(-0.5 * WAVE_PIXEL_VARIANCE * dot(across, across), WAVE_LEAST_EXPONENT));
    let cosine = cosine_of_turns(wave_turns(wave, p));
    let steepness = wave.z * wave.xy;
    // What the footprint hides, as a product without cancellation.
    let squared = kept * kept;
    let hidden = (1.0 - squared) * max(0.5 * (1.0 + squared) - squared * cosine * cosine, 0.0);
    return WeightedGaussian(
        -kept * cosine * steepness, hidden * steepness * steepness, hidden * steepness.x * steepness.y, 1.0,
    );
}

// The part of one of Gerstner's waves in the normal of the water that rests at p: a slope, and in z what the surface is
// shortened by. `roundness` is 1 for water that moves in circles, 0 for plain sines.
fn gerstner_part(wave: vec4f, p: vec2f, roundness: f32) -> vec3f {
    let turns = wave_turns(wave, p);
    return wave.z * vec3f(-cosine_of_turns(turns) * wave.xy, roundness * sine_of_turns(turns) * length(wave.xy));
}

// The slope of Gerstner's waves, from the sum of their parts.
fn gerstner_slope(parts: vec3f) -> vec2f {
    return parts.xy / max(1.0 - parts.z, WAVE_LEAST_PINCH);
}
