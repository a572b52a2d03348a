// How lobes are evaluated. Uploaded: 32 bytes, one word each.

struct ShadingOptions {
    specular_power: f32,    // Blinn-Phong exponent s of the base roughness, 1 to 100000; its slope variance is 1 / s
    form: u32,              // FORM_...
    base_frame: u32,        // BASE_...
    repair: u32,            // REPAIR_...
    masking: u32,           // MASKING_..., in the physical form
    footprint: u32,         // FOOTPRINT_...
    unused: vec2u,          // padding that gives the struct the same size in every language
}

const FORM_PHYSICAL: u32 = 0u;      // D G2 / n.v: the distribution below with shadowing and masking
const FORM_NORMALISED: u32 = 1u;    // D = p / h.z^4 of the slope density p; cosine lobes (s + 2) / (2 pi) cos^s
const FORM_PAPER: u32 = 2u;         // 2 pi p; cosine lobes s cos^s

const BASE_PLANE: u32 = 0u;         // variance 1 / s in the plane of the surface
const BASE_FACET: u32 = 1u;         // the actual lobe of a facet of slope B, in that plane

const REPAIR_CLAMP: u32 = 0u;       // impossible covariances are made positive semidefinite
const REPAIR_PUBLISHED: u32 = 1u;   // no highlight unless the determinant is positive

const MASKING_BASE: u32 = 0u;   // by the slopes of the base roughness
const MASKING_FULL: u32 = 1u;   // by the slopes of base roughness and bumps

const FOOTPRINT_CORRECTED: u32 = 0u;    // the variance under the pixel
const FOOTPRINT_PUBLISHED: u32 = 1u;    // the variance under the texture filter
