//! Levels of moments in f64, whether from the oracle, from stored samples or from the library's decoder.

use roughcast::texture::{MomentLevel, Texture, TextureArray};
use roughcast::{Baked, Image};

use super::slope_oracle::sample;

/// Names of the planes of a [`Level`], in order.
pub const NAMES: [&str; 5] = ["B.x", "B.y", "M.xx", "M.yy", "M.xy"];

/// One quantity of one level.
#[derive(Clone, Debug, PartialEq)]
pub struct Plane {
    pub width: usize,
    pub height: usize,
    pub values: Vec<f64>,
}

impl Plane {
    pub fn mean(&self) -> f64 {
        self.values.iter().sum::<f64>() / self.values.len() as f64
    }
}

/// One level: mean slope and raw second moments.
#[derive(Clone, Debug, PartialEq)]
pub struct Level {
    pub width: usize,
    pub height: usize,
    /// The planes, in the order of [`NAMES`].
    pub planes: [Vec<f64>; 5],
}

/// The five moments of a texel.
#[derive(Clone, Copy, Debug)]
pub struct Texel {
    pub b: [f64; 2],
    /// xx, yy, xy.
    pub m: [f64; 3],
}

impl Texel {
    /// `M - B Bᵀ`: xx, yy, xy.
    pub fn covariance(self) -> [f64; 3] {
        let [x, y] = self.b;
        [self.m[0] - x * x, self.m[1] - y * y, self.m[2] - x * y]
    }

    /// Root mean square slope of the footprint.
    pub fn rms(self) -> f64 {
        (self.m[0] + self.m[1]).max(0.0).sqrt()
    }
}

/// The larger and the smaller eigenvalue of a covariance xx, yy, xy.
pub fn eigenvalues(c: [f64; 3]) -> (f64, f64) {
    let middle = (c[0] + c[1]) / 2.0;
    let radius = (((c[0] - c[1]) / 2.0).powi(2) + c[2] * c[2]).sqrt();
    (middle + radius, middle - radius)
}

impl Level {
    pub fn texel(&self, index: usize) -> Texel {
        let [bx, by, xx, yy, xy] = &self.planes;
        Texel { b: [bx[index], by[index]], m: [xx[index], yy[index], xy[index]] }
    }

    pub fn texels(&self) -> impl Iterator<Item = Texel> + '_ {
        (0..self.width * self.height).map(|index| self.texel(index))
    }

    pub fn mean(&self, plane: usize) -> f64 {
        self.planes[plane].iter().sum::<f64>() / self.planes[plane].len() as f64
    }

    pub fn from_texels(width: usize, height: usize, texels: impl Iterator<Item = Texel>) -> Self {
        let mut planes: [Vec<f64>; 5] = Default::default();
        for texel in texels {
            for (plane, value) in planes.iter_mut().zip(texel.b.into_iter().chain(texel.m)) {
                plane.push(value);
            }
        }
        assert_eq!(planes[0].len(), width * height);
        Self { width, height, planes }
    }
}

/// Channel `channel` of an image.
pub fn channel_of(image: &Image, channel: usize) -> Plane {
    let (width, height) = (image.width(), image.height());
    let values = (0..width * height).map(|i| sample(image, i % width, i / width, channel)).collect();
    Plane { width, height, values }
}

/// The layer of a file with this name.
pub fn layer<'a>(array: &'a TextureArray, name: &str) -> &'a Texture {
    array
        .layers()
        .iter()
        .find(|layer| layer.name() == name)
        .unwrap_or_else(|| panic!("no layer is called {name}"))
}

/// The channel with this name on every level of a texture, as stored.
pub fn stored(texture: &Texture, channel: &str) -> Vec<Plane> {
    let index = texture.channel_names().iter().position(|name| *name == channel);
    let index = index.unwrap_or_else(|| {
        panic!("{} has no channel {channel}: {:?}", texture.name(), texture.channel_names())
    });
    texture.levels().iter().map(|image| channel_of(image, index)).collect()
}

/// The levels of a file of the layout `moments`, as stored, without the decoder's changes.
pub fn raw_moments(baked: &Baked) -> Vec<Level> {
    let texture = layer(&baked.arrays[0], "moments");
    let planes = NAMES.map(|name| stored(texture, name));
    (0..texture.levels().len())
        .map(|level| Level {
            width: planes[0][level].width,
            height: planes[0][level].height,
            planes: std::array::from_fn(|k| planes[k][level].values.clone()),
        })
        .collect()
}

/// B and M of LEAN's textures as stored, without the decoder's repair.
pub fn raw_lean(baked: &Baked) -> Vec<Level> {
    let sc = f64::from(baked.report.scale);
    let is_float = layer(&baked.arrays[0], "lean2").sample_type().is_float();
    // Floats hold the values directly.
    let signed = |v: f64| if is_float { v } else { 2.0 * v - 1.0 };
    let (first, second) = (layer(&baked.arrays[0], "lean1"), layer(&baked.arrays[0], "lean2"));
    let channel = |texture, name, load: &dyn Fn(f64) -> f64| -> Vec<Plane> {
        let mut planes = stored(texture, name);
        planes.iter_mut().flat_map(|plane| &mut plane.values).for_each(|v| *v = load(*v));
        planes
    };
    let mut planes = [
        channel(second, "B.x", &|v| signed(v) * sc),
        channel(second, "B.y", &|v| signed(v) * sc),
        channel(second, "M.xx", &|v| v * sc * sc),
        channel(second, "M.yy", &|v| v * sc * sc),
        channel(first, "M.xy", &|v| signed(v) * sc * sc),
    ];
    (0..planes[0].len())
        .map(|level| Level {
            width: planes[0][level].width,
            height: planes[0][level].height,
            planes: std::array::from_fn(|k| std::mem::take(&mut planes[k][level].values)),
        })
        .collect()
}

/// The levels as the library's decoder returns them.
pub fn decoded(arrays: &[TextureArray]) -> Vec<Level> {
    let levels = roughcast::texture::decode(arrays).unwrap_or_else(|error| panic!("{error}"));
    levels.iter().map(from_decoded).collect()
}

/// A level of the library in f64.
pub fn from_decoded(level: &MomentLevel) -> Level {
    let texels = level
        .moments()
        .iter()
        .map(|m| Texel { b: [m.mean.x.into(), m.mean.y.into()], m: [m.xx.into(), m.yy.into(), m.xy.into()] });
    Level::from_texels(level.width(), level.height(), texels)
}

/// A quantity of every texel of every level.
pub fn planes(levels: &[Level], quantity: impl Fn(Texel) -> f64) -> Vec<Plane> {
    let plane =
        |l: &Level| Plane { width: l.width, height: l.height, values: l.texels().map(&quantity).collect() };
    levels.iter().map(plane).collect()
}

/// The same, computed from several stored channels.
pub fn combined<const N: usize>(channels: [Vec<Plane>; N], f: impl Fn([f64; N]) -> f64) -> Vec<Plane> {
    let levels = channels[0].len();
    let value = |level: usize, i: usize| f(std::array::from_fn(|k| channels[k][level].values[i]));
    (0..levels)
        .map(|level| {
            let (width, height) = (channels[0][level].width, channels[0][level].height);
            let values = (0..width * height).map(|i| value(level, i)).collect();
            Plane { width, height, values }
        })
        .collect()
}
