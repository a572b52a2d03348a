//! Layers that are refused, in words.

use roughcast::layers::*;
use roughcast::texture::MomentLevel;
use roughcast::{Distribution, Image, Kind, Moments, SampleType, Slope, SourceOptions};

fn flat(width: usize, height: usize) -> Image {
    Image::new(width, height, 3, roughcast::Samples::U8([128, 128, 255].repeat(width * height)))
        .expect("full")
}

#[track_caller]
fn refused<T: std::fmt::Debug>(result: Result<T, LayerError>, line: &str) {
    assert_eq!(result.expect_err(line).to_string(), line);
}

#[test]
fn every_fault_is_named() {
    refused(Layers::new(Vec::new()).joint(), "there are no layers: give at least one");
    let map = flat(4, 4);
    let layers = |weights: &[f32]| Layers::new(weights.iter().map(|t| Layer::of(&map).weight(*t)).collect());
    refused(
        layers(&[0.5, 0.25]).joint(),
        "the weights of the layers sum to 0.75: the method 'joint' needs a sum of 1",
    );
    refused(layers(&[1.0, f32::NAN]).joint(), "the weight of layer 1 must be finite, not NaN");
    refused(
        layers(&[-1.0, 2.0]).masked_textures(),
        "layer 0 covers an area of -1: masks must not be negative",
    );
    assert!(layers(&[-1.0, 2.0]).joint().is_ok());
    refused(layers(&[1.0]).at(f64::INFINITY).joint(), "the time must be finite, not inf");
    refused(layers(&[1.0]).size(0, 4).joint(), "the layers need at least one texel, not 0x4");
    let still = LayerTransform::default().with_repeats([0.0, 1.0]);
    refused(
        Layers::new(vec![Layer::of(&map), Layer::of(&map).transform(still)]).mixing_textures(),
        "the transform of layer 1 must have finite numbers, and repeats that are not zero",
    );
    let grey = Image::zeros(4, 4, 1, SampleType::U8);
    refused(
        Layers::new(vec![Layer::of(&grey)]).joint(),
        "layer 0: a normal map needs 3 channels or more, and this map has 1",
    );
    let heights = SourceOptions::default().with_kind(Kind::Height);
    assert!(Layers::new(vec![Layer::of(&grey).source(heights)]).joint().is_ok());
}

/// Masks make the weights of a joint map vary; they must sum to one at every texel.
#[test]
fn the_sum_is_checked_at_every_texel() {
    let map = flat(4, 4);
    let mask = |last: u8| {
        let mut texels = vec![0; 16];
        texels[15] = last;
        Image::new(4, 4, 1, roughcast::Samples::U8(texels)).expect("full")
    };
    let (nothing, half) = (mask(0), mask(128));
    let layers = |mask: &Image| {
        Layers::new(vec![Layer::of(&map), Layer::of(&map).mask(mask.view())]).joint().map(|_| ())
    };
    assert_eq!(layers(&nothing), Ok(()));
    assert!(matches!(layers(&half), Err(LayerError::WeightSum { method: LayerMethod::Joint, .. })));
}

#[test]
fn levels_of_different_sizes_are_refused_and_distributions_are_not() {
    let level = |width, height| {
        let moments = vec![Moments::of_slope(Slope { x: 0.5, y: 0.0 }); width * height];
        MomentLevel::new(width, height, moments).expect("full")
    };
    let (large, small) = ([level(2, 2), level(1, 1)], [level(1, 1)]);
    let layers = [(0.5, &large[..]), (0.5, &small[..])];
    refused(
        approximated_levels(&layers),
        "level 0 of texture 1 is 1x1 and not 2x2: the method 'approximate' needs textures of one size",
    );
    let map = flat(2, 2);
    let mixing = Layers::new(vec![Layer::of(&map); 2]).mixing_textures().expect("valid");
    refused(
        mixed_levels(&[(0.5, &large[..]), (0.5, &large[..1])], &mixing),
        "level 1 of texture 1 is missing and not 1x1: the method 'mixing-textures' needs textures of one size",
    );
    refused(
        mixed_levels(&[(0.5, &small[..]), (0.5, &small[..])], &mixing),
        "level 0 of texture 2 is 2x2 and not 1x1: the method 'mixing-textures' needs textures of one size",
    );
    refused(mixed_levels(&layers, &[]), "2 layers have 1 pairs, and 0 cross terms are given");
    // Sampled, they may be of any size: here a texel of each.
    let sampled = |levels: &[MomentLevel]| {
        let moments = levels[0].moments()[0];
        Distribution::gaussian(moments.mean, moments.covariance())
    };
    let mixed = approximated(&[(0.5, sampled(&large)), (0.5, sampled(&small))]).expect("valid");
    assert_eq!(mixed.whole().mean.x, 0.5);
}

#[test]
fn methods_have_names_and_say_which_need_a_sum_of_one() {
    let names: Vec<_> =
        LayerMethod::ALL.iter().map(|method| (method.name(), method.needs_unit_sum())).collect();
    let wanted =
        [("joint", true), ("mixing-textures", true), ("approximate", true), ("add", false), ("mask", false)];
    assert_eq!(names, wanted);
    assert_eq!("mask".parse(), Ok(LayerMethod::Mask));
}
