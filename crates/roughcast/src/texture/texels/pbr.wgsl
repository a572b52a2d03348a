// The filtered texels of a physically based material as a distribution: alpha^2 = 2 variance along each axis.

// Stored exponents are clamped to at least this.
const LEAST_STORED_POWER: f32 = 1e-3;

// Slope variance per axis, alpha^2 / 2, of a stored roughness.
fn variance_from_stored(stored: f32, roughness_stored: u32) -> f32 {
    let rough = select(stored, 1.0 - stored, roughness_stored == STORED_GLOSS);
    let square = stored * stored;
    let perceptual = rough * rough;
    switch roughness_stored {
        case STORED_ALPHA: {
            return 0.5 * square;
        }
        case STORED_ALPHA_SQUARED: {
            return 0.5 * stored;
        }
        case STORED_SPECULAR_POWER: {
            return 1.0 / max(stored, LEAST_STORED_POWER);
        }
        default: {
            return 0.5 * perceptual * perceptual;
        }
    }
}

// The unit normal from the normal texture. If no z is stored (two-channel textures return 0 for it), it is
// reconstructed from x and y.
fn pbr_normal(normal: vec4f, packing: Packing) -> vec3f {
    let stored = normal.xyz * packing.unit.x + packing.unit.y;
    let z = sqrt(max(1.0 - dot(stored.xy, stored.xy), 0.0));
    return unit_normal(vec3f(stored.xy, select(z, stored.z, stored.z > 0.0)));
}

// If there is no anisotropy texture, pass vec4f(1.0, 0.5, 0.0, 1.0).
fn pbr_moments(normal: vec4f, roughness: f32, anisotropy: vec4f, packing: Packing) -> Distribution {
    let bump = pbr_normal(normal, packing);
    let variance = max(variance_from_stored(roughness, packing.roughness_stored), 0.0);
    let across = sqrt(2.0 * variance);
    // The alpha along the direction is mix(across, 1, strength^2); the variance that this adds is half the difference
    // of the squares. Widths above 1 are not changed, since the baker treats them as 1.
    let wider = max(1.0 - across, 0.0) * anisotropy.z * anisotropy.z;
    let added = wider * (across + 0.5 * wider);
    let direction = anisotropy.xy * packing.unit.x + packing.unit.y;
    let squared = dot(direction, direction);
    let along = select(vec2f(1.0, 0.0), direction * inverseSqrt(squared), squared > LEAST_COSINE);
    let sigma = vec3f(variance, variance, 0.0) + added * along.xyx * along.xyy;
    return one_gaussian(bump, bump.xy / bump.z, sigma, packing.base);
}
