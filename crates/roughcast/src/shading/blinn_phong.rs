//! Blinn-Phong: a cosine lobe about the filtered bump normal, in the half vector. The ordinary way, which loses the bumps.
//!
//! Source: Blinn, "Models of light reflection for computer synthesized pictures", 1977; its likeness to Beckmann's lobe is
//! LEAN mapping's, 3.1.

use super::facet::{BumpFacet, bump_facet, cosine_lobe, facet_visible_part};
use super::vector::{Vector, half_vector};
use super::{Form, LobeOptions};
use crate::distribution::Distribution;

/// The facet of a distribution's filtered normal.
pub fn blinn_phong_surface(distribution: &Distribution, options: &LobeOptions) -> BumpFacet {
    bump_facet(distribution.normal().to_array(), options.specular_power)
}

/// The lobe for unit directions to the viewer and to the light. Normalised about the bump normal.
pub fn blinn_phong_lobe(surface: &BumpFacet, view: Vector, light: Vector, options: &LobeOptions) -> f32 {
    let Some(half) = half_vector(view, light) else { return 0.0 };
    let lobe = cosine_lobe(surface.normal, half, surface.specular_power, options.form);
    match options.form {
        Form::Paper | Form::Normalised => lobe,
        Form::Physical => lobe * facet_visible_part(surface, view, light, options),
    }
}

/// The largest difference between `cos^s` and Beckmann's `exp(-s/2 tan²)` over all angles: LEAN mapping, Figure 4.
///
/// For large s it tends to `4 e⁻² / s`, about `0.54 / s`. `specular_power` is s, above zero.
pub fn blinn_phong_against_beckmann(specular_power: f64) -> f64 {
    /// Of u = s/2 tan², beyond which both lobes are below 1e-17 for s >= 1 but for Blinn-Phong's tail, which only falls.
    const FARTHEST: f64 = 40.0;
    /// Steps of u: near its maximum the difference is a parabola, and this leaves a relative error below 1e-6.
    const STEPS: u32 = 40_000;
    let difference = |u: f64| {
        let tangent_squared = 2.0 * u / specular_power;
        (-0.5 * specular_power * tangent_squared.ln_1p()).exp() - (-u).exp()
    };
    (1..=STEPS).map(|i| difference(FARTHEST * f64::from(i) / f64::from(STEPS))).fold(0.0, f64::max)
}
