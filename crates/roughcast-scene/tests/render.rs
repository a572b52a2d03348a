//! Laws of the renderer: methods compared with their ground truths.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use glam::DVec3;
use roughcast::shading::{Form, Material, Shading, ShadingOptions};
use roughcast::texture::{Part, TextureArray};
use roughcast::{Bake, BakeOptions, BaseRoughness, PbrOptions, RoughnessTexture, SampleType, Wrap};
use roughcast_scene::metrics::{energy_error, flicker, rmse};
use roughcast_scene::pattern::{self, Pattern};
use roughcast_scene::render::{Method, RenderError, Truth, unwatched};
use roughcast_scene::{
    BakedTextures, Camera, DetailError, Filter, Light, Picture, Plane, Sampler, Scene, Shape, SlopeDetail,
    SlopeMap, Sphere, Torus, slow_move,
};

const SIZE: (u32, u32) = (64, 48);

/// A map, its slopes, and its baked textures.
struct Map {
    pattern: Pattern,
    slopes: SlopeDetail,
}

impl Map {
    fn new(pattern: Pattern) -> Self {
        let slopes = SlopeMap::of(&pattern.heights, &pattern.source_options()).unwrap();
        Self { pattern, slopes: SlopeDetail::new(slopes, Wrap::Repeat) }
    }

    fn baked(&self, shading: Shading, specular_power: f32) -> Vec<TextureArray> {
        let options = BakeOptions::default().with_layout(shading.layout()).with_sample_type(SampleType::F32);
        let options = match shading {
            Shading::Ggx | Shading::Toksvig => options.with_sample_type(SampleType::U16),
            _ => options,
        };
        let roughness = Some(BaseRoughness::Variance(1.0 / specular_power));
        Bake::of(&self.pattern.heights)
            .source(self.pattern.source_options())
            .roughness(roughness)
            .options(options)
            .run()
            .unwrap()
            .arrays
    }

    fn method(&self, scene: &Scene, shading: Shading, filter: Filter, options: ShadingOptions) -> Picture {
        self.method_at(scene, SIZE, shading, filter, options)
    }

    fn method_at(
        &self,
        scene: &Scene,
        size: (u32, u32),
        shading: Shading,
        filter: Filter,
        options: ShadingOptions,
    ) -> Picture {
        let textures =
            BakedTextures::of_model(shading, &self.baked(shading, options.specular_power)).unwrap();
        let sampler = Sampler::default().with_filter(filter);
        Method { shading, detail: &textures.sampled(sampler), options }
            .render(scene, size, &unwatched)
            .unwrap()
    }

    fn truth(&self, shading: Shading, options: ShadingOptions, samples: u32) -> Truth<'_> {
        Truth { shading, detail: &self.slopes, options, samples }
    }
}

fn power(specular_power: f32, form: Form) -> ShadingOptions {
    ShadingOptions::default().with_specular_power(specular_power).with_form(form)
}

/// A plane seen from above, with a highlight in its middle and this many texels of a map of 256 per pixel.
fn plane(texels_per_pixel: f64) -> Scene {
    let camera = Camera::new(DVec3::new(0.0, 4.0, 3.0), DVec3::ZERO, DVec3::Y, 0.35).unwrap();
    // At a distance of 5 the picture's height is about 1.77.
    let pixel = 2.0 * (0.175_f64).tan() * 5.0 / f64::from(SIZE.1);
    Scene {
        shape: Arc::new(Shape::Plane(Plane::new(2.0).unwrap())),
        camera,
        lights: vec![Light::Directional {
            towards: DVec3::new(0.02, 4.0, -3.03).normalize(),
            irradiance: [3.0; 3],
        }],
        material: Material::default(),
        albedo: None,
        repeats: texels_per_pixel * 4.0 / (256.0 * pixel),
        background: [0.0; 3],
    }
}

/// The raised checker of LEAN Figure 14, in the distance.
fn figure_14() -> (Map, Scene) {
    let scene = Scene {
        shape: Arc::new(Shape::Plane(Plane::new(20.0).unwrap())),
        camera: Camera::new(DVec3::new(0.0, 1.0, 5.0), DVec3::ZERO, DVec3::Y, 0.8).unwrap(),
        lights: vec![Light::Directional {
            towards: DVec3::new(0.1, 0.242, -0.97).normalize(),
            irradiance: [3.0; 3],
        }],
        repeats: 64.0,
        ..plane(1.0)
    };
    (Map::new(pattern::raised_checker(256, 16, 2.0, 0.05)), scene)
}

fn flat() -> Map {
    Map::new(pattern::raised_checker(64, 2, 4.0, 0.0))
}

#[test]
fn on_a_flat_map_every_method_matches_its_ground_truth() {
    // Within a pixel a highlight of s = 32 is nearly constant; the pixel filter reduces its peak by this fraction.
    const WITHIN_A_PIXEL: f64 = 2e-3;
    let map = flat();
    for form in Form::ALL {
        for shading in Shading::ALL {
            let options = power(32.0, *form);
            let truth = map.truth(*shading, options, 64).render(&plane(2.0), SIZE, &unwatched).unwrap();
            let brightest = truth.specular().iter().map(|s| f64::from(s[0])).fold(0.0, f64::max);
            assert!(brightest > 0.01, "no highlight of {shading}");
            for filter in Filter::ALL {
                let picture = map.method(&plane(2.0), *shading, *filter, options);
                let error = rmse(&picture, &truth).unwrap() / brightest;
                assert!(error < WITHIN_A_PIXEL, "{shading} {form} {filter}: {error}");
            }
        }
    }
}

#[test]
fn ground_truth_converges_faster_than_random_sampling() {
    let (map, scene) = figure_14();
    let options = power(2048.0, Form::Paper);
    let render =
        |samples| map.truth(Shading::OffCentre, options, samples).render(&scene, SIZE, &unwatched).unwrap();
    let best = render(4096);
    let [few, some, many] = [4, 64, 1024].map(|samples| rmse(&render(samples), &best).unwrap());
    // Sixteen times the samples: if they were independent, the error would be a quarter. The 1024 samples share none
    // with the best 4096, whose own error is added to theirs.
    assert!(few > 4.0 * some && some > 4.0 * many, "{few} {some} {many}");
}

#[test]
fn ground_truth_is_the_mean_over_the_pixel_filter() {
    // A plane whose background is visible through no pixel, and one whose edge crosses some pixels: coverage is the
    // integral of the filter over the half plane, which is the cumulative normal distribution.
    let mut scene = plane(1.0);
    // Looking straight down, the edge x = 0.5 of a square crosses the picture along a column.
    scene.shape = Arc::new(Shape::Plane(Plane::new(0.5).unwrap()));
    scene.camera = Camera::new(DVec3::new(0.0, 10.0, 0.0), DVec3::ZERO, DVec3::NEG_Z, 0.2).unwrap();
    let map = flat();
    let picture = map
        .truth(Shading::OffCentre, power(32.0, Form::Paper), 1024)
        .render(&scene, SIZE, &unwatched)
        .unwrap();
    let pixel = 2.0 * 0.1_f64.tan() * 10.0 / f64::from(SIZE.1);
    let row = 24 * 64;
    let mut partial = 0;
    for x in 32..64 {
        let centre = (f64::from(x) + 0.5 - 32.0) * pixel;
        let deviations = (0.5 - centre) / pixel / 0.5;
        let covered = normal_distribution(deviations);
        let got = f64::from(picture.coverage()[row + x as usize]);
        // The edge cuts a row of 32 strata at some position within one of them.
        assert!((got - covered).abs() < 1.0 / 32.0, "{x}: {got} {covered}");
        partial += usize::from(got > 0.01 && got < 0.99);
    }
    assert!(partial >= 2, "the edge runs through pixels");
}

fn normal_distribution(deviations: f64) -> f64 {
    let steps = 10_000;
    let step = (deviations + 9.0) / f64::from(steps);
    let density = |i: i32| (-0.5 * (-9.0 + (f64::from(i) + 0.5) * step).powi(2)).exp();
    (0..steps).map(density).sum::<f64>() * step / std::f64::consts::TAU.sqrt()
}

#[test]
fn the_number_of_threads_does_not_change_any_bit() {
    let (map, scene) = figure_14();
    let options = power(2048.0, Form::Paper);
    let render = |threads: usize| {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(|| {
            let truth = map.truth(Shading::OffCentre, options, 16).render(&scene, SIZE, &unwatched).unwrap();
            (truth, map.method(&scene, Shading::Lean, Filter::Anisotropic, options))
        })
    };
    assert_eq!(render(1), render(3));
}

#[test]
fn far_away_lean_has_smaller_errors_than_conventional_bump_mapping() {
    // Random bumps, many under each pixel: the case that LEAN's Gaussian describes.
    let map = Map::new(pattern::random_bumps(256, 0.1, 5));
    let (scene, options) = (plane(32.0), power(2048.0, Form::Normalised));
    let truth = |shading| map.truth(shading, options, 1024).render(&scene, SIZE, &unwatched).unwrap();
    let (off_centre, blinn_phong) = (truth(Shading::OffCentre), truth(Shading::BlinnPhong));
    let lean = map.method(&scene, Shading::Lean, Filter::Trilinear, options);
    let ordinary = map.method(&scene, Shading::BlinnPhong, Filter::Trilinear, options);
    let (lean_error, ordinary_error) =
        (rmse(&lean, &off_centre).unwrap(), rmse(&ordinary, &blinn_phong).unwrap());
    // A factor of 13.8 was measured.
    assert!(ordinary_error > 8.0 * lean_error, "{ordinary_error} {lean_error}");
    // In the normalised form LEAN spreads the highlight's energy without losing any. The picture contains nearly all of
    // it.
    let energy = energy_error(&lean, &off_centre).unwrap();
    assert!(energy.abs() < 0.03, "{energy}");
}

#[test]
fn a_raised_checker_in_the_distance_needs_lean() {
    let ((map, scene), options) = (figure_14(), power(2048.0, Form::Paper));
    let size = (160, 120);
    let truth = map.truth(Shading::OffCentre, options, 64).render(&scene, size, &unwatched).unwrap();
    let error =
        |shading, filter| rmse(&map.method_at(&scene, size, shading, filter, options), &truth).unwrap();
    let unfiltered = error(Shading::BlinnPhong, Filter::Nearest);
    let [trilinear, anisotropic, ewa] =
        [Filter::Trilinear, Filter::Anisotropic, Filter::Ewa].map(|filter| error(Shading::Lean, filter));
    // 0.12, 0.14 and 0.12 were measured; with the elliptical average, which has exactly the filter of the ground truth,
    // the remaining error is LEAN's own and the noise of the ground truth.
    assert!(trilinear.max(anisotropic) < unfiltered / 3.0, "{unfiltered} {trilinear} {anisotropic}");
    assert!(ewa < anisotropic, "{ewa} {anisotropic}");
}

#[test]
fn conventional_bump_mapping_flickers() {
    let ((map, scene), options) = (figure_14(), power(2048.0, Form::Paper));
    let frames = slow_move(&scene, 8);
    let truth = map.truth(Shading::OffCentre, options, 256);
    let truth: Vec<Picture> = frames.iter().map(|s| truth.render(s, SIZE, &unwatched).unwrap()).collect();
    let measure = |shading, filter| {
        let pictures: Vec<Picture> = frames.iter().map(|s| map.method(s, shading, filter, options)).collect();
        flicker(&pictures, &truth).unwrap()
    };
    let (ordinary, lean) =
        (measure(Shading::BlinnPhong, Filter::Nearest), measure(Shading::Lean, Filter::Anisotropic));
    assert!(ordinary > 5.0 * lean, "{ordinary} {lean}");
}

#[test]
fn curved_shapes_give_finite_radiance() {
    let map = Map::new(pattern::random_bumps(64, 0.5, 6));
    let shapes =
        [Shape::Sphere(Sphere), Shape::Torus(Torus::new(0.4).unwrap()), Shape::Plane(Plane::default())];
    for shape in shapes {
        let scene = Scene {
            shape: Arc::new(shape),
            lights: vec![
                Light::Point { position: DVec3::new(1.0, 2.0, 2.0), intensity: [3.0; 3] },
                // Seen from behind, and exactly along a silhouette.
                Light::Directional { towards: DVec3::NEG_Z, irradiance: [1.0; 3] },
                Light::Directional { towards: DVec3::X, irradiance: [1.0; 3] },
            ],
            repeats: 3.0,
            background: [0.5, 0.25, 0.0],
            ..plane(1.0)
        };
        for shading in Shading::ALL {
            let options = power(13777.0, Form::Normalised);
            let method = map.method(&scene, *shading, Filter::Anisotropic, options);
            let truth = map.truth(*shading, options, 4).render(&scene, SIZE, &unwatched).unwrap();
            for picture in [&method, &truth] {
                assert!(
                    picture.radiance().as_flattened().iter().all(|c| c.is_finite() && *c >= 0.0),
                    "{shading}"
                );
                let behind = picture.coverage().iter().position(|c| *c == 0.0);
                assert!(behind.is_none_or(|i| picture.radiance()[i] == [0.5, 0.25, 0.0]));
                // Specular light is a part of the total light.
                let parts = picture.specular().as_flattened().iter().zip(picture.radiance().as_flattened());
                assert!(parts.into_iter().all(|(s, r)| s <= r));
            }
        }
    }
}

#[test]
fn packed_roughness_shades_as_roughness_alone() {
    let map = Map::new(pattern::random_bumps(64, 0.3, 7));
    let (scene, options) = (plane(4.0), power(64.0, Form::Normalised));
    let picture = |roughness_texture| {
        let pbr = PbrOptions::default().with_roughness_texture(roughness_texture);
        let bake_options = BakeOptions::default().with_layout(Shading::Ggx.layout()).with_pbr(pbr);
        let base = Some(BaseRoughness::Variance(1.0 / 64.0));
        let baked = Bake::of(&map.pattern.heights)
            .source(map.pattern.source_options())
            .roughness(base)
            .options(bake_options)
            .run()
            .unwrap();
        let textures = BakedTextures::of_model(Shading::Ggx, &baked.arrays).unwrap();
        let method = Method { shading: Shading::Ggx, detail: &textures.sampled(Sampler::default()), options };
        method.render(&scene, SIZE, &unwatched).unwrap()
    };
    let (alone, packed) = (picture(RoughnessTexture::Alone), picture(RoughnessTexture::Packed));
    assert_eq!(alone, packed);
    // The roughness is not the red channel's occlusion of one, which would leave hardly any highlight.
    let brightest = packed.specular().iter().map(|s| s[0]).fold(0.0, f32::max);
    assert!(brightest > 0.02, "{brightest}");
}

#[test]
fn invalid_renders_are_refused() {
    let (map, scene) = (flat(), plane(1.0));
    let options = power(32.0, Form::Paper);
    let truth =
        |samples, size| map.truth(Shading::OffCentre, options, samples).render(&scene, size, &unwatched);
    for samples in [0, 2, 63, 4095, 4097, 4225, u32::MAX] {
        assert_eq!(truth(samples, SIZE), Err(RenderError::Samples(samples)));
    }
    for size in [(0, 1), (1, 0), (u32::MAX, u32::MAX)] {
        assert_eq!(truth(1, size), Err(RenderError::Size(size.0, size.1)));
    }
    let lean = map.baked(Shading::Lean, 32.0);
    let wrong = BakedTextures::of_model(Shading::Clean, &lean).unwrap_err();
    assert_eq!(wrong, DetailError::MissingTexture { part: Part::Whole, layer: "clean" });
    assert!(BakedTextures::of_model(Shading::Lean, &[]).is_err());
    assert!(BakedTextures::of_model(Shading::Ggx, &map.baked(Shading::Ggx, 32.0)[..1]).is_err());
    let mut blind = plane(1.0);
    blind.camera.target = blind.camera.eye;
    let result = map.truth(Shading::OffCentre, options, 1).render(&blind, SIZE, &unwatched);
    assert!(matches!(result, Err(RenderError::Camera(_))));
}

#[test]
fn ground_truths_with_shared_rays_match_those_of_each_model() {
    const SMALL: (u32, u32) = (24, 16);
    let (map, scene) = figure_14();
    let truth = map.truth(Shading::Lean, power(64.0, Form::Normalised), 9);
    let together = truth.render_each(Shading::ALL, &scene, SMALL, &unwatched).unwrap();
    assert_eq!(together.len(), Shading::ALL.len());
    for (shading, picture) in Shading::ALL.iter().zip(&together) {
        let alone = Truth { shading: *shading, ..truth }.render(&scene, SMALL, &unwatched).unwrap();
        assert!(*picture == alone, "{shading}");
    }
    assert!(together[0] != together[1], "different lobes look alike");
    assert_eq!(truth.render_each(&[], &scene, SMALL, &unwatched), Ok(Vec::new()));
}

#[test]
fn progress_is_reported_per_row_and_can_stop() {
    let (map, scene) = (flat(), plane(1.0));
    let truth = map.truth(Shading::OffCentre, power(32.0, Form::Paper), 1);
    let (calls, most) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let watch = |done: usize, rows: usize| {
        assert_eq!(rows, SIZE.1 as usize);
        calls.fetch_add(1, Ordering::Relaxed);
        most.fetch_max(done, Ordering::Relaxed);
        ControlFlow::Continue(())
    };
    truth.render(&scene, SIZE, &watch).unwrap();
    assert_eq!((calls.into_inner(), most.into_inner()), (SIZE.1 as usize, SIZE.1 as usize));
    let stop = |done: usize, _| if done >= 5 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
    assert_eq!(truth.render(&scene, SIZE, &stop), Err(RenderError::Cancelled));
}
