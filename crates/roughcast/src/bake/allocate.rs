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
    let mut earlier = earlier.into_iter().flat_map(|array| array.layers);
    let mut texture = |spec: &LayerSpec, channels: usize| {
        let levels = level_sizes(size.0, size.1);
        let fits = |image: &Image, (width, height): (usize, usize)| {
            (image.width(), image.height(), image.channels()) == (width, height, channels)
                && image.samples().sample_type() == sample_type
        };
        let levels = match earlier.next() {
            Some(texture) if texture.levels.iter().zip(&levels).all(|(image, size)| fits(image, *size)) => {
                texture.levels
            }
            _ => levels.into_iter().map(|(w, h)| Image::zeros(w, h, channels, sample_type)).collect(),
        };
        Texture { name: spec.name, channels: spec.channels[..channels].to_vec(), levels }
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
            TextureArray { info, layers }
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
    for layer in arrays.iter_mut().flat_map(|array| &mut array.layers) {
        for (level, image) in layer.levels.iter_mut().enumerate() {
            let channels = image.channels();
            parts[level].push(PartOut { channels, samples: image.samples_mut() });
        }
    }
    sizes.into_iter().zip(parts).map(|(size, parts)| LevelOut::encoded(size, encoder, parts)).collect()
}
