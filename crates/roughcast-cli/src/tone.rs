//! Tone curves: from radiance at an exposure to what a screen shows, both linear.

roughcast::named_enum! {
    /// How radiance is mapped to the range of a screen, in which 1 is white.
    pub enum Tone: "tone" {
        /// Unchanged up to white. Brighter values are clamped, each channel by itself.
        Linear = "linear",
        /// Unchanged up to 80 % of white; brighter values approach white and lose their colour gradually.
        Neutral = "neutral",
    }
}

/// The value of the brightest channel above which [`Tone::Neutral`] compresses.
const SHOULDER: f32 = 0.8;
/// How fast highlights become white: half of the way where this fraction of the compressed light is one.
const DESATURATION: f32 = 0.15;
/// Replaces brighter and infinite values, so that no quotient is NaN; anything near it is white.
const BRIGHTEST: f32 = 1e30;

impl Tone {
    /// What a screen shows of a radiance at an exposure: each channel 0 ..= 1. NaN is black.
    pub fn shown(self, radiance: [f32; 3]) -> [f32; 3] {
        // A comparison with NaN is false.
        let valid = radiance.map(|value| if value > 0.0 { value.min(BRIGHTEST) } else { 0.0 });
        match self {
            Self::Linear => valid.map(|value| value.min(1.0)),
            Self::Neutral => neutral(valid),
        }
    }
}

/// The shoulder of Khronos PBR Neutral: <https://github.com/KhronosGroup/ToneMapping/tree/main/PBR_Neutral>.
///
/// The brightest channel p becomes `1 - d² / (p - s + d)` with the shoulder s and `d = 1 - s`, a hyperbola that continues
/// the line below with the same slope and approaches 1. The other channels keep their ratios to it, and all three approach
/// it as more light is compressed. Khronos also subtracts the 4 % that a dielectric reflects, for pictures of base
/// colours under a white sky; our scenes have no sky, so we do not.
fn neutral(colour: [f32; 3]) -> [f32; 3] {
    let peak = colour.into_iter().fold(0.0, f32::max);
    if peak <= SHOULDER {
        return colour;
    }
    let room = 1.0 - SHOULDER;
    let compressed = 1.0 - room * room / (peak - SHOULDER + room);
    let coloured = 1.0 / (DESATURATION * (peak - compressed) + 1.0);
    colour.map(|value| {
        let kept = value / peak * compressed;
        (compressed + (kept - compressed) * coloured).clamp(0.0, 1.0)
    })
}

#[cfg(test)]
mod tests {
    use roughcast_scene::luminance;

    use super::*;

    const COLOURS: [[f32; 3]; 5] =
        [[1.0, 1.0, 1.0], [1.0, 0.7, 0.3], [0.0, 0.0, 1.0], [0.02, 1.0, 0.4], [1.0, 0.0, 0.0]];

    /// Each colour from black to a million times white.
    fn exposures() -> impl Iterator<Item = f32> {
        (0..600).map(|step| 1e-3 * 10.0_f32.powf(f32::from(step as u16) * 0.015))
    }

    #[test]
    fn more_light_is_never_darker_and_never_above_white() {
        /// Rounding of single floats near white.
        const ROUNDING: f32 = 1e-6;
        for tone in Tone::ALL {
            for colour in COLOURS {
                let mut before = 0.0;
                for exposure in exposures() {
                    let shown = tone.shown(colour.map(|value| value * exposure));
                    assert!(shown.iter().all(|value| (0.0..=1.0).contains(value)), "{tone}: {shown:?}");
                    let now = luminance(shown);
                    assert!(
                        now >= before - ROUNDING,
                        "{tone}, {colour:?} at {exposure}: {now} after {before}"
                    );
                    before = now;
                }
            }
        }
    }

    #[test]
    fn colours_below_the_shoulder_are_unchanged_and_the_curve_has_no_kink() {
        for colour in COLOURS {
            for below in [0.0, 0.1, 0.5, SHOULDER] {
                let dim = colour.map(|value| value * below);
                assert_eq!(Tone::Neutral.shown(dim), dim);
            }
            // Second order in the distance from the shoulder: the square of a hundredth over the room above.
            let just_above = colour.map(|value| value * (SHOULDER + 0.01));
            for (shown, wanted) in Tone::Neutral.shown(just_above).iter().zip(just_above) {
                assert!((shown - wanted).abs() < 1e-4 / (1.0 - SHOULDER), "{shown} and {wanted}");
            }
        }
    }

    #[test]
    fn bright_colours_keep_their_hue_and_become_white() {
        let gold = |exposure: f32| Tone::Neutral.shown([1.0, 0.7, 0.3].map(|value| value * exposure));
        let [r, g, b] = gold(2.0);
        assert!(r > g && g > b && r < 1.0, "{r} {g} {b}");
        // Clamping makes it yellow.
        assert_eq!(Tone::Linear.shown([2.0, 1.4, 0.6]), [1.0, 1.0, 0.6]);
        assert!(gold(1e6).iter().all(|value| *value > 0.999));
        assert_eq!(Tone::Neutral.shown([f32::INFINITY; 3]), [1.0; 3]);
    }

    #[test]
    fn negative_and_nan_radiance_is_black() {
        for tone in Tone::ALL {
            assert_eq!(tone.shown([f32::NAN; 3]), [0.0; 3]);
            assert_eq!(tone.shown([-1.0, f32::NEG_INFINITY, -0.0]), [0.0; 3]);
            assert_eq!(tone.shown([f32::NAN, 0.5, 0.25]), [0.0, 0.5, 0.25]);
        }
    }
}
