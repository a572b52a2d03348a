//! Slow camera moves that make aliasing visible as flicker.

use crate::Scene;

/// How far the middle of the picture moves from frame to frame, as a fraction of the picture's height. It is less than
/// a pixel, so that all jumps are aliasing.
const STEP: f64 = 1.0 / 600.0;
/// The forward fraction of the move, which is mostly sideways; it changes the scale too.
const FORWARD: f64 = 0.5;

/// The scene in `frames` steps of a slow camera move, starting with the scene itself.
pub fn slow_move(scene: &Scene, frames: u32) -> Vec<Scene> {
    let camera = scene.camera;
    let forward = camera.target - camera.eye;
    let right = forward.cross(camera.up).normalize_or_zero();
    let height_there = 2.0 * (0.5 * camera.vertical_fov).tan() * forward.length();
    let step = STEP * height_there * (right + FORWARD * forward.normalize_or_zero());
    let at = |frame: u32| {
        let moved = step * f64::from(frame);
        let camera = crate::Camera { eye: camera.eye + moved, target: camera.target + moved, ..camera };
        Scene { camera, ..scene.clone() }
    };
    (0..frames).map(at).collect()
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use roughcast::shading::Material;

    use super::*;
    use crate::{Plane, Shape, View};

    #[test]
    fn a_move_starts_at_the_scene_with_steps_below_a_pixel() {
        const SIZE: (u32, u32) = (256, 192);
        let plane = Arc::new(Shape::Plane(Plane::default()));
        let scene = View::Mid.scene(plane, (64, 64), SIZE, Material::default());
        let frames = slow_move(&scene, 5);
        assert_eq!((frames.len(), frames[0].camera), (5, scene.camera));
        // Where each frame shows the point in the middle of the first frame.
        let seen = |frame: &Scene| {
            let aspect = f64::from(SIZE.0) / f64::from(SIZE.1);
            let clip = frame.camera.clip_from_world(aspect, 0.01, 100.0);
            let at = clip * scene.camera.target.extend(1.0);
            0.5 * f64::from(SIZE.0) * at.x / at.w
        };
        for pair in frames.windows(2) {
            let moved = seen(&pair[0]) - seen(&pair[1]);
            assert!(moved > 0.1 && moved < 1.0, "{moved} pixels");
        }
    }
}
