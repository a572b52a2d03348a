// How to decode stored texels: value = stored * x + y for each kind of quantity; (1, 0) for float textures.
// Uploaded: 64 bytes, the numbers in the order of the fields.

struct Packing {
    slope: vec2f,           // a component of a slope
    second: vec2f,          // Mxx, Myy
    mixed: vec2f,           // Mxy
    trace: vec2f,           // Mxx + Myy
    spread: vec2f,          // a stored variance or standard deviation
    signed_spread: vec2f,   // the signed entry of the factor of a covariance
    unit: vec2f,            // a component of a unit vector
    base: u32,              // MAPS_...: whether the maps include the base roughness
    roughness_stored: u32,  // STORED_...: how a material's roughness is stored
}

const STORED_PERCEPTUAL: u32 = 0u;      // sqrt(alpha)
const STORED_ALPHA: u32 = 1u;           // alpha
const STORED_ALPHA_SQUARED: u32 = 2u;   // alpha^2
const STORED_GLOSS: u32 = 3u;           // 1 - sqrt(alpha)
const STORED_SPECULAR_POWER: u32 = 4u;  // 2 / alpha^2
