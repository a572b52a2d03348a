//! Invalid normals are replaced by the mean of their neighbours, so that a few of them do not change a map.

mod common;

use common::{baked, float_moments, options, real_files, slope_oracle};
use roughcast::texture::{Layout, decode};
use roughcast::{Image, NormalRange, PyramidFilter, SampleType, Samples, SourceCounts, SourceOptions, Wrap};

/// A real map in the small set.
const MAP: &str = "crops/rock020_normal_256.jpg";
/// Broken texels per million in the map on which this problem was found.
const PARTS_IN_A_MILLION: f64 = 6.0;

/// Codes of normals that point into the surface: straight down, sideways, and barely.
const INTO_THE_SURFACE: [[u8; 3]; 3] = [[128, 128, 0], [255, 60, 20], [20, 128, 127]];
/// A steep normal that is still valid.
const STEEP: [u8; 3] = [20, 128, 128];

/// The map repeated to several million texels, so that very few of them can be broken, with these texels inserted.
fn map_with(texels: &[[u8; 3]]) -> (Image, usize) {
    let map = real_files::read(MAP);
    let Samples::U8(crop) = map.samples() else { panic!("{MAP} has 8 bits") };
    let (side, repeats) = (map.width(), 4);
    let row = |y: usize| &crop[y % side * side * 3..(y % side + 1) * side * 3];
    let mut samples: Vec<u8> = (0..side * repeats).flat_map(|y| row(y).repeat(repeats)).collect();
    let count = samples.len() / 3;
    let broken = (count as f64 * PARTS_IN_A_MILLION * 1e-6) as usize;
    for (i, texel) in texels.iter().cycle().take(broken).enumerate() {
        // Scattered, with some distance between them.
        let at = 3 * (i * 160_001 + 777);
        samples[at..at + 3].copy_from_slice(texel);
    }
    let size = side * repeats;
    (Image::new(size, size, 3, Samples::U8(samples)).expect("as many"), broken)
}

/// The standard deviation of the slopes of the whole map, which is its roughness from far away, and the number of
/// repaired texels.
fn far_roughness(image: &Image) -> (f64, SourceCounts) {
    let baked = baked(image, &SourceOptions::default(), &float_moments(PyramidFilter::Box));
    let levels = decode(&baked.arrays).expect("moments");
    let whole = levels[levels.len() - 1].moments()[0].covariance();
    (f64::from(whole.trace()).sqrt(), baked.report.counts)
}

#[test]
fn a_few_broken_texels_do_not_change_a_distant_real_map() {
    /// Tolerated relative change, as a few texels per million are replaced.
    const UNCHANGED: f64 = 1e-4;
    let (sound, _) = far_roughness(&map_with(&[]).0);
    let (image, broken) = map_with(&INTO_THE_SURFACE);
    let (repaired, counts) = far_roughness(&image);
    assert_eq!(counts, SourceCounts { behind: broken as u64, ..Default::default() });
    assert!((repaired / sound - 1.0).abs() < UNCHANGED, "{repaired} and {sound}");
    // The same share of texels does matter if they are as steep as possible.
    let (image, _) = map_with(&[STEEP]);
    let (steep, counts) = far_roughness(&image);
    assert_eq!(counts, SourceCounts { clamped: broken as u64, ..Default::default() });
    assert!(steep / sound > 1.1, "{steep} and {sound}");
}

/// A map of constant slope with broken texels has that slope everywhere, in every wrap mode and wherever the broken
/// texels are.
#[test]
fn broken_texels_of_a_constant_slope_get_that_slope() {
    const ROUNDING: f32 = 4.0 * f32::EPSILON;
    let (width, height) = (9, 6);
    let good = [0.25_f32, -0.5, 1.0];
    let source = SourceOptions::default().with_range(NormalRange::Signed);
    for bad in [[0.3, 0.1, -1.0], [f32::NAN, 0.0, 1.0], [0.0; 3], [0.2, 0.0, f32::INFINITY]] {
        // Corners, edges, adjacent texels, the middle.
        for broken in [vec![0], vec![8, 45, 53], vec![3, 4, 12], vec![30], vec![0, 1, 9]] {
            for wrap in Wrap::ALL {
                let texel = |i: usize| if broken.contains(&i) { bad } else { good };
                let samples = (0..width * height).flat_map(texel).collect();
                let image = Image::new(width, height, 3, Samples::F32(samples)).expect("as many");
                let baked =
                    baked(&image, &source.with_wrap(*wrap), &options(Layout::Moments, SampleType::F32));
                assert_eq!(baked.report.counts.broken(), broken.len() as u64);
                for moments in decode(&baked.arrays).expect("moments")[0].moments() {
                    let off = (moments.mean.x - 0.25).abs().max((moments.mean.y + 0.5).abs());
                    assert!(off <= ROUNDING, "{bad:?} at {broken:?}, {wrap}: {:?}", moments.mean);
                }
            }
        }
    }
}

/// Tiles of the fused pass are 512 columns wide: a broken texel at a tile's edge has neighbours in the next tile, and
/// at the map's edge in the first.
#[test]
fn neighbours_come_from_other_tiles_and_from_beyond_the_edge() {
    const ROUNDING: f64 = 4.0 * f32::EPSILON as f64;
    let (width, height) = (1024, 128);
    let slopes = common::maps::slopes(width, height, 71);
    for wrap in Wrap::ALL {
        let source = SourceOptions::default().with_range(NormalRange::Signed).with_wrap(*wrap);
        let mut image = common::maps::normal_map((width, height), &slopes, SampleType::F32, &source, 3);
        let Samples::F32(mut samples) = image.samples().clone() else { panic!("asked for floats") };
        let broken = [(0, 0), (1023, 127), (511, 64), (512, 63), (511, 63), (0, 70), (700, 127)];
        for (x, y) in broken {
            samples[3 * (y * width + x) + 2] = -0.5;
        }
        image = Image::new(width, height, 3, Samples::F32(samples)).expect("as many");
        let wanted = slope_oracle::slopes(&image, &source);
        let baked = baked(&image, &source, &options(Layout::Moments, SampleType::F32));
        assert_eq!(baked.report.counts, wanted.counts);
        let finest = &decode(&baked.arrays).expect("moments")[0];
        for (x, y) in broken {
            let ([want_x, want_y], got) =
                (wanted.texels[y * width + x], finest.moments()[y * width + x].mean);
            let off = (f64::from(got.x) - want_x).abs().max((f64::from(got.y) - want_y).abs());
            assert!(off <= ROUNDING, "{wrap}, {x}, {y}: {got:?}, not {want_x} {want_y}");
        }
    }
}

#[test]
fn a_completely_broken_map_is_flat() {
    let image = Image::new(4, 4, 3, Samples::U8(vec![0; 48])).expect("as many");
    let baked = baked(&image, &SourceOptions::default(), &options(Layout::Moments, SampleType::F32));
    assert_eq!(baked.report.counts, SourceCounts { behind: 16, ..Default::default() });
    assert_eq!((baked.report.maximum_slope, baked.report.rms_slope), (0.0, 0.0));
}
