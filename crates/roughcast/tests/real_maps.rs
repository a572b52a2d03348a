//! All real maps of the shared data, as moments and as LEAN in 16 bits.

mod common;

use common::compare::{EPS, check_means, check_semidefinite, compare_levels, expect};
use common::level::{decoded, raw_lean, raw_moments};
use common::real_files::{self, Entry};
use common::{baked, float_moments, maps, options, slope_oracle};
use roughcast::texture::Layout;
use roughcast::{
    Green, Image, Kind, MaxSlope, NormalRange, PyramidFilter, SampleType, Samples, SamplesMut, SourceCounts,
    SourceOptions,
};

/// Minimum number of maps; fewer means that the manifest was misread.
const NORMAL_MAPS: usize = 10;
const HEIGHT_MAPS: usize = 5;

/// Larger maps are cropped to this size, which limits the memory and time for their levels in f64.
const LARGEST_SIDE: usize = 768;

/// A pyramid of eleven levels costs some roundings of a footprint's rms slope.
const ROUNDINGS: f64 = 24.0;

/// Decoded moments are rounded to single floats.
const SEMIDEFINITE: f64 = 4.0;

/// Every law that a real map must obey.
fn check(name: &str, image: &Image, source: &SourceOptions) -> SourceCounts {
    // The rules for reading slopes, without the automatic limit, which depends on the whole map.
    let source = &(*source).with_max_slope(MaxSlope::Limit(MaxSlope::OF_ANY_MAP));
    let moments = baked(image, source, &float_moments(PyramidFilter::Box));
    let lean = baked(image, source, &options(Layout::Lean, SampleType::U16));
    assert_eq!(lean.report.counts, moments.report.counts, "{name}");
    let wanted = slope_oracle::slopes(image, source);
    assert_eq!(lean.report.counts, wanted.counts, "{name}");
    let levels = raw_moments(&moments);
    // The mean of all squares is the oracle's on level 0 and, by the laws below, on every level.
    let squares: f64 = wanted.texels.iter().map(|b| b[0] * b[0] + b[1] * b[1]).sum();
    let rms = (squares / wanted.texels.len() as f64).sqrt();
    let rounding = ROUNDINGS * EPS * (rms + 1.0);
    let top = levels[0].mean(2) + levels[0].mean(3);
    assert!((top.sqrt() - rms).abs() <= rounding, "{name}: {} instead of {rms}", top.sqrt());
    expect(check_means(&levels, (rounding, 2.0 * rms * rounding)), &name);
    // Sixteen bits: half a code, or twice that if the range is signed.
    let sc = f64::from(lean.report.scale);
    let code = 1.0 / 65535.0;
    let allowed = (sc * code + 2.0 * EPS * sc, sc * sc * code + 4.0 * EPS * sc * sc);
    expect(compare_levels(&raw_lean(&lean), &levels, |_| allowed), &name);
    expect(check_semidefinite(&decoded(&lean.arrays), SEMIDEFINITE), &name);
    lean.report.counts
}

fn green_of(entry: &Entry) -> Green {
    if entry.convention.starts_with("DX") { Green::Down } else { Green::Up }
}

#[test]
fn normal_maps() {
    let entries = real_files::entries("normal");
    assert!(entries.len() >= NORMAL_MAPS, "only {} normal maps", entries.len());
    let mut repaired = 0;
    for entry in &entries {
        let source = SourceOptions::default().with_green(green_of(entry));
        let image = real_files::read_part(&entry.path, LARGEST_SIDE);
        let counts = check(&entry.path, &image, &source);
        let texels = (image.width() * image.height()) as u64;
        assert!(counts.total() * 10 < texels, "{}: {counts:?}", entry.path);
        repaired += usize::from(counts.total() > 0);
    }
    // A few maps have normals that point into the surface; most have none.
    assert!(repaired > 0 && repaired * 3 < entries.len(), "{repaired} of {}", entries.len());
}

#[test]
fn height_maps() {
    let entries = real_files::entries("height");
    assert!(entries.len() >= HEIGHT_MAPS, "only {} height maps", entries.len());
    for entry in &entries {
        let image = real_files::read_part(&entry.path, LARGEST_SIDE);
        let source = SourceOptions::default().with_kind(Kind::Height);
        assert_eq!(check(&entry.path, &image, &source), SourceCounts::default());
    }
}

/// The manifest's `slope_rms` was measured with the stored z raised to at least 0.1, its own way to limit steep texels.
/// It is the root mean square of the length, with three decimals.
#[test]
fn rms_slopes_match_the_manifest() {
    const SMALLEST_Z: f32 = 0.1;
    /// Half of the last decimal, and a margin for the way in which it was rounded.
    const DECIMALS: f64 = 0.0006;
    let entries = real_files::entries("normal");
    let mut compared = 0;
    for entry in &entries {
        let Some(wanted) = entry.slope_rms else { continue };
        let image = real_files::read(&entry.path);
        let component = |i: usize, k| 2.0 * image.samples().get(i * image.channels() + k) - 1.0;
        let normals = (0..image.width() * image.height())
            .flat_map(|i| [component(i, 0), component(i, 1), component(i, 2).max(SMALLEST_Z)])
            .collect();
        let raised = maps::image(image.width(), image.height(), 3, Samples::F32(normals));
        let max_slope = MaxSlope::Limit(MaxSlope::OF_ANY_MAP);
        let source = SourceOptions::default().with_range(NormalRange::Signed).with_max_slope(max_slope);
        let got = baked(&raised, &source, &options(Layout::Clean, SampleType::U16)).report.rms_slope;
        assert!((got - wanted).abs() <= DECIMALS, "{}: {got} instead of {wanted}", entry.path);
        compared += 1;
    }
    assert!(compared >= NORMAL_MAPS, "only {compared} maps have an rms slope");
}

/// A map and its copy in the other convention give the same result.
#[test]
fn both_conventions_of_green_give_the_same_textures() {
    for path in [
        "materials/cheese/texture_cheese_normal.png",
        "materials/surfgrad_ocean16/normals_64crop_16bit_derived.png",
    ] {
        let up = real_files::read(path);
        let mut down = up.clone();
        match down.samples_mut() {
            SamplesMut::U8(v) => v.iter_mut().skip(1).step_by(3).for_each(|green| *green = 255 - *green),
            SamplesMut::U16(v) => v.iter_mut().skip(1).step_by(3).for_each(|green| *green = 65535 - *green),
            other => panic!("{path} has {:?}", other.sample_type()),
        }
        assert_eq!(up.channels(), 3);
        let options = options(Layout::Lean, SampleType::U16);
        let turned = SourceOptions::default().with_green(Green::Down);
        let one = baked(&up, &SourceOptions::default(), &options);
        assert!(one == baked(&down, &turned, &options), "{path}");
        assert!(one != baked(&up, &turned, &options), "{path}");
    }
}
