//! Slow camera moves, for flicker.

use glam::DVec3;

use crate::Scene;

/// A camera move: eye and target go together, along a straight line, by the same step each frame.
#[derive(Clone, Debug)]
pub struct Sequence {
    /// The scene of frame 0.
    pub scene: Scene,
    /// The move from one frame to the next, in world space.
    pub step: DVec3,
}

impl Sequence {
    /// A move to the right of the picture, by this many pixels a frame at the distance of the camera's target, in a picture
    /// of this height. A part of a pixel is slow enough that what the truth shows changes little from frame to frame.
    pub fn drift(scene: &Scene, pixels_per_frame: f64, height: u32) -> Self {
        let camera = &scene.camera;
        let view = camera.target - camera.eye;
        let pixel = 2.0 * (0.5 * camera.vertical_fov).tan() * view.length() / f64::from(height.max(1));
        let right = view.cross(camera.up).normalize_or_zero();
        Self { scene: scene.clone(), step: right * (pixel * pixels_per_frame) }
    }

    /// The scene of a frame; parts of one are between frames.
    pub fn at(&self, frame: f64) -> Scene {
        let mut scene = self.scene.clone();
        scene.camera.eye += self.step * frame;
        scene.camera.target += self.step * frame;
        scene
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use roughcast::shading::Material;

    use super::*;
    use crate::{Camera, Plane, Shape};

    #[test]
    fn a_drift_moves_what_the_camera_looks_at_by_so_many_pixels() {
        let camera = Camera::new(DVec3::new(1.0, 2.0, 3.0), DVec3::ZERO, DVec3::Y, 0.7).unwrap();
        let scene = Scene {
            shape: Arc::new(Shape::Plane(Plane::default())),
            camera,
            lights: vec![],
            material: Material::default(),
            repeats: 1.0,
            background: [0.0; 3],
        };
        let moved = Sequence::drift(&scene, 0.25, 100).at(8.0);
        // What was in the middle is two pixels further left now.
        let ray = moved.camera.ray(48.0, 50.0, 160, 100);
        let middle = moved.camera.ray(78.0, 50.0, 160, 100);
        assert!(middle.direction.cross((camera.target - middle.origin).normalize()).length() < 1e-4);
        assert!(ray.direction.cross((camera.target - ray.origin).normalize()).length() > 1e-2);
        assert_eq!(Sequence::drift(&scene, 0.25, 100).at(0.0).camera, camera);
    }
}
