//! Times from the GPU's clock, and measurements with them.

mod common;

use common::maps::normals;
use common::{gpu, gpu_without_features};
use pollster::block_on;
use roughcast::{BakeOptions, SampleType};
use roughcast_gpu::bake::{BakePath, GpuBake, bake_bandwidth, copy_bandwidth};
use roughcast_gpu::{GpuError, Timestamps};

#[test]
fn each_span_has_its_name_and_a_time() {
    let gpu = gpu();
    let image = normals(44, 36, 3, SampleType::U8);
    let options = BakeOptions::default().with_sample_type(SampleType::F16);
    let mut timestamps = block_on(Timestamps::new(&gpu, 2)).expect("lavapipe and every GPU have them");
    let mut encoder = gpu.device().create_command_encoder(&Default::default());
    for (name, path) in [("compute", BakePath::Compute), ("raster", BakePath::Raster)] {
        let bake = GpuBake::new().options(options).path(path);
        let baker = block_on(bake.for_image(&gpu, &image)).expect("made");
        let span = timestamps.span(name).expect("there is room for two");
        baker.encode(&mut encoder, Some(&span));
    }
    assert!(timestamps.span("one too many").is_none());
    timestamps.resolve(&mut encoder);
    gpu.queue().submit([encoder.finish()]);
    let measured = block_on(timestamps.read(&gpu)).expect("read back");
    assert_eq!(measured.iter().map(|span| span.name.as_str()).collect::<Vec<_>>(), ["compute", "raster"]);
    for span in measured {
        // More than an hour would mean a wrong unit.
        assert!(span.nanoseconds.is_some_and(|time| time > 0.0 && time < 3.6e12), "{span:?}");
    }
    assert!(timestamps.span("room again").is_some());
}

#[test]
fn without_the_feature_there_is_an_error() {
    let error =
        block_on(Timestamps::new(&gpu_without_features(), 1)).expect_err("the feature was not asked for");
    assert!(matches!(error, GpuError::Feature { feature: "timestamp queries", .. }), "{error:?}");
}

#[test]
fn bandwidths_count_the_necessary_bytes() {
    let gpu = gpu();
    let options = BakeOptions::default().with_sample_type(SampleType::F16);
    let baked = block_on(bake_bandwidth(&gpu, 4, &options, BakePath::Compute)).expect("measured");
    // 16 texels of 4 bytes in; 16 + 4 + 1 texels of 8 bytes in two textures out.
    assert_eq!(baked.bytes, 16 * 4 + 2 * 21 * 8);
    let copied = block_on(copy_bandwidth(&gpu, 1 << 22)).expect("measured");
    // 2^17 texels of 16 bytes, in rows of 368: a part of one more row.
    assert!(copied.bytes >= 1 << 22 && copied.bytes < (1 << 22) + 2 * 368 * 16, "{copied:?}");
    assert!(copied.bytes_per_second() > 1e6 && baked.bytes_per_second() > 0.0, "{copied:?} {baked:?}");
}
