//! Textures with their levels, and the array textures that they form.

use super::{ShapeFault, TextureInfo};
use crate::levels::level_sizes;
use crate::{Image, SampleType, SamplesMut};

/// A texture with its levels: level 0 first, each `max(1, floor(n / 2))` of the previous one, down to 1x1 or ending
/// earlier. There is at least one level; all have the same sample type and the same channels.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    name: &'static str,
    channel_names: Vec<&'static str>,
    levels: Vec<Image>,
}

impl Texture {
    /// A texture called `name` inside its array: `lean1`, `lean2`, `normal` ... The channels have the names stored in
    /// an EXR file: `B.x`, `M.xy`, `b0_h` ...
    ///
    /// # Errors
    /// [`ShapeFault`] if there are no levels, if a level has the wrong size or another format than level 0, or if the
    /// number of names is not the number of channels.
    pub fn new(
        name: &'static str,
        channel_names: Vec<&'static str>,
        levels: Vec<Image>,
    ) -> Result<Self, ShapeFault> {
        let finest = levels.first().ok_or(ShapeFault::NoLevels { layer: name })?;
        let (format, channels) = (format_of(finest), finest.channels());
        let sizes = level_sizes(finest.width(), finest.height());
        if levels.len() > sizes.len() {
            return Err(ShapeFault::TooManyLevels { layer: name });
        }
        for (number, (level, wanted)) in levels.iter().zip(sizes).enumerate() {
            let got = (level.width(), level.height());
            if got != wanted {
                return Err(ShapeFault::LevelSize { layer: name, level: number, got, wanted });
            }
            if format_of(level) != format {
                return Err(ShapeFault::LevelFormat { layer: name, level: number });
            }
        }
        if channel_names.len() != channels {
            return Err(ShapeFault::ChannelNames { layer: name, names: channel_names.len(), channels });
        }
        Ok(Self { name, channel_names, levels })
    }

    /// The name of the texture inside its array.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// The name of each channel.
    pub fn channel_names(&self) -> &[&'static str] {
        &self.channel_names
    }

    /// The levels, at least one.
    pub fn levels(&self) -> &[Image] {
        &self.levels
    }

    /// Level 0, which is the largest.
    pub fn finest(&self) -> &Image {
        &self.levels[0]
    }

    /// The levels, without a copy.
    pub fn into_levels(self) -> Vec<Image> {
        self.levels
    }

    /// Width and height of level 0, in texels.
    pub fn size(&self) -> (usize, usize) {
        (self.finest().width(), self.finest().height())
    }

    /// The storage type of the samples.
    pub fn sample_type(&self) -> SampleType {
        self.finest().samples().sample_type()
    }
}

/// The sample type and the number of channels.
fn format_of(image: &Image) -> (SampleType, usize) {
    (image.samples().sample_type(), image.channels())
}

/// Textures that go into one file, as the layers of one array texture. There is at least one; all have the same size,
/// the same number of levels and the same sample type.
#[derive(Clone, Debug, PartialEq)]
pub struct TextureArray {
    /// The meaning of the texels. Any info may stand here: [`decode`](super::decode) checks that the textures are
    /// those of its layout.
    pub info: TextureInfo,
    layers: Vec<Texture>,
}

impl TextureArray {
    /// An array of these layers.
    ///
    /// # Errors
    /// [`ShapeFault`] if there are no layers, or if they differ in size, in number of levels or in sample type.
    ///
    /// ```
    /// use roughcast::texture::{Layout, Part, ShapeFault, Texture, TextureArray, TextureInfo};
    /// use roughcast::{Image, SampleType};
    ///
    /// let heights = |side| Image::zeros(side, side, 1, SampleType::F16);
    /// let texture = Texture::new("heights", vec!["Y"], vec![heights(4), heights(2), heights(1)])?;
    /// let info = TextureInfo::new(Layout::Variance, Part::Whole);
    /// let array = TextureArray::new(info, vec![texture])?;
    /// assert_eq!((array.size(), array.level_count()), ((4, 4), 3));
    /// assert_eq!(TextureArray::new(info, vec![]), Err(ShapeFault::NoLayers));
    /// # Ok::<(), ShapeFault>(())
    /// ```
    pub fn new(info: TextureInfo, layers: Vec<Texture>) -> Result<Self, ShapeFault> {
        let first = layers.first().ok_or(ShapeFault::NoLayers)?;
        let (wanted, sample_type) = (first.size(), first.sample_type());
        for layer in &layers {
            if layer.levels.len() != first.levels.len() {
                return Err(ShapeFault::LevelCounts);
            }
            if layer.size() != wanted {
                return Err(ShapeFault::LevelSize { layer: layer.name, level: 0, got: layer.size(), wanted });
            }
            if layer.sample_type() != sample_type {
                return Err(ShapeFault::SampleTypes);
            }
        }
        Ok(Self { info, layers })
    }

    /// The layers, at least one.
    pub fn layers(&self) -> &[Texture] {
        &self.layers
    }

    /// The layers, without a copy.
    pub fn into_layers(self) -> Vec<Texture> {
        self.layers
    }

    /// The samples of a level of a layer, to be changed.
    ///
    /// # Panics
    /// If there is no such layer or level.
    pub fn samples_mut(&mut self, layer: usize, level: usize) -> SamplesMut<'_> {
        self.layers[layer].levels[level].samples_mut()
    }

    /// The levels of each layer, for code that changes their texels but not their shapes.
    pub(crate) fn levels_mut(&mut self) -> impl Iterator<Item = &mut [Image]> {
        self.layers.iter_mut().map(|layer| &mut layer.levels[..])
    }

    /// Width and height of level 0, in texels.
    pub fn size(&self) -> (usize, usize) {
        self.layers[0].size()
    }

    /// Number of levels of each layer.
    pub fn level_count(&self) -> usize {
        self.layers[0].levels.len()
    }

    /// The storage type of the samples.
    pub fn sample_type(&self) -> SampleType {
        self.layers[0].sample_type()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::{Layout, Part};

    fn level(width: usize, height: usize, channels: usize, sample_type: SampleType) -> Image {
        Image::zeros(width, height, channels, sample_type)
    }

    fn levels() -> Vec<Image> {
        [(8, 4), (4, 2), (2, 1), (1, 1)].map(|(w, h)| level(w, h, 2, SampleType::U16)).into()
    }

    fn texture(levels: Vec<Image>) -> Result<Texture, ShapeFault> {
        Texture::new("lean2", vec!["R", "G"], levels)
    }

    fn array(layers: Vec<Texture>) -> Result<TextureArray, ShapeFault> {
        TextureArray::new(TextureInfo::new(Layout::Lean, Part::Whole), layers)
    }

    #[test]
    fn a_texture_checks_every_level() {
        assert!(texture(levels()).is_ok());
        assert!(texture(levels()[..2].to_vec()).is_ok(), "a chain may end early");
        let damaged = |damage: &dyn Fn(&mut Vec<Image>)| {
            let mut levels = levels();
            damage(&mut levels);
            texture(levels).expect_err("it is faulty").to_string()
        };
        let line = damaged(&|levels| levels[1] = level(4, 3, 2, SampleType::U16));
        assert_eq!(line, "level 1 of 'lean2' has 4x3 texels instead of 4x2");
        let line = damaged(&|levels| levels[2] = level(2, 1, 3, SampleType::U16));
        assert_eq!(line, "level 2 of 'lean2' has another sample type or number of channels");
        let line = damaged(&|levels| levels[3] = level(1, 1, 2, SampleType::U8));
        assert_eq!(line, "level 3 of 'lean2' has another sample type or number of channels");
        let line = damaged(&|levels| drop(levels.remove(1)));
        assert_eq!(line, "level 1 of 'lean2' has 2x1 texels instead of 4x2");
        let line = damaged(&|levels| levels.push(levels[3].clone()));
        assert_eq!(line, "'lean2' has levels beyond 1x1");
        assert_eq!(damaged(&Vec::clear), "'lean2' has no levels");
        let unnamed = Texture::new("lean2", vec!["R"], levels()).expect_err("a name is missing");
        assert_eq!(unnamed.to_string(), "'lean2' has 1 channel names for 2 channels");
    }

    #[test]
    fn an_array_checks_that_its_layers_are_alike() {
        let good = texture(levels()).expect("a texture");
        assert_eq!(array(vec![]), Err(ShapeFault::NoLayers));
        assert!(array(vec![good.clone(); 3]).is_ok());
        let shorter = texture(levels()[..2].to_vec()).expect("a texture");
        assert_eq!(array(vec![good.clone(), shorter]), Err(ShapeFault::LevelCounts));
        let wide = [(8, 1), (4, 1), (2, 1), (1, 1)].map(|(w, h)| level(w, h, 2, SampleType::U16)).into();
        let line = array(vec![good.clone(), texture(wide).expect("a texture")]).expect_err("other sizes");
        assert_eq!(line.to_string(), "level 0 of 'lean2' has 8x1 texels instead of 8x4");
        let bytes = levels().iter().map(|l| level(l.width(), l.height(), 2, SampleType::U8)).collect();
        let mixed = array(vec![good, texture(bytes).expect("a texture")]);
        assert_eq!(mixed, Err(ShapeFault::SampleTypes));
    }

    #[test]
    fn texels_can_be_changed_in_place() {
        let mut changed = array(vec![texture(levels()).expect("a texture"); 2]).expect("an array");
        if let SamplesMut::U16(samples) = changed.samples_mut(1, 2) {
            samples[3] = 7;
        }
        assert_eq!(changed.layers()[1].levels()[2].get(1, 0, 1), 7.0 / 65535.0);
        assert_eq!(changed.layers()[0].levels()[2].get(1, 0, 1), 0.0);
    }
}
