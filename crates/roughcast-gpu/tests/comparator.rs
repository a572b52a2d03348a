//! The comparison of baked textures fails when it should.

mod common;

use common::compare::difference;
use common::maps::normals;
use half::f16;
use roughcast::texture::TextureArray;
use roughcast::{BakeOptions, SampleType, SamplesMut};

fn baked(bits: SampleType) -> TextureArray {
    let options = BakeOptions::default().with_sample_type(bits);
    let image = normals(16, 8, 3, SampleType::U8);
    roughcast::Bake::of(&image).options(options).run().expect("baked").arrays.remove(0)
}

/// Moves one channel of one texel of the third level of the second texture by `steps`.
fn moved(array: &TextureArray, steps: u16) -> TextureArray {
    let mut moved = array.clone();
    match moved.samples_mut(1, 2) {
        SamplesMut::U8(v) => v[5] = v[5].wrapping_add(steps as u8),
        SamplesMut::U16(v) => v[5] = v[5].wrapping_add(steps),
        SamplesMut::F16(v) => v[5] = f16::from_bits(v[5].to_bits().wrapping_add(steps)),
        SamplesMut::F32(_) => unreachable!("the GPU bakes no single floats"),
    }
    moved
}

#[test]
fn a_wrong_texel_is_detected_and_measured() {
    for bits in [SampleType::U8, SampleType::U16, SampleType::F16] {
        let array = baked(bits);
        assert_eq!(difference(&array, &array).expect("one shape").steps, 0);
        for steps in [1, 2, 7] {
            let found = difference(&array, &moved(&array, steps)).expect("one shape");
            assert_eq!((found.steps, found.texels_that_differ), (u32::from(steps), 1), "{bits}");
            assert!(found.place.starts_with("lean2 level 2 (1, 0)"), "{}", found.place);
        }
    }
}

#[test]
fn half_steps_are_counted_across_zero_and_nan_is_far_from_everything() {
    let with = |value: f16| {
        let mut array = baked(SampleType::F16);
        let SamplesMut::F16(v) = array.samples_mut(0, 0) else { unreachable!("asked for") };
        v[0] = value;
        array
    };
    let steps = |a, b| difference(&with(a), &with(b)).expect("one shape").steps;
    let smallest = f16::from_bits(1);
    assert_eq!(steps(f16::ZERO, f16::NEG_ZERO), 0);
    assert_eq!(steps(smallest, -smallest), 2);
    assert!(steps(f16::NAN, f16::ONE) > 1000);
}

#[test]
fn other_shapes_do_not_match() {
    let array = baked(SampleType::F16);
    let first = array.layers()[0].clone();
    let short = TextureArray::new(array.info, vec![first]).expect("one layer");
    assert!(difference(&array, &short).is_err());
    assert!(difference(&array, &baked(SampleType::U16)).is_err());
}
