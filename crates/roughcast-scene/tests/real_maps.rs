//! Real normal maps, seen from afar: LEAN against conventional bump mapping.

mod common;

use std::sync::Arc;

use common::picture;
use roughcast::shading::{Form, Material, Shading, ShadingOptions};
use roughcast::{Bake, SourceOptions, Wrap};
use roughcast_scene::metrics::{energy_error, rmse};
use roughcast_scene::render::{Method, Truth, unwatched};
use roughcast_scene::{
    BakedTextures, Filter, Plane, Reconstruction, Sampler, Shape, SlopeDetail, SlopeMap, View,
};

const SIZE: (u32, u32) = (64, 48);

/// Maps with many bumps per pixel, and the factor by which LEAN's error must be smaller than that of Blinn-Phong with
/// the same filter. 17, 11 and 1.5 were measured; scratches are few and long, with few under each pixel.
const MAPS: [(&str, f64); 3] = [
    ("materials/water_bevy/water_normals.png", 8.0),
    ("materials/rock020/Rock020_1K_Normal.jpg", 5.0),
    ("materials/scratched_gold/ScratchedGold-Normal.png", 1.2),
];

#[test]
fn lean_has_smaller_errors_on_real_maps() {
    for (name, factor) in roughcast_testdata::rows_with_files(MAPS, |row| row.0) {
        let map = picture(name).image;
        let source = SourceOptions::default();
        let arrays = Bake::of(&map).source(source).run().unwrap().arrays;
        let slopes = SlopeMap::of(&map, &source).unwrap();
        let plane = Arc::new(Shape::Plane(Plane::default()));
        let scene = View::Far.scene(plane, (map.width(), map.height()), SIZE, Material::default());
        let options = ShadingOptions::default().with_specular_power(256.0).with_form(Form::Normalised);
        let errors = |shading: Shading, reconstruction| {
            let truth = Truth {
                shading,
                detail: &SlopeDetail::new(slopes.clone(), Wrap::Repeat).with_reconstruction(reconstruction),
                options,
                samples: 64,
            };
            let truth = truth.render(&scene, SIZE, &unwatched).unwrap();
            let textures = BakedTextures::of_model(shading, &arrays).unwrap();
            let sampler = Sampler::default().with_filter(Filter::Trilinear);
            let picture = Method { shading, detail: &textures.sampled(sampler), options }
                .render(&scene, SIZE, &unwatched)
                .unwrap();
            (rmse(&picture, &truth).unwrap(), energy_error(&picture, &truth).unwrap())
        };
        for reconstruction in Reconstruction::ALL {
            let ordinary = errors(Shading::BlinnPhong, *reconstruction);
            let lean = errors(Shading::Lean, *reconstruction);
            assert!(ordinary.0 > factor * lean.0, "{name} {reconstruction}: {ordinary:?} {lean:?}");
        }
    }
}
