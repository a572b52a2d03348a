//! With default options LEAN is as good as stored variance: the few steep texels of real maps must not waste the range.

mod common;

use std::sync::Arc;

use common::picture;
use roughcast::detect::{guess_channels, guess_range};
use roughcast::shading::{Material, Shading, ShadingOptions};
use roughcast::{Bake, BakeOptions, BakeReport, Green, Image, MaxSlope, SamplesMut, SourceOptions};
use roughcast_scene::metrics::rmse;
use roughcast_scene::render::{Method, Truth, unwatched};
use roughcast_scene::{BakedTextures, Picture, Plane, Sampler, Scene, Shape, SlopeDetail, SlopeMap, View};

const SIZE: (u32, u32) = (48, 36);
const SAMPLES: u32 = 64;

/// The largest error of LEAN relative to stored variance, both in 16 bits.
const LARGEST_RATIO: f64 = 1.15;

/// A map seen from far away, with its ground truth.
struct Far {
    image: Image,
    source: SourceOptions,
    scene: Scene,
    truth: [Picture; 2],
}

const MODELS: [Shading; 2] = [Shading::Lean, Shading::Variance];

impl Far {
    fn new(path: &str, green: Green) -> Self {
        Self::of(path, green, &[])
    }

    /// The map with some of its texels replaced by these.
    fn of(path: &str, green: Green, texels: &[[u8; 3]]) -> Self {
        let decoded = picture(path);
        let (range, mut image) = (guess_range(&decoded.image), decoded.image);
        let channels = image.channels();
        for (i, texel) in texels.iter().enumerate() {
            let SamplesMut::U8(samples) = image.samples_mut() else { panic!("{path} has 8 bits") };
            let at = channels * (9_973 * i + 1_234);
            samples[at..at + 3].copy_from_slice(texel);
        }
        let normal_channels = guess_channels(&image, &decoded.info.channels, range);
        let source = SourceOptions::default()
            .with_green(green)
            .with_range(range)
            .with_normal_channels(normal_channels);
        let plane = Arc::new(Shape::Plane(Plane::default()));
        let scene = View::Far.scene(plane, (image.width(), image.height()), SIZE, Material::default());
        let slopes = SlopeMap::of(&image, &source).expect("a map");
        let truth = MODELS.map(|shading| {
            let truth = Truth {
                shading,
                detail: &SlopeDetail::new(slopes.clone(), source.wrap),
                options: ShadingOptions::default(),
                samples: SAMPLES,
            };
            truth.render(&scene, SIZE, &unwatched).expect("a picture")
        });
        Self { image, source, scene, truth }
    }

    /// The root mean square error of a model with maps baked by the default options, except for the maximum slope.
    fn error(&self, model: usize, max_slope: MaxSlope) -> (f64, BakeReport) {
        let options = BakeOptions::default().with_layout(MODELS[model].layout());
        let source = self.source.with_max_slope(max_slope);
        let baked = Bake::of(&self.image).source(source).options(options).run().expect("a map");
        let textures = BakedTextures::of_model(MODELS[model], &baked.arrays).expect("the model's maps");
        let method = Method {
            shading: MODELS[model],
            detail: &textures.sampled(Sampler::default()),
            options: ShadingOptions::default(),
        };
        let picture = method.render(&self.scene, SIZE, &unwatched).expect("a picture");
        (rmse(&picture, &self.truth[model]).expect("pictures of one size"), baked.report)
    }
}

#[test]
fn lean_is_as_good_as_variance_on_every_real_map() {
    let (mut maps, mut limited) = (0, 0);
    let mut missed = Vec::new();
    for row in roughcast_testdata::manifest() {
        let path = row["path"].as_str();
        if row["kind"] != "normal" || !path.starts_with("materials/") {
            continue;
        }
        let green = if row["convention"].starts_with("DX") { Green::Down } else { Green::Up };
        let far = Far::new(path, green);
        let any = MaxSlope::Limit(MaxSlope::OF_ANY_MAP);
        let ((lean, report), (variance, of_variance)) =
            (far.error(0, MaxSlope::Auto), far.error(1, MaxSlope::Auto));
        let (without, with_any) = (far.error(0, any).0, far.error(1, any).0);
        eprintln!(
            "{path}: lean {lean:.5} variance {variance:.5} ratio {:.3}; limit {:.3} ({} texels, {:.1}x), variance's {:.3}; at 128: lean {without:.5} variance {with_any:.5} ratio {:.3}",
            lean / variance,
            report.max_slope,
            report.limit.map_or(0, |l| l.texels),
            report.limit.map_or(1.0, |l| l.factor),
            of_variance.max_slope,
            without / with_any,
        );
        maps += 1;
        limited += usize::from(report.limit.is_some());
        if lean > LARGEST_RATIO * variance {
            missed.push(format!("{path}: {lean} and {variance}"));
        }
    }
    assert!(missed.is_empty(), "{missed:#?}");
    assert!(maps >= 10 && limited > 0, "{limited} of {maps} maps limited");
}

/// The counterpart of the test above: a map that needs the limit.
#[test]
fn five_steep_texels_spoil_lean_only_without_the_limit() {
    // z is the smallest value above zero that 8 bits can represent.
    let steep = [[255, 128, 128], [128, 0, 128], [20, 60, 128], [200, 200, 128], [60, 255, 128]];
    let far = Far::of("crops/rock020_normal_256.jpg", Green::Down, &steep);
    let (variance, (lean, report)) = (far.error(1, MaxSlope::Auto).0, far.error(0, MaxSlope::Auto));
    let limit = report.limit.expect("the report says so");
    let (unlimited, _) = far.error(0, MaxSlope::Limit(MaxSlope::OF_ANY_MAP));
    eprintln!("lean {lean}, variance {variance}, lean at 128 {unlimited}, {limit:?}");
    assert!(lean <= LARGEST_RATIO * variance, "{lean} and {variance}");
    assert!(unlimited > LARGEST_RATIO * variance, "{unlimited} and {variance}");
    assert!(limit.texels >= 5 && limit.texels <= report.texels / 1000 + 1, "{limit:?}");
}
