//! Compares the GPU's bake with the CPU's.

mod common;

use common::compare::difference;
use common::maps::{heights, normals, real};
use common::{gpu, gpu_of_the_web, gpu_without_features, one_level};
use pollster::block_on;
use roughcast::texture::{Base, Layout, TextureArray};
use roughcast::{
    BakeOptions, BaseRoughness, Gradient, Green, HeightSense, Image, Kind, MaxSlope, NormalChannels,
    NormalRange, PyramidFilter, Red, SampleType, Samples, ScaleChoice, SourceOptions, Wrap,
};
use roughcast_gpu::bake::{BakePath, GpuBake, GpuBaker};
use roughcast_gpu::{Gpu, GpuError};
use wgpu::util::DeviceExt;

/// Allowed difference in steps of the format. Where the CPU's value is close to the midpoint between two codes, the
/// last bit of a float decides, and a GPU may fuse or round differently.
const ALLOWED_STEPS: u32 = 1;

/// Largest relative difference of an automatic scale, which takes a root, a square and a sum in f32.
const SCALE_ROUNDING: f32 = 4.0 * f32::EPSILON;

const SIZES: [(usize, usize); 7] = [(1, 1), (1, 7), (64, 64), (256, 128), (100, 60), (127, 33), (513, 511)];
/// Maps of 8 and 16 bits and floats, steep and fine.
const REAL_MAPS: &[(&str, Kind)] = &[
    ("materials/aluminium_brushed/aluminium_normal.png", Kind::Normal),
    ("materials/bricks_godot/texture_bricks_normal.jpg", Kind::Normal),
    ("materials/pmndrs_normals/0004.webp", Kind::Normal),
    ("heights/canyon_height.jpg", Kind::Height),
    ("heights/surfgrad_Dump_u16.tif", Kind::Height),
    ("heights/t3d_stones.exr", Kind::Height),
];
const FORMATS: [SampleType; 3] = [SampleType::F16, SampleType::U16, SampleType::U8];
const LAYOUTS: [Layout; 2] = [Layout::Lean, Layout::Clean];

/// A bake of the same map on the CPU and the GPU.
struct Case<'a> {
    image: &'a Image,
    source: SourceOptions,
    roughness: Option<BaseRoughness<'a>>,
    options: BakeOptions,
    path: BakePath,
}

fn bake_of(source: SourceOptions, options: BakeOptions) -> GpuBake<'static> {
    GpuBake::new().source(source).options(options)
}

impl<'a> Case<'a> {
    fn new(image: &'a Image, source: SourceOptions, layout: Layout, bits: SampleType) -> Self {
        let options = BakeOptions::default().with_layout(layout).with_sample_type(bits);
        Self { image, source, roughness: None, options, path: BakePath::Compute }
    }

    fn on_gpu(&self, gpu: &Gpu) -> (GpuBaker, TextureArray) {
        let Self { image, source, roughness, options, path } = self;
        let bake = GpuBake::new().source(*source).roughness(*roughness).options(*options).path(*path);
        let baker = block_on(bake.for_image(gpu, *image)).unwrap_or_else(|error| panic!("{self}: {error}"));
        baker.run();
        let array = block_on(baker.read_back()).unwrap_or_else(|error| panic!("{self}: {error}"));
        (baker, array)
    }

    fn check(&self, gpu: &Gpu) {
        let mut cpu = roughcast::Bake::of(self.image)
            .source(self.source)
            .roughness(self.roughness)
            .options(self.options)
            .run()
            .unwrap_or_else(|error| panic!("{self}: {error}"));
        let (baker, array) = self.on_gpu(gpu);
        let expected = cpu.arrays.remove(0);
        let (got, wanted) = (array.info.scale, expected.info.scale);
        assert!((got / wanted - 1.0).abs() <= SCALE_ROUNDING, "{self}: a scale of {got}, not {wanted}");
        let mut info = array.info;
        info.scale = wanted;
        assert_eq!(info.to_pairs(), expected.info.to_pairs(), "{self}");
        let found = difference(&array, &expected).unwrap_or_else(|error| panic!("{self}: {error}"));
        assert!(found.steps <= ALLOWED_STEPS, "{self}: {found:?}");
        if self.path == BakePath::Compute {
            assert_eq!(block_on(baker.counts()), Ok(Some(cpu.report.counts)), "{self}");
        }
    }
}

impl std::fmt::Display for Case<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let image = self.image;
        write!(
            f,
            "{}x{}x{} {:?} by {:?}: {:?}, {:?}",
            image.width(),
            image.height(),
            image.channels(),
            image.samples().sample_type(),
            self.path,
            self.source,
            self.options
        )
    }
}

fn normal_source() -> SourceOptions {
    SourceOptions::default()
}

fn height_source() -> SourceOptions {
    SourceOptions::default().with_kind(Kind::Height).with_height_scale(0.1)
}

const PATHS: [BakePath; 2] = [BakePath::Compute, BakePath::Raster];

#[test]
fn every_size_of_normals_matches_the_cpu() {
    let gpu = gpu();
    for (width, height) in SIZES {
        let image = normals(width, height, 3, SampleType::U8);
        for path in PATHS {
            Case { path, ..Case::new(&image, normal_source(), Layout::Lean, SampleType::F16) }.check(&gpu);
        }
    }
}

#[test]
fn every_size_of_heights_matches_the_cpu() {
    let gpu = gpu();
    for (width, height) in SIZES {
        let image = heights(width, height, SampleType::U16);
        for path in PATHS {
            Case { path, ..Case::new(&image, height_source(), Layout::Clean, SampleType::U16) }.check(&gpu);
        }
    }
}

// The sizes from here on are even twice and then odd: this covers every way to average, and shaders stay small.

#[test]
fn every_format_layout_and_path_matches_the_cpu() {
    let gpu = gpu();
    let image = normals(92, 44, 3, SampleType::U16);
    for bits in FORMATS {
        for layout in LAYOUTS {
            for path in PATHS {
                Case { path, ..Case::new(&image, normal_source(), layout, bits) }.check(&gpu);
            }
        }
    }
}

#[test]
fn every_type_of_height_matches_the_cpu() {
    let gpu = gpu();
    for sample_type in [SampleType::U8, SampleType::U16, SampleType::F16, SampleType::F32] {
        let image = heights(44, 36, sample_type);
        Case::new(&image, height_source(), Layout::Lean, SampleType::F16).check(&gpu);
    }
}

#[test]
fn every_gradient_wrap_and_sense_matches_the_cpu() {
    let gpu = gpu();
    let image = heights(44, 36, SampleType::U16);
    for gradient in Gradient::ALL {
        for wrap in Wrap::ALL {
            let source = height_source().with_gradient(*gradient).with_wrap(*wrap);
            Case::new(&image, source, Layout::Lean, SampleType::F16).check(&gpu);
        }
    }
    let source = height_source().with_height_sense(HeightSense::WhiteDeep);
    Case::new(&image, source, Layout::Lean, SampleType::F16).check(&gpu);
}

#[test]
fn every_way_to_store_normals_matches_the_cpu() {
    let gpu = gpu();
    for order in NormalChannels::ALL {
        for green in Green::ALL {
            for sample_type in [SampleType::U8, SampleType::U16, SampleType::F16, SampleType::F32] {
                let image = normals(44, 36, 4, sample_type);
                let source = normal_source().with_normal_channels(*order).with_green(*green);
                Case::new(&image, source, Layout::Lean, SampleType::F16).check(&gpu);
            }
        }
    }
    // Factors that are not powers of two round. A mean close to zero can then differ by more than one half-float step,
    // though by no more than the rounding of the slopes: 1.75 has one such texel of 16832.
    for (red, normal_scale) in [(Red::Left, 1.0), (Red::Right, 0.5), (Red::Left, 1.25)] {
        for order in NormalChannels::ALL {
            let image = normals(44, 36, 4, SampleType::U8);
            let source =
                normal_source().with_normal_channels(*order).with_red(red).with_normal_scale(normal_scale);
            Case::new(&image, source, Layout::Lean, SampleType::F16).check(&gpu);
        }
    }
    let unsigned = normals(44, 36, 3, SampleType::F32);
    let Samples::F32(values) = unsigned.samples() else { unreachable!("asked for") };
    let signed = values.iter().map(|v| 2.0 * v - 1.0).collect();
    let image = Image::new(44, 36, 3, Samples::F32(signed)).expect("as many");
    let source = normal_source().with_range(NormalRange::Signed);
    Case::new(&image, source, Layout::Lean, SampleType::F16).check(&gpu);
}

#[test]
fn bad_texels_are_repaired_and_counted_as_on_the_cpu() {
    let gpu = gpu();
    let bad = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 0.0, -1.0, 1e-30, 1e30];
    let values: Vec<f32> = (0..16 * 16 * 3).map(|i| if i % 5 == 0 { bad[i / 5 % 7] } else { 0.7 }).collect();
    let image = Image::new(16, 16, 3, Samples::F32(values)).expect("as many");
    for wrap in Wrap::ALL {
        let source = normal_source()
            .with_range(NormalRange::Signed)
            .with_max_slope(MaxSlope::Limit(4.0))
            .with_wrap(*wrap);
        for path in PATHS {
            Case { path, ..Case::new(&image, source, Layout::Lean, SampleType::F16) }.check(&gpu);
        }
    }
    // Two channels without any slopes.
    let image = Image::new(8, 8, 2, Samples::U8(vec![0; 128])).expect("as many");
    let source = normal_source().with_normal_channels(NormalChannels::Xy);
    Case::new(&image, source, Layout::Lean, SampleType::F16).check(&gpu);
}

/// A map whose few steep texels trigger the automatic limit: slopes of up to 2, and a slope of 40 once in `every`
/// texels.
fn few_steep(width: usize, height: usize, every: usize) -> Image {
    let slope = |i: usize| match (i % every, i % 7, i % 11) {
        (0, ..) => [40.0, -9.0],
        (_, x, y) => [x as f32 / 3.0 - 1.0, 1.0 - y as f32 / 5.0],
    };
    let samples = (0..width * height).flat_map(|i| [slope(i)[0], slope(i)[1], 1.0]).collect();
    Image::new(width, height, 3, Samples::F32(samples)).expect("as many")
}

#[test]
fn the_automatic_limit_of_slopes_matches_the_cpu() {
    let gpu = gpu();
    let source = normal_source().with_range(NormalRange::Signed);
    let mut limited = 0;
    for (size, every) in [((64, 64), 1500), ((64, 64), 500), ((127, 33), 1200), ((1400, 1100), 1700)] {
        let image = few_steep(size.0, size.1, every);
        for (layout, bits) in [(Layout::Lean, SampleType::U16), (Layout::Clean, SampleType::U8)] {
            for (path, base) in [(BakePath::Compute, Base::None), (BakePath::Raster, Base::Baked)] {
                let mut case = Case { path, ..Case::new(&image, source, layout, bits) };
                case.options.base = base;
                case.roughness = Some(BaseRoughness::Variance(0.04));
                case.check(&gpu);
                let report = roughcast::Bake::of(&image)
                    .source(source)
                    .roughness(case.roughness)
                    .options(case.options)
                    .run()
                    .expect("a map")
                    .report;
                let (baker, _) = case.on_gpu(&gpu);
                let got = block_on(baker.max_slope()).expect("read back");
                assert!(
                    (got / report.max_slope - 1.0).abs() <= SCALE_ROUNDING,
                    "{case}: {got}, {}",
                    report.max_slope
                );
                limited += usize::from(report.limit.is_some());
                assert_eq!(report.limit.is_some(), every > 1000, "{case}");
            }
        }
    }
    assert_eq!(limited, 12);
}

#[test]
fn holes_in_heights_are_flat_and_counted_as_on_the_cpu() {
    let gpu = gpu();
    let holes = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
    let values = (0..32 * 32).map(|i| if i % 29 == 0 { holes[i % 3] } else { (i % 13) as f32 / 13.0 });
    let image = Image::new(32, 32, 1, Samples::F32(values.collect())).expect("as many");
    for gradient in [Gradient::Sobel, Gradient::Central, Gradient::Forward] {
        let source = height_source().with_gradient(gradient);
        for path in PATHS {
            Case { path, ..Case::new(&image, source, Layout::Lean, SampleType::F16) }.check(&gpu);
        }
    }
}

#[test]
fn base_roughness_and_fixed_scales_match_the_cpu() {
    let gpu = gpu();
    let image = normals(44, 36, 3, SampleType::U8);
    let roughness = Some(BaseRoughness::Variance(1.0 / 64.0));
    for bits in FORMATS {
        for base in [Base::None, Base::Baked] {
            for layout in LAYOUTS {
                let mut case = Case::new(&image, normal_source(), layout, bits);
                case.roughness = roughness;
                case.options.base = base;
                case.check(&gpu);
                if bits != SampleType::F16 {
                    case.options.scale = ScaleChoice::Fixed(1.25);
                    case.check(&gpu);
                    case.path = BakePath::Raster;
                    case.check(&gpu);
                }
            }
        }
    }
}

#[test]
fn real_maps_match_the_cpu() {
    let gpu = gpu();
    for (path, kind) in roughcast_testdata::rows_with_files(REAL_MAPS, |row| row.0) {
        let image = real(path, 300, 252);
        let source = SourceOptions::default().with_kind(*kind);
        for path in PATHS {
            Case { path, ..Case::new(&image, source, Layout::Lean, SampleType::U16) }.check(&gpu);
        }
    }
}

#[test]
fn the_webs_limits_take_more_dispatches_to_the_same_result() {
    let (native, web) = (gpu(), gpu_of_the_web());
    let image = normals(96, 48, 3, SampleType::U8);
    for layout in LAYOUTS {
        let case = Case::new(&image, normal_source(), layout, SampleType::F16);
        let ((many, expected), (few, got)) = (case.on_gpu(&native), case.on_gpu(&web));
        assert_eq!(web.limits().max_storage_textures_per_shader_stage, 4);
        assert!(few.dispatch_count() > many.dispatch_count(), "the limit was felt");
        assert_eq!(difference(&got, &expected).expect("one shape").steps, 0);
        case.check(&web);
    }
}

#[test]
fn moving_bumps_reuse_textures_and_follow_their_inputs() {
    let gpu = gpu();
    let frames = [normals(64, 32, 3, SampleType::U8), normals(64, 32, 3, SampleType::U8).flipped()];
    let options = BakeOptions::default().with_sample_type(SampleType::U16);
    for path in PATHS {
        let first = &frames[0];
        let baker =
            block_on(bake_of(normal_source(), options).path(path).for_image(&gpu, first)).expect("made");
        let textures = baker.textures().to_vec();
        let mut read = Vec::new();
        for frame in &frames {
            baker.upload(frame).expect("of the same kind");
            baker.run();
            let array = block_on(baker.read_back()).expect("read back");
            let cpu =
                roughcast::Bake::of(frame).source(normal_source()).options(options).run().expect("baked");
            let found = difference(&array, &cpu.arrays[0]).expect("one shape");
            assert!(found.steps <= ALLOWED_STEPS, "{path:?}: {found:?}");
            assert_eq!(baker.textures(), textures);
            read.push(array);
        }
        assert!(
            difference(&read[0], &read[1]).expect("one shape").steps > 1000,
            "another frame, other texels"
        );
        let other = normals(32, 32, 3, SampleType::U8);
        assert!(matches!(baker.upload(&other), Err(GpuError::OtherMap { .. })));
    }
}

#[test]
fn textures_already_on_the_gpu_match_the_cpu() {
    let gpu = gpu();
    let options = BakeOptions::default().with_sample_type(SampleType::F16);
    let cases = [
        (normals(44, 36, 4, SampleType::U8), normal_source(), wgpu::TextureFormat::Rgba8Unorm),
        (normals(44, 36, 4, SampleType::U16), normal_source(), wgpu::TextureFormat::Rgba16Unorm),
        (heights(44, 36, SampleType::U8), height_source(), wgpu::TextureFormat::R8Unorm),
        (heights(44, 36, SampleType::F32), height_source(), wgpu::TextureFormat::R32Float),
    ];
    for (image, source, format) in cases {
        let bytes: &[u8] = match image.samples() {
            Samples::U8(v) => v,
            Samples::U16(v) => bytemuck::cast_slice(v),
            Samples::F16(v) => bytemuck::cast_slice(v),
            Samples::F32(v) => bytemuck::cast_slice(v),
        };
        let descriptor = one_level((44, 36), format, wgpu::TextureUsages::TEXTURE_BINDING);
        let map = gpu.device().create_texture_with_data(gpu.queue(), &descriptor, Default::default(), bytes);
        let cpu = roughcast::Bake::of(&image).source(source).options(options).run().expect("baked");
        for path in PATHS {
            let baker = block_on(bake_of(source, options).path(path).for_texture(&gpu, &map)).expect("made");
            baker.run();
            let array = block_on(baker.read_back()).expect("read back");
            let found = difference(&array, &cpu.arrays[0]).expect("one shape");
            assert!(found.steps <= ALLOWED_STEPS, "{format:?} {path:?}: {found:?}");
        }
    }
}

#[test]
fn a_device_without_16_bit_unorm_is_refused_by_name() {
    let gpu = gpu_without_features();
    let image = normals(8, 8, 3, SampleType::U16);
    let make = |bits| {
        let options = BakeOptions::default().with_sample_type(bits);
        block_on(bake_of(normal_source(), options).for_image(&gpu, &image))
    };
    let line = make(SampleType::U16).err().expect("a feature").to_string();
    assert!(line.contains("Rgba16Unorm") && line.contains("use half floats"), "{line}");
    make(SampleType::F16).expect("half floats need no feature, nor does a map of 16 bits");
}

/// A picture with its rows in reverse.
trait Flipped {
    fn flipped(&self) -> Image;
}

impl Flipped for Image {
    fn flipped(&self) -> Image {
        let Samples::U8(samples) = self.samples() else { unreachable!("these frames have 8 bits") };
        let rows = samples.chunks(self.width() * self.channels()).rev();
        let samples = Samples::U8(rows.flatten().copied().collect());
        Image::new(self.width(), self.height(), self.channels(), samples).expect("as many")
    }
}

#[test]
fn unsupported_requests_are_refused_with_a_reason() {
    let gpu = gpu();
    let image = normals(8, 8, 3, SampleType::U8);
    let refused = |options: BakeOptions, word: &str| {
        let error = block_on(bake_of(normal_source(), options).for_image(&gpu, &image));
        let line = error.err().expect("refused").to_string();
        assert!(line.contains(word) && !line.contains('\n'), "{line}");
    };
    refused(
        BakeOptions::default().with_filter(PyramidFilter::Gaussian).with_sample_type(SampleType::F16),
        "gaussian",
    );
    refused(BakeOptions::default().with_sample_type(SampleType::F32), "half");
    refused(BakeOptions::default().with_layout(Layout::Schilling), "schilling");
    refused(BakeOptions::default().with_base(Base::Baked), "needs a roughness");
    let narrow = normals(8, 8, 2, SampleType::U8);
    let error = block_on(bake_of(normal_source(), BakeOptions::default()).for_image(&gpu, &narrow));
    assert!(error.err().expect("refused").to_string().contains("channels"));
}
