//! How the map of a layer lies on the surface, and how it moves.

use crate::moments::SlopeMatrix;
use crate::named::named_enum;
use crate::setters::setters;

named_enum! {
    /// What happens to the slopes of a map that is repeated, and so becomes smaller on the surface.
    pub enum RepeatedBumps: "size of repeated bumps" {
        /// Slopes stay the same: bumps become as much lower as narrower. glTF's convention for normal textures, and the
        /// default.
        SameSlopes = "same-slopes",
        /// Heights stay the same: a map that is repeated four times is four times as steep.
        SameHeights = "same-heights",
    }
}

/// How the map of a layer lies on the surface: its texture coordinates at those of the surface, which run from (0, 0) in
/// the top left corner to (1, 1), with v downwards.
///
/// `layer uv = R (repeats * uv) + offset - velocity * time`, where R turns the bumps counter-clockwise by `rotation`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
#[non_exhaustive]
pub struct LayerTransform {
    /// How often the map is repeated along u and v; not zero. A negative number mirrors it. The combined map repeats
    /// without a seam only if these are whole numbers and the rotation is a multiple of a right angle.
    pub repeats: [f64; 2],
    /// Added to the coordinates of the layer.
    pub offset: [f64; 2],
    /// Counter-clockwise rotation of the bumps, in radians.
    pub rotation: f64,
    /// How fast the bumps move along u and v of the layer, in repeats per second.
    pub velocity: [f64; 2],
    /// What repeating does to slopes.
    pub bumps: RepeatedBumps,
}

setters!(LayerTransform {
    with_repeats(repeats: [f64; 2]),
    with_offset(offset: [f64; 2]),
    with_rotation(rotation: f64),
    with_velocity(velocity: [f64; 2]),
    with_bumps(bumps: RepeatedBumps),
});

impl Default for LayerTransform {
    /// The map as it is.
    fn default() -> Self {
        Self {
            repeats: [1.0; 2],
            offset: [0.0; 2],
            rotation: 0.0,
            velocity: [0.0; 2],
            bumps: RepeatedBumps::SameSlopes,
        }
    }
}

impl LayerTransform {
    /// Whether all numbers are finite and no repeat is zero.
    pub fn is_valid(&self) -> bool {
        let Self { repeats, offset, rotation, velocity, .. } = self;
        let numbers = repeats.iter().chain(offset).chain(velocity).chain([rotation]);
        numbers.into_iter().all(|number| number.is_finite()) && repeats.iter().all(|number| *number != 0.0)
    }

    /// The coordinates of the layer at these of the surface, `time` seconds after the start.
    pub fn layer_uv(&self, [u, v]: [f64; 2], time: f64) -> [f64; 2] {
        let (sin, cos) = self.rotation.sin_cos();
        let [u, v] = [self.repeats[0] * u, self.repeats[1] * v];
        let moved = |axis: usize| self.offset[axis] - self.velocity[axis] * time;
        [cos * u - sin * v + moved(0), sin * u + cos * v + moved(1)]
    }

    /// The matrix from slopes of the layer to slopes of the surface. `aspects` are width by height of the layer's map and of
    /// the combined map, in texels; they matter to heights only.
    pub fn slope_matrix(&self, aspects: [f64; 2]) -> SlopeMatrix {
        let (sin, cos) = self.rotation.sin_cos();
        let ([x, y], [of_layer, of_map]) = match self.bumps {
            RepeatedBumps::SameSlopes => (self.repeats.map(f64::signum), [1.0; 2]),
            RepeatedBumps::SameHeights => (self.repeats, aspects),
        };
        // Derivatives by the coordinates of the surface are those by the layer's times the transposed matrix of
        // `layer_uv`. A slope is minus the derivative by u, and that by v (downwards) times the aspect.
        let matrix = [[x * cos, -x * sin / of_layer], [y * sin * of_map, y * cos * of_map / of_layer]];
        matrix.map(|row| row.map(|entry| entry as f32))
    }

    /// Factor of the heights of the layer's map, as a part of the width of the map.
    pub(super) fn height_factor(&self) -> f64 {
        match self.bumps {
            RepeatedBumps::SameSlopes => (self.repeats[0] * self.repeats[1]).abs().sqrt().recip(),
            RepeatedBumps::SameHeights => 1.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;
    use crate::slope::Slope;

    /// Rounding of sines and cosines in single floats.
    const ROUNDING: f32 = 1e-6;

    #[test]
    fn a_rotation_turns_bumps_counter_clockwise() {
        let turned = LayerTransform::default().with_rotation(FRAC_PI_2);
        // What lies to the right in the layer lies above in the surface, where v is smaller.
        let [u, v] = turned.layer_uv([0.0, -0.25], 0.0);
        assert!((u - 0.25).abs() < 1e-12 && v.abs() < 1e-12);
        let Slope { x, y } = Slope { x: 1.0, y: 0.0 }.transformed(turned.slope_matrix([1.0; 2]));
        assert!(x.abs() < ROUNDING && (y - 1.0).abs() < ROUNDING);
    }

    #[test]
    fn slopes_of_repeated_heights_are_derivatives_of_the_heights() {
        /// Of central differences of a smooth function, times the aspect.
        const DIFFERENCE: f64 = 1e-6;
        const STEP: f64 = 1e-5;
        let height = |[u, v]: [f64; 2]| (3.0 * u + 1.3).sin() * (2.0 * v - 0.4).cos();
        let (of_layer, of_map) = (2.0, 0.5);
        let transform = LayerTransform::default()
            .with_repeats([3.0, -2.0])
            .with_rotation(0.7)
            .with_offset([0.3, 0.1])
            .with_velocity([0.2, -0.6])
            .with_bumps(RepeatedBumps::SameHeights);
        // Heights as parts of the width, so a unit along v is 1 / aspect long.
        let slope = |of: &dyn Fn([f64; 2]) -> f64, [u, v]: [f64; 2], aspect: f64| {
            let along = |du: f64, dv: f64| (of([u + du, v + dv]) - of([u - du, v - dv])) / (2.0 * STEP);
            [-along(STEP, 0.0), along(0.0, STEP) * aspect]
        };
        for uv in [[0.1, 0.2], [0.5, 0.9], [0.33, 0.77]] {
            let wanted = slope(&|uv| height(transform.layer_uv(uv, 0.4)), uv, of_map);
            let [x, y] = slope(&height, transform.layer_uv(uv, 0.4), of_layer);
            let got =
                Slope { x: x as f32, y: y as f32 }.transformed(transform.slope_matrix([of_layer, of_map]));
            let errors = [f64::from(got.x) - wanted[0], f64::from(got.y) - wanted[1]];
            assert!(errors.iter().all(|error| error.abs() < 20.0 * DIFFERENCE), "{errors:?}");
        }
    }

    #[test]
    fn same_slopes_only_turn_and_mirror() {
        let transform = LayerTransform::default().with_repeats([4.0, -2.0]);
        assert_eq!(transform.slope_matrix([2.0, 1.0]), [[1.0, 0.0], [0.0, -1.0]]);
        let steep = transform.with_bumps(RepeatedBumps::SameHeights);
        assert_eq!(steep.slope_matrix([1.0; 2]), [[4.0, 0.0], [0.0, -2.0]]);
    }

    #[test]
    fn bumps_move_with_their_velocity() {
        let moving = LayerTransform::default().with_velocity([0.25, -0.5]);
        let [u, v] = [0.4, 0.7];
        assert_eq!(moving.layer_uv([u + 0.5, v - 1.0], 2.0), LayerTransform::default().layer_uv([u, v], 0.0));
    }

    #[test]
    fn repeats_of_zero_and_odd_numbers_are_not_valid() {
        let valid = LayerTransform::default();
        assert!(valid.is_valid());
        assert!(!valid.with_repeats([0.0, 1.0]).is_valid());
        assert!(!valid.with_offset([f64::NAN, 0.0]).is_valid());
        assert!(!valid.with_velocity([0.0, f64::INFINITY]).is_valid());
        assert!(!valid.with_rotation(f64::NAN).is_valid());
    }
}
