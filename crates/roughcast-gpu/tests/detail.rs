//! Sources of bumps other than the textures of a model's own layout: textures of any layout, and code without textures.

mod common;

use common::drawn::{by_cpu, by_gpu, compared, options};
use common::gpu;
use common::scenes::{maps, scenes};
use glam::DVec3;
use roughcast::shading::{Shading, ShadingOptions};
use roughcast::texture::{Base, Layout};
use roughcast::{BakeOptions, Covariance, Distribution, SampleType, Slope};
use roughcast_gpu::GpuError;
use roughcast_gpu::render::{Bumps, DetailCode, DrawOptions, GpuDetail};
use roughcast_scene::{BakedTextures, Detail, DetailPoint, Filter, Resolved, Sampler, Shape, View};

/// Mean difference of radiance between the renderers: single against double precision on flat shapes, and triangles that
/// lie within 2e-5 of round ones. Largest measured: 5.4e-5, on the torus.
const SAME_BUMPS: f64 = 5e-4;
/// Mean difference with textures that graphics hardware interpolates at a known level, as in `pictures.rs`.
const INTERPOLATED: f64 = 2e-3;

const WASHBOARD: DetailCode = DetailCode::new(include_str!("washboard.wgsl"));

/// The twin of `washboard.wgsl`.
struct Washboard;

const WAVE: DVec3 = DVec3::new(2.0, 0.5, 1.0);
const HEIGHT: f64 = 0.2;

impl Detail for Washboard {
    fn slope(&self, at: &DetailPoint<'_>) -> Slope {
        let hit = at.hit();
        let gradient = HEIGHT * WAVE.dot(hit.position).cos() * WAVE;
        let slope = -hit.frame.tangent_from_world(gradient);
        Slope { x: slope.x as f32, y: slope.y as f32 }
    }

    fn distribution(&self, at: &DetailPoint<'_>, _: &ShadingOptions) -> Distribution {
        let Slope { x, y } = self.slope(at);
        let along = HEIGHT * at.hit().frame.tangent_from_world(WAVE);
        let [xx, yy, xy] =
            [along.x * along.x, along.y * along.y, along.x * along.y].map(|part| 0.25 * part as f32);
        Distribution::gaussian(Slope { x: 0.5 * x, y: 0.5 * y }, Covariance { xx, yy, xy })
            .with_base(Base::None)
    }
}

#[test]
fn code_without_textures_gives_the_picture_of_its_twin_on_the_cpu() {
    let gpu = gpu();
    for (name, scene) in scenes(View::Mid) {
        for shading in [Shading::Lean, Shading::Ggx, Shading::BlinnPhong, Shading::Toksvig] {
            let detail = GpuDetail::of_code(shading, WASHBOARD);
            for bumps in [Bumps::Filtered, Bumps::Resolved] {
                let draw = DrawOptions::default().with_shading_options(options()).with_bumps(bumps);
                let there = by_gpu(&gpu, &scene, &detail, &draw).expect("a picture");
                let [filtered, resolved] =
                    [by_cpu(&scene, shading, &Washboard), by_cpu(&scene, shading, &Resolved(&Washboard))];
                let (here, other) =
                    if bumps == Bumps::Filtered { (&filtered, &resolved) } else { (&resolved, &filtered) };
                let same = compared(here, &there);
                assert!(same.mean < SAME_BUMPS && same.covered > 1000, "{name}, {shading}: {same:?}");
                let other = compared(other, &there);
                assert!(other.mean > 10.0 * SAME_BUMPS, "{name}, {shading}: {other:?}");
            }
        }
    }
}

#[test]
fn any_model_shades_the_textures_of_any_layout() {
    let gpu = gpu();
    let (_, scene) = scenes(View::Mid)
        .into_iter()
        .find(|(_, scene)| matches!(*scene.shape, Shape::Plane(_)))
        .expect("a plane");
    let sampler = Sampler::default().with_filter(Filter::Trilinear).with_level(Some(1.5));
    for layout in [Layout::Lean, Layout::Schilling, Layout::SchillingIsotropic, Layout::Variance, Layout::Pbr]
    {
        let arrays = common::scenes::maps_with(
            BakeOptions::default().with_layout(layout).with_sample_type(SampleType::F16),
        );
        for shading in [Shading::Lean, Shading::Ggx, Shading::OffCentre] {
            let textures = BakedTextures::new(shading.wanted(), &arrays).expect("its own textures");
            let here = by_cpu(&scene, shading, &textures.sampled(sampler));
            let detail =
                pollster::block_on(GpuDetail::of_textures(&gpu, shading, &arrays)).expect("textures");
            let draw = DrawOptions::default().with_sampler(sampler).with_shading_options(options());
            let there = by_gpu(&gpu, &scene, &detail, &draw).expect("a picture");
            let same = compared(&here, &there);
            assert!(same.mean < INTERPOLATED && same.covered > 1000, "{layout}, {shading}: {same:?}");
        }
    }
    // The model's own layout is another source.
    let own =
        pollster::block_on(GpuDetail::of_model(&gpu, Shading::Ggx, &maps(Shading::Lean, SampleType::F16)));
    assert!(matches!(own, Err(GpuError::Detail(_))), "GGX is made for 'pbr'");
}

#[test]
fn faulty_code_is_refused_in_one_line() {
    let gpu = gpu();
    let (_, scene) = scenes(View::Mid).remove(0);
    let line = |code: DetailCode| {
        let detail = GpuDetail::of_code(Shading::Lean, code);
        let result = by_gpu(&gpu, &scene, &detail, &DrawOptions::default());
        let line = result.expect_err("it is faulty").to_string();
        assert!(!line.contains('\n'), "{line}");
        line
    };
    let missing = line(DetailCode::new("fn detail_slope(at: DetailPoint) -> vec2f { return vec2f(0.0); }"));
    assert!(missing.contains("detail_distribution"), "{missing}");
    let unknown = line(WASHBOARD.with_needs(&["perlin"]));
    assert!(unknown.contains("'perlin'"), "{unknown}");
}
