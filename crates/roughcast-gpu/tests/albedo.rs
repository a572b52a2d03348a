//! Maps of diffuse colours: pictures by the GPU against those by the CPU, and what a drawing does when its scene gets
//! another map.

mod common;

use std::sync::Arc;

use common::pictures::{Apart, GpuPictures, apart, by_cpu, inside, options, well_placed};
use common::scenes::{SIDE, SIZE, maps, scene, scenes};
use common::{gpu, gpu_of_the_web};
use pollster::block_on;
use roughcast::shading::{Shading, ShadingOptions};
use roughcast::{SampleType, Wrap};
use roughcast_gpu::render::{
    Bumps, DetailCode, DrawOptions, Geometry, GpuDetail, RenderTarget, Renderer, render,
};
use roughcast_gpu::{Gpu, GpuError};
use roughcast_scene::{AlbedoMap, Filter, Picture, Plane, Sampler, Scene, Shape, Sphere, Torus, View};

/// Number of squares along v in the mesh of a round shape.
const DETAIL: u32 = 256;
/// As in `pictures.rs`, with the rounding of the colours to half floats, 5e-4, in addition.
const SAME_TEXELS: f64 = 1.5e-3;
/// As in `pictures.rs`: flat triangles that stand for round shapes.
const SAME_TEXELS_ROUND: f64 = 2e-2;
/// As in `pictures.rs`: mean difference where hardware interpolates at a known level.
const INTERPOLATED: f64 = 2e-3;
/// The same on round shapes, where flat triangles move colours that change at random from texel to texel. Largest measured:
/// 2.1e-3, on the torus.
const INTERPOLATED_ROUND: f64 = 4e-3;
/// As in `pictures.rs`: mean difference where hardware computes the level of detail.
const OWN_LEVEL: f64 = 2.5e-2;
/// As in `pictures.rs`: mean difference with the taps of a driver.
const OWN_TAPS: f64 = 0.05;
/// Distance from a texel edge, in texels, within which rounding decides which texel is read.
const EDGE: f64 = 0.02;
/// Largest difference between a map of one colour, exact in a half float, and that colour: weights that sum to one with
/// the error of a driver's arithmetic.
const SAME_COLOUR: f64 = 1e-5;

/// Random colours from dark to bright, each texel another one.
fn colours(width: usize, height: usize) -> Arc<AlbedoMap> {
    let code = |i: usize| ((i * 2_654_435_761) >> 7) % 256;
    let colour = |i: usize| [3 * i, 3 * i + 1, 3 * i + 2].map(|i| 0.05 + code(i) as f32 / 300.0);
    let colours: Vec<_> = (0..width * height).map(colour).collect();
    Arc::new(AlbedoMap::new(width, height, &colours).expect("they are valid"))
}

fn with_map(scene: &Scene, map: &Arc<AlbedoMap>) -> Scene {
    Scene { albedo: Some(Arc::clone(map)), ..scene.clone() }
}

fn sampled(sampler: Sampler) -> DrawOptions {
    options(sampler, ShadingOptions::default().with_specular_power(common::scenes::SPECULAR_POWER))
}

/// The difference between the CPU's and the GPU's pictures.
fn both(pictures: &mut GpuPictures, scene: &Scene, draw: &DrawOptions, edge: f64) -> Apart {
    let maps = maps(Shading::Lean, SampleType::F16);
    let cpu = by_cpu(scene, Shading::Lean, &maps, draw, SIZE);
    let gpu = pictures.render(scene, Shading::Lean, &maps, draw, SIZE).expect("a picture");
    let apart =
        apart(&cpu, &gpu, |i| inside(&cpu, &gpu, i) && well_placed(scene, SIZE, i, SIDE as f64, edge));
    assert!(apart.covered > 1000 && apart.pixels > apart.covered / 2, "{apart:?}");
    apart
}

#[test]
fn unfiltered_colours_are_those_of_the_cpu_on_every_shape() {
    let gpu = gpu();
    // The edges of its texels are among those of the bumps.
    let map = colours(SIDE, SIDE / 2);
    for (name, scene) in scenes(View::Near) {
        let scene = with_map(&scene, &map);
        let mut pictures = GpuPictures::new(&gpu, &scene, DETAIL);
        let round = matches!(*scene.shape, Shape::Sphere(_) | Shape::Torus(_));
        let allowed = if round { SAME_TEXELS_ROUND } else { SAME_TEXELS };
        for wrap in [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror] {
            let draw = sampled(
                Sampler::default().with_filter(Filter::Nearest).with_level(Some(0.0)).with_wrap(wrap),
            );
            let apart = both(&mut pictures, &scene, &draw, EDGE);
            assert!(apart.largest < allowed, "{name}, {wrap}: {apart:?}");
        }
    }
}

#[test]
fn filtered_colours_agree_with_those_of_the_cpu() {
    let gpu = gpu();
    // Sides that are not powers of two, other than those of the bumps. With anisotropy, Mesa's software driver reads other
    // texels of such textures than without: the pictures are 0.08 apart, and 0.003 without.
    let (odd, even) = (colours(45, 70), colours(64, 64));
    let trilinear = Sampler::default().with_filter(Filter::Trilinear);
    for shape in [Shape::Plane(Plane::default()), Shape::Sphere(Sphere), Shape::Torus(Torus::default())] {
        let scene = scene(shape, View::Mid);
        let interpolated =
            if matches!(*scene.shape, Shape::Plane(_)) { INTERPOLATED } else { INTERPOLATED_ROUND };
        let mut pictures = GpuPictures::new(&gpu, &scene, DETAIL);
        for (map, draw, allowed) in [
            (&odd, sampled(trilinear.with_level(Some(0.0))), interpolated),
            (&odd, sampled(trilinear.with_level(Some(1.5))), interpolated),
            (&odd, sampled(Sampler::default()).with_bumps(Bumps::Resolved), interpolated),
            (&odd, sampled(trilinear), OWN_LEVEL),
            (&odd, sampled(trilinear.with_mip_bias(1.0)), OWN_LEVEL),
            (&even, sampled(Sampler::default()), OWN_TAPS),
        ] {
            let apart = both(&mut pictures, &with_map(&scene, map), &draw, 0.0);
            assert!(apart.mean < allowed, "{draw:?}: {apart:?}");
        }
    }
}

#[test]
fn the_comparisons_of_colours_fail_when_they_should() {
    let gpu = gpu();
    let map = colours(45, 70);
    let scene = with_map(&scene(Shape::Plane(Plane::default()), View::Mid), &map);
    let mut pictures = GpuPictures::new(&gpu, &scene, DETAIL);
    let maps = maps(Shading::Lean, SampleType::F16);
    let at = |level| sampled(Sampler::default().with_filter(Filter::Trilinear).with_level(Some(level)));
    let gpu = pictures.render(&scene, Shading::Lean, &maps, &at(1.5), SIZE).expect("a picture");
    let without = Scene { albedo: None, ..scene.clone() };
    let turned = with_map(&scene, &colours(70, 45));
    let others = [(&without, 1.5), (&turned, 1.5), (&scene, 1.0)];
    for (index, (other, level)) in others.into_iter().enumerate() {
        let cpu = by_cpu(other, Shading::Lean, &maps, &at(level), SIZE);
        let apart = apart(&cpu, &gpu, |i| inside(&cpu, &gpu, i));
        assert!(apart.mean > 5.0 * INTERPOLATED, "{index}: {apart:?}");
    }
}

/// The pictures of a drawing whose scene changes, with textures or with code.
fn frames(gpu: &Gpu, detail: &GpuDetail, scenes: &[Scene]) -> Result<Vec<Picture>, GpuError> {
    block_on(async {
        let mut renderer = Renderer::new(gpu, RenderTarget::Parts).await?;
        let geometry = Geometry::new(gpu, &scenes[0].shape, DETAIL).await?;
        let mut drawing = renderer.prepare(&geometry, detail, &DrawOptions::default()).await?;
        let mut frames = Vec::new();
        for scene in scenes {
            frames.push(render(&renderer, &mut drawing, scene, SIZE).await?);
            // The drawing keeps its map when its options change.
            let nearest = sampled(Sampler::default().with_filter(Filter::Nearest));
            drawing.set_options(&mut renderer, &nearest).await?;
            drawing.set_options(&mut renderer, &DrawOptions::default()).await?;
            let again = render(&renderer, &mut drawing, scene, SIZE).await?;
            assert!(frames.last() == Some(&again), "the same scene gives the same picture");
        }
        Ok(frames)
    })
}

const FLAT: DetailCode = DetailCode::new(
    "fn detail_slope(at: DetailPoint) -> vec2f { return vec2f(0.0); }
    fn detail_distribution(at: DetailPoint) -> Distribution { return distribution_of_slope(vec2f(0.0)); }",
);

#[test]
fn a_map_of_one_colour_is_that_colour_and_a_drawing_follows_its_scene() {
    let gpu = gpu();
    let mut plain = scene(Shape::Plane(Plane::default()), View::Mid);
    plain.material = plain.material.with_albedo([0.5, 0.25, 0.125]);
    let constant = AlbedoMap::new(5, 3, &[[0.5, 0.25, 0.125]; 15]).expect("it is valid");
    let one = with_map(&plain, &Arc::new(constant));
    let many = with_map(&plain, &colours(8, 8));
    let details = [
        block_on(GpuDetail::of_model(&gpu, Shading::Lean, &maps(Shading::Lean, SampleType::F16)))
            .expect("textures"),
        GpuDetail::of_code(Shading::Lean, FLAT),
    ];
    for detail in details {
        let scenes = [plain.clone(), one.clone(), many.clone(), one.clone(), plain.clone()];
        let frames = frames(&gpu, &detail, &scenes).expect("pictures");
        let same = apart(&frames[0], &frames[1], |_| true);
        assert!(same.largest < SAME_COLOUR, "{same:?}");
        assert!(apart(&frames[0], &frames[2], |_| true).mean > 0.05, "another map is another picture");
        assert!(frames[1] == frames[3] && frames[0] == frames[4]);
    }
}

#[test]
fn maps_of_colours_fit_into_the_limits_of_the_web() {
    let gpu = gpu_of_the_web();
    let plain = scene(Shape::Plane(Plane::default()), View::Mid);
    let detail = block_on(GpuDetail::of_model(&gpu, Shading::Lean, &maps(Shading::Lean, SampleType::F16)));
    let detail = detail.expect("half floats are everywhere");
    frames(&gpu, &detail, &[with_map(&plain, &colours(8, 8))]).expect("a picture");
    let wide =
        with_map(&plain, &Arc::new(AlbedoMap::new(20_000, 1, &vec![[0.5; 3]; 20_000]).expect("it is valid")));
    let line = frames(&gpu, &detail, &[wide]).expect_err("too wide").to_string();
    assert!(line.contains("20000") && !line.contains('\n'), "{line}");
}
