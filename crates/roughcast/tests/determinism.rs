//! The same input gives the same textures and report for any number of threads, whether the library owns the input's
//! memory or not.

mod common;

use common::{baked_with, maps, options};
use roughcast::texture::{Base, Layout, RoughnessStored};
use roughcast::{
    Bake, BakeOptions, Baked, BaseRoughness, Image, ImageView, PyramidFilter, RoughnessMap, SampleType,
    Samples, SamplesView, SourceOptions,
};

fn with_threads(threads: usize, work: impl FnOnce() -> Baked + Send) -> Baked {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be started");
    pool.install(work)
}

fn check(image: &Image, source: &SourceOptions, options: &BakeOptions) {
    let base = Some(BaseRoughness::Variance(0.01));
    let one = with_threads(1, || baked_with(image, source, base, options));
    for threads in [2, 3, 8] {
        let many = with_threads(threads, || baked_with(image, source, base, options));
        // Compares everything: every sample, every sum of the report.
        assert!(one == many, "{threads} threads, {}x{}, {options:?}", image.width(), image.height());
    }
}

#[test]
fn the_number_of_threads_makes_no_difference() {
    // Several bands of the fused pass, of the general one, and of both in sequence.
    for (width, height) in [(640, 427), (1088, 192), (514, 258)] {
        let (normals, normal_source) = maps::plain_normal_map(width, height, 61);
        let (heights, height_source) = maps::height_map(width, height, SampleType::U16, 62);
        for filter in PyramidFilter::ALL {
            let moments = options(Layout::Moments, SampleType::F32).with_filter(*filter);
            check(&normals, &normal_source, &moments);
            check(&heights, &height_source, &moments);
        }
    }
}

/// The automatic limit of slopes depends on counts over the whole map.
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
        check(&normals, &source, &options(*layout, bits).with_base(Base::Baked));
    }
}

/// A map and a roughness map that are parts of one larger array, as another program may store them.
#[test]
fn borrowed_memory_gives_the_same_as_images() {
    let (width, height) = (48, 33);
    let (normals, source) = maps::plain_normal_map(width, height, 65);
    let roughness: Vec<f32> = (0..width * height).map(|i| (i % 97) as f32 / 97.0).collect();
    let options = options(Layout::Moments, SampleType::F32).with_base(Base::Baked);
    let (channel, stored) = (0, RoughnessStored::Alpha);
    let bake_with = |map: ImageView<'_>, image: ImageView<'_>| {
        let base = BaseRoughness::Map(RoughnessMap { image, channel, stored });
        let Baked { arrays, report } =
            Bake::of(map).source(source).roughness(base).options(options).run().expect("a map");
        // The metadata is excluded: its base variance is NaN for a varying base.
        (arrays.into_iter().map(|array| array.into_layers()).collect::<Vec<_>>(), report)
    };
    let owned = Image::new(width, height, 1, Samples::F32(roughness.clone())).expect("whole rows");
    let expected = bake_with(normals.view(), owned.view());

    let texels: Vec<f32> = (0..normals.samples().len()).map(|i| normals.samples().get(i)).collect();
    let theirs = [&[7.0][..], &texels, &roughness, &[7.0]].concat();
    let (map, rest) = theirs[1..].split_at(texels.len());
    let map = ImageView::new(width, height, 3, SamplesView::F32(map)).expect("whole rows");
    let view =
        ImageView::new(width, height, 1, SamplesView::F32(&rest[..roughness.len()])).expect("whole rows");
    let borrowed = bake_with(map, view);
    let of_floats = bake_with(map.to_image().view(), owned.view());
    assert!(borrowed == of_floats);
    assert!(bake_with(normals.view(), view) == expected);
}
