//! Mismatched sizes: a roughness map of another size than the map, and blocks that Direct3D cannot create.

mod common;

use common::{bake, data, scratch, textures};
use roughcast::{Image, Samples};
use roughcast_io::png_levels;

/// The channel in which glTF stores roughness.
const GREEN: usize = 1;

/// The largest rounding error of a roughness stored in 8 bits.
const HALF_A_STEP: f64 = 0.5 / 255.0;

/// Error of f32 arithmetic, far below a step of 8 bits.
const ROUNDING: f64 = 1e-4;

#[test]
fn a_roughness_map_of_another_size_is_resampled_and_reported() {
    let folder = scratch();
    let half = data("cases/missing-roughness-size/r_half.png");
    let map = data("cases/missing-roughness-size/plain.png");
    let options = ["--as", "pbr", "--roughness", half.to_str().expect("UTF-8")];
    let output = folder.path().join("rock.ktx2");
    let report = bake(&map, &output, &[&options[..], &["--json"]].concat()).expect_success().json();
    assert_eq!(report["roughness_resampled_from"], serde_json::json!([32, 24]));
    let told = bake(&map, &output, &options).expect_success().stdout;
    assert!(told.contains("roughness map of 32x24 resampled to 64x48"), "{told}");
}

/// A flat map stores nothing but the resampled roughness.
#[test]
fn the_stored_value_is_the_resampled_variance() {
    let folder = scratch();
    let flat = folder.path().join("flat.png");
    let write = |path: &std::path::Path, image: &Image| {
        let file = std::fs::File::create(path).expect("a writable folder");
        png_levels::write_level(image, &Default::default(), file).expect("space");
    };
    // 16 bits, whose middle code is so close to 0 that the slopes vanish.
    let texels = [[32768_u16, 32768, 65535]; 4].concat();
    write(&flat, &Image::new(4, 1, 3, Samples::U16(texels)).expect("a map"));
    let stored = [51_u8, 204];
    let [low, high] = stored.map(|code| (f64::from(code) / 255.0).powi(4));
    let small = folder.path().join("small.png");
    write(&small, &Image::new(2, 1, 1, Samples::U8(stored.to_vec())).expect("a map"));
    let large = folder.path().join("large.png");
    let eight = vec![51, 51, 51, 204, 204, 204, 51, 51];
    write(&large, &Image::new(8, 1, 1, Samples::U8(eight)).expect("a map"));

    let quarter = |a: f64, b: f64| 0.75 * a + 0.25 * b;
    // Enlarging is bilinear between centres, also across the edge of a repeating map; reducing averages the area of
    // pairs.
    let grown = [quarter(low, high), quarter(low, high), quarter(high, low), quarter(high, low)];
    let shrunk = [low, 0.5 * (low + high), high, low];
    for (roughness, expected) in [(&small, grown), (&large, shrunk)] {
        let output = folder.path().join("out.ktx2");
        bake(&flat, &output, &["--as", "pbr", "--roughness", roughness.to_str().expect("UTF-8")])
            .expect_success();
        let written = textures(&folder.path().join("out.roughness.ktx2"));
        for (x, alpha_squared) in expected.into_iter().enumerate() {
            let value = f64::from(written.layers()[0].finest().get(x, 0, GREEN));
            let difference = (value - alpha_squared.powf(0.25)).abs();
            assert!(difference <= HALF_A_STEP + ROUNDING, "{}: texel {x}: {value}", roughness.display());
        }
    }
}

#[test]
fn blocks_that_direct3d_cannot_create_get_a_warning() {
    let folder = scratch();
    let odd = data("cases/missing-bc-size-warning/n30.png");
    let even = data("cases/missing-roughness-size/plain.png");
    let warns = |map: &std::path::Path, name: &str, options: &[&str]| {
        let all = [&["--as", "pbr", "--roughness", "0.5"], options].concat();
        let told = bake(map, &folder.path().join(name), &all).expect_success();
        told.stderr.contains("Direct3D cannot create a block-compressed texture")
    };
    let bc = ["--compress", "bc"];
    assert!(warns(&odd, "n30.dds", &bc));
    assert!(!warns(&odd, "n30.ktx2", &bc), "KTX2 is for Vulkan, which has no such rule");
    assert!(!warns(&odd, "plain30.dds", &[]), "plain texels have no blocks");
    assert!(!warns(&even, "n64.dds", &bc));
}
