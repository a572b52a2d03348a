//! Drawings whose options change, that fill a part of their target, and that overlap another drawing.

mod common;

use common::scenes::{SIZE, maps, scene};
use common::{gpu, one_level};
use pollster::block_on;
use roughcast::SampleType;
use roughcast::shading::{Form, Shading, ShadingOptions};
use roughcast_gpu::render::{
    DEPTH_FORMAT, DrawOptions, Drawing, Geometry, GpuDetail, Order, PARTS_FORMAT, Part, RenderTarget,
    Renderer, Views, render,
};
use roughcast_gpu::{Gpu, GpuError, read_back};
use roughcast_scene::{Filter, Picture, Plane, Sampler, Scene, Shape, Torus, View};

fn plane() -> Scene {
    scene(Shape::Plane(Plane::default()), View::Mid)
}

async fn drawing(renderer: &mut Renderer, scene: &Scene, options: &DrawOptions) -> Result<Drawing, GpuError> {
    let gpu = renderer.gpu().clone();
    let geometry = Geometry::new(&gpu, &scene.shape, 64).await?;
    let textures = GpuDetail::of_model(&gpu, Shading::Lean, &maps(Shading::Lean, SampleType::F16)).await?;
    renderer.prepare(&geometry, &textures, options).await
}

#[test]
fn options_change_without_another_drawing() {
    let (gpu, scene) = (gpu(), plane());
    let plain = DrawOptions::default();
    let other = plain.with_sampler(Sampler::default().with_filter(Filter::Nearest)).with_shading_options(
        ShadingOptions::default().with_specular_power(20.0).with_form(Form::Normalised),
    );
    let [first, changed, back, fresh]: [Picture; 4] = block_on(async {
        let mut renderer = Renderer::new(&gpu, RenderTarget::Parts).await?;
        let mut changing = drawing(&mut renderer, &scene, &plain).await?;
        let first = render(&renderer, &mut changing, &scene, SIZE).await?;
        changing.set_options(&mut renderer, &other).await?;
        let changed = render(&renderer, &mut changing, &scene, SIZE).await?;
        changing.set_options(&mut renderer, &plain).await?;
        let back = render(&renderer, &mut changing, &scene, SIZE).await?;
        // A filter that the hardware does not support leaves the drawing unchanged.
        let ewa = plain.with_sampler(Sampler::default().with_filter(Filter::Ewa));
        assert!(changing.set_options(&mut renderer, &ewa).await.is_err());
        assert_eq!(render(&renderer, &mut changing, &scene, SIZE).await?, back);
        let mut fresh = drawing(&mut renderer, &scene, &other).await?;
        let fresh = render(&renderer, &mut fresh, &scene, SIZE).await?;
        Ok::<_, GpuError>([first, changed, back, fresh])
    })
    .expect("four pictures");
    assert_ne!(first, changed);
    assert_eq!(changed, fresh, "the same as a drawing made with these options");
    assert_eq!(first, back);
}

/// A target of radiance and specular parts with its depths.
struct Target {
    colour: wgpu::Texture,
    specular: wgpu::Texture,
    depth: wgpu::Texture,
}

impl Target {
    fn new(gpu: &Gpu, size: (u32, u32)) -> Self {
        let texture = |format, usage| {
            let usage = usage | wgpu::TextureUsages::RENDER_ATTACHMENT;
            gpu.device().create_texture(&one_level(size, format, usage))
        };
        let copied = wgpu::TextureUsages::COPY_SRC;
        Self {
            colour: texture(PARTS_FORMAT, copied),
            specular: texture(PARTS_FORMAT, copied),
            depth: texture(DEPTH_FORMAT, wgpu::TextureUsages::empty()),
        }
    }

    fn draw(&self, gpu: &Gpu, drawing: &Drawing, part: Option<Part>, order: Order) {
        let [colour, specular, depth] = [&self.colour, &self.specular, &self.depth]
            .map(|texture| texture.create_view(&Default::default()));
        let mut encoder = gpu.device().create_command_encoder(&Default::default());
        let views = Views { specular: Some(&specular), part, order, ..Views::new(&colour, &depth) };
        drawing.draw(&mut encoder, &views, None);
        gpu.queue().submit([encoder.finish()]);
    }

    /// Radiance and coverage of each pixel.
    fn pixels(&self, gpu: &Gpu) -> Vec<[f32; 4]> {
        let bytes = block_on(read_back::read_texture(gpu, &self.colour, 0)).expect("pixels");
        bytemuck::pod_collect_to_vec(&bytes)
    }
}

#[test]
fn a_drawing_fills_a_part_of_its_target() {
    /// Tolerance for pixels further to the right, whose positions round differently. The flank of a lobe amplifies the
    /// rounding, and for a few pixels the sampler chooses other levels.
    const MOVED: f32 = 1e-3;
    /// Fraction of the pixels that may differ by more. A part that is one pixel off changes most of them.
    const FEW: f64 = 0.005;
    let (gpu, scene) = (gpu(), plane());
    let (width, height) = SIZE;
    let part = Part { x: width, y: 0, width, height };
    let target = Target::new(&gpu, (2 * width, height));
    let alone = block_on(async {
        let mut renderer = Renderer::new(&gpu, RenderTarget::Parts).await?;
        let mut drawing = drawing(&mut renderer, &scene, &DrawOptions::default()).await?;
        let alone = render(&renderer, &mut drawing, &scene, SIZE).await?;
        target.draw(&gpu, &drawing, Some(part), Order::Only);
        Ok::<_, GpuError>(alone)
    })
    .expect("a picture");
    let pixels = target.pixels(&gpu);
    let mut moved = 0;
    for (i, [r, g, b, coverage]) in pixels.iter().enumerate() {
        let (x, y) = (i as u32 % (2 * width), i as u32 / (2 * width));
        if x < width {
            assert_eq!(([*r, *g, *b], *coverage), (scene.background, 0.0), "({x}, {y}) is not of the part");
        } else {
            let j = (y * width + x - width) as usize;
            assert_eq!(*coverage, alone.coverage()[j], "({x}, {y})");
            let is_moved = |(got, wanted): (&f32, f32)| (got - wanted).abs() > MOVED * wanted.abs().max(1e-2);
            moved += usize::from([r, g, b].into_iter().zip(alone.radiance()[j]).any(is_moved));
        }
    }
    let share = moved as f64 / alone.coverage().len() as f64;
    assert!(share <= FEW, "{share} of the pixels differ");
}

#[test]
fn a_drawing_lies_over_another_and_is_hidden_by_it() {
    let gpu = gpu();
    let floor = plane();
    // The ring is half in the floor.
    let ring = Scene { shape: std::sync::Arc::new(Shape::Torus(Torus::default())), ..floor.clone() };
    let (behind, hidden) = (Target::new(&gpu, SIZE), Target::new(&gpu, SIZE));
    let [floor_alone, ring_alone] = block_on(async {
        let mut renderer = Renderer::new(&gpu, RenderTarget::Parts).await?;
        let mut of_floor = drawing(&mut renderer, &floor, &DrawOptions::default()).await?;
        let mut of_ring = drawing(&mut renderer, &ring, &DrawOptions::default()).await?;
        let floor_alone = render(&renderer, &mut of_floor, &floor, SIZE).await?;
        // Both must place their depth planes identically, by the larger shape.
        let as_floor = Scene { shape: floor.shape.clone(), ..ring.clone() };
        of_ring.set_view(&renderer, &as_floor, SIZE).await?;
        let alone = Target::new(&gpu, SIZE);
        alone.draw(&gpu, &of_ring, None, Order::Only);
        behind.draw(&gpu, &of_floor, None, Order::First);
        behind.draw(&gpu, &of_ring, None, Order::Next);
        hidden.draw(&gpu, &of_ring, None, Order::First);
        hidden.draw(&gpu, &of_floor, None, Order::Next);
        let floor_alone: Vec<[f32; 4]> = (0..floor_alone.len())
            .map(|i| {
                let [r, g, b] = floor_alone.radiance()[i];
                [r, g, b, floor_alone.coverage()[i]]
            })
            .collect();
        Ok::<_, GpuError>([floor_alone, alone.pixels(&gpu)])
    })
    .expect("pictures");
    let (one, other) = (behind.pixels(&gpu), hidden.pixels(&gpu));
    assert_eq!(one, other, "the order does not matter");
    let [mut of_floor, mut of_ring] = [0, 0];
    for (i, pixel) in one.iter().enumerate() {
        assert!(*pixel == floor_alone[i] || *pixel == ring_alone[i], "{i}: {pixel:?} is of neither");
        of_floor += usize::from(*pixel == floor_alone[i] && *pixel != ring_alone[i]);
        of_ring += usize::from(*pixel == ring_alone[i] && *pixel != floor_alone[i]);
    }
    assert!(of_floor > 100 && of_ring > 100, "{of_floor} pixels of the floor and {of_ring} of the ring");
}
