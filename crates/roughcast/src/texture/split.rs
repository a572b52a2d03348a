//! Splits array layers into one file per layer, for readers that do not support array textures.

use super::{DecodeError, ShapeFault, Texture, TextureArray, TextureInfo, layers_of, set_id};

/// Assigns a common [`TextureInfo::set`], which identifies the files of one bake, to textures that have none yet.
pub fn mark_set(arrays: &mut [TextureArray]) {
    if arrays.iter().all(|array| array.info.set == 0) {
        let set = set_id(arrays);
        arrays.iter_mut().for_each(|array| array.info.set = set);
    }
}

/// The meaning of each layer of a file, once each has a file of its own. A part of one layer is unchanged.
pub fn split_infos(info: &TextureInfo) -> Vec<TextureInfo> {
    let layers = layers_of(info).len();
    if layers == 1 {
        return vec![*info];
    }
    (0..layers as u8).map(|layer| TextureInfo { layer: Some(layer), ..*info }).collect()
}

/// Joins layers that come from separate files. Arrays that have all their layers are unchanged.
///
/// # Errors
/// [`DecodeError::MissingLayer`] if a layer is missing, [`DecodeError::OtherSet`] and [`DecodeError::Shape`] if
/// layers do not belong together.
pub fn join_layers(arrays: Vec<TextureArray>) -> Result<Vec<TextureArray>, DecodeError> {
    let (single, mut joined): (Vec<_>, Vec<_>) =
        arrays.into_iter().partition(|array| array.info.layer.is_some());
    let mut parts: Vec<Vec<TextureArray>> = Vec::new();
    for array in single {
        match parts.iter_mut().find(|layers| layers[0].info.part == array.info.part) {
            Some(layers) => layers.push(array),
            None => parts.push(vec![array]),
        }
    }
    for layers in parts {
        joined.push(join(layers)?);
    }
    Ok(joined)
}

/// Joins the layers of one part, of which there is at least one.
fn join(mut layers: Vec<TextureArray>) -> Result<TextureArray, DecodeError> {
    layers.sort_by_key(|array| array.info.layer);
    let info = layers[0].info.of_whole_part();
    let layout = info.layout;
    let shape = |fault| DecodeError::Shape { layout, fault };
    for (place, spec) in layers_of(&info).iter().enumerate() {
        match layers.get(place).and_then(|array| array.info.layer).map(usize::from) {
            Some(layer) if layer == place => {}
            Some(layer) if layer < place => return Err(shape(ShapeFault::RepeatedLayer)),
            _ => return Err(DecodeError::MissingLayer { layout, layer: spec.name }),
        }
    }
    let first_size = layers[0].size();
    for array in &layers {
        if array.info.set != info.set {
            return Err(DecodeError::OtherSet { part: array.info.part, first: info.part });
        }
        if array.info.of_whole_part() != info && !info.base_variance.is_nan() {
            return Err(shape(ShapeFault::LayerInfos));
        }
        if array.size() != first_size || array.level_count() != layers[0].level_count() {
            return Err(shape(ShapeFault::LayerSizes));
        }
    }
    let textures: Vec<Texture> = layers.into_iter().flat_map(TextureArray::into_layers).collect();
    if textures.len() != layers_of(&info).len() {
        return Err(shape(ShapeFault::SeveralLayers));
    }
    TextureArray::new(info, textures).map_err(shape)
}

/// Splits arrays into one file per layer: the inverse of [`join_layers`].
pub fn split_layers(arrays: Vec<TextureArray>) -> Vec<TextureArray> {
    let split = |array: TextureArray| {
        let infos = split_infos(&array.info);
        if infos.len() != array.layers().len() || infos.len() == 1 {
            return vec![array];
        }
        let alone = |(info, layer)| TextureArray::new(info, vec![layer]).expect("a layer is alike to itself");
        infos.into_iter().zip(array.into_layers()).map(alone).collect()
    };
    arrays.into_iter().flat_map(split).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::{Layout, decode};
    use crate::{Bake, Image, SampleType, Samples};

    fn baked() -> Vec<TextureArray> {
        let codes = (0..8 * 8 * 3).map(|i| if i % 3 == 2 { 250 } else { (i * 37 % 256) as u8 }).collect();
        let map = Image::new(8, 8, 3, Samples::U8(codes)).expect("whole pixels");
        assert_eq!(map.samples().sample_type(), SampleType::U8);
        let mut arrays = Bake::of(&map).run().expect("a map").arrays;
        mark_set(&mut arrays);
        arrays
    }

    #[test]
    fn layers_in_files_of_their_own_are_put_together_in_any_order() {
        let whole = baked();
        let mut split = split_layers(whole.clone());
        assert_eq!(split.len(), 2);
        assert!(split.iter().all(|array| array.layers().len() == 1 && array.info.set != 0));
        split.reverse();
        assert_eq!(join_layers(split.clone()), Ok(whole.clone()));
        assert_eq!(decode(&split), decode(&whole), "decoding joins by itself");
    }

    #[test]
    fn a_missing_or_foreign_layer_is_named() {
        let split = split_layers(baked());
        for (left, gone) in [(1, "lean1"), (0, "lean2")] {
            let wanted = DecodeError::MissingLayer { layout: Layout::Lean, layer: gone };
            assert_eq!(join_layers(vec![split[left].clone()]), Err(wanted));
        }
        let mut foreign = split.clone();
        foreign[1].info.set = 1;
        assert!(matches!(join_layers(foreign), Err(DecodeError::OtherSet { .. })));
        let twice = vec![split[0].clone(), split[0].clone()];
        assert!(matches!(join_layers(twice), Err(DecodeError::Shape { .. })));
        let fault = |fault| Err(DecodeError::Shape { layout: Layout::Lean, fault });
        let layer = &split[1].layers()[0];
        let names = layer.channel_names().to_vec();
        let levels = layer.levels()[1..].to_vec();
        let smaller = Texture::new(layer.name(), names, levels).expect("levels that halve");
        let smaller = TextureArray::new(split[1].info, vec![smaller]).expect("one layer");
        assert_eq!(join_layers(vec![split[0].clone(), smaller]), fault(ShapeFault::LayerSizes));
        let mut several = split;
        several[1] = TextureArray::new(several[1].info, baked().remove(0).into_layers()).expect("two layers");
        assert_eq!(join_layers(several), fault(ShapeFault::SeveralLayers));
    }
}
