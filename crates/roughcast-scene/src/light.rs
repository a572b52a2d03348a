//! Lights.

use glam::DVec3;

/// A light without extent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Light {
    /// Infinitely far away.
    Directional {
        /// Unit vector towards the light.
        towards: DVec3,
        /// Irradiance on a surface that faces it, in linear RGB.
        irradiance: [f32; 3],
    },
    /// A point, whose irradiance falls with the square of the distance.
    Point {
        /// Where it is.
        position: DVec3,
        /// Irradiance at a distance of one, in linear RGB.
        intensity: [f32; 3],
    },
}

impl Light {
    /// Irradiance that gives a white surface which faces the light a radiance of one.
    pub const WHITE: [f32; 3] = [std::f32::consts::PI; 3];

    /// Unit vector towards the light and the irradiance of a surface that faces it, at a point.
    pub fn at(&self, point: DVec3) -> (DVec3, [f32; 3]) {
        match *self {
            Self::Directional { towards, irradiance } => (towards, irradiance),
            Self::Point { position, intensity } => {
                let to_light = position - point;
                let squared = to_light.length_squared().max(f64::MIN_POSITIVE);
                (to_light / squared.sqrt(), intensity.map(|i| (f64::from(i) / squared) as f32))
            }
        }
    }
}
