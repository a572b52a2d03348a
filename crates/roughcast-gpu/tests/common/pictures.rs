//! Compares pictures by the CPU and by the GPU.

use roughcast::shading::ShadingOptions;
use roughcast::texture::TextureArray;
use roughcast_gpu::render::{Bumps, DrawOptions, Geometry, GpuDetail, RenderTarget, Renderer, render};
use roughcast_gpu::{Gpu, GpuError};
use roughcast_scene::render::{Method, unwatched};
use roughcast_scene::{BakedTextures, Detail, Picture, Resolved, Sampler, Scene, Shape};

use roughcast::shading::Shading;

/// A picture by the CPU.
pub fn by_cpu(
    scene: &Scene,
    shading: Shading,
    maps: &[TextureArray],
    options: &DrawOptions,
    size: (u32, u32),
) -> Picture {
    let textures = BakedTextures::of_model(shading, maps).expect("the maps are the model's");
    let DrawOptions { sampler, shading_options, bumps, .. } = *options;
    let detail = textures.sampled(sampler);
    let resolved = Resolved(&detail);
    let detail: &dyn Detail = match bumps {
        Bumps::Resolved => &resolved,
        _ => &detail,
    };
    Method { shading, detail, options: shading_options }.render(scene, size, &unwatched).expect("a picture")
}

/// Pictures by the GPU, with the geometry of one scene.
pub struct GpuPictures {
    pub renderer: Renderer,
    pub geometry: Geometry,
}

impl GpuPictures {
    /// `detail` is that of the shape's triangles.
    pub fn new(gpu: &Gpu, scene: &Scene, detail: u32) -> Self {
        let renderer = pollster::block_on(Renderer::new(gpu, RenderTarget::Parts)).expect("a renderer");
        let geometry = pollster::block_on(Geometry::new(gpu, &scene.shape, detail)).expect("a shape");
        Self { renderer, geometry }
    }

    pub fn render(
        &mut self,
        scene: &Scene,
        shading: Shading,
        maps: &[TextureArray],
        options: &DrawOptions,
        size: (u32, u32),
    ) -> Result<Picture, GpuError> {
        pollster::block_on(async {
            let textures = GpuDetail::of_model(self.renderer.gpu(), shading, maps).await?;
            let mut drawing = self.renderer.prepare(&self.geometry, &textures, options).await?;
            render(&self.renderer, &mut drawing, scene, size).await
        })
    }
}

pub fn options(sampler: Sampler, shading_options: ShadingOptions) -> DrawOptions {
    DrawOptions::default().with_sampler(sampler).with_shading_options(shading_options)
}

/// The difference between two pictures.
#[derive(Clone, Debug, PartialEq)]
pub struct Apart {
    /// Largest difference of a channel, relative to the value or to a hundredth of the brightest value, whichever is
    /// larger.
    pub largest: f64,
    /// Location of the largest difference.
    pub place: String,
    /// Mean absolute difference divided by the mean radiance.
    pub mean: f64,
    /// Relative difference of the total specular light.
    pub energy: f64,
    /// Pixels that were compared.
    pub pixels: usize,
    /// Covered pixels of the first picture.
    pub covered: usize,
}

/// Fraction of the brightest value below which differences are no longer relative to the value.
const DARK: f64 = 0.01;

/// Compares radiance and specular parts at the pixels that `compared` chooses.
pub fn apart(cpu: &Picture, gpu: &Picture, compared: impl Fn(usize) -> bool) -> Apart {
    assert_eq!((cpu.width(), cpu.height()), (gpu.width(), gpu.height()));
    let values = |picture: &Picture, i: usize| {
        let [r, s] = [picture.radiance()[i], picture.specular()[i]];
        [r[0], r[1], r[2], s[0], s[1], s[2]].map(f64::from)
    };
    let brightest = (0..cpu.len()).flat_map(|i| values(cpu, i)).fold(0.0, f64::max);
    let mut apart = Apart {
        largest: 0.0,
        place: String::new(),
        mean: 0.0,
        energy: 0.0,
        pixels: 0,
        covered: cpu.coverage().iter().filter(|c| **c > 0.0).count(),
    };
    let (mut differences, mut radiance) = (0.0, 0.0);
    let mut energy = [0.0, 0.0];
    for i in (0..cpu.len()).filter(|i| compared(*i)) {
        apart.pixels += 1;
        let (a, b) = (values(cpu, i), values(gpu, i));
        for (channel, (a, b)) in a.into_iter().zip(b).enumerate() {
            let difference = (a - b).abs() / a.max(DARK * brightest);
            // NaN is far from everything.
            if difference.is_nan() || difference > apart.largest {
                apart.largest = if difference.is_nan() { f64::INFINITY } else { difference };
                apart.place =
                    format!("({}, {}) channel {channel}: {a:e} and {b:e}", i % cpu.width(), i / cpu.width());
            }
            if channel < 3 {
                differences += (a - b).abs();
                radiance += a;
            } else {
                energy[0] += a;
                energy[1] += b;
            }
        }
    }
    apart.mean = differences / radiance;
    apart.energy = energy[1] / energy[0] - 1.0;
    apart
}

/// Whether all neighbouring pixels have the same coverage in both pictures. At a silhouette they do not, because
/// rounding decides there.
pub fn inside(cpu: &Picture, gpu: &Picture, i: usize) -> bool {
    let (width, height) = (cpu.width(), cpu.height());
    let (x, y) = (i % width, i / width);
    let (columns, rows) =
        (x.saturating_sub(1)..=(x + 1).min(width - 1), y.saturating_sub(1)..=(y + 1).min(height - 1));
    let own = cpu.coverage()[i];
    rows.flat_map(|y| columns.clone().map(move |x| y * width + x))
        .all(|j| cpu.coverage()[j] == own && gpu.coverage()[j] == own)
}

/// Least cosine between view and surface normal at which flat triangles can stand for round shapes. Seen more
/// obliquely, triangles that lie slightly lower meet the view ray somewhere else.
const OBLIQUE: f64 = 0.3;
/// Distance from the poles of a sphere, as a fraction of the map's height, within which triangles do not follow the
/// direction of its tangent.
const POLE: f64 = 0.1;

/// Whether the centre of a pixel shows a place where flat triangles stand for the shape and where rounding does not
/// decide which texel is nearest: at least `margin` texels from the edges of its texel, for maps of `side` texels.
pub fn well_placed(scene: &Scene, (width, height): (u32, u32), i: usize, side: f64, margin: f64) -> bool {
    let (x, y) = (i % width as usize, i / width as usize);
    let ray = scene.camera.ray(x as f64 + 0.5, y as f64 + 0.5, width, height);
    let Some(hit) = scene.shape.hit(&ray) else { return false };
    let round = matches!(*scene.shape, Shape::Sphere(_) | Shape::Torus(_));
    let at_pole = matches!(*scene.shape, Shape::Sphere(_)) && !(POLE..1.0 - POLE).contains(&hit.uv(0).y);
    let at = hit.uv(0) * scene.repeats * side;
    let from_edge = (at - at.round()).abs().min_element();
    let oblique = round && -hit.geometric_normal.dot(ray.direction) < OBLIQUE;
    from_edge >= margin && !oblique && !at_pole
}
