use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::*;
use crate::texture::{Layout, Texture};
use crate::{Image, PyramidFilter, SampleType, Samples};

/// Normals computed from integers, so that they are the same on every machine.
fn map(width: usize, height: usize) -> Image {
    let texel = |i: usize| [(i * i / 7 % 120 + 70) as u8, (i * 31 % 110 + 75) as u8, 255 - (i % 40) as u8];
    let samples = Samples::U8((0..width * height).flat_map(texel).collect());
    Image::new(width, height, 3, samples).expect("whole pixels")
}

/// Sizes that halve evenly down to a single column, once, and never.
const SIZES: [(usize, usize); 3] = [(128, 64), (130, 66), (67, 131)];

fn bake_of(map: &Image, layout: Layout, filter: PyramidFilter) -> Bake<'_> {
    let bits = layout.default_sample_type();
    let options = BakeOptions { layout, sample_type: bits, filter, ..BakeOptions::default() };
    Bake::of(map).roughness(BaseRoughness::Variance(0.01)).options(options)
}

/// FNV-1a hash of all samples of all levels.
fn hash(baked: &Baked) -> u64 {
    let layers = baked.arrays.iter().flat_map(|array| array.layers());
    let images = layers.flat_map(|layer| layer.levels());
    let samples = images.flat_map(|image| (0..image.samples().len()).map(|i| image.samples().get(i)));
    samples
        .flat_map(|sample| sample.to_bits().to_le_bytes())
        .fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3))
}

#[test]
fn textures_of_any_shape_can_be_reused() {
    let (small, large) = (map(32, 16), map(64, 64));
    let bake = |map, sample_type| {
        let options = BakeOptions { sample_type, ..BakeOptions::default() };
        Bake::of(map).options(options)
    };
    let fresh = |map, sample_type| bake(map, sample_type).run().expect("a map").arrays;
    let wanted = fresh(&small, SampleType::U16);
    let chain_that_ends_early = wanted.iter().map(|array| {
        let layers = array.layers().iter().map(|layer| {
            let (names, levels) = (layer.channel_names().to_vec(), layer.levels()[..2].to_vec());
            Texture::new(layer.name(), names, levels).expect("levels that halve")
        });
        TextureArray::new(array.info, layers.collect()).expect("layers of one size")
    });
    let other_channels = bake_of(&small, Layout::Clean, PyramidFilter::Box).run().expect("a map").arrays;
    for earlier in [
        fresh(&small, SampleType::U16),
        fresh(&small, SampleType::U8),
        fresh(&large, SampleType::U16),
        chain_that_ends_early.collect(),
        other_channels,
        vec![],
    ] {
        let reused = bake(&small, SampleType::U16).reusing(earlier).run().expect("a map");
        assert_eq!(reused.arrays, wanted);
    }
}

/// Runs with all features and with none: the pinned hashes apply to every build. A layout that is not in the list is
/// not pinned yet.
#[test]
fn the_bytes_do_not_depend_on_the_features_of_the_build() {
    let expected = BTreeMap::from([
        ("bump-slopes", 0x3159_9d2f_a4e0_0986),
        ("clean", 0xb6e4_10ba_c6b0_815c),
        ("lean", 0x1644_14d2_2520_b76e),
        ("moments", 0xa3d7_85d1_f6a5_79cc),
        ("pbr", 0xa025_f922_adc8_c8fa),
        ("schilling", 0x4c80_fa50_66d3_1855),
        ("schilling-isotropic", 0xc047_77dd_45cb_2f42),
        ("toksvig", 0xdf8e_9ef2_3510_a758),
        ("variance", 0xc3d0_a46c_215f_b56d),
    ]);
    let hash_of = |layout: Layout| {
        let of_size = |(width, height)| {
            let baked = bake_of(&map(width, height), layout, PyramidFilter::Box).run().expect("a map");
            hash(&baked)
        };
        SIZES.map(of_size).into_iter().fold(0, u64::wrapping_add)
    };
    let hashes: BTreeMap<&str, u64> =
        expected.keys().map(|name| (*name, hash_of(name.parse().expect("a layout")))).collect();
    assert_eq!(hashes, expected, "{hashes:#x?}");
}

#[test]
fn a_watch_hears_fractions_up_to_one() {
    for (width, height) in SIZES {
        for filter in PyramidFilter::ALL {
            for layout in Layout::ALL {
                let map = map(width, height);
                let heard = std::sync::Mutex::new(Vec::new());
                let watch = |fraction: f32| {
                    heard.lock().expect("no panic").push(fraction);
                    ControlFlow::Continue(())
                };
                let watched = bake_of(&map, *layout, *filter).watched(&watch).run().expect("a map");
                let case = format!("{width}x{height}, {filter}, {layout}");
                assert!(watched == bake_of(&map, *layout, *filter).run().expect("a map"), "{case}");
                let heard = heard.into_inner().expect("no panic");
                assert!(heard.iter().all(|fraction| (0.0..=1.0).contains(fraction)), "{case}: {heard:?}");
                assert_eq!(heard.iter().copied().fold(0.0, f32::max), 1.0, "{case}: {heard:?}");
            }
        }
    }
}

#[test]
fn a_bake_stops_where_its_watch_breaks() {
    // Many bands of each kind of work, so that the threads cannot process all of them at once.
    let (width, height) = (64, 4096);
    for (height, filter) in [(height, PyramidFilter::Box), (height + 1, PyramidFilter::Triangle)] {
        for layout in [Layout::Lean, Layout::Variance, Layout::Moments] {
            let map = map(width, height);
            let reports_of = |stop_at: f32| {
                let reports = AtomicUsize::new(0);
                let result = bake_of(&map, layout, filter)
                    .watched(&|fraction| {
                        reports.fetch_add(1, Ordering::Relaxed);
                        if fraction >= stop_at { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
                    })
                    .run();
                (result, reports.into_inner())
            };
            let (whole, all) = reports_of(2.0);
            assert!(whole.is_ok());
            let case = format!("{height}, {filter}, {layout}");
            for stop_at in [0.0, 0.3, 0.6, 0.95] {
                let (result, some) = reports_of(stop_at);
                assert!(matches!(result, Err(BakeError::Stopped)), "{case}: {stop_at}");
                assert!(some < all, "{case}: {stop_at}: {some} of {all} reports");
            }
            let (_, first) = reports_of(0.0);
            assert!(first < all / 2, "{case}: {first} of {all} reports");
        }
    }
}
