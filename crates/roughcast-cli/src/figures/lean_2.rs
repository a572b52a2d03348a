//! LEAN Figure 2: bumps and ridges at the coarsest level.

use anyhow::Result;
use glam::{DVec2, DVec3};
use roughcast::shading::{Shading, ShadingOptions};
use roughcast::{Bake, Covariance, SampleType};
use roughcast_scene::pattern::{Pattern, random_bumps, random_ridges};
use roughcast_scene::{Camera, Filter, Picture, Sampler, Scene, Shape, Sphere, luminance};
use serde_json::{Map, Value, json};

use super::scene::{Stage, scene};
use super::{Figure, Panel, Table};
use crate::display::{exposure_of, shown};

const SPECULAR_POWER: f32 = 128.0;
const SIZE: (u32, u32) = (240, 240);
/// Texels along each side of the maps, as in the paper.
const TEXELS: usize = 512;
const RMS_SLOPE: f64 = 0.25;
/// Distance at which a pixel covers tens of texels.
const FAR_REPEATS: f64 = 64.0;
const SAMPLES: u32 = 256;
/// The largest allowed relative difference between the highlight's measured aspect ratio and the covariance's.
const ASPECT_ERROR: f64 = 0.05;
/// Half vectors farther out are at the rim of the sphere, where a pixel spans too many of them; a Gaussian as wide as
/// the widest here has less than a ten-thousandth of its weight there.
const FARTHEST: f64 = 1.5;

pub fn make() -> Result<Figure> {
    let mut figure = Parts::default();
    figure.add("bumps", random_bumps(TEXELS, RMS_SLOPE, 2))?;
    let [truth, lean] = figure.add("ridges", random_ridges(TEXELS, RMS_SLOPE, 2))?;
    let holds = truth.abs() <= ASPECT_ERROR && lean.abs() <= ASPECT_ERROR;
    Ok(Figure {
        title: "bumps become roughness, ridges a highlight with a direction",
        claim: format!(
            "far away the ridges' highlight is longer than wide: in the plane of h.xy / h.z its aspect ratio is sqrt(l1 / l2) of the \
             eigenvalues of covariance + I/s within {:.0} %, in the ground truth and with LEAN, while conventional mip maps keep it round",
            100.0 * ASPECT_ERROR
        ),
        numbers: figure.numbers,
        holds,
        making: format!(
            "Maps of {TEXELS}x{TEXELS} texels with a root mean square slope of {RMS_SLOPE}, s = {SPECULAR_POWER}, the paper's form; 16-bit \
             textures, and 8-bit ones beside them as in the paper. Finest and coarsest level by --level; ground truth of {SAMPLES} samples per \
             pixel with {FAR_REPEATS} repeats of the map. {}x{} pixels.",
            SIZE.0, SIZE.1
        ),
        panels: figure.panels,
        charts: Vec::new(),
        table: Some(Table {
            header: vec!["highlight", "variance 1", "variance 2", "aspect ratio", "expected"],
            rows: figure.rows,
        }),
    })
}

#[derive(Default)]
struct Parts {
    panels: Vec<Panel>,
    numbers: Map<String, Value>,
    rows: Vec<Vec<String>>,
}

impl Parts {
    /// Pictures and measurements of one map. Returns the errors of the aspect ratios of the ground truth and of LEAN in
    /// 16 bits.
    fn add(&mut self, name: &str, map: Pattern) -> Result<[f64; 2]> {
        let expected = expected(&map)?;
        let mut stage = stage(map);
        let last = f64::from((TEXELS as u32).ilog2());
        let at = |level| Sampler::default().with_filter(Filter::Trilinear).with_level(Some(level));

        let finest = stage.sampled(Shading::BlinnPhong, at(0.0))?;
        let ordinary = stage.sampled(Shading::BlinnPhong, at(last))?;
        let lean = stage.sampled(Shading::Lean, at(last))?;
        stage.sample_type = SampleType::U8;
        let lean_8 = stage.sampled(Shading::Lean, at(last))?;
        stage.scene.repeats = FAR_REPEATS;
        let truth = stage.truth(Shading::OffCentre, SAMPLES)?;

        let exposure = exposure_of(&truth);
        for (picture, what) in [
            (&finest, "finest level"),
            (&ordinary, "coarsest level, conventional"),
            (&lean, "coarsest level, LEAN"),
            (&truth, "truth, far away"),
        ] {
            self.panels.push(Panel { picture: shown(picture, exposure), caption: format!("{name}: {what}") });
        }
        let scene = &stage.scene;
        let mut off = |what: &str, picture: &Picture| self.measure(name, what, scene, picture, expected);
        off("ordinary", &ordinary);
        let lean_error = off("LEAN, 16 bits", &lean);
        off("LEAN, 8 bits", &lean_8);
        Ok([off("truth", &truth), lean_error])
    }

    fn measure(&mut self, name: &str, what: &str, scene: &Scene, picture: &Picture, expected: f64) -> f64 {
        let (large, small) = highlight(scene, picture).eigenvalues();
        let aspect = f64::from(large / small).sqrt();
        let error = aspect / expected - 1.0;
        self.numbers.insert(format!("{name}, {what}: aspect ratio"), json!(aspect));
        self.numbers.insert(format!("{name}, {what}: off by"), json!(error));
        self.rows.push(vec![
            format!("{name}, {what}"),
            format!("{large:.5}"),
            format!("{small:.5}"),
            format!("{aspect:.3}"),
            format!("{expected:.3}"),
        ]);
        error
    }
}

/// The aspect ratio that the whole map's covariance and the base roughness predict.
fn expected(map: &Pattern) -> Result<f64> {
    let levels = Bake::of(&map.heights).source(map.source_options()).moments()?;
    let covariance = levels.last().expect("there is a level").moments()[0].covariance();
    let base = 1.0 / SPECULAR_POWER;
    let with_base = covariance + Covariance::isotropic(base);
    let (large, small) = with_base.eigenvalues();
    Ok(f64::from(large / small).sqrt())
}

/// The covariance of the half vectors, as points `h.xy / h.z` of the surface's frame, weighted by the highlight.
fn highlight(scene: &Scene, picture: &Picture) -> Covariance {
    let (width, height) = (picture.width() as u32, picture.height() as u32);
    let (mut weight, mut sum, mut squares) = (0.0, DVec2::ZERO, [0.0; 3]);
    for y in 0..height {
        for x in 0..width {
            let (cx, cy) = (f64::from(x) + 0.5, f64::from(y) + 0.5);
            let half = |x: f64, y: f64| half_slope(scene, picture, x, y);
            let (Some(at), Some(right), Some(below)) = (half(cx, cy), half(cx + 0.5, cy), half(cx, cy + 0.5))
            else {
                continue;
            };
            if at.length() > FARTHEST {
                continue;
            }
            // The area in that plane that a pixel represents.
            let area = 4.0 * (right - at).perp_dot(below - at).abs();
            let w = area * f64::from(luminance(picture.specular()[(y * width + x) as usize]));
            weight += w;
            sum += w * at;
            squares =
                [squares[0] + w * at.x * at.x, squares[1] + w * at.y * at.y, squares[2] + w * at.x * at.y];
        }
    }
    let mean = sum / weight;
    Covariance {
        xx: (squares[0] / weight - mean.x * mean.x) as f32,
        yy: (squares[1] / weight - mean.y * mean.y) as f32,
        xy: (squares[2] / weight - mean.x * mean.y) as f32,
    }
}

/// `h.xy / h.z` at a point of the picture, in the local frame of the surface.
fn half_slope(scene: &Scene, picture: &Picture, x: f64, y: f64) -> Option<DVec2> {
    let ray = scene.camera.ray(x, y, picture.width() as u32, picture.height() as u32);
    let hit = scene.shape.hit(&ray)?;
    let (towards_light, _) = scene.lights[0].at(hit.position);
    let half = hit.frame.tangent_from_world(towards_light - ray.direction);
    (half.z > 0.0).then(|| half.truncate() / half.z)
}

/// A sphere with the light behind the camera, so that all relevant half vectors occur on it.
fn stage(map: Pattern) -> Stage {
    let eye = DVec3::new(0.0, 0.0, 12.0);
    let camera = Camera { eye, target: DVec3::ZERO, up: DVec3::Y, vertical_fov: 0.18 };
    let mut scene = scene(Shape::Sphere(Sphere), 2.0, camera, eye);
    scene.material.albedo = [0.02; 3];
    Stage {
        map,
        scene,
        options: ShadingOptions::published(SPECULAR_POWER),
        sample_type: SampleType::U16,
        size: SIZE,
    }
}
