// Gabor noise in a plane: random ripples of one frequency and direction. Twin of gabor.rs.
//
// Source: Lagae et al., Procedural Noise using Sparse Gabor Convolution, 2009.

const GABOR_TURN: f32 = 6.283185307179586;
// Pi times the squared side of a cell in units of a kernel's width: the exponent at a distance of one cell.
const GABOR_EXPONENT: f32 = 2.9957323;
// The largest number of impulses in a cell.
const GABOR_MOST_IN_CELL: u32 = 64u;
// Positions this many cells or more from the origin, 2^30, are flat. These are the bits of that number.
const GABOR_REACH_BITS: u32 = 0x4e800000u;

// Uploaded: 32 bytes, one word each.
struct GaborNoise {
    cells: f32,             // cells per unit of length
    cycles: f32,            // cycles per cell
    direction: f32,         // across the ripples, in radians counter-clockwise from x
    spread: f32,            // of the directions to either side, in radians
    kernel_height: f32,     // factor of all kernels
    least_product: f32,     // exp(-mean number of impulses in a cell)
    period: u32,            // cells after which the noise repeats, or 0
    seed: u32,
}

fn gabor_hash(key: u32) -> u32 {
    return noise_hash(vec4u(key)).x;
}

// A number in 0 .. 1 from a hash.
fn gabor_uniform(hash: u32) -> f32 {
    return f32(hash >> 8u) * 5.9604644775390625e-8;
}

fn gabor_cell_hash(noise: GaborNoise, cell: vec2i) -> u32 {
    var corner = cell;
    if noise.period > 0u {
        let side = vec2i(i32(noise.period));
        corner = ((cell % side) + side) % side;
    }
    let key = bitcast<vec2u>(corner);
    return gabor_hash(key.x + gabor_hash(key.y + gabor_hash(noise.seed)));
}

// The number of impulses of the cell with this hash, with a Poisson distribution.
fn gabor_impulse_count(noise: GaborNoise, hash: u32) -> u32 {
    var product = gabor_uniform(hash);
    var count = 0u;
    while (product > noise.least_product) & (count < GABOR_MOST_IN_CELL) {
        count += 1u;
        product *= gabor_uniform(gabor_hash(hash + count));
    }
    return count;
}

// One kernel of a cell, at an offset from its corner in cells: gradient by cells in xy, value in z, without their common factor.
fn gabor_kernel(noise: GaborNoise, hash: u32, index: u32, at: vec2f) -> vec3f {
    let words = noise_hash(vec4u(hash + GABOR_MOST_IN_CELL + 1u + 4u * index) + vec4u(0u, 1u, 2u, 3u));
    let x = at - vec2f(gabor_uniform(words.x), gabor_uniform(words.y));
    let squared = dot(x, x);
    if squared >= 1.0 {
        return vec3f(0.0);
    }
    let turn = (noise.direction + noise.spread * (2.0 * gabor_uniform(words.w) - 1.0)) / GABOR_TURN;
    let across = vec2f(cosine_of_turns(turn), sine_of_turns(turn));
    let envelope = (2.0 * gabor_uniform(words.z) - 1.0) * exp(-GABOR_EXPONENT * squared);
    let phase = noise.cycles * dot(x, across);
    let wave = vec2f(cosine_of_turns(phase), sine_of_turns(phase));
    let gradient = 2.0 * GABOR_EXPONENT * wave.x * x + GABOR_TURN * noise.cycles * wave.y * across;
    return envelope * vec3f(-gradient, wave.x);
}

// The sum of the kernels of the cell with this hash, of which there are `count`.
fn gabor_kernels(noise: GaborNoise, hash: u32, count: u32, at: vec2f) -> vec3f {
    var heights = vec3f(0.0);
    for (var index = 0u; index < count; index++) {
        heights += gabor_kernel(noise, hash, index, at);
    }
    return heights;
}

// The height at a position, in z, and its gradient in xy.
fn gabor_sample(noise: GaborNoise, p: vec2f) -> vec3f {
    let cells = p * noise.cells;
    if !all((bitcast<vec2u>(cells) & vec2u(0x7fffffffu)) < vec2u(GABOR_REACH_BITS)) {
        return vec3f(0.0);
    }
    let cell = floor(cells);
    var heights = vec3f(0.0);
    for (var place = 0; place < 9; place++) {
        let offset = vec2i(place % 3 - 1, place / 3 - 1);
        let hash = gabor_cell_hash(noise, vec2i(cell) + offset);
        let count = gabor_impulse_count(noise, hash);
        heights += gabor_kernels(noise, hash, count, cells - cell - vec2f(offset));
    }
    return noise.kernel_height * vec3f(noise.cells * heights.xy, heights.z);
}
