//! Compares pictures of the same scenes by the CPU and by the GPU.

mod common;

use common::gpu;
use common::pictures::{Apart, GpuPictures, apart, by_cpu, inside, options, well_placed};
use common::scenes::{SIDE, SIZE, SPECULAR_POWER, maps, maps_with, scene, scenes};
use roughcast::shading::{BaseFrame, Form, Shading, ShadingOptions};
use roughcast::texture::TextureArray;
use roughcast::{AnisotropyOutput, BakeOptions, PbrOptions, RoughnessTexture, SampleType, Wrap};
use roughcast_gpu::render::{Bumps, DrawOptions};
use roughcast_scene::{Filter, Picture, Plane, Sampler, Scene, Shape, Sphere, Torus, View};

/// Number of squares along v in the mesh of a round shape. The triangles lie within 2e-5 of the shape.
const DETAIL: u32 = 256;

/// Largest difference with one texel per pixel, no filter and the same lobes, where only single against double
/// precision remains. Directions and texture coordinates are off by a few 1e-7 (ten times as much for a mesh far
/// smaller than one), and the flank of a lobe amplifies that some ten times; the largest measured is 2e-4. Differences
/// are relative to the value, down to a hundredth of the brightest.
const SAME_TEXELS: f64 = 1e-3;
/// Largest difference on round shapes, where flat triangles also stand for round surfaces: the view ray meets the
/// triangle up to 6e-5 from the point on the round shape, and the bumps' frame is rotated by as much. Largest
/// measured: 8e-3; it falls as the triangles shrink.
const SAME_TEXELS_ROUND: f64 = 2e-2;
/// Least fraction of the covered pixels that must be far enough from texel edges and silhouettes to be compared.
const COMPARED: f64 = 0.7;
/// Distance from a texel edge, in texels, within which rounding decides which texel is read.
const EDGE: f64 = 0.02;

/// Mean difference where texels are interpolated at a known level. Graphics hardware weights them in steps of 1/256, so
/// slopes are off by up to 1/512 of the difference between neighbouring texels. A driver with exact weights stays below
/// 1e-5.
const INTERPOLATED: f64 = 2e-3;
/// Mean difference where the hardware also computes the level of detail: from differences over 2x2 pixels, along the
/// pixel's sides where the CPU uses the ellipse's axis (up to half a level more), and with an approximate logarithm.
/// Largest measured: 1.3e-2.
const OWN_LEVEL: f64 = 2.5e-2;
/// Mean difference with anisotropic filters, whose taps each driver chooses freely. Largest measured: 0.03 where
/// footprints are up to a few times as long as wide, and 0.1 in the grazing view, where they are longer than any
/// filter.
fn own_taps(view: View) -> f64 {
    if view == View::Grazing { 0.15 } else { 0.05 }
}
/// Relative difference of the highlight's energy with anisotropic filters, for models that preserve it with any filter.
/// Largest measured: 0.014.
const ENERGY: f64 = 0.03;

const FORMS: [(Form, BaseFrame); 3] = [
    (Form::Paper, BaseFrame::Facet),
    (Form::Normalised, BaseFrame::Plane),
    (Form::Physical, BaseFrame::Plane),
];

fn shading_options(form: Form, base_frame: BaseFrame) -> ShadingOptions {
    ShadingOptions::default().with_specular_power(SPECULAR_POWER).with_form(form).with_base_frame(base_frame)
}

fn unfiltered() -> Sampler {
    Sampler::default().with_filter(Filter::Nearest).with_level(Some(0.0))
}

fn with_filter(filter: Filter) -> DrawOptions {
    let sampler = Sampler::default().with_filter(filter);
    options(sampler, shading_options(Form::Physical, BaseFrame::Plane))
}

/// Every model with its maps; GGX also with an anisotropy texture and with packed roughness.
fn models() -> Vec<(Shading, Vec<TextureArray>)> {
    let mut models: Vec<_> = Shading::ALL.iter().map(|s| (*s, maps(*s, SampleType::F16))).collect();
    let pbr = BakeOptions::default().with_layout(Shading::Ggx.layout()).with_sample_type(SampleType::U8);
    let plain = PbrOptions::default();
    for choices in [
        plain.with_anisotropy(Some(AnisotropyOutput::Khr)),
        plain.with_roughness_texture(RoughnessTexture::Packed),
    ] {
        models.push((Shading::Ggx, maps_with(pbr.with_pbr(choices))));
    }
    models
}

/// Compares the pixels that one texel and one surface determine.
fn apart_within_texels(scene: &Scene, cpu: &Picture, gpu: &Picture) -> Apart {
    compare(scene, cpu, gpu, EDGE)
}

fn compare(scene: &Scene, cpu: &Picture, gpu: &Picture, edge: f64) -> Apart {
    let apart = apart(cpu, gpu, |i| inside(cpu, gpu, i) && well_placed(scene, SIZE, i, SIDE as f64, edge));
    assert!(apart.pixels as f64 > COMPARED * apart.covered as f64, "too few pixels are compared: {apart:?}");
    apart
}

#[test]
fn unfiltered_pictures_of_every_model_and_shape_match() {
    let gpu = gpu();
    let models = models();
    for (place, (name, scene)) in scenes(View::Near).iter().enumerate() {
        let mut pictures = GpuPictures::new(&gpu, scene, DETAIL);
        let round = matches!(*scene.shape, Shape::Sphere(_) | Shape::Torus(_));
        let allowed = if round { SAME_TEXELS_ROUND } else { SAME_TEXELS };
        for (index, (shading, maps)) in models.iter().enumerate() {
            // Each model uses another form on the next shape.
            let (form, base) = FORMS[(place + index) % FORMS.len()];
            let draw = options(unfiltered(), shading_options(form, base));
            let cpu = by_cpu(scene, *shading, maps, &draw, SIZE);
            let gpu = pictures.render(scene, *shading, maps, &draw, SIZE).expect("a picture");
            let apart = apart_within_texels(scene, &cpu, &gpu);
            assert!(apart.largest < allowed, "{name}, {shading} ({index}), {form}: {apart:?}");
            assert!(apart.covered > 1000, "{name}: {apart:?}");
        }
    }
}

#[test]
fn resolved_bumps_are_those_of_the_cpu() {
    let gpu = gpu();
    for (name, scene) in scenes(View::Mid) {
        let mut pictures = GpuPictures::new(&gpu, &scene, DETAIL);
        for shading in [Shading::Lean, Shading::Clean, Shading::BlinnPhong, Shading::Ggx] {
            let resolved = with_filter(Filter::Anisotropic).with_bumps(Bumps::Resolved);
            let apart = both(&mut pictures, &scene, shading, &resolved);
            assert!(apart.mean < INTERPOLATED, "{name}, {shading}: {apart:?}");
            // They must differ from the filtered bumps.
            let maps = maps(shading, SampleType::F16);
            let filtered = by_cpu(&scene, shading, &maps, &with_filter(Filter::Anisotropic), SIZE);
            let gpu = pictures.render(&scene, shading, &maps, &resolved, SIZE).expect("a picture");
            let other = apart_within_texels(&scene, &filtered, &gpu);
            assert!(other.mean > 10.0 * INTERPOLATED, "{name}, {shading}: {other:?}");
        }
    }
}

#[test]
fn interpolated_pictures_agree_at_a_known_level() {
    let gpu = gpu();
    for (name, scene) in scenes(View::Mid) {
        let mut pictures = GpuPictures::new(&gpu, &scene, DETAIL);
        for level in [0.0, 1.5, 3.0] {
            for shading in [Shading::Lean, Shading::OffCentre, Shading::Ggx] {
                let sampler = Sampler::default().with_filter(Filter::Trilinear).with_level(Some(level));
                let draw = options(sampler, shading_options(Form::Physical, BaseFrame::Plane));
                let apart = both(&mut pictures, &scene, shading, &draw);
                assert!(apart.mean < INTERPOLATED, "{name}, {shading}, level {level}: {apart:?}");
            }
        }
    }
}

#[test]
fn trilinear_pictures_agree_in_the_mean_with_and_without_a_bias() {
    let gpu = gpu();
    for (name, scene) in scenes(View::Mid) {
        let mut pictures = GpuPictures::new(&gpu, &scene, DETAIL);
        for (shading, bias) in Shading::ALL.iter().zip([0.0, 0.0, 1.0].into_iter().cycle()) {
            let sampler = Sampler::default().with_filter(Filter::Trilinear).with_mip_bias(bias);
            let draw = options(sampler, shading_options(Form::Physical, BaseFrame::Plane));
            let apart = both(&mut pictures, &scene, *shading, &draw);
            assert!(apart.mean < OWN_LEVEL, "{name}, {shading}, bias {bias}: {apart:?}");
        }
    }
}

#[test]
fn anisotropic_pictures_agree_in_the_mean_and_moments_keep_the_highlights_energy() {
    let gpu = gpu();
    for view in [View::Mid, View::Grazing] {
        for (name, scene) in scenes(view) {
            let mut pictures = GpuPictures::new(&gpu, &scene, DETAIL);
            for shading in [Shading::Lean, Shading::Clean, Shading::BlinnPhong] {
                let apart = both(&mut pictures, &scene, shading, &with_filter(Filter::Anisotropic));
                assert!(apart.mean < own_taps(view), "{view}, {name}, {shading}: {apart:?}");
                let keeps_energy = matches!(shading, Shading::Lean | Shading::Clean);
                assert!(!keeps_energy || apart.energy.abs() < ENERGY, "{view}, {name}, {shading}: {apart:?}");
            }
        }
    }
}

/// The difference between the CPU's and the GPU's pictures, with half-float maps.
fn both(pictures: &mut GpuPictures, scene: &Scene, shading: Shading, draw: &DrawOptions) -> Apart {
    let maps = maps(shading, SampleType::F16);
    let cpu = by_cpu(scene, shading, &maps, draw, SIZE);
    let gpu = pictures.render(scene, shading, &maps, draw, SIZE).expect("a picture");
    compare(scene, &cpu, &gpu, 0.0)
}

#[test]
fn the_comparisons_fail_when_they_should() {
    let scene = scene(Shape::Plane(Plane::default()), View::Mid);
    let mut pictures = GpuPictures::new(&gpu(), &scene, 4);
    let unfiltered = options(unfiltered(), shading_options(Form::Normalised, BaseFrame::Plane));
    let cpu =
        |shading, draw: &DrawOptions| by_cpu(&scene, shading, &maps(shading, SampleType::F16), draw, SIZE);
    let mut gpu = |shading, draw: &DrawOptions| {
        pictures.render(&scene, shading, &maps(shading, SampleType::F16), draw, SIZE).expect("a picture")
    };
    let lean = gpu(Shading::Lean, &unfiltered);
    let same = apart_within_texels(&scene, &cpu(Shading::Lean, &unfiltered), &lean);
    assert!(same.largest < SAME_TEXELS, "{same:?}");
    // Another model, another form, a base that differs by a hundredth, and a picture shifted by a pixel.
    let mut darker = unfiltered;
    darker.shading_options.specular_power *= 1.01;
    let mut paper = unfiltered;
    paper.shading_options.form = Form::Paper;
    let mut shifted = cpu(Shading::Lean, &unfiltered);
    shifted.radiance_mut().rotate_right(1);
    shifted.specular_mut().rotate_right(1);
    let others = [
        cpu(Shading::BlinnPhong, &unfiltered),
        cpu(Shading::Lean, &paper),
        cpu(Shading::Lean, &darker),
        shifted,
    ];
    for (index, other) in others.iter().enumerate() {
        let apart = apart_within_texels(&scene, other, &lean);
        assert!(apart.largest > SAME_TEXELS_ROUND, "{index}: {apart:?}");
    }
    // The means also detect another filter, another level, another wrap and another model.
    let at = |level, wrap| {
        let sampler =
            Sampler::default().with_filter(Filter::Trilinear).with_level(Some(level)).with_wrap(wrap);
        options(sampler, unfiltered.shading_options)
    };
    let interpolated = gpu(Shading::Lean, &at(1.0, Wrap::Repeat));
    for other in [at(1.1, Wrap::Repeat), at(1.0, Wrap::Mirror), unfiltered] {
        let apart = compare(&scene, &cpu(Shading::Lean, &other), &interpolated, 0.0);
        assert!(apart.mean > INTERPOLATED, "{other:?}: {apart:?}");
    }
    let other = cpu(Shading::Clean, &at(1.0, Wrap::Repeat));
    assert!(compare(&scene, &other, &interpolated, 0.0).mean > INTERPOLATED);
    let mut broken = lean.clone();
    broken.radiance_mut().fill([f32::NAN; 3]);
    assert_eq!(apart_within_texels(&scene, &lean, &broken).largest, f64::INFINITY);
}

#[test]
fn the_comparisons_of_filters_fail_when_they_should() {
    let gpu = gpu();
    let with = |filter, mip_bias, power: f32| {
        let mut draw = with_filter(filter);
        draw.sampler.mip_bias = mip_bias;
        draw.shading_options.specular_power *= power;
        draw
    };
    for view in [View::Mid, View::Grazing] {
        let scene = scene(Shape::Plane(Plane::default()), view);
        let mut pictures = GpuPictures::new(&gpu, &scene, DETAIL);
        for shading in [Shading::Lean, Shading::Clean, Shading::BlinnPhong] {
            let maps = maps(shading, SampleType::F16);
            let mut against = |filter, other: DrawOptions| {
                let right = with(filter, 0.0, 1.0);
                let gpu = pictures.render(&scene, shading, &maps, &right, SIZE).expect("a picture");
                compare(&scene, &by_cpu(&scene, shading, &maps, &other, SIZE), &gpu, 0.0)
            };
            let what = format!("{view}, {shading}");
            // A level that is off by half a level.
            for bias in [0.5, -0.5] {
                let apart = against(Filter::Trilinear, with(Filter::Trilinear, bias, 1.0));
                assert!(apart.mean > OWN_LEVEL, "{what}, bias {bias}: {apart:?}");
            }
            // No filter, and a filter that is twice as wide, or eight times in the grazing view.
            let wider = if view == View::Grazing { 3.0 } else { 1.0 };
            for other in [with(Filter::Nearest, 0.0, 1.0), with(Filter::Anisotropic, wider, 1.0)] {
                let apart = against(Filter::Anisotropic, other);
                assert!(apart.mean > own_taps(view), "{what}, {other:?}: {apart:?}");
            }
            // A wrong base roughness, and a model that loses the highlight at a wrong level.
            let other = match shading {
                Shading::BlinnPhong => with(Filter::Anisotropic, 2.0, 1.0),
                _ => with(Filter::Anisotropic, 0.0, 1.5),
            };
            let apart = against(Filter::Anisotropic, other);
            assert!(view == View::Grazing || apart.energy.abs() > ENERGY, "{what}: {apart:?}");
        }
    }
}

#[test]
fn round_shapes_converge_as_their_triangles_shrink() {
    let gpu = gpu();
    let scene = scene(Shape::Torus(Torus::default()), View::Near);
    let draw = options(unfiltered(), shading_options(Form::Normalised, BaseFrame::Plane));
    let maps = maps(Shading::Lean, SampleType::F16);
    let cpu = by_cpu(&scene, Shading::Lean, &maps, &draw, SIZE);
    let [coarse, fine] = [64, 256].map(|detail| {
        let mut pictures = GpuPictures::new(&gpu, &scene, detail);
        let gpu = pictures.render(&scene, Shading::Lean, &maps, &draw, SIZE).expect("a picture");
        apart_within_texels(&scene, &cpu, &gpu).mean
    });
    // Four times as many triangles each way give a sixteenth of the difference where only their flatness matters.
    assert!(coarse > 8.0 * fine, "{coarse:e} and {fine:e}");
}

#[test]
fn every_format_and_wrap_is_read_as_the_cpu_reads_it() {
    let gpu = gpu();
    // Far enough away for the map to repeat.
    let scene = scene(Shape::Plane(Plane::default()), View::Mid);
    assert!(scene.repeats > 1.5, "{}", scene.repeats);
    let mut pictures = GpuPictures::new(&gpu, &scene, 4);
    for bits in [SampleType::U8, SampleType::U16, SampleType::F16, SampleType::F32] {
        for wrap in [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror] {
            let sampler = unfiltered().with_wrap(wrap);
            let draw = options(sampler, shading_options(Form::Physical, BaseFrame::Plane));
            let maps = maps(Shading::Lean, bits);
            let cpu = by_cpu(&scene, Shading::Lean, &maps, &draw, SIZE);
            let gpu = pictures.render(&scene, Shading::Lean, &maps, &draw, SIZE).expect("a picture");
            let apart = apart_within_texels(&scene, &cpu, &gpu);
            assert!(apart.largest < SAME_TEXELS, "{bits}, {wrap}: {apart:?}");
        }
    }
}

#[test]
fn no_light_and_many_lights_give_their_sum() {
    let gpu = gpu();
    let mut scene = scene(Shape::Sphere(Sphere), View::Near);
    let mut pictures = GpuPictures::new(&gpu, &scene, DETAIL);
    let light = scene.lights[1];
    let draw = options(unfiltered(), shading_options(Form::Normalised, BaseFrame::Plane));
    for count in [0, 1, 3, 300] {
        scene.lights = vec![light; count];
        let maps = maps(Shading::Clean, SampleType::F16);
        let cpu = by_cpu(&scene, Shading::Clean, &maps, &draw, SIZE);
        let gpu = pictures.render(&scene, Shading::Clean, &maps, &draw, SIZE).expect("a picture");
        let apart = apart_within_texels(&scene, &cpu, &gpu);
        assert!(apart.largest < SAME_TEXELS_ROUND, "{count} lights: {apart:?}");
    }
}
