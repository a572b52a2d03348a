//! Mikkelsen Figure 4: bump mapping by derivatives on the screen against normal mapping with tangents, on a mesh.

use std::sync::Arc;

use anyhow::Result;
use glam::DVec3;
use roughcast::noise::{Noise, NoiseKind};
use roughcast::shading::ShadingOptions;
use roughcast::{Distribution, Image, Samples, Slope, SourceOptions};
use roughcast_scene::pattern::Pattern;
use roughcast_scene::{
    Combined, Detail, DetailPoint, HeightDerivative, HeightDetail, HeightMap, NoiseDetail, Placement,
    Sampler, Scene, Shape, SlopeDetail, SlopeFrame, SlopeMap, Strengthened, TangentSource, Torus,
    TriangleMesh, pattern, repeats,
};
use serde_json::{Map, json};

use super::bumps::{Angles, angles, exact_normal, panels, picture, scene, shaded_normal, shape_of};
use super::given::{heights_or, textured_mesh};
use super::{Args, Figure, Table};

const SIZE: (u32, u32) = (360, 270);
/// The shape fills the picture.
const ZOOM: f64 = 1.25;
/// Texels per pixel of the whole view, and of the magnified one.
const WHOLE: f64 = 0.4;
const MAGNIFIED: f64 = 1.0 / 12.0;
/// The largest mean angle between the two methods, relative to the angle of the bumps themselves: Listing 1 differentiates
/// heights between pixels, the normal map between texels, and a tangent frame ignores how the texture is stretched.
const SAME: f64 = 0.25;
/// How much more of the magnified map's error the bicubic derivative must remove than the fine one.
const SMOOTHER: f64 = 3.0;
/// Repeats over the detail noise: cells per texel.
const CELLS_PER_TEXEL: f64 = 1.5;

/// A mesh with a height map.
struct Subject {
    shape: Shape,
    heights: Image,
    source: SourceOptions,
    name: String,
}

impl Subject {
    /// The mesh and the map of the arguments, or a torus with random bumps.
    fn new(args: &Args) -> Result<Self> {
        let (shape, mesh) = match textured_mesh(args)? {
            Some((mesh, name)) => (Shape::Mesh(Arc::new(mesh)), name),
            None => (shape_of(unstretched_torus())?, "a torus".to_owned()),
        };
        let heights =
            heights_or(args, || (pattern::random_bumps(256, 0.4, 3), "random bumps of 256x256".to_owned()))?;
        let name = format!("{} on {mesh}", heights.name);
        Ok(Self { shape, heights: heights.image, source: heights.source, name })
    }

    /// The scene in which a pixel spans this many texels.
    fn scene(&self, texels_per_pixel: f64) -> Scene {
        let mut scene = scene(self.shape.clone(), ZOOM);
        let texels = (self.heights.width(), self.heights.height());
        scene.repeats = repeats(&scene.shape, &scene.camera, texels, SIZE, texels_per_pixel).max(1e-3);
        scene
    }
}

/// A torus whose texture is stretched about equally in both directions, without tangents: MikkTSpace computes them.
fn unstretched_torus() -> TriangleMesh {
    let torus = Torus::default();
    let mut mesh = TriangleMesh { tangents: Vec::new(), ..Shape::Torus(torus).triangles(64) };
    let around = torus.minor().recip().round() as f32;
    mesh.uv_sets[0].iter_mut().for_each(|uv| uv[0] *= around);
    mesh
}

pub fn make(args: &Args) -> Result<Figure> {
    let subject = Subject::new(args)?;
    let heights = HeightMap::of(&subject.heights, &subject.source)?;
    let slopes = SlopeMap::of(&subject.heights, &subject.source)?;
    let listing_1 = |derivative| HeightDetail {
        derivative,
        sampler: Sampler::default().with_wrap(subject.source.wrap),
        ..HeightDetail::new(heights.clone())
    };
    let fine = listing_1(HeightDerivative::Fine);
    let placed = |tangents| {
        let placement = Placement::default().with_tangent_source(tangents);
        SlopeDetail::new(slopes.clone(), subject.source.wrap).placed(placement)
    };
    let (normal_map, cotangent) = (placed(TangentSource::Mesh), placed(TangentSource::Derivatives));

    let whole = subject.scene(WHOLE);
    let between = |a: &dyn Detail, b: &dyn Detail| {
        angles(&whole, SIZE, |at| [shaded_normal(a, at), exact_normal(b, at)])
    };
    let (of_normal_map, of_cotangent) = (between(&fine, &normal_map), between(&fine, &cotangent));
    let unperturbed = angles(&whole, SIZE, |at| [at.hit().frame.normal(), exact_normal(&normal_map, at)]);

    let close = subject.scene(MAGNIFIED);
    let smooth = listing_1(HeightDerivative::Bicubic);
    let errors = magnified_errors(&subject)?;
    let error_of = |wanted| errors.iter().find(|(name, _)| *name == wanted).map_or(f64::NAN, |(_, e)| e.mean);
    let ratio = error_of(HeightDerivative::Fine) / error_of(HeightDerivative::Bicubic);
    let mut numbers = Map::new();
    for (name, value) in [
        ("mean angle to normal mapping with MikkTSpace tangents, degrees", of_normal_map.mean),
        ("mean angle to normal mapping with a frame from derivatives (Schüler), degrees", of_cotangent.mean),
        ("mean angle of the bumps themselves, degrees", unperturbed.mean),
        ("magnified: error of fine / error of bicubic derivatives", ratio),
    ] {
        numbers.insert(name.to_owned(), json!(value));
    }
    let noise = detail_noise(&subject, &close);
    let with_noise = Combined::new(vec![
        Strengthened { detail: &fine, strength: 1.0 },
        Strengthened { detail: &noise, strength: 1.0 },
    ]);
    let flat = Combined::new(Vec::new());
    let pictures = vec![
        (picture(&whole, &fine, SIZE)?, "Listing 1, heights alone".to_owned()),
        (picture(&whole, &normal_map, SIZE)?, "normal mapping with tangents".to_owned()),
        (picture(&whole, &flat, SIZE)?, "no perturbation".to_owned()),
        (picture(&close, &fine, SIZE)?, "magnified: piecewise flat".to_owned()),
        (picture(&close, &with_noise, SIZE)?, "magnified, with turbulence as detail".to_owned()),
        (picture(&close, &smooth, SIZE)?, "magnified, bicubic derivatives".to_owned()),
    ];
    let rows = errors
        .iter()
        .map(|(name, error)| {
            vec![name.to_string(), format!("{:.3}", error.mean), format!("{:.2}", error.largest)]
        })
        .collect();
    Ok(Figure {
        title: "heights on the screen against normal mapping",
        claim: format!(
            "Listing 1 and normal mapping with tangents differ by at most {SAME} of the angle of the bumps themselves on average; where the map \
             is magnified, bicubic derivatives remove the facets: their error is at least {SMOOTHER} times smaller"
        ),
        numbers,
        holds: of_normal_map.mean <= SAME * unperturbed.mean && ratio >= SMOOTHER,
        making: format!(
            "{}; {}x{} pixels, {WHOLE} texels a pixel, and {MAGNIFIED:.3} where it is magnified. Errors of derivatives are angles to the \
             known normals of waves {} and {} texels long.",
            subject.name, SIZE.0, SIZE.1, WAVELENGTHS[0], WAVELENGTHS[1]
        ),
        panels: panels(pictures),
        charts: Vec::new(),
        table: Some(Table { header: vec!["derivative", "mean error, degrees", "largest"], rows }),
    })
}

/// Waves of known slopes in a height map, as a source of bumps.
struct Waves;

/// The side of their map, and the wavelengths along u and v, in texels.
const SIDE: usize = 96;
const WAVELENGTHS: [f64; 2] = [12.0, 16.0];

impl Waves {
    fn wave_number(axis: usize) -> f64 {
        std::f64::consts::TAU / WAVELENGTHS[axis]
    }

    /// Heights in texels over texels, the first at its centre.
    fn height(x: f64, y: f64) -> f64 {
        (Self::wave_number(0) * x).sin() + (Self::wave_number(1) * y).cos()
    }

    fn map() -> Pattern {
        let texel = |i: usize| {
            let (x, y) = ((i % SIDE) as f64 + 0.5, (i / SIDE) as f64 + 0.5);
            (Self::height(x, y) / SIDE as f64) as f32
        };
        let samples = Samples::F32((0..SIDE * SIDE).map(texel).collect());
        Pattern { heights: Image::new(SIDE, SIDE, 1, samples).expect("a square") }
    }
}

impl Detail for Waves {
    fn slope(&self, at: &DetailPoint<'_>) -> Slope {
        let [kx, ky] = [0, 1].map(Self::wave_number);
        let at_texel = at.uv(0) * SIDE as f64;
        // Rows grow downwards, and y points up.
        let stored =
            Slope { x: -(kx * (kx * at_texel.x).cos()) as f32, y: -(ky * (ky * at_texel.y).sin()) as f32 };
        let placement = Placement::default().with_tangent_source(TangentSource::Derivatives);
        stored.transformed(SlopeFrame::new((SIDE, SIDE), at.repeats(), placement).matrix(at.hit()))
    }

    fn distribution(&self, at: &DetailPoint<'_>, _: &ShadingOptions) -> Distribution {
        Distribution::of_slope(self.slope(at))
    }
}

/// The error of each derivative where a map of known slopes is magnified.
fn magnified_errors(subject: &Subject) -> Result<Vec<(HeightDerivative, Angles)>> {
    let map = Waves::map();
    let heights = HeightMap::of(&map.heights, &map.source_options())?;
    let mut close = scene(subject.shape.clone(), ZOOM);
    close.repeats = repeats(&close.shape, &close.camera, (SIDE, SIDE), SIZE, MAGNIFIED).max(1e-3);
    let error = |derivative: &HeightDerivative| {
        let detail = HeightDetail { derivative: *derivative, ..HeightDetail::new(heights.clone()) };
        let error = angles(&close, SIZE, |at| [shaded_normal(&detail, at), exact_normal(&Waves, at)]);
        (*derivative, error)
    };
    Ok(HeightDerivative::ALL.iter().map(error).collect())
}

/// Turbulence with cells of about a texel, which hides the facets of a magnified map.
fn detail_noise(subject: &Subject, scene: &Scene) -> NoiseDetail {
    let camera = &scene.camera;
    let ray = camera.ray(0.5 * f64::from(SIZE.0), 0.5 * f64::from(SIZE.1), SIZE.0, SIZE.1);
    let texel = scene.shape.hit(&ray).map_or(1.0, |hit| {
        let along: DVec3 = hit.dpdu(0);
        along.length() / (scene.repeats * subject.heights.width() as f64)
    });
    let frequency = CELLS_PER_TEXEL / texel.max(f64::MIN_POSITIVE);
    NoiseDetail::new(
        Noise::default()
            .with_kind(NoiseKind::Turbulence)
            .with_octaves(4)
            .with_frequency(frequency)
            .with_amplitude(0.15 / frequency),
    )
}
