//! The interface between sources of bumps and renderers: baked textures return the same distribution as the slopes
//! themselves.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use roughcast::shading::{Shading, ShadingOptions, Wanted};
use roughcast::texture::{Layout, TextureArray};
use roughcast::{Bake, BakeOptions, Covariance, Distribution, Slope, Wrap};
use roughcast_scene::render::{Method, Truth, unwatched};
use roughcast_scene::{
    BakedTextures, Camera, Detail, DetailPoint, Filter, Hit, Light, Mesh, Picture, Placement, Plane, Ray,
    Reconstruction, Resolved, Sampler, Scene, Shape, SlopeDetail, SlopeMap, TriangleMesh, pattern,
};

const SIDE: usize = 64;

/// Bumps that repeat.
fn bumps() -> pattern::Pattern {
    pattern::random_bumps(SIDE, 0.15, 5)
}

fn slopes() -> SlopeDetail {
    let bumps = bumps();
    SlopeDetail::new(SlopeMap::of(&bumps.heights, &bumps.source_options()).expect("a map"), Wrap::Repeat)
}

/// The bumps baked in a layout, as floats if it supports them.
fn baked(layout: Layout) -> Vec<TextureArray> {
    let bumps = bumps();
    let bits = *layout.sample_types().last().expect("a layout has sample types");
    let options = BakeOptions::default().with_layout(layout).with_sample_type(bits);
    let base = roughcast::BaseRoughness::Variance(1.0 / 64.0);
    let bake = Bake::of(&bumps.heights).source(bumps.source_options()).options(options).roughness(base);
    bake.run().expect("a map").arrays
}

/// Points of a plane seen from above, with this many texels per pixel.
fn points(texels: f64) -> (Shape, Vec<(Ray, Ray, Ray)>) {
    let plane = Shape::Plane(Plane::default());
    // The map spans two units of the plane.
    let pixel = texels * 2.0 / SIDE as f64;
    let down = |x: f64, z: f64| Ray { origin: DVec3::new(x, 1.0, z), direction: DVec3::NEG_Y };
    let rays = (0..40).map(|i| {
        let at = DVec2::new((f64::from(i) * 0.618).fract(), (f64::from(i) * 0.414).fract()) * 1.2 - 0.6;
        (down(at.x, at.y), down(at.x + pixel, at.y), down(at.x, at.y + pixel))
    });
    (plane, rays.collect())
}

/// Root of the mean squared error of mean slopes and of traces over the points, each relative to the reference's mean
/// square.
fn errors(reference: &dyn Detail, tested: &dyn Detail, texels: f64) -> [f64; 2] {
    let (shape, rays) = points(texels);
    let options = ShadingOptions::default();
    let (mut off, mut whole) = ([0.0; 2], [0.0; 2]);
    for (ray, right, below) in &rays {
        let hit = shape.hit(ray).expect("the plane");
        let at = DetailPoint::under_pixel(&hit, 1.0, (0, 0), right, below);
        let (a, b) =
            (reference.distribution(&at, &options).whole(), tested.distribution(&at, &options).whole());
        let Slope { x, y } = b.mean - a.mean;
        off[0] += f64::from(x * x + y * y);
        whole[0] += f64::from(a.mean.x * a.mean.x + a.mean.y * a.mean.y);
        off[1] += f64::from(b.covariance.trace() - a.covariance.trace()).powi(2);
        whole[1] += f64::from(a.covariance.trace()).powi(2);
    }
    [0, 1].map(|i| (off[i] / whole[i]).sqrt())
}

#[test]
fn lean_textures_answer_what_the_slopes_under_the_pixel_are() {
    /// EWA's Gaussian is the pixel filter's, applied to texels that average four per axis; the box of that average
    /// remains as error.
    const MEAN: f64 = 0.25;
    const VARIANCE: f64 = 0.15;
    let textures = BakedTextures::new(Wanted::Distribution, &baked(Layout::Lean)).expect("LEAN");
    let sampler = Sampler::default().with_filter(Filter::Ewa);
    for texels in [3.0, 6.0] {
        let [mean, variance] = errors(&slopes(), &textures.sampled(sampler), texels);
        assert!(mean < MEAN && variance < VARIANCE, "{texels} texels: {mean} and {variance}");
    }
    // A map with half the bumps' height is detected.
    let flatter = Scaled(textures.sampled(sampler));
    let [mean, variance] = errors(&slopes(), &flatter, 6.0);
    assert!(mean > MEAN && variance > VARIANCE, "{mean} and {variance}");
}

/// Another source of bumps, with slopes half as steep, which shows that the interface can be implemented outside the
/// crate.
struct Scaled<D>(D);

const HALF: [[f32; 2]; 2] = [[0.5, 0.0], [0.0, 0.5]];

impl<D: Detail> Detail for Scaled<D> {
    fn slope(&self, at: &DetailPoint<'_>) -> Slope {
        self.0.slope(at).transformed(HALF)
    }

    fn distribution(&self, at: &DetailPoint<'_>, options: &ShadingOptions) -> Distribution {
        self.0.distribution(at, options).transformed(HALF)
    }
}

#[test]
fn every_layout_that_a_sampler_reads_answers_both_questions() {
    let (shape, rays) = points(4.0);
    let reference = slopes();
    let mut layouts = 0;
    for layout in Layout::ALL.iter().copied() {
        let Ok(textures) = BakedTextures::new(Wanted::Distribution, &baked(layout)) else { continue };
        layouts += 1;
        let detail = textures.sampled(Sampler::default().with_filter(Filter::Trilinear));
        let options = detail.options(ShadingOptions::default().with_specular_power(64.0));
        let (mut near, mut trace) = (0.0_f32, 0.0_f32);
        for (ray, right, below) in &rays {
            let hit = shape.hit(ray).expect("the plane");
            let at = DetailPoint::under_pixel(&hit, 1.0, (0, 0), right, below);
            let (a, b) = (reference.slope(&at), detail.slope(&at));
            near = near.max((a.x - b.x).abs()).max((a.y - b.y).abs());
            let seen = detail.distribution(&at, &options);
            assert_eq!(seen.gaussians().len(), 1, "{layout}");
            let base = roughcast::shading::base_in_map(seen.base(), &options);
            trace += seen.whole().covariance.trace() - 2.0 * base;
        }
        // Normals are interpolated as normals, so slopes between texels differ from interpolated slopes.
        assert!(near < 0.02, "{layout}: {near}");
        // Layouts of variances and of standard deviations omit the variance between texels; trilinear filters cover
        // more than the pixel.
        let found = trace / rays.len() as f32 / bump_variance();
        assert!((0.25..2.0).contains(&found), "{layout}: {found} of the variance");
    }
    assert!(layouts >= 7, "{layouts}");
}

/// Mean trace of the covariance under four texels, computed from the slopes themselves.
fn bump_variance() -> f32 {
    let (shape, rays) = points(4.0);
    let reference = slopes();
    let traces = rays.iter().map(|(ray, right, below)| {
        let hit = shape.hit(ray).expect("the plane");
        let at = DetailPoint::under_pixel(&hit, 1.0, (0, 0), right, below);
        reference.distribution(&at, &ShadingOptions::default()).whole().covariance.trace()
    });
    traces.sum::<f32>() / rays.len() as f32
}

#[test]
fn any_model_shades_any_layout() {
    let (shape, rays) = points(4.0);
    let (ray, right, below) = &rays[3];
    let hit = shape.hit(ray).expect("the plane");
    let at = DetailPoint::under_pixel(&hit, 1.0, (0, 0), right, below);
    let up = [0.0, 0.0, 1.0];
    for layout in [Layout::Lean, Layout::Clean, Layout::Schilling, Layout::Pbr] {
        let textures = BakedTextures::new(Wanted::Distribution, &baked(layout)).expect("its own textures");
        let detail = textures.sampled(Sampler::default());
        let options = detail.options(ShadingOptions::default().with_specular_power(20.0));
        for model in Shading::ALL {
            let lobe = model.surface_of(&detail.distribution(&at, &options), &options).lobe(up, up, &options);
            assert!(lobe.is_finite() && lobe > 0.0, "{model} on {layout}: {lobe}");
        }
    }
}

fn plane_scene() -> Scene {
    Scene {
        shape: Arc::new(Shape::Plane(Plane::default())),
        camera: Camera::new(DVec3::new(0.3, 1.1, 1.4), DVec3::ZERO, DVec3::Y, 0.7).expect("a camera"),
        lights: vec![Light::Directional {
            towards: DVec3::new(-0.3, 1.0, -0.4).normalize(),
            irradiance: Light::WHITE,
        }],
        material: Default::default(),
        albedo: None,
        repeats: 2.0,
        background: [0.0; 3],
    }
}

#[test]
fn resolved_detail_rendered_once_a_pixel_is_ground_truth_with_one_sample() {
    let detail = slopes();
    let options = ShadingOptions::default().with_specular_power(60.0);
    let (scene, size) = (plane_scene(), (48, 32));
    let method = Method { shading: Shading::Lean, detail: &Resolved(&detail), options };
    let once = method.render(&scene, size, &unwatched).expect("a picture");
    let truth = Truth { shading: Shading::Lean, detail: &detail, options, samples: 1024 };
    let many = truth.render(&scene, size, &unwatched).expect("a picture");
    let mean = |picture: &Picture| picture.specular().iter().map(|s| f64::from(s[0])).sum::<f64>();
    /// One sample for each of 1536 pixels compared with a thousand: noise of about a percent.
    const NOISE: f64 = 0.08;
    assert!((mean(&once) / mean(&many) - 1.0).abs() < NOISE, "{} and {}", mean(&once), mean(&many));
    assert!(once != many);
}

/// A quad whose second set of texture coordinates grows twice as fast along u and in the opposite direction along v.
fn quad() -> Shape {
    let corners = [[-1.0, 0.0], [1.0, 0.0], [1.0, 1.0], [-1.0, 1.0]];
    let mesh = TriangleMesh {
        positions: corners.map(|[x, y]| [x as f32, y as f32, 0.0]).to_vec(),
        uv_sets: vec![
            corners.map(|[x, y]| [0.5 * x as f32 + 0.5, 1.0 - y as f32]).to_vec(),
            corners.map(|[x, y]| [x as f32 + 1.0, y as f32]).to_vec(),
        ],
        indices: vec![0, 1, 2, 0, 2, 3],
        ..TriangleMesh::default()
    };
    Shape::Mesh(Arc::new(Mesh::new(vec![mesh]).expect("a quad")))
}

fn hit_of(shape: &Shape, x: f64, y: f64) -> (Hit<'_>, Ray, Ray) {
    let ray = |x: f64, y: f64| Ray { origin: DVec3::new(x, y, 1.0), direction: DVec3::NEG_Z };
    (shape.hit(&ray(x, y)).expect("the quad"), ray(x + 0.05, y), ray(x, y + 0.05))
}

#[test]
fn a_placement_by_the_second_set_looks_up_and_turns_slopes_by_it() {
    let shape = quad();
    let placed =
        slopes().placed(Placement::default().with_uv_set(1).with_world_height_per_texel(1.0 / SIDE as f64));
    let plain = slopes();
    let texture = SlopeMap::of(&bumps().heights, &bumps().source_options()).expect("a map");
    for (x, y) in [(0.13, 0.4), (-0.7, 0.21), (0.55, 0.83)] {
        let (hit, right, below) = hit_of(&shape, x, y);
        let at = DetailPoint::under_pixel(&hit, 1.0, (0, 0), &right, &below);
        // In the second set u is x + 1 and v is y, downwards in the texture: a texel is 1/64 of a unit along both axes.
        let stored = texture.at(DVec2::new(x + 1.0, y), Wrap::Repeat, Reconstruction::Linear);
        let found = placed.slope(&at);
        assert!(
            (found.x - stored.x).abs() < 1e-5 && (found.y + stored.y).abs() < 1e-5,
            "{found:?} {stored:?}"
        );
        assert_ne!(found, plain.slope(&at));
        // The distribution is mirrored like the slope: the mixed term changes its sign.
        let (seen, of_texture) = (
            placed.distribution(&at, &ShadingOptions::default()).whole(),
            slopes()
                .placed(Placement::default().with_uv_set(1))
                .distribution(&at, &ShadingOptions::default())
                .whole(),
        );
        let Covariance { xx, yy, xy } = of_texture.covariance;
        let close = |a: f32, b: f32| (a - b).abs() < 1e-5;
        assert!(
            close(seen.covariance.xx, xx) && close(seen.covariance.yy, yy) && close(seen.covariance.xy, -xy)
        );
        assert!(close(seen.mean.x, of_texture.mean.x) && close(seen.mean.y, -of_texture.mean.y));
    }
}
