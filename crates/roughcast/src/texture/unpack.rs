//! Any layout as the layout `moments`.

use super::{
    Base, BaseRole, DecodeError, Layout, Part, Texture, TextureArray, TextureInfo, decode, layers_of,
};
use crate::{Image, Samples};

/// The moments of the files of any layout as a texture of the layout `moments`, in single floats, with what the files say
/// about the base roughness.
///
/// # Errors
/// [`DecodeError`] if a file is missing or the textures do not belong together.
///
/// ```
/// use roughcast::texture::{Layout, unpack};
/// use roughcast::{Bake, BakeOptions, Image, Samples};
///
/// let flat = Image::new(4, 4, 3, Samples::U8([128, 128, 255].repeat(16)))?;
/// let clean = Bake::of(&flat).options(BakeOptions::default().with_layout(Layout::Clean)).run()?;
/// let moments = unpack(&clean.arrays)?;
/// assert_eq!((moments.info.layout, moments.level_count()), (Layout::Moments, 3));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn unpack(arrays: &[TextureArray]) -> Result<TextureArray, DecodeError> {
    let levels = decode(arrays)?;
    let first = &arrays[0].info;
    let info = TextureInfo {
        // Toksvig's factor includes the base, but the variance decoded from its normals does not.
        base: if first.layout.base_role() == BaseRole::Apart { Base::None } else { first.base },
        base_variance: first.base_variance,
        brdf: first.brdf,
        wrap: first.wrap,
        ..TextureInfo::new(Layout::Moments, Part::Whole)
    };
    let spec = &layers_of(&info)[0];
    let images = levels.into_iter().map(|level| {
        let texels = level.moments().iter().flat_map(|m| [m.mean.x, m.mean.y, m.xx, m.yy, m.xy]).collect();
        let image = Image::new(level.width(), level.height(), spec.channels.len(), Samples::F32(texels));
        image.expect("five samples for each texel")
    });
    let layer = Texture::new(spec.name, spec.channels.to_vec(), images.collect());
    let array = layer.and_then(|layer| TextureArray::new(info, vec![layer]));
    Ok(array.expect("the levels of a texture halve"))
}
