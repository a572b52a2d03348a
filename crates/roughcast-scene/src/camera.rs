//! A perspective camera.

use glam::dcamera::rh::{proj::directx, view};
use glam::{DMat4, DVec3};

use crate::Ray;

/// A pinhole camera that looks at `target`, which appears in the middle of the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Position of the eye.
    pub eye: DVec3,
    /// The point in the middle of the picture.
    pub target: DVec3,
    /// The direction that points up in the picture. It must not be parallel to the view; its length does not matter.
    pub up: DVec3,
    /// Full vertical angle of view, in radians, in 0 .. pi.
    pub vertical_fov: f64,
}

/// Why a camera is invalid.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CameraError {
    /// NaN or infinity.
    #[error("the camera has a coordinate that is not finite: give numbers")]
    NotFinite,
    /// The eye coincides with its target.
    #[error("the camera's eye is at its target {0}: move one of them")]
    NoView(DVec3),
    /// The view is parallel to the up direction, or the up direction is zero.
    #[error("the camera's up direction {up} is zero or parallel to its view {view}: choose another")]
    ParallelUp {
        /// The up direction as given.
        up: DVec3,
        /// The direction from the eye to the target.
        view: DVec3,
    },
    /// The angle of view lies outside of 0 .. pi.
    #[error("the camera's vertical angle of view is {0} radians: choose one between 0 and pi, both excluded")]
    FieldOfView(f64),
}

/// Smallest sine of the angle between the view and the up direction. Below it, the picture's right direction is
/// rounding noise.
const MIN_SINE: f64 = 1e-9;

impl Camera {
    /// Creates a valid camera.
    ///
    /// # Errors
    /// [`CameraError`] if a number is not finite, or the camera has no view or no picture plane.
    pub fn new(eye: DVec3, target: DVec3, up: DVec3, vertical_fov: f64) -> Result<Self, CameraError> {
        let camera = Self { eye, target, up, vertical_fov };
        camera.validate()?;
        Ok(camera)
    }

    /// Checks that the camera is valid. The other methods require a valid camera.
    ///
    /// # Errors
    /// As [`Camera::new`].
    pub fn validate(&self) -> Result<(), CameraError> {
        let view = self.target - self.eye;
        if !(self.eye.is_finite() && view.is_finite() && self.up.is_finite() && self.vertical_fov.is_finite())
        {
            return Err(CameraError::NotFinite);
        }
        if view.try_normalize().is_none() {
            return Err(CameraError::NoView(self.target));
        }
        let sine = view.normalize().cross(self.up.normalize_or_zero()).length();
        if sine < MIN_SINE {
            return Err(CameraError::ParallelUp { up: self.up, view });
        }
        if !(self.vertical_fov > 0.0 && self.vertical_fov < std::f64::consts::PI) {
            return Err(CameraError::FieldOfView(self.vertical_fov));
        }
        Ok(())
    }

    /// The rays of a picture of `width` x `height` pixels.
    pub fn pixel_rays(&self, width: u32, height: u32) -> PixelRays {
        let forward = (self.target - self.eye).normalize();
        let right = forward.cross(self.up).normalize();
        let down = forward.cross(right);
        // Pixels are square; this is a pixel's size on the image plane at distance one.
        let pixel = 2.0 * (0.5 * self.vertical_fov).tan() / f64::from(height.max(1));
        let corner =
            forward - right * (0.5 * pixel * f64::from(width)) - down * (0.5 * pixel * f64::from(height));
        PixelRays { eye: self.eye, corner, right: right * pixel, down: down * pixel }
    }

    /// The ray through a point of a picture of `width` x `height` pixels, both at least one.
    ///
    /// `x` and `y` are in pixels; (0, 0) is the top left corner of the top left pixel, so pixel centres are at +0.5.
    /// Points outside of the picture are valid too.
    pub fn ray(&self, x: f64, y: f64, width: u32, height: u32) -> Ray {
        self.pixel_rays(width, height).ray(x, y)
    }

    /// The matrix from world space to clip space in wgpu's conventions: right-handed world, x right and y up in -w ..
    /// w, z in 0 .. w from `near` to `far` (0 < near < far). `aspect` is width over height.
    pub fn clip_from_world(&self, aspect: f64, near: f64, far: f64) -> DMat4 {
        directx::perspective(self.vertical_fov, aspect, near, far)
            * view::look_at_mat4(self.eye, self.target, self.up.normalize_or_zero())
    }
}

/// A camera together with the size of a picture: [`Camera::ray`] with precomputed constants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelRays {
    eye: DVec3,
    /// From the eye to the top left corner of the image plane at distance one.
    corner: DVec3,
    /// One pixel to the right on that plane.
    right: DVec3,
    /// One pixel down on that plane.
    down: DVec3,
}

impl PixelRays {
    /// See [`Camera::ray`].
    pub fn ray(&self, x: f64, y: f64) -> Ray {
        Ray { origin: self.eye, direction: (self.corner + self.right * x + self.down * y).normalize() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rounding of a few operations on numbers around one, in f64.
    const ROUNDING: f64 = 1e-13;

    fn camera() -> Camera {
        Camera::new(DVec3::new(1.0, 2.0, 5.0), DVec3::new(0.2, -0.3, 0.1), DVec3::new(0.1, 2.0, 0.3), 0.7)
            .unwrap()
    }

    #[test]
    fn rays_agree_with_the_clip_matrix() {
        let (camera, width, height) = (camera(), 320, 200);
        let clip_from_world = camera.clip_from_world(1.6, 0.1, 100.0);
        for (x, y) in
            [(0.0, 0.0), (320.0, 200.0), (160.0, 100.0), (0.5, 199.5), (311.25, 17.75), (-3.0, 250.0)]
        {
            let ray = camera.ray(x, y, width, height);
            assert!((ray.direction.length() - 1.0).abs() < ROUNDING);
            for distance in [0.3, 4.0, 90.0] {
                let clip = clip_from_world * (ray.origin + ray.direction * distance).extend(1.0);
                let ndc = clip.truncate() / clip.w;
                assert!((ndc.x - (2.0 * x / 320.0 - 1.0)).abs() < ROUNDING, "x {x} {y}: {ndc}");
                assert!((ndc.y - (1.0 - 2.0 * y / 200.0)).abs() < ROUNDING, "y {x} {y}: {ndc}");
            }
        }
    }

    #[test]
    fn depth_goes_from_zero_to_one() {
        let camera = camera();
        let clip_from_world = camera.clip_from_world(1.6, 0.5, 50.0);
        let forward = camera.ray(160.0, 100.0, 320, 200).direction;
        for (distance, depth) in [(0.5, 0.0), (50.0, 1.0)] {
            let clip = clip_from_world * (camera.eye + forward * distance).extend(1.0);
            assert!((clip.z / clip.w - depth).abs() < ROUNDING);
        }
    }

    #[test]
    fn the_middle_looks_at_the_target_and_up_is_up() {
        let camera = camera();
        let middle = camera.ray(8.0, 4.5, 16, 9).direction;
        assert!((middle - (camera.target - camera.eye).normalize()).length() < ROUNDING);
        let above = camera.ray(8.0, 1.0, 16, 9).direction;
        assert!((above - middle).dot(camera.up) > 0.0);
        let right = camera.ray(12.0, 4.5, 16, 9).direction;
        assert!((right - middle).dot(middle.cross(camera.up)) > 0.0);
    }

    #[test]
    fn cameras_that_show_nothing_are_refused() {
        let (o, z, y) = (DVec3::ZERO, DVec3::Z, DVec3::Y);
        assert_eq!(Camera::new(z, z, y, 1.0), Err(CameraError::NoView(z)));
        assert!(matches!(Camera::new(o, z, z, 1.0), Err(CameraError::ParallelUp { .. })));
        assert!(matches!(Camera::new(o, z, -3.0 * z, 1.0), Err(CameraError::ParallelUp { .. })));
        assert!(matches!(Camera::new(o, z, o, 1.0), Err(CameraError::ParallelUp { .. })));
        assert_eq!(Camera::new(o, z, y, 0.0), Err(CameraError::FieldOfView(0.0)));
        assert!(matches!(Camera::new(o, z, y, std::f64::consts::PI), Err(CameraError::FieldOfView(_))));
        assert_eq!(Camera::new(o, z, y, f64::NAN), Err(CameraError::NotFinite));
        assert_eq!(Camera::new(o, z * f64::INFINITY, y, 1.0), Err(CameraError::NotFinite));
    }
}
