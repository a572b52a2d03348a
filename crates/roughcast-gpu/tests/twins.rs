//! Compares the library's rules in WGSL with their Rust twins for thousands of inputs.

mod common;

use common::compute::submit;
use common::gpu;
use common::maps::Random;
use glam::DVec3;
use half::f16;
use pollster::block_on;
use roughcast::wgsl::{Role, library_of};
use roughcast::{MaxSlope, Normal, Slope, SourceCounts};
use roughcast_gpu::{Gpu, read_back};
use roughcast_scene::Light;
use wgpu::util::DeviceExt;

const INPUTS: usize = 1 << 14;

/// Error of a GPU quotient or root after one exact correction, in floats: the result is the nearest float unless two
/// floats are about equally near.
const NEAREST_OR_NEXT: u32 = 1;

/// Error of a repaired slope: the quotient by the larger component, two squares, a root, a quotient and a product, in
/// f32 where the CPU uses f64.
const REPAIRED: f32 = 6.0 * f32::EPSILON;

/// Error of the reciprocal of a product of two factors, read back through another reciprocal.
const STORES: f32 = 4.0 * f32::EPSILON;

/// Runs `body`, WGSL that computes `output: vec4f` from `input: vec4f`, for all inputs.
fn run(gpu: &Gpu, body: &str, inputs: &[[f32; 4]]) -> Vec<[f32; 4]> {
    run_with(gpu, &library_of(Role::Bake), &format!("opaque_zero = zero;\n{body}"), inputs)
}

/// Runs `body` with functions other than the library's.
fn run_with(gpu: &Gpu, functions: &str, body: &str, inputs: &[[f32; 4]]) -> Vec<[f32; 4]> {
    // `zero` must be used, otherwise the binding would be removed.
    let source = format!(
        "{functions}\n@group(0) @binding(0) var<storage, read> inputs: array<vec4f>;\n\
         @group(0) @binding(1) var<storage, read_write> outputs: array<vec4f>;\n\
         @group(0) @binding(2) var<storage, read> zero: u32;\n\
         @compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3u) {{\n\
         let input = inputs[id.x + zero];\nvar output = vec4f(0.0);\n{body}\noutputs[id.x] = output;\n}}\n"
    );
    let device = gpu.device();
    let buffer = |contents: &[u8]| {
        device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: None,
            contents,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
        })
    };
    let bytes: &[u8] = bytemuck::cast_slice(inputs);
    let (input, output, zero) = (buffer(bytes), buffer(&vec![0; bytes.len()]), buffer(&[0; 4]));
    submit(gpu, &source, &[&input, &output, &zero], (inputs.len() / 64) as u32);
    let bytes = block_on(read_back::read_buffer(gpu, &output)).expect("read back");
    bytemuck::pod_collect_to_vec(&bytes)
}

/// Numbers of both signs over many powers of two.
fn inputs(seed: u64, smallest_exponent: i32, largest_exponent: i32) -> Vec<[f32; 4]> {
    let mut random = Random(seed);
    let mut number = || {
        let exponent =
            smallest_exponent as f32 + random.next() * (largest_exponent - smallest_exponent) as f32;
        (random.next() - 0.5) * 2.0 * exponent.floor().exp2()
    };
    (0..INPUTS).map(|_| std::array::from_fn(|_| number())).collect()
}

/// Distance in floats between two of the same sign.
fn floats_apart(a: f32, b: f32) -> u32 {
    if a == b { 0 } else { a.to_bits().abs_diff(b.to_bits()) }
}

#[test]
fn quotients_and_roots_are_rounded_as_on_the_cpu() {
    let inputs = inputs(1, -20, 20);
    let body =
        "output = vec4f(quotient(input.x, input.y), square_root(abs(input.z)), quotient(1.0, input.w), 0.0);";
    let outputs = run(&gpu(), body, &inputs);
    let mut differ = 0;
    for (input, output) in inputs.iter().zip(&outputs) {
        let expected = [input[0] / input[1], input[2].abs().sqrt(), 1.0 / input[3]];
        for (got, wanted) in output.iter().zip(expected) {
            let apart = floats_apart(*got, wanted);
            assert!(apart <= NEAREST_OR_NEXT, "{input:?}: {got:e}, not {wanted:e}");
            differ += usize::from(apart > 0);
        }
    }
    assert!(differ * 1000 < INPUTS, "{differ} are not the nearest");
}

#[test]
fn codes_divided_by_their_number_match_the_cpu() {
    let inputs: Vec<[f32; 4]> =
        (0..1 << 16).map(|code| [code as f32, (code % 256) as f32, 0.0, 0.0]).collect();
    let body = "output = vec4f(component_from_code(input.x, 65535.0), component_from_code(input.y, 255.0),\
                quotient(input.x, 65535.0), quotient(input.y, 255.0));";
    for (input, output) in inputs.iter().zip(run(&gpu(), body, &inputs)) {
        let [wide, narrow, ..] = *input;
        let expected = [
            (2.0 * wide - 65535.0) / 65535.0,
            (2.0 * narrow - 255.0) / 255.0,
            wide / 65535.0,
            narrow / 255.0,
        ];
        assert_eq!(output, expected);
    }
}

#[test]
fn slopes_are_repaired_as_on_the_cpu() {
    const MAX_SLOPE: f32 = 3.0;
    let mut inputs = inputs(2, -8, 8);
    let special = [0.0, -1.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e30, 1e-30];
    for (i, input) in inputs.iter_mut().enumerate().take(special.len().pow(3)) {
        *input = [special[i % 7], special[i / 7 % 7], special[i / 49], 0.0];
    }
    let body = "let repaired = repaired_slope(input.xyz, 3.0);\noutput = vec4f(repaired.slope, f32(repaired.fault), 0.0);";
    for (input, output) in inputs.iter().zip(run(&gpu(), body, &inputs)) {
        let mut counts = SourceCounts::default();
        let wanted = roughcast::repaired_slope(input[0], input[1], input[2], MAX_SLOPE, &mut counts)
            .unwrap_or_default();
        let length = wanted.x.hypot(wanted.y);
        // A slope almost exactly as long as the maximum may fall on either side of it.
        let on_the_edge = (length - MAX_SLOPE).abs() <= REPAIRED * MAX_SLOPE;
        let fault = match (counts.clamped, counts.behind, counts.invalid, counts.non_finite) {
            (1, ..) => 1.0,
            (_, 1, ..) => 2.0,
            (_, _, 1, _) => 3.0,
            (_, _, _, 1) => 4.0,
            _ => 0.0,
        };
        assert!(output[2] == fault || (on_the_edge && fault < 2.0), "{input:?}: {output:?}, not {fault}");
        for (got, wanted) in output.iter().zip([wanted.x, wanted.y]) {
            assert!((got - wanted).abs() <= REPAIRED * wanted.abs(), "{input:?}: {output:?}, not {wanted:?}");
        }
    }
}

#[test]
fn unit_normals_match_the_cpu() {
    let inputs = inputs(3, -8, 6);
    for (input, output) in
        inputs.iter().zip(run(&gpu(), "output = vec4f(normal_from_slope(input.xy), 0.0);", &inputs))
    {
        let Normal { x, y, z } = roughcast::normal_from_slope(Slope { x: input[0], y: input[1] });
        for (got, wanted) in output.iter().zip([x, y, z]) {
            // The product with z, which may be one float off, rounds once more.
            assert!(floats_apart(*got, wanted) <= 2 * NEAREST_OR_NEXT, "{input:?}: {output:?}, not {wanted}");
        }
    }
}

#[test]
fn texels_are_rounded_as_the_cpu_rounds() {
    let mut inputs = inputs(4, -30, 15);
    // Numbers midway between two half floats, and midway between two codes.
    inputs.extend((0..256_u16).map(|i| {
        let half = f16::from_bits(i * 97);
        let middle = 0.5 * (half.to_f32() + f16::from_bits(i * 97 + 1).to_f32());
        [middle, -middle, (f32::from(i) + 0.5) / 255.0, f32::from(i) / 255.0]
    }));
    let gpu = gpu();
    for (input, output) in inputs.iter().zip(run(&gpu, "output = half_nearest(input);", &inputs)) {
        assert_eq!(output, input.map(|v| f16::from_f32(v).to_f32()), "{input:?}");
    }
    for steps in [255.0_f32, 65535.0] {
        let body = format!("output = round(unorm_nearest(input, {steps:.1}) * {steps:.1});");
        for (input, output) in inputs.iter().zip(run(&gpu, &body, &inputs)) {
            assert_eq!(output, input.map(|v| (v.clamp(0.0, 1.0) * steps).round_ties_even()), "{input:?}");
        }
    }
}

#[test]
fn weights_are_coverage() {
    let inputs: Vec<[f32; 4]> = (0..INPUTS)
        .map(|i| {
            let size = 1 + i % 4096;
            let j = (i * 31) % (size / 2).max(1);
            [j as f32, size as f32, 0.0, 0.0]
        })
        .collect();
    let body = "output = vec4f(halving_weights(u32(input.x), u32(input.y)), 0.0);";
    for (input, output) in inputs.iter().zip(run(&gpu(), body, &inputs)) {
        let (j, from) = (f64::from(input[0]), f64::from(input[1]));
        let ratio = from / (from / 2.0).floor().max(1.0);
        // Overlap of the coarser texel with the finer one, as a fraction of the coarser.
        let covered = |i: f64| (((j + 1.0) * ratio).min(i + 1.0) - (j * ratio).max(i)).max(0.0) / ratio;
        for (k, weight) in output.iter().take(3).enumerate() {
            let wanted = covered(2.0 * j + k as f64);
            assert!((f64::from(*weight) - wanted).abs() <= f64::from(f32::EPSILON), "{input:?}: {output:?}");
        }
    }
}

#[test]
fn scales_match_the_cpu() {
    let inputs = inputs(5, -14, 8);
    let body = "let scale = smallest_scale(abs(input.x), abs(input.y));\nlet stores = unsigned_stores(scale);\n\
                output = vec4f(scale, stores.slope.x, stores.second.x, stores.trace.x);";
    for (input, output) in inputs.iter().zip(run(&gpu(), body, &inputs)) {
        let scale = (input[0] * input[0] + input[1].abs()).sqrt().max(1.0 / 1024.0);
        let expected = [scale, 0.5 / scale, 1.0 / (scale * scale), 0.5 / (scale * scale)];
        for (got, wanted) in output.iter().zip(expected) {
            assert!((got / wanted - 1.0).abs() <= STORES, "{input:?}: {output:?}, not {expected:?}");
        }
    }
}

#[test]
fn bins_contain_the_slopes_counted_in_them() {
    /// Relative width of a bin, which the leading five bits of the square determine: at most 3.1 %, and half of that
    /// for the length.
    const BIN: f32 = 1.0158;
    let inputs: Vec<[f32; 4]> = inputs(6, -9, 6).into_iter().map(|input| input.map(f32::abs)).collect();
    let body = "output = vec4f(upper_edge_of_slope_bin(slope_bin(input.x * input.x)), 0.0, 0.0, 0.0);";
    for (input, output) in inputs.iter().zip(run(&gpu(), body, &inputs)) {
        let (length, edge) = (input[0], output[0]);
        let squared = length * length;
        if squared > 1.0 / 1024.0 / 1024.0 && squared <= MaxSlope::OF_ANY_MAP * MaxSlope::OF_ANY_MAP {
            assert!(edge >= length * (1.0 - f32::EPSILON) && edge <= BIN * length, "{length}: {edge}");
        }
    }
}

#[test]
fn the_automatic_limit_matches_the_cpu() {
    let inputs: Vec<[f32; 4]> = inputs(7, -6, 7).into_iter().map(|input| input.map(f32::abs)).collect();
    let body = "output = vec4f(automatic_limit(input.x, input.y, input.z, 128.0));";
    let mut limited = 0;
    for ([exceeded, peak, base, _], output) in inputs.iter().zip(run(&gpu(), body, &inputs)) {
        let limit = exceeded.max(MaxSlope::LEAST_AUTOMATIC);
        let square =
            |component: f32| (f64::from(component).powi(2) + f64::from(*base)).max(2.0_f64.powi(-20));
        let factor = square(*peak) / square(peak.min(limit));
        // Where the factor is almost exactly four, rounding decides.
        if (factor / 4.0 - 1.0).abs() > 1e-5 {
            assert_eq!(
                output[0],
                if factor > 4.0 { limit } else { 128.0 },
                "{exceeded} {peak} {base}: {factor}"
            );
        }
        limited += usize::from(factor > 4.0);
    }
    assert!(limited > 100 && limited < inputs.len() - 100, "{limited}");
}

#[test]
fn a_wrong_twin_is_detected() {
    let inputs: Vec<[f32; 4]> = (0..64).map(|i| [i as f32, 1.0, 2.0, 3.0]).collect();
    let wrong = run(&gpu(), "output = vec4f(quotient(input.x + 1.0, 3.0));", &inputs);
    assert!(
        inputs
            .iter()
            .zip(&wrong)
            .all(|(input, output)| floats_apart(output[0], input[0] / 3.0) > NEAREST_OR_NEXT)
    );
}

/// Error of a root, a quotient and products on a GPU, of up to 2.5 units each.
const LIGHT: f32 = 8.0 * f32::EPSILON;

/// The part of the renderer's shader that starts with `begin` and ends at the next brace on its own line.
fn item(begin: &str) -> &'static str {
    let source = include_str!("../src/render/wgsl/scene.wgsl");
    let (_, rest) = source.split_once(begin).unwrap_or_else(|| panic!("the shader has no '{begin}'"));
    let (length, start) = (rest.find("\n}\n").expect("it ends"), source.len() - rest.len() - begin.len());
    &source[start..start + begin.len() + length + 3]
}

#[test]
fn lights_are_finite_at_every_distance_and_match_the_cpu() {
    let source = include_str!("../src/render/wgsl/scene.wgsl");
    let least = source.lines().find(|line| line.starts_with("const LEAST_SQUARED_DISTANCE"));
    let functions = ["struct SceneLight {", "struct LightAt {", "fn light_at("].map(item);
    let library = roughcast::wgsl::library(&["vector"]).expect("it exists");
    let functions = [&library, least.expect("the shader has it"), &functions.join("\n")].join("\n");
    let body = "let point = SceneLight(vec4f(0.0, 0.0, 0.0, 1.0), vec3f(8.0, 4.0, 2.0));\n\
                let at = light_at(point, input.xyz);\noutput = vec4f(at.towards, at.irradiance.y);";
    // The light is at the origin, so that no distance is rounded before it is squared.
    let mut positions = inputs(9, -40, 10);
    positions[0] = [0.0; 4];
    positions[1] = [1e-30, 0.0, 0.0, 0.0];
    let light = Light::Point { position: DVec3::ZERO, intensity: [8.0, 4.0, 2.0] };
    let (mut near, mut far) = (0, 0);
    for (position, got) in positions.iter().zip(run_with(&gpu(), &functions, body, &positions)) {
        let at = DVec3::new(position[0].into(), position[1].into(), position[2].into());
        let (towards, irradiance) = light.at(at);
        // Squares too small for single floats count as zero.
        let towards = if at.length() > 1e-18 { towards } else { DVec3::ZERO };
        let want = [towards.x as f32, towards.y as f32, towards.z as f32, irradiance[1]];
        for (got, want) in got.into_iter().zip(want) {
            let close = (got - want).abs() <= LIGHT * want.abs().max(1.0);
            assert!(close, "{position:?}: {got:e} and not {want:e}");
        }
        if at.length() < Light::LEAST_DISTANCE { near += 1 } else { far += 1 }
    }
    assert!(near > 1000 && far > 1000, "{near} and {far}");
}
