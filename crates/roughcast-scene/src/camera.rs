//! A perspective camera.

use glam::DVec3;

/// A pinhole camera. The picture's middle looks at `target`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Position of the eye.
    pub eye: DVec3,
    /// The point in the middle of the picture.
    pub target: DVec3,
    /// The direction that is up in the picture, not parallel to the view; its length does not matter.
    pub up: DVec3,
    /// Full vertical angle of view, in radians, in 0 .. pi.
    pub vertical_fov: f64,
}
