//! The same input gives the same textures and the same report for any number of threads.

mod common;

use common::{baked_with, maps, options};
use roughcast::texture::{Base, Layout};
use roughcast::{BakeOptions, Baked, BaseRoughness, Image, PyramidFilter, SampleType, SourceOptions};

fn with_threads(threads: usize, work: impl FnOnce() -> Baked + Send) -> Baked {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be started");
    pool.install(work)
}

fn check(image: &Image, source: &SourceOptions, options: &BakeOptions) {
    let base = Some(BaseRoughness::Variance(0.01));
    let one = with_threads(1, || baked_with(image, source, base, options));
    for threads in [2, 3, 8] {
        let many = with_threads(threads, || baked_with(image, source, base, options));
        // The whole of it: every sample, every sum of the report.
        assert!(one == many, "{threads} threads, {}x{}, {options:?}", image.width(), image.height());
    }
}

#[test]
fn threads_make_no_difference() {
    // Several bands of the fused pass, of the general one, and of both after each other.
    for (width, height) in [(640, 427), (1088, 192), (514, 258)] {
        let (normals, normal_source) = maps::plain_normal_map(width, height, 61);
        let (heights, height_source) = maps::height_map(width, height, SampleType::U16, 62);
        for filter in PyramidFilter::ALL {
            let moments = BakeOptions { filter: *filter, ..options(Layout::Moments, SampleType::F32) };
            check(&normals, &normal_source, &moments);
            check(&heights, &height_source, &moments);
        }
    }
}

/// The automatic limit of slopes follows from counts of all of them.
#[test]
fn threads_make_no_difference_to_a_limit() {
    let (width, height) = (514, 258);
    let mut slopes = maps::slopes(width, height, 64);
    slopes.iter_mut().step_by(1501).for_each(|slope| *slope = [40.0, -9.0]);
    let (image, source) = maps::slope_map(width, height, &slopes);
    for layout in [Layout::Lean, Layout::Variance] {
        let options = options(layout, SampleType::U16);
        assert!(baked_with(&image, &source, None, &options).report.limit.is_some());
        check(&image, &source, &options);
    }
}

#[test]
fn threads_make_no_difference_to_any_layout() {
    let (normals, source) = maps::plain_normal_map(514, 258, 63);
    for layout in Layout::ALL {
        let bits = if matches!(layout, Layout::Moments | Layout::BumpSlopes) {
            SampleType::F16
        } else {
            SampleType::U16
        };
        check(&normals, &source, &BakeOptions { base: Base::Baked, ..options(*layout, bits) });
    }
}
