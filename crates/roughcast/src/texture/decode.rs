//! From stored textures back to moments.

use rayon::prelude::*;

use super::codec::Units;
use super::{
    Layout, Part, TextureArray, bump_slopes, clean, join_layers, lean, moments as moments_layout, pbr,
    schilling, toksvig, variance,
};
use crate::moments::Moments;

/// A level of moments, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct MomentLevel {
    /// Texels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// `width * height` moments. Their covariance is positive semidefinite.
    pub moments: Vec<Moments>,
}

/// Why textures do not decode.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DecodeError {
    /// There is nothing to decode.
    #[error("there are no textures: give at least one file of a layout")]
    NoFiles,
    /// A layout of several files was given without one of them.
    #[error("the layout '{layout}' needs its '{part}' file beside the others, and it is not there")]
    MissingPart {
        /// The layout.
        layout: Layout,
        /// The part that is not there.
        part: Part,
    },
    /// A layout whose layers have files of their own was given without one of them.
    #[error(
        "the layout '{layout}' needs the file of its layer '{layer}' beside the others, and it is not there"
    )]
    MissingLayer {
        /// The layout.
        layout: Layout,
        /// The name of the layer that is not there.
        layer: &'static str,
    },
    /// A file belongs to another bake than the first.
    #[error("the '{part}' file belongs to another bake than the '{first}' file: bake them together again")]
    OtherSet {
        /// The part of another bake.
        part: Part,
        /// The part that the others are compared with.
        first: Part,
    },
    /// The files' channels, sizes or levels are not those of the layout.
    #[error("the textures are not those of the layout '{layout}': {fault}; bake them anew")]
    Shape {
        /// The layout.
        layout: Layout,
        /// What does not fit.
        fault: String,
    },
}

/// Decodes the files of one layout: a single one, all parts of `pbr` or of block-compressed `toksvig`, or all layers of a
/// layout whose layers have files of their own ([`join_layers`] spares the copy that is made of these).
///
/// Base roughness stays in where the files hold it; their info says so.
///
/// # Errors
/// [`DecodeError`] where a part is missing or the textures do not belong together.
pub fn decode(arrays: &[TextureArray]) -> Result<Vec<MomentLevel>, DecodeError> {
    if arrays.iter().any(|array| array.info.layer.is_some()) {
        return decode(&join_layers(arrays.to_vec())?);
    }
    let first = arrays.first().ok_or(DecodeError::NoFiles)?;
    arrays.iter().try_for_each(TextureArray::check)?;
    let parts = Parts::find(arrays, first.info.layout)?;
    let levels = (0..first.level_count()).map(|level| {
        let image = &first.layers[0].levels[level];
        let (width, height) = (image.width(), image.height());
        let mut moments = vec![Moments::default(); width * height];
        moments.par_chunks_mut(width).enumerate().for_each_init(Vec::new, |texel, (y, row)| {
            for (x, moments) in row.iter_mut().enumerate() {
                let decoded = parts.decode_texel(level, x, y, texel);
                *moments = Moments::from_mean_and_covariance(decoded.mean, decoded.covariance());
            }
        });
        MomentLevel { width, height, moments }
    });
    Ok(levels.collect())
}

/// The files of a layout, found by their part.
struct Parts<'a> {
    main: &'a TextureArray,
    roughness: Option<&'a TextureArray>,
    anisotropy: Option<&'a TextureArray>,
    /// The widths along x and y.
    alphas: Option<[&'a TextureArray; 2]>,
    gloss: Option<&'a TextureArray>,
}

impl<'a> Parts<'a> {
    fn find(arrays: &'a [TextureArray], layout: Layout) -> Result<Self, DecodeError> {
        let find = |wanted: &[Part]| arrays.iter().find(|array| wanted.contains(&array.info.part));
        let missing = |part| DecodeError::MissingPart { layout, part };
        let main = find(&[Part::Whole, Part::Split, Part::Normal]).ok_or(missing(Part::Normal))?;
        let parts = Self {
            main,
            roughness: find(&[Part::Roughness, Part::OcclusionRoughnessMetallic]),
            anisotropy: find(&[Part::Anisotropy]),
            alphas: match (find(&[Part::AlphaX]), find(&[Part::AlphaY])) {
                (Some(x), Some(y)) => Some([x, y]),
                (Some(_), None) => return Err(missing(Part::AlphaY)),
                (None, Some(_)) => return Err(missing(Part::AlphaX)),
                (None, None) => None,
            },
            gloss: find(&[Part::Gloss]),
        };
        if layout == Layout::Pbr && parts.roughness.is_none() {
            return Err(missing(Part::Roughness));
        }
        if layout == Layout::Toksvig && main.info.part == Part::Normal && parts.gloss.is_none() {
            return Err(missing(Part::Gloss));
        }
        parts.check(layout)?;
        Ok(parts)
    }

    /// All sizes and channels fit, so that decoding a texel cannot fail.
    fn check(&self, layout: Layout) -> Result<(), DecodeError> {
        let fault = |fault: String| Err(DecodeError::Shape { layout, fault });
        let parts = [Some(self.main), self.roughness, self.anisotropy, self.gloss];
        let all = parts.into_iter().flatten().chain(self.alphas.into_iter().flatten());
        for array in all {
            if array.info.set != self.main.info.set {
                return Err(DecodeError::OtherSet { part: array.info.part, first: self.main.info.part });
            }
            if array.info.layout != layout {
                return fault(format!("one file holds '{}'", array.info.layout));
            }
            if !layout.parts().contains(&array.info.part) {
                return fault(format!("it has no part '{}'", array.info.part));
            }
            if array.size() != self.main.size() || array.level_count() != self.main.level_count() {
                return fault("the files differ in size or in number of levels".to_owned());
            }
            let wanted = super::layers_of(&array.info);
            if array.layers.len() != wanted.len() {
                return fault(format!("{} layers instead of {}", array.layers.len(), wanted.len()));
            }
            for (layer, spec) in array.layers.iter().zip(wanted) {
                let channels = layer.levels[0].channels();
                // A block-compressed normal has lost its third channel and the filler; nothing else may be missing.
                let short_normal = array.info.part == Part::Normal && channels == 2;
                if channels < spec.channels.len() && !short_normal {
                    return fault(format!("{channels} channels instead of {}", spec.channels.len()));
                }
            }
        }
        Ok(())
    }

    fn decode_texel(&self, level: usize, x: usize, y: usize, texel: &mut Vec<f32>) -> Moments {
        load(self.main, level, x, y, texel);
        let info = &self.main.info;
        let units = Units::new(info, self.main.layers[0].sample_type());
        match (info.layout, info.part) {
            (Layout::Lean, _) => lean::decode(units, texel),
            (Layout::Clean, _) => clean::decode(units, texel),
            (Layout::Schilling, _) => schilling::decode(units, texel),
            (Layout::SchillingIsotropic, _) => schilling::decode_isotropic(units, texel),
            (Layout::Variance, _) => variance::decode(units, texel),
            (Layout::BumpSlopes, _) => bump_slopes::decode(texel),
            (Layout::Moments, _) => moments_layout::decode(texel),
            (Layout::Toksvig, Part::Normal) => {
                texel.truncate(2);
                append(self.gloss, level, x, y, texel);
                toksvig::decode_parts(units, info, texel)
            }
            (Layout::Toksvig, _) => toksvig::decode(units, texel),
            (Layout::Pbr, _) => {
                let normal_channels = texel.len();
                if let Some(alphas) = self.alphas {
                    let widths = alphas.map(|array| array.layers[0].levels[level].get(x, y, 0));
                    return pbr::decode_alphas(units, texel, widths);
                }
                let roughness = self.roughness.expect("checked to be there");
                append(self.roughness, level, x, y, texel);
                let value = texel[normal_channels + roughness.info.roughness_texture.roughness_channel()];
                let anisotropy_at = texel.len();
                append(self.anisotropy, level, x, y, texel);
                let anisotropy = self.anisotropy.map(|_| &texel[anisotropy_at..]);
                pbr::decode(units, info, &texel[..normal_channels], value, anisotropy)
            }
        }
    }
}

fn load(array: &TextureArray, level: usize, x: usize, y: usize, texel: &mut Vec<f32>) {
    texel.clear();
    append(Some(array), level, x, y, texel);
}

fn append(array: Option<&TextureArray>, level: usize, x: usize, y: usize, texel: &mut Vec<f32>) {
    for layer in array.into_iter().flat_map(|array| &array.layers) {
        let image = &layer.levels[level];
        texel.extend((0..image.channels()).map(|channel| image.get(x, y, channel)));
    }
}
