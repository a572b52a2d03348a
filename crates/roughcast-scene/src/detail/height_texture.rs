//! The heights of a map as a texture, for any renderer.

use roughcast::texture::{Layout, Texture};
use roughcast::{
    Bake, BakeError, BakeOptions, HeightSense, Image, ImageView, SampleType, Samples, SourceOptions,
};

roughcast::named_enum! {
    /// How the derivatives of heights between pixels are computed. Source: Mikkelsen 2010, section 4 and Listing 2.
    #[non_exhaustive]
    pub enum HeightDerivative: "derivative of heights" {
        /// The difference to one neighbour in the pixel's quad, as `dpdxFine`: one tap. Two pixels share it.
        Fine = "fine",
        /// Forward differences: three taps, a pixel apart.
        Forward = "forward",
        /// Central differences: four taps, at half a pixel on either side.
        Central = "central",
        /// The derivative of a bicubic B-spline through the texels: smooth under magnification. Sixteen texels.
        Bicubic = "bicubic",
    }
}

/// The heights of a height map, in texels of level 0: one channel of single floats, averaged into levels.
///
/// # Errors
/// [`BakeError`] if the map cannot be read as a height map.
pub fn height_texture<'m>(
    map: impl Into<ImageView<'m>>,
    options: &SourceOptions,
) -> Result<Texture, BakeError> {
    let map = map.into();
    let sign = match options.height_sense {
        HeightSense::WhiteHigh => 1.0,
        HeightSense::WhiteDeep => -1.0,
    };
    let texels = sign * options.height_scale * map.width() as f32;
    // The layout that stores heights beside the slopes.
    let bake = BakeOptions::default().with_layout(Layout::BumpSlopes).with_sample_type(SampleType::F32);
    let baked = Bake::of(map).source(*options).options(bake).run()?;
    let level = |image: &Image| {
        let (width, height) = (image.width(), image.height());
        let heights = (0..width * height).map(|i| texels * image.get(i % width, i / width, 0));
        Image::new(width, height, 1, Samples::F32(heights.collect())).expect("as many texels as the bake's")
    };
    let levels = baked.arrays[0].layers()[0].levels().iter().map(level).collect();
    Ok(Texture::new("height", vec!["h"], levels).expect("the levels of a bake"))
}
