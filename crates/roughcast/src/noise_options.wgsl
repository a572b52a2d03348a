// Noise as the caller describes it.

const NOISE_FBM: u32 = 0u;          // the noise itself
const NOISE_TURBULENCE: u32 = 1u;   // its absolute value

const NOISE_OCTAVES_FADE: u32 = 0u; // octaves too small for the footprint become covariance
const NOISE_OCTAVES_DROP: u32 = 1u; // nothing is left of them
const NOISE_OCTAVES_KEEP: u32 = 2u; // all octaves at full strength, which aliases

// Uploaded: 32 bytes, one word each.
struct Noise {
    frequency: f32,     // cells of the first octave per unit of length, above 0
    amplitude: f32,     // factor of the noise of the first octave, in units of length
    octaves: u32,       // 1 to MAX_OCTAVES
    kind: u32,          // NOISE_FBM or NOISE_TURBULENCE
    seed: u32,          // of the first octave; the next has the next number
    unused_word: u32,   // padding
    unused: vec2u,
}
