//! The exponent of the LEAN paper's ocean, 13777: 16-bit maps shade like float maps, and 8-bit maps do not.

use std::sync::Arc;

use roughcast::shading::{Material, Shading, ShadingOptions};
use roughcast::{Bake, BakeOptions, Image, SampleType};
use roughcast_io::{ReadOptions, read_image_file};
use roughcast_scene::metrics::{DEFAULT_PIXELS_PER_DEGREE, hdr_flip};
use roughcast_scene::render::{Method, unwatched};
use roughcast_scene::{BakedTextures, Picture, Plane, Sampler, Shape, View};

const SPECULAR_POWER: f32 = 13_777.0;
const SIZE: (u32, u32) = (160, 120);
/// Mean FLIP below which two pictures count as equal: a hundredth of the distance from one colour to its opposite.
const SAME: f64 = 0.01;
/// Eight bits support exponents up to about a hundred for slopes of one: the comparator must detect that, by this
/// factor above its tolerance.
const DIFFERENT: f64 = 2.0;
/// Maps of the test data with slopes above one.
const MAPS: [&str; 2] = ["materials/water_bevy/water_normals.png", "materials/rock020/Rock020_1K_Normal.jpg"];

fn map(name: &str) -> Image {
    read_image_file(&roughcast_testdata::find(name), &ReadOptions::default()).expect("a map").image
}

fn picture(map: &Image, bits: SampleType, view: View) -> Picture {
    let options = BakeOptions::default().with_sample_type(bits);
    let baked = Bake::of(map).options(options).run().expect("a map");
    let textures = BakedTextures::of_model(Shading::Lean, &baked.arrays).expect("LEAN's textures");
    let plane = Arc::new(Shape::Plane(Plane::default()));
    let scene = view.scene(plane, (map.width(), map.height()), SIZE, Material::default());
    let options = ShadingOptions::default().with_specular_power(SPECULAR_POWER);
    let method = Method { shading: Shading::Lean, detail: &textures.sampled(Sampler::default()), options };
    method.render(&scene, SIZE, &unwatched).expect("a picture")
}

fn flip(map: &Image, bits: SampleType, view: View) -> f64 {
    let float = picture(map, SampleType::F32, view);
    hdr_flip(&picture(map, bits, view), &float, DEFAULT_PIXELS_PER_DEGREE).expect("pictures of one size").mean
}

#[test]
fn sixteen_bits_and_halves_represent_the_exponent_of_the_paper() {
    for name in roughcast_testdata::rows_with_files(MAPS, |name| name) {
        let map = map(name);
        for view in View::ALL {
            for bits in [SampleType::U16, SampleType::F16] {
                let flip = flip(&map, bits, *view);
                println!("{name}, {view}, {bits}: FLIP {flip:.5}");
                assert!(flip < SAME, "{name}, {view}, {bits}: FLIP {flip}");
            }
        }
    }
}

#[test]
fn eight_bits_do_not() {
    let flip = flip(&map("crops/rock020_normal_256.jpg"), SampleType::U8, View::Near);
    println!("FLIP {flip:.5}");
    assert!(flip > DIFFERENT * SAME, "FLIP {flip}");
}
