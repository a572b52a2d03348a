//! Runs functions of the WGSL library on the GPU and compares their results with those of their Rust twins.

use std::fmt::Write;

use roughcast::shading::ShadingOptions;
use roughcast::texture::Packing;
use roughcast::wgsl::{self, Role};
use roughcast_gpu::Gpu;
use roughcast_gpu::read_back::read_buffer;
use wgpu::util::DeviceExt;

use crate::common::compute::submit;

/// Words of the packing and the options that precede the arguments of a case.
const PACKING_WORDS: usize = 16;
const OPTION_WORDS: usize = 8;
/// Cases that run together.
const WORKGROUP: u32 = 64;

/// A function with its arguments laid out as words.
pub struct Twin {
    /// The WGSL function's name.
    pub name: &'static str,
    /// Kind of its results.
    pub gives: Gives,
    /// A WGSL statement that calls it with the arguments `f(i)`, `f2(i)`, ..., the options `o()` and the packing `p()`,
    /// and writes the results.
    pub call: &'static str,
    /// Arguments of a case.
    pub arguments: fn(&mut crate::inputs::Inputs) -> Vec<f32>,
    /// The Rust twin; where Rust has the function only inside others, the formula in f64.
    pub rust: fn(&[f32], &ShadingOptions, &Packing) -> Vec<f32>,
}

/// Kind of a function's results, which decides how much intermediate rounding matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gives {
    /// Independent numbers.
    Numbers,
    /// The six words of a Gaussian, whose determinant is a small difference of products.
    Gaussian,
    /// The words of a mixture's surface: four weights, and the words of four Gaussians.
    Mixture,
    /// The six words of a footprint's axes; the shorter is a small difference of products if the footprint is long.
    Axes,
    /// The eight words of a footprint's ratio: parts and their complements to one.
    Ratio,
    /// Noise: sums of numbers of the size of one, with weights that are small differences of larger ones.
    Noise,
    /// The four words of a footprint of noise, whose direction is a small difference if it is nearly round.
    Footprint,
    /// The eight words of a facet of GGX, whose tangent is a small difference of vectors.
    Ggx,
}

/// One call.
pub struct Case {
    pub packing: Packing,
    pub options: ShadingOptions,
    pub arguments: Vec<f32>,
}

/// The shading modules. Detail modules need a host, and baking modules have their own test.
pub fn modules() -> impl Iterator<Item = &'static wgsl::Module> {
    let shades = |module: &&wgsl::Module| !matches!(module.role, Role::Bake | Role::Detail);
    wgsl::MODULES.iter().filter(shades)
}

/// The shading library as Rust assembles it.
pub fn library() -> String {
    let names: Vec<&str> = modules().map(|module| module.name).collect();
    wgsl::library(&names).expect("these are modules")
}

/// Runs a twin's WGSL function of `library` on the GPU and returns its results for each case.
pub async fn run(gpu: &Gpu, library: &str, twin: &Twin, cases: &[Case]) -> Vec<Vec<f32>> {
    let outputs = (twin.rust)(&cases[0].arguments, &cases[0].options, &cases[0].packing).len();
    let words: Vec<u32> = cases.iter().flat_map(words).collect();
    let stride = words.len() / cases.len();
    let source = source(library, twin, [stride, outputs, cases.len()]);
    let storage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
    let input = gpu.device().create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: None,
        contents: bytemuck::cast_slice(&words),
        usage: storage,
    });
    let output = gpu.device().create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: (cases.len() * outputs * size_of::<f32>()) as u64,
        usage: storage,
        mapped_at_creation: false,
    });
    submit(gpu, &source, &[&input, &output], (cases.len() as u32).div_ceil(WORKGROUP));
    let bytes = read_buffer(gpu, &output).await.expect("results");
    let values: Vec<f32> = bytemuck::pod_collect_to_vec(&bytes);
    values.chunks_exact(outputs).map(<[f32]>::to_vec).collect()
}

fn words(case: &Case) -> Vec<u32> {
    let packing = case.packing.to_words();
    let arguments = case.arguments.iter().map(|value| value.to_bits());
    packing.into_iter().chain(case.options.to_words()).chain(arguments).collect()
}

fn source(library: &str, twin: &Twin, [stride, outputs, cases]: [usize; 3]) -> String {
    let mut source = format!("{library}\n{}\n", include_str!("harness.wgsl"));
    let _ = write!(
        source,
        "const OPTION_WORDS: u32 = {OPTION_WORDS}u;\n\
         @compute @workgroup_size({WORKGROUP})\n\
         fn main(@builtin(global_invocation_id) id: vec3u) {{\n    \
         if id.x >= {cases}u {{\n        return;\n    }}\n    \
         input_at = id.x * {stride}u + {}u;\n    output_at = id.x * {outputs}u;\n    {}\n}}\n",
        PACKING_WORDS + OPTION_WORDS,
        twin.call
    );
    source
}

/// Perturbation of the arguments, in units in the last place. A function may return anything that its twin returns for
/// arguments perturbed by this much: it rounds intermediate results, each by half a unit or, for GPU quotients and
/// roots, by up to 2.5, and only a few of them affect a result together.
const ARGUMENT_ULPS: f32 = 8.0;

/// Error allowed where intermediate results of the size of one cancel, in units in the last place of one.
const CANCELLED_ULPS: f32 = 4.0;

/// The same for noise: a weight near one is `10 - 9`, rounded by up to half a unit of each, for each of three axes, and is
/// the factor of a difference of up to 3.
const NOISE_ULPS: f32 = 16.0;

/// Relative error allowed in addition: a GPU's `exp` is off by 3 + 2 |x| units (Vulkan), here with |x| <= 87, and its
/// `log` near 1 by 2^-21, which an exponent of at most 430 (beyond it nothing is left where `log` is used) amplifies to
/// 1e-4.
const RELATIVE: f32 = 1e-4;

/// Magnitude below which a value counts as zero: GPUs may flush subnormal single floats, below 1.2e-38, to zero,
/// including those that are later multiplied by an exponent of up to 16384.
const FLUSHED: f32 = 2e-34;

/// The first result that differs from the Rust twin's, in words.
pub fn first_difference(twin: &Twin, cases: &[Case], results: &[Vec<f32>]) -> Option<String> {
    cases.iter().zip(results).find_map(|(case, got)| {
        let (wanted, allowed) = wanted_and_allowed(twin, case);
        // NaN is never close, and an infinite tolerance never passes.
        let close = |i: &usize| (got[*i] - wanted[*i]).abs() <= allowed[*i] && allowed[*i].is_finite();
        let wrong = (0..wanted.len()).find(|i| !close(i))?;
        Some(format!(
            "{} gives {:e} and not {:e} +- {:e} as number {wrong}, for {:?} with {:?}",
            twin.name, got[wrong], wanted[wrong], allowed[wrong], case.arguments, case.options
        ))
    })
}

/// The results of the Rust twin, and their tolerances.
pub fn wanted_and_allowed(twin: &Twin, case: &Case) -> (Vec<f32>, Vec<f32>) {
    let rust = |arguments: &[f32]| (twin.rust)(arguments, &case.options, &case.packing);
    let wanted = rust(&case.arguments);
    let mut allowed = tolerances(&rust, &case.arguments, &wanted);
    let cancelled = cancellation(twin.gives, &wanted);
    allowed.iter_mut().zip(cancelled).for_each(|(allowed, more)| *allowed += more);
    (wanted, allowed)
}

/// The error that rounding before a subtraction leaves in the result, which perturbing the arguments does not reveal.
fn cancellation(gives: Gives, wanted: &[f32]) -> Vec<f32> {
    let unit = CANCELLED_ULPS * f32::EPSILON;
    let mut left = vec![0.0; wanted.len()];
    match gives {
        Gives::Numbers => {}
        Gives::Gaussian => cancellation_of_gaussian(unit, wanted, &mut left),
        Gives::Mixture => {
            for (wanted, left) in wanted[4..].chunks(6).zip(left[4..].chunks_mut(6)) {
                cancellation_of_gaussian(unit, wanted, left);
            }
        }
        // The part of the derivatives along the shorter axis.
        Gives::Axes => left[4..6].fill(unit * wanted[0].sqrt() / wanted[1]),
        Gives::Noise => left.fill(NOISE_ULPS * f32::EPSILON),
        Gives::Footprint => {
            left[..2].fill(unit * wanted[2] / wanted[3].max(unit * wanted[2]));
            left[3] = unit * wanted[2];
        }
        Gives::Ratio => [0, 2, 7].iter().for_each(|place| left[*place] = unit),
        // For a direction in the surface's plane, the part across the normal is no shorter than the normal's z.
        Gives::Ggx => left[4..7].fill(unit / wanted[2]),
    }
    left
}

/// The same for the words of a Gaussian.
fn cancellation_of_gaussian(unit: f32, wanted: &[f32], left: &mut [f32]) {
    let [xx, yy, xy] = [wanted[2], wanted[3], wanted[4]];
    let determinant = unit * (xx * yy + xy * xy).abs();
    // The repair adds about determinant / trace to the variances.
    let variance = determinant / (xx + yy).abs().max(f32::MIN_POSITIVE);
    (left[2], left[3], left[5]) = (variance, variance, 2.0 * determinant);
}

/// How far each result moves when the arguments are perturbed.
fn tolerances(rust: &impl Fn(&[f32]) -> Vec<f32>, arguments: &[f32], wanted: &[f32]) -> Vec<f32> {
    let mut allowed: Vec<f32> = wanted.iter().map(|value| RELATIVE * value.abs() + FLUSHED).collect();
    let mut moved = arguments.to_vec();
    for i in 0..arguments.len() {
        let mut farthest = vec![0.0_f32; wanted.len()];
        for side in [1.0, -1.0] {
            moved[i] = arguments[i] * (1.0 + side * ARGUMENT_ULPS * f32::EPSILON);
            for ((farthest, value), wanted) in farthest.iter_mut().zip(rust(&moved)).zip(wanted) {
                *farthest = farthest.max((value - wanted).abs());
            }
        }
        moved[i] = arguments[i];
        allowed.iter_mut().zip(farthest).for_each(|(allowed, farthest)| *allowed += farthest);
    }
    allowed
}
