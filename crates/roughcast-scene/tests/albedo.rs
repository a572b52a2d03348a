//! Laws of maps of diffuse colours, in pictures.

use std::sync::Arc;

use glam::DVec3;
use roughcast::shading::{Material, Shading, ShadingOptions};
use roughcast::{Bake, BakeOptions, Distribution, SampleType, Slope, Wrap};
use roughcast_scene::pattern::{self, Pattern};
use roughcast_scene::render::{Method, Truth, unwatched};
use roughcast_scene::{
    AlbedoMap, BakedTextures, Camera, Detail, DetailPoint, Filter, Light, Mesh, Picture, Plane, Resolved,
    Sampler, Scene, Shape, SlopeDetail, SlopeMap, Sphere, Torus, TriangleMesh,
};

const SIZE: (u32, u32) = (64, 48);
/// Exact in binary, so that interpolating between equal texels does not change it by more than [`ROUNDING`].
const COLOUR: [f32; 3] = [0.5, 0.25, 0.125];
/// Weights of filters sum to one with the error of a few operations.
const ROUNDING: f32 = 1e-5;

fn scene(shape: Shape, repeats: f64) -> Scene {
    Scene {
        shape: Arc::new(shape),
        camera: Camera::new(DVec3::new(0.0, 4.0, 3.0), DVec3::ZERO, DVec3::Y, 0.35).unwrap(),
        lights: vec![Light::Directional { towards: DVec3::Y, irradiance: Light::WHITE }],
        material: Material::default(),
        albedo: None,
        repeats,
        background: [0.0; 3],
    }
}

fn plane(repeats: f64) -> Scene {
    scene(Shape::Plane(Plane::new(2.0).unwrap()), repeats)
}

fn textures(bumps: &Pattern) -> BakedTextures {
    let options =
        BakeOptions::default().with_layout(Shading::Lean.layout()).with_sample_type(SampleType::F32);
    let baked = Bake::of(&bumps.heights).source(bumps.source_options()).options(options).run().unwrap();
    BakedTextures::of_model(Shading::Lean, &baked.arrays).unwrap()
}

fn slopes(bumps: &Pattern, wrap: Wrap) -> SlopeDetail {
    SlopeDetail::new(SlopeMap::of(&bumps.heights, &bumps.source_options()).unwrap(), wrap)
}

fn method(scene: &Scene, detail: &dyn Detail) -> Picture {
    let method = Method { shading: Shading::Lean, detail, options: ShadingOptions::default() };
    method.render(scene, SIZE, &unwatched).unwrap()
}

fn truth(scene: &Scene, detail: &dyn Detail, samples: u32) -> Picture {
    let truth = Truth { shading: Shading::Lean, detail, options: ShadingOptions::default(), samples };
    truth.render(scene, SIZE, &unwatched).unwrap()
}

/// The largest difference of a channel, relative to the value.
fn apart(a: &Picture, b: &Picture) -> f32 {
    let values = a.radiance().as_flattened().iter().zip(b.radiance().as_flattened());
    values.map(|(a, b)| (a - b).abs() / a.max(1e-3)).fold(0.0, f32::max)
}

fn constant() -> Arc<AlbedoMap> {
    Arc::new(AlbedoMap::new(7, 3, &[COLOUR; 21]).unwrap())
}

/// A texel of one, then one of zero, in both directions.
fn checkered(side: usize) -> Arc<AlbedoMap> {
    let colours: Vec<_> = (0..side * side).map(|i| [((i % side + i / side) % 2) as f32; 3]).collect();
    Arc::new(AlbedoMap::new(side, side, &colours).unwrap())
}

#[test]
fn a_map_of_one_colour_is_that_colour_by_every_filter_and_in_the_truth() {
    let bumps = pattern::random_bumps(64, 0.2, 3);
    let (textures, slopes) = (textures(&bumps), slopes(&bumps, Wrap::Repeat));
    for shape in
        [Shape::Plane(Plane::new(2.0).unwrap()), Shape::Sphere(Sphere), Shape::Torus(Torus::default())]
    {
        let mut plain = scene(shape, 3.0);
        plain.material = plain.material.with_albedo(COLOUR);
        // The map replaces the colour of the material.
        let mapped = Scene { albedo: Some(constant()), material: Material::default(), ..plain.clone() };
        for filter in Filter::ALL {
            let detail = textures.sampled(Sampler::default().with_filter(*filter));
            let (plain, mapped) = (method(&plain, &detail), method(&mapped, &detail));
            assert!(apart(&plain, &mapped) < ROUNDING, "{filter}: {}", apart(&plain, &mapped));
            assert_eq!(plain.specular(), mapped.specular());
        }
        let (plain, mapped) = (truth(&plain, &slopes, 4), truth(&mapped, &slopes, 4));
        assert!(apart(&plain, &mapped) < ROUNDING, "{}", apart(&plain, &mapped));
    }
}

/// The diffuse light of a picture, without its highlights, of one channel.
fn diffuse(picture: &Picture) -> Vec<f32> {
    picture.radiance().iter().zip(picture.specular()).map(|(all, specular)| all[0] - specular[0]).collect()
}

#[test]
fn a_checkered_map_far_away_is_the_mean_of_its_colours_in_linear_light() {
    /// The finest levels still show at some weight; the checks are a hundred to the pixel.
    const MEAN: f32 = 1e-2;
    /// Noise of 256 samples, a standard deviation of 0.5 / 16 for each pixel, in the worst of 3072 pixels.
    const NOISE: f32 = 0.16;
    let bumps = pattern::raised_checker(64, 2, 4.0, 0.0);
    let mut grey = plane(200.0);
    grey.material = grey.material.with_albedo([0.5; 3]);
    let checks = Scene { albedo: Some(checkered(32)), ..grey.clone() };
    let textures = textures(&bumps);
    for filter in [Filter::Trilinear, Filter::Anisotropic, Filter::Ewa, Filter::SummedArea] {
        let detail = textures.sampled(Sampler::default().with_filter(filter));
        let (grey, checks) = (diffuse(&method(&grey, &detail)), diffuse(&method(&checks, &detail)));
        for (grey, checks) in grey.iter().zip(&checks) {
            assert!((checks / grey - 1.0).abs() < MEAN, "{filter}: {checks} and {grey}");
        }
    }
    let detail = slopes(&bumps, Wrap::Repeat);
    let (grey, checks) = (diffuse(&truth(&grey, &detail, 256)), diffuse(&truth(&checks, &detail, 256)));
    for (grey, checks) in grey.iter().zip(&checks) {
        assert!((0.5 * checks / grey - 0.5).abs() < NOISE, "{checks} and {grey}");
    }
    let mean = |values: &[f32]| values.iter().sum::<f32>() / values.len() as f32;
    assert!((mean(&checks) / mean(&grey) - 1.0).abs() < MEAN, "{} and {}", mean(&checks), mean(&grey));
}

#[test]
fn filtered_colours_come_close_to_those_of_the_truth() {
    /// Root mean square error relative to the mean: the filters' shapes differ from the Gaussian of the truth, and the
    /// truth has noise. Without a filter it is several times as large.
    const CLOSE: f32 = 0.08;
    let bumps = pattern::raised_checker(64, 2, 4.0, 0.0);
    // Smooth waves of colours, eight to the map.
    let wave = |i: usize| 0.5 + 0.4 * (i as f32 / 64.0 * 8.0 * std::f32::consts::TAU).sin();
    let colours: Vec<_> = (0..64 * 64).map(|i| [wave(i % 64), wave(i / 64), 0.5]).collect();
    let scene = Scene { albedo: Some(Arc::new(AlbedoMap::new(64, 64, &colours).unwrap())), ..plane(4.0) };
    let wanted = diffuse(&truth(&scene, &slopes(&bumps, Wrap::Repeat), 64));
    let textures = textures(&bumps);
    let mean = wanted.iter().sum::<f32>() / wanted.len() as f32;
    let error = |filter| {
        let got = diffuse(&method(&scene, &textures.sampled(Sampler::default().with_filter(filter))));
        let squares = got.iter().zip(&wanted).map(|(a, b)| (a - b).powi(2)).sum::<f32>();
        (squares / wanted.len() as f32).sqrt() / mean
    };
    for filter in [Filter::Anisotropic, Filter::Ewa] {
        assert!(error(filter) < CLOSE, "{filter}: {}", error(filter));
    }
}

#[test]
fn the_colours_wrap_and_repeat_like_the_bumps() {
    let bumps = pattern::raised_checker(64, 2, 4.0, 0.0);
    let textures = textures(&bumps);
    // Black on the left, white on the right.
    let halves: Vec<_> = (0..16).map(|i| [if i < 8 { 0.0 } else { 1.0 }; 3]).collect();
    let scene = Scene { albedo: Some(Arc::new(AlbedoMap::new(16, 1, &halves).unwrap())), ..plane(2.0) };
    // In the first copy of the map, and in each half of the second, as far as the picture shows it.
    let places = [0.75, 1.25, 1.55];
    for (wrap, wanted) in [
        (Wrap::Repeat, [true, false, true]),
        (Wrap::Clamp, [true, true, true]),
        (Wrap::Mirror, [true, true, false]),
    ] {
        let sampler = Sampler::default().with_wrap(wrap);
        let (nearest, linear) =
            (textures.sampled(sampler.with_filter(Filter::Nearest)), textures.sampled(sampler));
        let slopes = slopes(&bumps, wrap);
        let details: [&dyn Detail; 4] = [&nearest, &linear, &Resolved(&linear), &Resolved(&slopes)];
        for detail in details {
            let diffuse = diffuse(&method(&scene, detail));
            let bright = places.map(|u| diffuse[pixel_of(&scene, u)] > 0.1);
            assert_eq!(bright, wanted, "{wrap}");
        }
    }
}

/// The pixel in the middle row where the scaled texture coordinate u is nearest to this.
fn pixel_of(scene: &Scene, u: f64) -> usize {
    let row = SIZE.1 / 2;
    let distance = |column: &u32| {
        let ray = scene.camera.ray(f64::from(*column) + 0.5, f64::from(row) + 0.5, SIZE.0, SIZE.1);
        (scene.shape.hit(&ray).unwrap().uv(0).x * scene.repeats - u).abs()
    };
    let column = (0..SIZE.0).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap();
    (row * SIZE.0 + column) as usize
}

/// A source of bumps without textures.
struct Flat;

impl Detail for Flat {
    fn slope(&self, _: &DetailPoint<'_>) -> Slope {
        Slope::default()
    }

    fn distribution(&self, _: &DetailPoint<'_>, _: &ShadingOptions) -> Distribution {
        Distribution::of_slope(Slope::default())
    }
}

#[test]
fn a_shape_without_texture_coordinates_has_the_colour_of_one_place() {
    let triangle = TriangleMesh {
        positions: vec![[-3.0, 0.0, 3.0], [3.0, 0.0, 3.0], [0.0, 0.0, -3.0]],
        normals: vec![[0.0, 1.0, 0.0]; 3],
        tangents: vec![[1.0, 0.0, 0.0, 1.0]; 3],
        uv_sets: Vec::new(),
        indices: vec![0, 1, 2],
    };
    let mesh = Mesh::new(vec![triangle]).unwrap();
    let scene = Scene { albedo: Some(checkered(4)), ..scene(Shape::Mesh(Arc::new(mesh)), 1.0) };
    for picture in [method(&scene, &Flat), truth(&scene, &Flat, 4)] {
        let covered: Vec<f32> = diffuse(&picture)
            .into_iter()
            .zip(picture.coverage())
            .filter_map(|(diffuse, coverage)| (*coverage == 1.0).then_some(diffuse))
            .collect();
        assert!(covered.len() > 100);
        assert!(covered.iter().all(|value| value.is_finite() && (value - covered[0]).abs() < ROUNDING));
    }
}
