//! Compares the bake in memory with its lower bound: decoded 16-bit pixels to both LEAN layers in 16 bits, all levels,
//! against a memcpy that moves the same bytes in and out with the same threads.
//!
//! `cargo bench -p roughcast --bench in_memory [-- SIZE]`; one run measures both alternately, because the machine
//! may be shared and noisy.

use std::hint::black_box;
use std::time::{Duration, Instant};

use rayon::prelude::*;
use roughcast::{Bake, BakeOptions, Image, Samples, ScaleChoice, SourceOptions};

const ROUNDS: usize = 15;
const CHANNELS: usize = 3;

/// A bumpy normal map of `size` by `size` texels, 16-bit RGB.
fn waves(size: usize) -> Image {
    let mut samples = Vec::with_capacity(size * size * CHANNELS);
    for y in 0..size {
        for x in 0..size {
            let (u, v) = (x as f32 * 0.37, y as f32 * 0.23);
            let (sx, sy) = (0.4 * (u + v.sin()).sin(), 0.3 * (v - 0.5 * u).cos());
            let z = 1.0 / (1.0 + sx * sx + sy * sy).sqrt();
            for component in [sx * z, sy * z, z] {
                samples.push(((component * 0.5 + 0.5) * 65535.0).round() as u16);
            }
        }
    }
    Image::new(size, size, CHANNELS, Samples::U16(samples)).expect("the samples are counted")
}

/// Median and minimum.
fn summary(mut times: Vec<Duration>) -> [f64; 2] {
    times.sort();
    [times[times.len() / 2], times[0]].map(|time| time.as_secs_f64())
}

fn main() {
    let size = std::env::args().skip(1).find_map(|a| a.parse().ok()).unwrap_or(4096);
    let map = waves(size);
    let threads = rayon::current_num_threads();
    // Both layers have four 16-bit channels, and all further levels together are a third of level 0.
    let bytes_in = size * size * CHANNELS * 2;
    let bytes_out = size * size * 2 * 4 * 2 * 4 / 3;
    // A copy reads as much as it writes, so half of the traffic goes each way.
    let copied = (bytes_in + bytes_out) / 2;
    let from = vec![1_u8; copied];
    let mut to = vec![0_u8; copied];
    let chunk = copied.div_ceil(threads);
    let source = SourceOptions::default();
    let fixed = BakeOptions::default().with_scale(ScaleChoice::Fixed(1.0));
    let auto = BakeOptions::default();

    let mut textures = Vec::new();
    let (mut copy, mut fixed_times, mut auto_times, mut fresh_times) = (vec![], vec![], vec![], vec![]);
    for _ in 0..ROUNDS {
        copy.push(timed(|| {
            to.par_chunks_mut(chunk)
                .zip(from.par_chunks(chunk))
                .for_each(|(to, from)| to.copy_from_slice(from));
            black_box(&mut to);
        }));
        for (options, times) in [(&fixed, &mut fixed_times), (&auto, &mut auto_times)] {
            times.push(timed(|| {
                let reused = std::mem::take(&mut textures);
                textures = Bake::of(&map)
                    .source(source)
                    .options(*options)
                    .reusing(reused)
                    .run()
                    .expect("a plain bake")
                    .arrays;
            }));
        }
        fresh_times.push(timed(|| {
            black_box(Bake::of(&map).source(source).options(fixed).run().expect("a plain bake"));
        }));
    }
    let copy = summary(copy);
    println!("{size}x{size} RGB16 -> LEAN, 2 x RGBA16, all levels; {threads} threads; {ROUNDS} rounds");
    println!("bytes in {bytes_in}, out {bytes_out}");
    println!("{:<44} {:>10} {:>7} {:>10} {:>7}", "", "median ms", "ratio", "least ms", "ratio");
    for (name, times) in [
        ("memcpy of the same bytes in and out", copy),
        ("bake, scale given, memory reused", summary(fixed_times)),
        ("bake, scale found (a second pass), reused", summary(auto_times)),
        ("bake, scale given, fresh memory", summary(fresh_times)),
    ] {
        let [median, least] = times.map(|seconds| seconds * 1e3);
        let [median_ratio, least_ratio] = [times[0] / copy[0], times[1] / copy[1]];
        println!("{name:<44} {median:>10.1} {median_ratio:>7.2} {least:>10.1} {least_ratio:>7.2}");
    }
}

fn timed(work: impl FnOnce()) -> Duration {
    let start = Instant::now();
    work();
    start.elapsed()
}
