//! What two layers have in common: the cross terms of the LEAN paper's Eqs. 7 to 9.

use crate::moments::Covariance;
use crate::slope::Slope;

/// The cross term of the slopes `a` and `b` of two layers, averaged over a footprint:
/// `C = E[(2 a.x b.x, 2 a.y b.y, a.x b.y + b.x a.y)]`, in the order xx, yy, xy. It is the same if the layers change
/// places, and it is linear in the products, so any non-negative filter may average it, as it averages [`Moments`].
///
/// Stored values are these *raw* moments, because only they are linear. What the layers share beyond their means, the
/// [`covariance`](Self::covariance), is computed from them once per pixel, with exact products.
///
/// Source: LEAN mapping, Eqs. 7 to 9, the terms with both layers. The paper counts four numbers; the two of the mixed term
/// only ever occur as their sum, so three suffice.
///
/// [`Moments`]: crate::Moments
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct CrossMoments {
    /// `E[2 a.x b.x]`.
    pub xx: f32,
    /// `E[2 a.y b.y]`.
    pub yy: f32,
    /// `E[a.x b.y + b.x a.y]`.
    pub xy: f32,
}

impl CrossMoments {
    /// The cross term of two single slopes: a texel of level 0.
    ///
    /// Of two filtered means it is the paper's approximation, which takes the layers for uncorrelated
    /// ([`LayerMethod::Approximate`](super::LayerMethod::Approximate)).
    pub fn of_slopes(a: Slope, b: Slope) -> Self {
        let [xx, yy, xy] = cross_of([a, b].map(doubles)).map(|value| value as f32);
        Self { xx, yy, xy }
    }

    /// The part that the means do not explain, `C - C(A, B)` for the means A and B of the two layers: twice the symmetric
    /// part of the cross-covariance, `E[a bᵀ + b aᵀ] - (A Bᵀ + B Aᵀ)`. Zero for uncorrelated layers, and not positive
    /// semidefinite in general.
    pub fn covariance(self, mean_a: Slope, mean_b: Slope) -> Covariance {
        // The products are exact in f64, so only the rounding of the stored numbers themselves remains.
        let [xx, yy, xy] = cross_of([mean_a, mean_b].map(doubles));
        Covariance {
            xx: (f64::from(self.xx) - xx) as f32,
            yy: (f64::from(self.yy) - yy) as f32,
            xy: (f64::from(self.xy) - xy) as f32,
        }
    }
}

/// The cross term of two slopes: xx, yy, xy.
pub(super) fn cross_of([a, b]: [[f64; 2]; 2]) -> [f64; 3] {
    [2.0 * a[0] * b[0], 2.0 * a[1] * b[1], a[0] * b[1] + b[0] * a[1]]
}

pub(super) fn doubles(slope: Slope) -> [f64; 2] {
    [f64::from(slope.x), f64::from(slope.y)]
}

/// The number of pairs of `layers` layers: 1 for two, 3 for three, 6 for four.
pub const fn pair_count(layers: usize) -> usize {
    layers * layers.saturating_sub(1) / 2
}

/// The pairs of `layers` layers in the order of their cross terms: (0, 1), (0, 2), (1, 2), (0, 3) … A further layer
/// appends its pairs, so the others keep their places.
///
/// ```
/// use roughcast::layers::{pair_count, pairs};
///
/// assert_eq!(pairs(3).collect::<Vec<_>>(), [(0, 1), (0, 2), (1, 2)]);
/// assert_eq!(pairs(4).count(), pair_count(4));
/// ```
pub fn pairs(layers: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..layers).flat_map(|second| (0..second).map(move |first| (first, second)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pair_is_symmetric_and_doubles_its_square() {
        let (a, b) = (Slope { x: 0.5, y: -0.25 }, Slope { x: 2.0, y: 0.75 });
        assert_eq!(CrossMoments::of_slopes(a, b), CrossMoments { xx: 2.0, yy: -0.375, xy: -0.125 });
        assert_eq!(CrossMoments::of_slopes(a, b), CrossMoments::of_slopes(b, a));
        assert_eq!(CrossMoments::of_slopes(a, a), CrossMoments { xx: 0.5, yy: 0.125, xy: -0.25 });
    }

    #[test]
    fn the_means_explain_the_cross_term_of_single_slopes() {
        let (a, b) = (Slope { x: 0.5, y: -0.25 }, Slope { x: 2.0, y: 0.75 });
        assert_eq!(CrossMoments::of_slopes(a, b).covariance(a, b), Covariance::default());
    }

    #[test]
    fn further_layers_append_their_pairs() {
        let all: Vec<_> = pairs(5).collect();
        for layers in 0..=5 {
            assert_eq!(pairs(layers).collect::<Vec<_>>(), all[..pair_count(layers)]);
        }
        assert_eq!([2, 3, 4].map(pair_count), [1, 3, 6]);
    }
}
