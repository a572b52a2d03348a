//! The textures that a bake writes into.

use crate::Image;
use crate::levels::level_sizes;
use crate::options::BakeOptions;
use crate::pyramid::{LevelOut, PartOut};
use crate::texture::{self, Blocks, LayerSpec, Part, Texture, TextureArray, TextureInfo};

/// Allocates the textures of all files of a layout, reusing those of `earlier` that have the right shape.
pub(super) fn allocate(
    earlier: Vec<TextureArray>,
    info: &TextureInfo,
    options: &BakeOptions,
    size: (usize, usize),
) -> Vec<TextureArray> {
    let sample_type = options.sample_type;
    let mut earlier = earlier.into_iter().flat_map(TextureArray::into_layers);
    let mut texture = |spec: &LayerSpec, channels: usize| {
        let sizes = level_sizes(size.0, size.1);
        let fits = |texture: &Texture| {
            texture.size() == size
                && texture.levels().len() == sizes.len()
                && texture.channel_names().len() == channels
                && texture.sample_type() == sample_type
        };
        let levels = match earlier.next().filter(fits) {
            Some(texture) => texture.into_levels(),
            None => sizes.into_iter().map(|(w, h)| Image::zeros(w, h, channels, sample_type)).collect(),
        };
        Texture::new(spec.name, spec.channels[..channels].to_vec(), levels).expect("levels that halve")
    };
    let parts = options.layout.parts_written(options.blocks, &options.pbr);
    parts
        .into_iter()
        .map(|part| {
            let info = TextureInfo { part, ..*info };
            let two_channels = part == Part::Normal && options.blocks == Blocks::Bc;
            let layers = texture::layers_of(&info)
                .iter()
                .map(|spec| texture(spec, if two_channels { 2 } else { spec.channels.len() }))
                .collect();
            TextureArray::new(info, layers).expect("a layout has layers, all of one size")
        })
        .collect()
}

pub(super) fn level_outs<'a>(
    arrays: &'a mut [TextureArray],
    encoder: &'a dyn texture::codec::RowEncoder,
) -> Vec<LevelOut<'a>> {
    let (width, height) = arrays[0].size();
    let sizes = level_sizes(width, height);
    let mut parts: Vec<Vec<PartOut<'a>>> = sizes.iter().map(|_| Vec::new()).collect();
    for levels in arrays.iter_mut().flat_map(TextureArray::levels_mut) {
        for (image, parts) in levels.iter_mut().zip(&mut parts) {
            let channels = image.channels();
            parts.push(PartOut { channels, samples: image.samples_mut() });
        }
    }
    sizes.into_iter().zip(parts).map(|(size, parts)| LevelOut::encoded(size, encoder, parts)).collect()
}
