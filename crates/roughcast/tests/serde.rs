//! With the feature `serde`, values, options and reports survive a round trip through JSON, and enums are written by
//! name.

use std::fmt::Debug;

use roughcast::detect::GreenVerdict;
use roughcast::precision::{Precision, measure};
use roughcast::shading::{Shading, ShadingOptions};
use roughcast::texture::{Layout, MomentLevel, Part, TextureInfo, decode};
use roughcast::{
    AnisotropyOutput, Bake, BakeOptions, BakePlan, BakeReport, Covariance, Distribution, Green, Image, Kind,
    MaxSlope, Moments, PbrOptions, Samples, ScaleChoice, Slope, SourceOptions, WeightedGaussian,
};
use serde_json::{from_value, json, to_value};

/// Checks that a value survives the round trip, and returns its JSON.
fn round_trip<T>(value: &T) -> serde_json::Value
where
    T: serde::Serialize + serde::de::DeserializeOwned + PartialEq + Debug,
{
    let written = to_value(value).expect("plain data");
    // Through text, as in files.
    let read: T = serde_json::from_str(&written.to_string()).expect("what was written");
    assert_eq!(&read, value, "{written}");
    written
}

/// 8-bit waves with some variance on every level.
fn waves() -> Image {
    let texel = |i: usize| [(128 + i * 37 % 60) as u8, (100 + i * 11 % 60) as u8, 250];
    Image::new(8, 8, 3, Samples::U8((0..64).flat_map(texel).collect())).expect("whole pixels")
}

#[test]
fn values_survive() {
    let moments = Moments::from_mean_and_covariance(Slope { x: 0.1, y: -0.3 }, Covariance::isotropic(0.02));
    round_trip(&moments);
    let part = WeightedGaussian { weight: 0.5, mean: moments.mean, covariance: moments.covariance() };
    let written = round_trip(&Distribution::mixture(&[part, part]).expect("two"));
    assert_eq!(written["gaussians"].as_array().map(Vec::len), Some(2));
    let empty = json!({ "normal": written["normal"], "base": "none", "gaussians": [] });
    let error = from_value::<Distribution>(empty).expect_err("no Gaussian").to_string();
    assert!(error.contains("1 to 4 Gaussians, not 0"), "{error}");
    round_trip(&decode(&Bake::of(&waves()).run().expect("a map").arrays).expect("textures"));
    let short = json!({ "width": 2, "height": 2, "moments": [moments] });
    let error = from_value::<MomentLevel>(short).expect_err("three are missing").to_string();
    assert!(error.contains("2x2 texels need as many moments, not 1"), "{error}");
    assert_eq!(round_trip(&GreenVerdict::Undecided), json!("undecided"));
}

#[test]
fn options_survive_and_what_is_left_out_is_the_default() {
    let mut source = SourceOptions::default();
    (source.kind, source.green, source.max_slope) = (Kind::Height, Green::Down, MaxSlope::Limit(2.0));
    let written = round_trip(&source);
    assert_eq!((&written["green"], &written["max_slope"]), (&json!("down"), &json!({ "limit": 2.0 })));
    let mut options = BakeOptions::default();
    (options.layout, options.scale) = (Layout::Pbr, ScaleChoice::Fixed(0.5));
    options.pbr.anisotropy = Some(AnisotropyOutput::Khr);
    round_trip(&options);
    round_trip(&PbrOptions::default());
    round_trip(&ShadingOptions::published(90.0));
    let short: BakeOptions = from_value(json!({ "layout": "clean" })).expect("the rest is the default");
    assert_eq!((short.layout, short.sample_type), (Layout::Clean, BakeOptions::default().sample_type));
    let error = from_value::<BakeOptions>(json!({ "layuot": "clean" })).expect_err("a misprint").to_string();
    assert!(error.contains("layuot"), "{error}");
}

#[test]
fn reports_survive() {
    let map = waves();
    let baked = Bake::of(&map).run().expect("a map");
    let written = round_trip::<BakeReport>(&baked.report);
    assert_eq!(written["texels"], json!(64));
    round_trip::<BakePlan>(
        &BakePlan::new(&SourceOptions::default(), None, &BakeOptions::default()).expect("defaults"),
    );
    round_trip::<Vec<Precision>>(&measure(&map, &SourceOptions::default()).expect("a map"));
}

#[test]
fn the_base_variance_of_a_map_of_roughness_is_none() {
    let mut info = TextureInfo::new(Layout::Pbr, Part::Normal);
    info.base_variance = f32::NAN;
    let written = to_value(info).expect("plain data");
    assert!(written["base_variance"].is_null());
    let read: TextureInfo = from_value(written).expect("what was written");
    assert!(read.base_variance.is_nan());
    info.base_variance = 0.25;
    assert_eq!(round_trip(&info)["layout"], json!("pbr"));
}

#[test]
fn named_enums_go_by_their_names() {
    for shading in Shading::ALL {
        assert_eq!(round_trip(shading), json!(shading.name()));
    }
    let error = from_value::<Shading>(json!("leen")).expect_err("no such model").to_string();
    assert!(error.contains("leen"), "{error}");
}
