//! The shading models in WGSL against their Rust twins, over thousands of texels, directions and options.

mod common;

use common::gpu;
use pollster::block_on;
use roughcast::shading::{
    BaseLobe, Form, LightSample, LobeOptions, Material, Repair, Shading, reflect, wgsl,
};
use roughcast::texture::{Base, Packing, RoughnessStored};
use roughcast::{Lobe, Moments, Slope, normal_from_slope};
use roughcast_gpu::{Gpu, read_back};
use wgpu::util::DeviceExt;

const DRAWS: usize = 1 << 13;

/// Of a lobe, relative to itself or to `FAINT` of its peak where it is less. Both sides round half vector, slope and variance
/// to 6e-8 of numbers near one; a lobe of variance 1e-3 at five deviations multiplies that by `5 / sqrt(1e-3)` for the
/// slope and `25 / 1e-3 / 2` for a variance that was subtracted. WGSL grants `exp` another 2e-6 there.
const LOBE: f32 = 2e-3;
const FAINT: f32 = 1e-4;

/// A normal, or a radiance's cosines: a few roundings of numbers near one.
const NORMAL: f32 = 2e-6;

/// What a shader reads of one draw: three texels, view, light, options. The options' two words of filling make the
/// record a multiple of sixteen bytes.
#[derive(Clone, Copy, Debug)]
struct Draw {
    texels: [[f32; 4]; 3],
    view: [f32; 3],
    light: [f32; 3],
    options: LobeOptions,
}

impl Draw {
    fn bytes(&self) -> Vec<u8> {
        let [view, light] = [self.view, self.light].map(|[x, y, z]| [x, y, z, 0.0]);
        let floats = self.texels.into_iter().chain([view, light]).flatten().map(f32::to_bits);
        floats.chain(self.options.to_words()).flat_map(u32::to_le_bytes).collect()
    }
}

const MATERIAL: Material =
    Material { albedo: [0.5, 0.25, 0.1], ambient: [0.0; 3], specular: [0.04, 0.5, 1.0] };
const IRRADIANCE: [f32; 3] = [3.0, 2.0, 1.0];

/// What it gives back: normal and lobe, diffuse and specular radiance of red.
type Result = [f32; 8];

fn on_cpu(shading: Shading, draw: &Draw, packing: &Packing) -> Result {
    let surface = shading.surface(&draw.texels, packing, &draw.options);
    let lobe = surface.lobe(draw.view, draw.light, &draw.options);
    let light = LightSample { direction: draw.light, irradiance: IRRADIANCE };
    let radiance = reflect(&surface, &MATERIAL, draw.view, &light, &draw.options);
    let [x, y, z] = surface.normal;
    [x, y, z, lobe, radiance.diffuse[0], radiance.diffuse[1], radiance.specular[0], radiance.specular[1]]
}

/// The statements that give `normal` and `surface` of the texels `a`, `b`, `c`.
fn statements(shading: Shading) -> String {
    let name = shading.name().replace('-', "_");
    match shading {
        Shading::Phong | Shading::BlinnPhong | Shading::Beckmann | Shading::OffCentre => {
            format!("let normal = bump_normal(a, packing); let surface = {name}_surface(normal, options);")
        }
        Shading::Lean => {
            "let normal = bump_normal(a, packing); let surface = lean_surface(a, b, packing, options);".into()
        }
        Shading::Clean | Shading::Variance => {
            format!(
                "let surface = {name}_surface(a, packing, options); let normal = slope_normal(surface.mean);"
            )
        }
        Shading::Toksvig => {
            "let normal = toksvig_normal(a, packing); let surface = toksvig_surface(a, packing, options);"
                .into()
        }
        Shading::Ggx => {
            "let normal = ggx_normal(a, packing); let surface = ggx_surface(a, b.x, c, packing, options);"
                .into()
        }
    }
}

fn on_gpu(gpu: &Gpu, shading: Shading, draws: &[Draw], packing: &Packing) -> Vec<Result> {
    let library = wgsl::library(&[shading.name(), "reflectance"]).expect("these modules exist");
    let name = shading.name().replace('-', "_");
    let statements = statements(shading);
    let source = format!(
        "{library}
        struct Draw {{ a: vec4f, b: vec4f, c: vec4f, view: vec4f, light: vec4f, options: LobeOptions }}
        @group(0) @binding(0) var<storage, read> draws: array<Draw>;
        @group(0) @binding(1) var<storage, read_write> results: array<vec4f>;
        @group(0) @binding(2) var<uniform> packing: Packing;
        @compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3u) {{
            let draw = draws[id.x];
            let a = draw.a; let b = draw.b; let c = draw.c;
            let options = draw.options; let view = draw.view.xyz; let light = draw.light.xyz;
            {statements}
            let lobe = {name}_lobe(surface, view, light, options);
            let irradiance = vec3f(3.0, 2.0, 1.0);
            let diffuse = diffuse_radiance(normal, vec3f(0.5, 0.25, 0.1), light, irradiance);
            let specular = specular_radiance(lobe, vec3f(0.04, 0.5, 1.0), view, light, irradiance, options);
            results[2u * id.x] = vec4f(normal, lobe);
            results[2u * id.x + 1u] = vec4f(diffuse.xy, specular.xy);
        }}"
    );
    assert!(draws.len().is_multiple_of(64));
    let device = &gpu.device;
    let buffer = |contents: &[u8], usage| {
        device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: None, contents, usage })
    };
    let storage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
    let input = buffer(&draws.iter().flat_map(Draw::bytes).collect::<Vec<_>>(), storage);
    let output = buffer(&vec![0; size_of::<Result>() * draws.len()], storage);
    let packing = buffer(bytemuck::cast_slice(&packing.to_array()), wgpu::BufferUsages::UNIFORM);
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(shading.name()),
        source: wgpu::ShaderSource::Wgsl(source.into()),
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(shading.name()),
        layout: None,
        module: &module,
        entry_point: None,
        compilation_options: Default::default(),
        cache: None,
    });
    let bound = [&input, &output, &packing].into_iter().enumerate();
    let entries: Vec<_> = bound
        .map(|(binding, buffer)| wgpu::BindGroupEntry {
            binding: binding as u32,
            resource: buffer.as_entire_binding(),
        })
        .collect();
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &entries,
    });
    let mut encoder = device.create_command_encoder(&Default::default());
    let mut pass = encoder.begin_compute_pass(&Default::default());
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.dispatch_workgroups(draws.len() as u32 / 64, 1, 1);
    drop(pass);
    gpu.queue.submit([encoder.finish()]);
    let bytes = block_on(read_back::read_buffer(gpu, &output)).expect("the results can be read back");
    bytemuck::pod_collect_to_vec::<u8, Result>(&bytes)
}

/// SplitMix64, by Sebastiano Vigna: numbers from 0 to 1 that are the same on every run.
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 40) as f32 / (1 << 24) as f32
    }

    fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.unit()
    }

    fn one_of<T: Copy>(&mut self, all: &[T]) -> T {
        all[(self.unit() * all.len() as f32) as usize]
    }

    /// Options of every kind, whose base has at least this variance.
    fn options(&mut self, least_variance: f32) -> LobeOptions {
        LobeOptions {
            specular_power: self.between(1.0, 1.0 / least_variance.sqrt()).powi(2),
            form: self.one_of(Form::ALL),
            base: self.one_of(BaseLobe::ALL),
            repair: self.one_of(Repair::ALL),
            base_in_maps: self.one_of(Base::ALL),
            roughness_stored: self.one_of(RoughnessStored::ALL),
        }
    }
}

fn normalize([x, y, z]: [f32; 3]) -> [f32; 3] {
    let length = (x * x + y * y + z * z).sqrt();
    [x / length, y / length, z / length]
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Stored texels of a bump with slopes up to one and variances of 1e-3 to 0.1, for the inputs of a model.
fn texels(
    shading: Shading,
    random: &mut Random,
    options: &LobeOptions,
    packing: &Packing,
) -> ([[f32; 4]; 3], Slope) {
    let mean = Slope { x: random.between(-1.0, 1.0), y: random.between(-1.0, 1.0) };
    let [xx, yy] = [0; 2].map(|_| 0.1_f32.powf(random.between(1.0, 2.5)));
    let xy = random.between(-0.7, 0.7) * (xx * yy).sqrt();
    let m = Moments { mean, xx: xx + mean.x * mean.x, yy: yy + mean.y * mean.y, xy: xy + mean.x * mean.y };
    let stored = |value: f32, [scale, offset]: [f32; 2]| (value - offset) / scale;
    let shortening = random.between(0.6, 1.0);
    let unit = normal_from_slope(mean);
    let [nx, ny, nz] = [unit.x, unit.y, unit.z].map(|v| v * shortening);
    let [bx, by] = [mean.x, mean.y].map(|b| stored(b, packing.slope));
    let [ux, uy] = [nx, ny].map(|n| stored(n, packing.unit));
    let none = [0.0; 4];
    let texels = match shading {
        Shading::Clean => [[bx, by, stored(m.xx + m.yy, packing.trace), 1.0], none, none],
        Shading::Variance => {
            [[bx, by, stored(xx, packing.variance), stored(yy, packing.variance)], none, none]
        }
        Shading::Toksvig => [[ux, uy, stored(nz, packing.unit), random.between(0.01, 1.0)], none, none],
        Shading::Ggx => {
            let z = if random.unit() < 0.3 { 0.0 } else { stored(unit.z, packing.unit) };
            let roughness = roughcast::stored_from_variance(xx, options.roughness_stored);
            let direction = [0; 2].map(|_| stored(random.between(-1.0, 1.0), packing.unit));
            [
                [stored(unit.x, packing.unit), stored(unit.y, packing.unit), z, 1.0],
                [roughness, 0.0, 0.0, 1.0],
                [direction[0], direction[1], random.unit(), 1.0],
            ]
        }
        _ => [
            [ux, uy, nz, stored(m.xy, packing.mixed)],
            [bx, by, stored(m.xx, packing.second), stored(m.yy, packing.second)],
            none,
        ],
    };
    (texels, mean)
}

/// A draw whose half vector is within some deviations of the lobe's middle.
fn draw(shading: Shading, random: &mut Random, packing: &Packing) -> Draw {
    loop {
        let options = random.options(1e-3);
        let (texels, mean) = texels(shading, random, &options, packing);
        let width = 4.0 * (1.0 / options.specular_power).sqrt().max(0.03);
        let [x, y] = [mean.x, mean.y].map(|b| b + random.between(-width, width));
        let half = normalize([x, y, 1.0]);
        let view =
            normalize([random.between(-1.0, 1.0), random.between(-1.0, 1.0), random.between(0.05, 1.0)]);
        let twice = 2.0 * dot(half, view);
        let light = normalize([0, 1, 2].map(|i| twice * half[i] - view[i]));
        if light[2] > 0.02 && twice > 0.1 {
            return Draw { texels, view, light, options };
        }
    }
}

/// Where two results differ by more than what rounding explains.
fn difference(
    shading: Shading,
    draw: &Draw,
    packing: &Packing,
    cpu: &Result,
    gpu: &Result,
) -> Option<String> {
    let surface = shading.surface(&draw.texels, packing, &draw.options);
    let axis = normalize(surface.normal);
    let peak = surface.lobe(axis, axis, &draw.options);
    let lobe = (cpu[3] - gpu[3]).abs() / cpu[3].max(FAINT * peak);
    let normal = (0..3).map(|i| (cpu[i] - gpu[i]).abs()).fold(0.0, f32::max);
    let diffuse = (4..6).map(|i| (cpu[i] - gpu[i]).abs()).fold(0.0, f32::max);
    let specular =
        (6..8).map(|i| (cpu[i] - gpu[i]).abs() / cpu[i].max(FAINT * peak * 0.01)).fold(0.0, f32::max);
    let fine = lobe < LOBE && normal < NORMAL && diffuse < NORMAL && specular < 2.0 * LOBE;
    (!fine).then(|| {
        format!("{shading}: lobe {lobe:e}, normal {normal:e}, diffuse {diffuse:e}, specular {specular:e}")
    })
}

/// Scale 1.9, variance scale 0.2, sixteen bits.
fn unsigned() -> Packing {
    Packing {
        slope: [3.8, -1.9],
        second: [3.61, 0.0],
        mixed: [7.22, -3.61],
        trace: [7.22, 0.0],
        variance: [0.2, 0.0],
        unit: [2.0, -1.0],
    }
}

#[test]
fn lobes_normals_and_radiance() {
    let gpu = gpu();
    for packing in [Packing::IDENTITY, unsigned()] {
        for shading in Shading::ALL.iter().copied() {
            let mut random = Random(5);
            let draws: Vec<_> = (0..DRAWS).map(|_| draw(shading, &mut random, &packing)).collect();
            let found = on_gpu(&gpu, shading, &draws, &packing);
            let mut bright = 0;
            for (draw, gpu) in draws.iter().zip(&found) {
                let cpu = on_cpu(shading, draw, &packing);
                bright += usize::from(cpu[3] > 1e-3);
                if let Some(fault) = difference(shading, draw, &packing, &cpu, gpu) {
                    panic!("{fault}\n{draw:?}\nCPU {cpu:?}\nGPU {gpu:?}");
                }
            }
            assert!(bright > DRAWS / 10, "{shading}: only {bright} lobes are more than nothing");
        }
    }
}

#[test]
fn nothing_is_ever_nan_infinite_or_negative() {
    let gpu = gpu();
    let packing = Packing { variance: [16_384.0, 0.0], ..unsigned() };
    let ends = [0.0, 0.5, 1.0];
    let heights = [1e-30, 1e-15, 1e-6, 0.1, 1.0];
    for shading in Shading::ALL.iter().copied() {
        let mut random = Random(9);
        let draws: Vec<_> = (0..DRAWS)
            .map(|_| {
                let mut direction = || {
                    let angle = random.one_of(&[0.0_f32, 0.5, 1.0, 1.3]) * std::f32::consts::PI;
                    normalize([angle.cos(), angle.sin(), random.one_of(&heights)])
                };
                let (view, light) = (direction(), direction());
                let texels = [[0.0; 4]; 3].map(|texel| texel.map(|_| random.one_of(&ends)));
                Draw { texels, view, light, options: random.options(1e-5) }
            })
            .collect();
        for (draw, result) in draws.iter().zip(on_gpu(&gpu, shading, &draws, &packing)) {
            let fine = result.iter().all(|v| v.is_finite()) && result[3..].iter().all(|v| *v >= 0.0);
            assert!(fine, "{shading}: {draw:?} gives {result:?}");
        }
    }
}

#[test]
fn the_comparison_tells_a_slightly_different_model() {
    let gpu = gpu();
    let packing = Packing::IDENTITY;
    let mut random = Random(5);
    let draws: Vec<_> = (0..DRAWS).map(|_| draw(Shading::Lean, &mut random, &packing)).collect();
    let other: Vec<_> = draws
        .iter()
        .map(|draw| {
            let specular_power = 1.01 * draw.options.specular_power;
            Draw { options: LobeOptions { specular_power, ..draw.options }, ..*draw }
        })
        .collect();
    let found = on_gpu(&gpu, Shading::Lean, &other, &packing);
    let differ = draws.iter().zip(&found).filter(|(draw, gpu)| {
        let cpu = on_cpu(Shading::Lean, draw, &packing);
        difference(Shading::Lean, draw, &packing, &cpu, gpu).is_some()
    });
    assert!(differ.count() > DRAWS / 10);
}
