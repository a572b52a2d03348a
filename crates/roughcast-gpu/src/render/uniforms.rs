//! The uniforms of a scene, as words of the shaders' structs.

use roughcast_scene::{Bounds, Light, Scene};

/// Words of WGSL's `SceneView`.
pub(super) const VIEW_WORDS: usize = 32;
/// Words of WGSL's `SceneLight`.
pub(super) const LIGHT_WORDS: usize = 8;

/// Smallest distance of the near plane, as a fraction of the far plane's distance. Depths are reversed floats, whose
/// relative precision is the same everywhere, so a small value costs no precision.
const NEAREST: f64 = 1e-5;
/// The planes are moved outwards by this fraction, so that rounding does not clip the shape.
const MARGIN: f64 = 1e-3;

/// WGSL's `SceneView`, for a picture of this size.
pub(super) fn view_words(scene: &Scene, size: (u32, u32)) -> [u32; VIEW_WORDS] {
    let material = &scene.material;
    let eye = scene.camera.eye.as_vec3().to_array();
    let mut words = [0; VIEW_WORDS];
    put(&mut words, 0, &clip_from_world(scene, size));
    put(&mut words, 16, &eye);
    put(&mut words, 19, &[scene.repeats as f32]);
    put(&mut words, 20, &material.albedo);
    words[23] = scene.lights.len() as u32;
    put(&mut words, 24, &material.ambient);
    put(&mut words, 28, &material.specular);
    words
}

fn put(words: &mut [u32], at: usize, values: &[f32]) {
    for (word, value) in words[at..].iter_mut().zip(values) {
        *word = value.to_bits();
    }
}

/// Columns of the matrix. Depth is 1 at the near plane and 0 at the far plane.
fn clip_from_world(scene: &Scene, (width, height): (u32, u32)) -> [f32; 16] {
    let (near, far) = depth_range(scene.shape.bounds(), scene);
    let aspect = f64::from(width) / f64::from(height);
    let mut columns = scene.camera.clip_from_world(aspect, near, far).to_cols_array();
    // Computed in f64 before rounding: w - z in single floats would lose the precision that reversed depth is meant to
    // gain.
    for column in columns.chunks_exact_mut(4) {
        column[2] = column[3] - column[2];
    }
    columns.map(|value| value as f32)
}

/// Distances of the near and the far plane. They enclose the part of the shape in front of the eye.
fn depth_range(bounds: Bounds, scene: &Scene) -> (f64, f64) {
    let forward = (scene.camera.target - scene.camera.eye).normalize();
    let middle = (bounds.centre - scene.camera.eye).dot(forward);
    let radius = bounds.radius * (1.0 + MARGIN);
    // If the shape lies behind the eye, nothing is visible whatever the planes.
    let far = (middle + radius).max(radius);
    ((middle - radius).max(NEAREST * far), far)
}

/// WGSL's `SceneLight`s; at least one, because buffers must not be empty.
pub(super) fn light_words(lights: &[Light]) -> Vec<u32> {
    let mut words = vec![0; LIGHT_WORDS * lights.len().max(1)];
    for (words, light) in words.chunks_exact_mut(LIGHT_WORDS).zip(lights) {
        let (place, kind, irradiance) = match light {
            Light::Directional { towards, irradiance } => (towards, 0.0, irradiance),
            Light::Point { position, intensity } => (position, 1.0, intensity),
        };
        put(words, 0, &place.as_vec3().to_array());
        put(words, 3, &[kind]);
        put(words, 4, irradiance);
    }
    words
}

/// Words of a buffer for lights that need this many words: twice as many if the device's limit allows it, so that
/// adding lights one by one does not create a buffer each time.
pub(super) fn room_for(words: usize, limit_bytes: u64) -> usize {
    let limit = usize::try_from(limit_bytes / size_of::<u32>() as u64).unwrap_or(usize::MAX);
    (2 * words).min(limit - limit % LIGHT_WORDS).max(words)
}

#[cfg(test)]
mod tests {
    use super::*;

    const WEBGPUS_LIMIT: u64 = 128 << 20;

    #[test]
    fn lights_added_one_by_one_seldom_cost_a_buffer() {
        let (mut room, mut buffers) = (LIGHT_WORDS, 1);
        for lights in 1..=1024 {
            let words = lights * LIGHT_WORDS;
            if words > room {
                room = room_for(words, WEBGPUS_LIMIT);
                buffers += 1;
                assert!(room >= words + LIGHT_WORDS, "no spare room for a light after {lights}");
            }
        }
        // 1, 4, 10, 22, ... 1534 lights: the n-th buffer has room for 3 * 2^(n - 1) - 2.
        assert_eq!(buffers, 10);
    }

    #[test]
    fn spare_room_does_not_exceed_the_limit() {
        let limit = 100 * LIGHT_WORDS;
        let bytes = (limit * size_of::<u32>()) as u64;
        assert_eq!(room_for(limit, bytes), limit);
        assert_eq!(room_for(limit - LIGHT_WORDS, bytes + 5), limit);
        // A size that does not fit is returned unchanged, so that the error states that size.
        assert_eq!(room_for(limit + LIGHT_WORDS, bytes), limit + LIGHT_WORDS);
    }
}
