//! Levels of what layers have in common, and the levels of mixed maps.

use super::mix::check_pairs;
use super::{CrossMoments, LayerError, LayerMethod, MaskedMoments, approximated, masked, mixed};
use crate::convention::Wrap;
use crate::distribution::Distribution;
use crate::moments::Moments;
use crate::options::PyramidFilter;
use crate::pyramid::weights::halving_in_doubles;
use crate::texture::MomentLevel;

/// A level of a texture of layers, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct LayerLevel<T> {
    width: usize,
    height: usize,
    texels: Vec<T>,
}

impl<T> LayerLevel<T> {
    /// Number of texels per row.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Number of rows.
    pub fn height(&self) -> usize {
        self.height
    }

    /// The texels, `width * height` of them.
    pub fn texels(&self) -> &[T] {
        &self.texels
    }
}

/// The cross terms of a pair of layers on every level.
#[derive(Clone, Debug, PartialEq)]
pub struct MixingTexture {
    pair: (usize, usize),
    levels: Vec<LayerLevel<CrossMoments>>,
}

impl MixingTexture {
    pub(super) fn new(pair: (usize, usize), levels: Vec<LayerLevel<CrossMoments>>) -> Self {
        Self { pair, levels }
    }

    /// The numbers of the two layers.
    pub fn pair(&self) -> (usize, usize) {
        self.pair
    }

    /// The levels, down to 1x1.
    pub fn levels(&self) -> &[LayerLevel<CrossMoments>] {
        &self.levels
    }
}

/// All levels of texels of N numbers, with the weights of the pyramid. They are raw moments, carried in doubles, so that
/// each level is rounded once, when it is stored.
pub(super) fn filtered<const N: usize, T>(
    size: (usize, usize),
    texels: Vec<[f64; N]>,
    filter: PyramidFilter,
    wrap: Wrap,
    stored: impl Fn([f64; N]) -> T,
) -> Vec<LayerLevel<T>> {
    let store = |(width, height), texels: &[[f64; N]]| LayerLevel {
        width,
        height,
        texels: texels.iter().map(|texel| stored(*texel)).collect(),
    };
    let (mut size, mut texels) = (size, texels);
    let mut levels = vec![store(size, &texels)];
    while size != (1, 1) {
        (size, texels) = halved(size, &texels, filter, wrap);
        levels.push(store(size, &texels));
    }
    levels
}

fn halved<const N: usize>(
    (width, height): (usize, usize),
    texels: &[[f64; N]],
    filter: PyramidFilter,
    wrap: Wrap,
) -> ((usize, usize), Vec<[f64; N]>) {
    let (columns, rows) = (halving_in_doubles(width, filter, wrap), halving_in_doubles(height, filter, wrap));
    let average = |line: &[(usize, f64)], texel: &dyn Fn(usize) -> [f64; N]| {
        line.iter().fold([0.0; N], |mut sum, (index, weight)| {
            sum.iter_mut().zip(texel(*index)).for_each(|(sum, value)| *sum += weight * value);
            sum
        })
    };
    let narrow: Vec<[f64; N]> = texels
        .chunks_exact(width)
        .flat_map(|row| columns.iter().map(|column| average(column, &|x| row[x])))
        .collect();
    let next = rows
        .iter()
        .flat_map(|row| (0..columns.len()).map(|x| average(row, &|y| narrow[y * columns.len() + x])));
    let next = next.collect();
    ((columns.len(), rows.len()), next)
}

/// Every level of layers mixed with their mixing textures, with constant weights: [`mixed`] at every texel. Rounding may leave
/// moments whose covariance is not valid; [`Moments::covariance`] repairs it.
///
/// # Errors
/// [`LayerError`] as [`mixed`], and if the textures differ in size: a mixing texture belongs to the texels of both layers.
pub fn mixed_levels(
    layers: &[(f32, &[MomentLevel])],
    mixing: &[MixingTexture],
) -> Result<Vec<MomentLevel>, LayerError> {
    check_pairs(layers.len(), mixing.len())?;
    let method = LayerMethod::MixingTextures;
    let sizes = layers.iter().map(|(_, levels)| sizes_of(levels.iter().map(|l| (l.width(), l.height()))));
    let of_mixing = mixing.iter().map(|mixing| sizes_of(mixing.levels.iter().map(|l| (l.width, l.height))));
    same_sizes(method, &sizes.chain(of_mixing).collect::<Vec<_>>())?;
    combined(layers, |level, texel| {
        let cross: Vec<_> = mixing.iter().map(|mixing| mixing.levels[level].texels[texel]).collect();
        mixed(&distributions(layers, level, texel), &cross)
    })
}

/// Every level of layers mixed from their filtered means, with constant weights: [`approximated`] at every texel.
///
/// # Errors
/// [`LayerError`] as [`approximated`], and if the textures differ in size. A renderer may mix textures of any sizes, since
/// it samples each by itself; levels, however, are combined texel by texel.
pub fn approximated_levels(layers: &[(f32, &[MomentLevel])]) -> Result<Vec<MomentLevel>, LayerError> {
    let sizes = layers.iter().map(|(_, levels)| sizes_of(levels.iter().map(|l| (l.width(), l.height()))));
    same_sizes(LayerMethod::Approximate, &sizes.collect::<Vec<_>>())?;
    combined(layers, |level, texel| approximated(&distributions(layers, level, texel)))
}

/// Every level of masked layers: [`masked`] at every texel.
///
/// # Errors
/// [`LayerError`] as [`masked`], and if the textures differ in size.
pub fn masked_levels(layers: &[Vec<LayerLevel<MaskedMoments>>]) -> Result<Vec<MomentLevel>, LayerError> {
    let sizes = layers.iter().map(|levels| sizes_of(levels.iter().map(|l| (l.width, l.height))));
    same_sizes(LayerMethod::Mask, &sizes.collect::<Vec<_>>())?;
    let first = layers.first().ok_or(LayerError::NoLayers)?;
    let level = |number: usize| {
        let (width, height) = (first[number].width, first[number].height);
        moment_level(width, height, |texel| {
            masked(&layers.iter().map(|levels| levels[number].texels[texel]).collect::<Vec<_>>())
        })
    };
    (0..first.len()).map(level).collect()
}

fn combined(
    layers: &[(f32, &[MomentLevel])],
    texel: impl Fn(usize, usize) -> Result<Distribution, LayerError>,
) -> Result<Vec<MomentLevel>, LayerError> {
    let (_, first) = layers.first().ok_or(LayerError::NoLayers)?;
    let levels = first.iter().enumerate();
    levels.map(|(number, level)| moment_level(level.width(), level.height(), |i| texel(number, i))).collect()
}

fn moment_level(
    width: usize,
    height: usize,
    texel: impl Fn(usize) -> Result<Distribution, LayerError>,
) -> Result<MomentLevel, LayerError> {
    // Not repaired: clamping the mixed term of a nearly singular covariance would multiply the rounding of its variances.
    let moments = |texel: Distribution| {
        let whole = texel.whole();
        Moments::from_mean_and_covariance(whole.mean, whole.covariance)
    };
    let moments = (0..width * height).map(|i| texel(i).map(moments)).collect::<Result<Vec<_>, _>>()?;
    Ok(MomentLevel::new(width, height, moments).expect("as many as texels"))
}

fn distributions(layers: &[(f32, &[MomentLevel])], level: usize, texel: usize) -> Vec<(f32, Distribution)> {
    let one = |(weight, levels): &(f32, &[MomentLevel])| {
        let moments = levels[level].moments()[texel];
        (*weight, Distribution::gaussian(moments.mean, moments.covariance_as_stored()))
    };
    layers.iter().map(one).collect()
}

type Sizes = Vec<(usize, usize)>;

fn sizes_of(levels: impl Iterator<Item = (usize, usize)>) -> Sizes {
    levels.collect()
}

/// Checks that all textures have the sizes of the first.
fn same_sizes(method: LayerMethod, textures: &[Sizes]) -> Result<(), LayerError> {
    let Some((first, rest)) = textures.split_first() else { return Err(LayerError::NoLayers) };
    for (index, sizes) in rest.iter().enumerate() {
        for level in 0..first.len().max(sizes.len()) {
            let (got, wanted) = (sizes.get(level).copied(), first.get(level).copied());
            if got != wanted {
                return Err(LayerError::Sizes { method, texture: index + 1, level, got, wanted });
            }
        }
    }
    Ok(())
}
