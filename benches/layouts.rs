//! Baking in memory, by layout and by filter, and decoding: `cargo bench -p roughcast --bench layouts`.

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use roughcast::texture::{Layout, decode};
use roughcast::{
    Bake, BakeOptions, BaseRoughness, Image, Kind, PyramidFilter, SampleType, Samples, SourceOptions,
};

/// Width and height in texels; small enough that a whole run takes seconds.
const SIDE: usize = 1024;

fn main() {
    divan::main();
}

/// Rolling hills, 16-bit grey.
fn hills(width: usize, height: usize) -> Image {
    let value = |index: usize| {
        let (x, y) = ((index % width) as f32, (index / width) as f32);
        let hill = (x * 0.11).sin() * (y * 0.07).cos() + 0.3 * (x * 0.9 + y * 0.4).sin();
        ((0.5 + 0.3 * hill) * 65535.0) as u16
    };
    let samples = (0..width * height).map(value).collect();
    Image::new(width, height, 1, Samples::U16(samples)).expect("one sample a pixel")
}

fn heights() -> SourceOptions {
    SourceOptions::default().with_kind(Kind::Height)
}

fn options(layout: Layout) -> BakeOptions {
    let bits = match layout.default_sample_type() {
        // Single floats would mainly measure memory bandwidth.
        SampleType::F32 => SampleType::F16,
        suited => suited,
    };
    BakeOptions::default().with_layout(layout).with_sample_type(bits)
}

#[divan::bench(args = Layout::ALL)]
fn layout(bencher: Bencher, layout: &Layout) {
    let map = hills(SIDE, SIDE);
    let base = Some(BaseRoughness::Variance(0.01));
    let mut textures = Vec::new();
    bencher.counter(ItemsCount::new(SIDE * SIDE)).bench_local(|| {
        let reused = std::mem::take(&mut textures);
        textures = Bake::of(&map)
            .source(heights())
            .roughness(base)
            .options(options(*layout))
            .reusing(reused)
            .run()
            .expect("a plain bake")
            .arrays;
    });
}

#[divan::bench(args = PyramidFilter::ALL)]
fn filter(bencher: Bencher, filter: &PyramidFilter) {
    let map = hills(SIDE, SIDE);
    let options = BakeOptions::default().with_filter(*filter);
    bencher.counter(ItemsCount::new(SIDE * SIDE)).bench_local(|| {
        Bake::of(black_box(&map)).source(heights()).options(options).run().expect("a plain bake")
    });
}

/// Sizes that do not halve evenly use the general code path.
#[divan::bench]
fn odd_size(bencher: Bencher) {
    let map = hills(SIDE + 1, SIDE + 1);
    bencher
        .counter(ItemsCount::new((SIDE + 1) * (SIDE + 1)))
        .bench_local(|| Bake::of(black_box(&map)).source(heights()).run().expect("a plain bake"));
}

#[divan::bench]
fn decode_lean(bencher: Bencher) {
    let map = hills(SIDE, SIDE);
    let baked = Bake::of(&map).source(heights()).run().expect("a plain bake");
    bencher
        .counter(ItemsCount::new(SIDE * SIDE))
        .bench_local(|| decode(black_box(&baked.arrays)).expect("a whole layout"));
}
