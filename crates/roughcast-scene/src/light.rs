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
    /// A point light. Its irradiance falls with the square of the distance, beyond [`Light::LEAST_DISTANCE`].
    Point {
        /// Its position.
        position: DVec3,
        /// Irradiance at a distance of one, in linear RGB.
        intensity: [f32; 3],
    },
}

impl Light {
    /// Irradiance that gives a white surface facing the light a radiance of one.
    pub const WHITE: [f32; 3] = [std::f32::consts::PI; 3];

    /// A point light's irradiance is constant at distances below this, so that it and the results of single-float
    /// shaders stay finite.
    pub const LEAST_DISTANCE: f64 = 1e-6;

    /// Unit vector towards the light, and the irradiance of a surface that faces it, at a point. At the position of a
    /// point light the vector is zero, so the light has no effect there.
    pub fn at(&self, point: DVec3) -> (DVec3, [f32; 3]) {
        match *self {
            Self::Directional { towards, irradiance } => (towards, irradiance),
            Self::Point { position, intensity } => {
                let to_light = position - point;
                let squared = to_light.length_squared().max(Self::LEAST_DISTANCE * Self::LEAST_DISTANCE);
                (to_light.normalize_or_zero(), intensity.map(|i| (f64::from(i) / squared) as f32))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use roughcast::Slope;
    use roughcast::shading::{Form, LightSample, Material, Shading, ShadingOptions, reflect};

    use super::*;

    /// At the origin, where all distances are representable.
    const LIGHT: Light = Light::Point { position: DVec3::ZERO, intensity: [8.0, 4.0, 2.0] };

    #[test]
    fn irradiance_falls_with_the_square_of_the_distance() {
        let (towards, irradiance) = LIGHT.at(DVec3::new(0.0, 0.0, -2.0));
        assert_eq!((towards, irradiance), (DVec3::Z, [2.0, 1.0, 0.5]));
    }

    #[test]
    fn the_radiance_beside_and_at_a_point_light_is_finite() {
        for distance in [0.0, f64::MIN_POSITIVE, 1e-200, 1e-30, 1e-7, 1e-6, 1e-3] {
            let (towards, irradiance) = LIGHT.at(DVec3::new(0.0, 0.0, -distance));
            let direction = towards.as_vec3().to_array();
            for (shading, form) in Shading::ALL.iter().flat_map(|s| Form::ALL.iter().map(move |f| (s, f))) {
                let options = ShadingOptions::default().with_form(*form);
                let surface = shading.surface_of_slope(Slope::default(), &options);
                let sample = LightSample { direction, irradiance };
                let light = reflect(&surface, &Material::default(), [0.0, 0.0, 1.0], &sample, &options);
                let radiance = [light.diffuse, light.specular].concat();
                assert!(radiance.iter().all(|r| r.is_finite()), "{shading}, {distance:e}: {light:?}");
                // At the light's own position no side faces it. The squares of the two shortest distances are zero in
                // f64.
                assert_eq!(radiance.iter().any(|r| *r > 0.0), distance > 1e-100, "{shading}, {distance:e}");
            }
        }
    }
}
