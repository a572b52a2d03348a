//! The methods of LEAN Figure 12, drawn in turn and timed by the GPU's own clock.

use std::sync::Arc;

use anyhow::{Context, Result};
use glam::DVec2;
use roughcast::noise::Noise;
use roughcast::shading::{Material, Shading};
use roughcast::{BakeOptions, Image, SampleType, Samples, SourceOptions, Wrap, normal_from_slope};
use roughcast_gpu::bake::{BakePath, GpuBake, GpuBaker, bake_bandwidth};
use roughcast_gpu::render::{
    DEPTH_FORMAT, DrawOptions, Drawing, Geometry, GpuDetail, GpuPlacement, RenderTarget, Renderer, Views,
    shader_source,
};
use roughcast_gpu::wgpu;
use roughcast_gpu::{Gpu, Span, Timestamps};
use roughcast_scene::{
    NoiseDetail, Placement, Plane, Reconstruction, Scene, Shape, SlopeMap, TangentSource, View, pattern,
};

use super::instructions::{Instructions, count};
use crate::progress;

/// A method, and when its maps are baked.
struct TimedMethod {
    name: &'static str,
    shading: Shading,
    /// Texels of the maps along each side.
    side: usize,
    maps: Maps,
    bumps: Bumps,
}

/// The source of bumps, and how it is placed.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Bumps {
    /// The maps, in the frame of the mesh.
    Mesh,
    /// The maps, without tangents.
    Derivatives,
    /// The maps, along three axes.
    Triplanar,
    /// The maps in the frame of the mesh, and six octaves of noise on top.
    WithNoise,
}

/// When maps are made.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Maps {
    Once,
    EveryFrame,
}

/// Texels along each side of a map that is baked once.
pub const SIDE: usize = 512;

/// All methods; the others are compared with the first.
const METHODS: [TimedMethod; 8] = [
    TimedMethod { name: "blinn-phong", shading: Shading::BlinnPhong, ..LEAN },
    LEAN,
    TimedMethod { name: "lean-generated-512", maps: Maps::EveryFrame, ..LEAN },
    TimedMethod { name: "lean-generated-2048", side: 2048, maps: Maps::EveryFrame, ..LEAN },
    TimedMethod { name: "clean", shading: Shading::Clean, ..LEAN },
    TimedMethod { name: "lean-without-tangents", bumps: Bumps::Derivatives, ..LEAN },
    TimedMethod { name: "lean-triplanar", bumps: Bumps::Triplanar, ..LEAN },
    TimedMethod { name: "lean-and-noise", bumps: Bumps::WithNoise, ..LEAN },
];

const LEAN: TimedMethod =
    TimedMethod { name: "lean", shading: Shading::Lean, side: SIDE, maps: Maps::Once, bumps: Bumps::Mesh };

impl Bumps {
    /// The maps of a scene in their place.
    fn place(self, maps: GpuDetail, scene: &Scene, side: usize) -> GpuDetail {
        let texel = 1.0 / (side as f64 * scene.repeats);
        let sized = Placement::default().with_world_height_per_texel(texel);
        match self {
            Self::Mesh => maps,
            Self::Derivatives => {
                maps.placed(Placement::default().with_tangent_source(TangentSource::Derivatives))
            }
            Self::Triplanar => maps.placed(GpuPlacement::from(sized).triplanar()),
            // The finest octave is three pixels wide.
            Self::WithNoise => maps.with_noise(NoiseDetail::new(
                Noise::default().with_octaves(6).with_frequency(0.03 / texel).with_amplitude(5.0 * texel),
            )),
        }
    }
}

/// The cost of one method.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    pub name: &'static str,
    pub instructions: Instructions,
    /// Milliseconds per frame: the median drawing time plus, if maps are baked for every frame, the median baking time.
    pub milliseconds: f64,
    /// The time relative to Blinn-Phong.
    pub ratio: f64,
    /// Bytes that baking the maps moves in every frame; 0 if they are baked once.
    pub generated_bytes: u64,
}

/// Warm-up frames before the measured ones, in which drivers compile, allocate and raise clocks.
const WARM_UP: u32 = 3;

/// Half floats, which every device can filter, store to and render to; without a base, which the model adds when
/// shading.
pub fn bake_options(shading: Shading) -> BakeOptions {
    BakeOptions::default().with_layout(shading.layout()).with_sample_type(SampleType::F16)
}

/// Draws `frames` frames of each method in pictures of `size` pixels.
///
/// The methods take turns within a frame, and each frame begins with a different method, so that clock drift and the
/// state of the caches affect all methods equally. Maps that are baked for every frame are baked before it is drawn;
/// their baking time is measured separately.
pub async fn measure(gpu: &Gpu, size: (u32, u32), frames: u32) -> Result<Vec<Row>> {
    let mut timestamps = Timestamps::new(gpu, 1).await?;
    let mut renderer = Renderer::new(gpu, RenderTarget::Colour(COLOUR_FORMAT)).await?;
    let mut prepared = Vec::new();
    for timed_method in &METHODS {
        prepared.push(PreparedMethod::new(&mut renderer, timed_method, size).await?);
    }
    let canvas = Canvas::new(gpu, size).await?;
    let bar = progress::timed_bar(u64::from(WARM_UP + frames));
    for frame in 0..WARM_UP + frames {
        for turn in 0..prepared.len() {
            let index = (frame as usize + turn) % prepared.len();
            let nanoseconds = prepared[index].draw(gpu, &canvas, &mut timestamps).await?;
            if frame >= WARM_UP {
                prepared[index].nanoseconds.extend(nanoseconds);
            }
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    rows(&prepared)
}

/// Submits one pass, waits for it, and returns how many nanoseconds it took, if the clock measured it.
async fn timed(
    gpu: &Gpu,
    timestamps: &mut Timestamps,
    encode: impl FnOnce(&mut wgpu::CommandEncoder, &Span),
) -> Result<Option<f64>> {
    let span = timestamps.span("pass").context("there is room for a span")?;
    let mut encoder = gpu.device().create_command_encoder(&Default::default());
    encode(&mut encoder, &span);
    timestamps.resolve(&mut encoder);
    gpu.queue().submit([encoder.finish()]);
    Ok(timestamps.read(gpu).await?.first().and_then(|span| span.nanoseconds))
}

fn rows(prepared: &[PreparedMethod]) -> Result<Vec<Row>> {
    let mut rows: Vec<Row> = Vec::new();
    for method in prepared {
        let draw = median(&method.nanoseconds)
            .context("the GPU's clock is too coarse to measure this: use a larger --size")?;
        let milliseconds = (method.bake_nanoseconds + draw) * 1e-6;
        let reference = rows.first().map_or(milliseconds, |first| first.milliseconds);
        rows.push(Row {
            name: method.timed_method.name,
            instructions: method.instructions,
            milliseconds,
            ratio: milliseconds / reference,
            generated_bytes: match method.timed_method.maps {
                Maps::Once => 0,
                Maps::EveryFrame => method.baker.moved_bytes(),
            },
        });
    }
    Ok(rows)
}

/// A method with all its GPU resources.
struct PreparedMethod {
    timed_method: &'static TimedMethod,
    instructions: Instructions,
    baker: GpuBaker,
    drawing: Drawing,
    /// Times of baking the maps for one frame.
    bake_nanoseconds: f64,
    /// Times of drawing each measured frame.
    nanoseconds: Vec<f64>,
}

impl PreparedMethod {
    async fn new(
        renderer: &mut Renderer,
        timed_method: &'static TimedMethod,
        size: (u32, u32),
    ) -> Result<Self> {
        let gpu = renderer.gpu().clone();
        let (map, source) = (normal_map(timed_method.side)?, SourceOptions::default());
        let options = bake_options(timed_method.shading);
        let baker = GpuBake::new().source(source).options(options).for_image(&gpu, &map).await?;
        baker.run();
        let textures =
            GpuDetail::of_baked(&gpu, timed_method.shading, baker.textures(), &baker.info().await?)?;
        let scene = scene(timed_method.side, size);
        let textures = timed_method.bumps.place(textures, &scene, timed_method.side);
        let geometry = Geometry::new(&gpu, &scene.shape, 1).await?;
        let mut drawing = renderer.prepare(&geometry, &textures, &DrawOptions::default()).await?;
        drawing.set_view(renderer, &scene, size).await?;
        let key = textures.shader_key(&geometry)?;
        let instructions = count(&shader_source(&key)?, "radiance")?;
        // Measured separately: between render passes, lavapipe's clock reports no time for a compute pass.
        let bake_nanoseconds = match timed_method.maps {
            Maps::Once => 0.0,
            Maps::EveryFrame => {
                bake_bandwidth(&gpu, timed_method.side as u32, &options, BakePath::default())
                    .await?
                    .nanoseconds
            }
        };
        Ok(Self { timed_method, instructions, baker, drawing, bake_nanoseconds, nanoseconds: Vec::new() })
    }

    /// Bakes the maps for a frame, if needed, and draws it. Returns the nanoseconds of the drawing, or `None` if the
    /// clock did not measure it.
    async fn draw(&self, gpu: &Gpu, canvas: &Canvas, timestamps: &mut Timestamps) -> Result<Option<f64>> {
        if self.timed_method.maps == Maps::EveryFrame {
            self.baker.run();
        }
        let views = Views::new(&canvas.colour, &canvas.depth);
        timed(gpu, timestamps, |encoder, span| {
            self.drawing.draw(encoder, &views, Some(span.of_render_pass()));
        })
        .await
    }
}

/// The render target, which is not displayed.
struct Canvas {
    colour: wgpu::TextureView,
    depth: wgpu::TextureView,
}

const COLOUR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

impl Canvas {
    async fn new(gpu: &Gpu, (width, height): (u32, u32)) -> Result<Self> {
        let descriptor = |format| wgpu::TextureDescriptor {
            label: Some("canvas"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
            view_formats: &[],
        };
        let colour = gpu.create_texture("the picture", &descriptor(COLOUR_FORMAT)).await?;
        let depth = gpu.create_texture("the picture's depths", &descriptor(DEPTH_FORMAT)).await?;
        Ok(Self {
            colour: colour.create_view(&Default::default()),
            depth: depth.create_view(&Default::default()),
        })
    }
}

/// A plane that covers the whole picture, with maps of this many texels along each side, three texels per pixel.
fn scene(side: usize, size: (u32, u32)) -> Scene {
    View::Mid.scene(Arc::new(Shape::Plane(Plane::default())), (side, side), size, Material::default())
}

/// Root mean square slope of the bumps.
const RMS_SLOPE: f64 = 0.3;
const SEED: u64 = 12;

/// A normal map of 4 x 8 bits with random bumps, repeated if it is larger than [`SIDE`].
fn normal_map(side: usize) -> Result<Image> {
    let bumps = pattern::random_bumps(SIDE, RMS_SLOPE, SEED);
    let slopes = SlopeMap::of(&bumps.heights, &bumps.source_options())?;
    let byte = |component: f32| (127.5 + 127.5 * component).round() as u8;
    let texel = |i: usize| {
        let centre = DVec2::new((i % side) as f64 + 0.5, (i / side) as f64 + 0.5) / SIDE as f64;
        let normal = normal_from_slope(slopes.at(centre, Wrap::Repeat, Reconstruction::Facets));
        [byte(normal.x), byte(normal.y), byte(normal.z), u8::MAX]
    };
    Ok(Image::new(side, side, 4, Samples::U8((0..side * side).flat_map(texel).collect()))?)
}

fn median(times: &[f64]) -> Option<f64> {
    let mut sorted = times.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_object_covers_every_pixel() {
        let size = (1600, 1200);
        let scene = scene(SIDE, size);
        // A plane is convex: if it is visible at the corners of the picture, it covers all of it.
        for (x, y) in [(0.0, 0.0), (1600.0, 0.0), (0.0, 1200.0), (1600.0, 1200.0)] {
            assert!(scene.shape.hit(&scene.camera.ray(x, y, size.0, size.1)).is_some(), "{x}, {y}");
        }
    }

    #[test]
    fn the_map_has_bumps_that_repeat() {
        let (one, many) = (normal_map(SIDE).expect("a map"), normal_map(2 * SIDE).expect("a map"));
        let (Samples::U8(one), Samples::U8(many)) = (one.samples(), many.samples()) else { panic!("8 bits") };
        assert_eq!(one[..4 * SIDE], many[..4 * SIDE]);
        assert_eq!(one[..4 * SIDE], many[4 * SIDE..8 * SIDE]);
        assert_ne!(one[..4 * SIDE], one[4 * SIDE..8 * SIDE]);
    }

    #[test]
    fn a_median_is_the_middle_one() {
        assert_eq!(median(&[3.0, 1.0, 100.0]), Some(3.0));
        assert_eq!(median(&[]), None);
    }
}
