//! Options for reading and filtering a map. The command line, Python and the GPU use them unchanged.

use crate::SampleType;
use crate::convention::{Green, HeightSense, Kind, NormalChannels, NormalRange, Red, Wrap};
use crate::named::named_enum;
use crate::roughness::{Base, Brdf};
use crate::setters::setters;
use crate::texture::{Blocks, Layout, PbrOptions};

named_enum! {
    /// How a height map's gradient is estimated. All gradients are in texels of level 0.
    ///
    /// This enum is exhaustive, because other implementations that compute slopes, such as one on a GPU, must know all
    /// variants.
    pub enum Gradient: "gradient" {
        /// The 8-tap Sobel filter divided by 8.
        Sobel = "sobel",
        /// Central differences divided by 2.
        Central = "central",
        /// Difference to the next texel, right and up.
        Forward = "forward",
    }
}

named_enum! {
    /// The kernel that computes a level from the previous one. All kernels are non-negative: with negative lobes the
    /// result would no longer be a covariance.
    #[non_exhaustive]
    pub enum PyramidFilter: "filter" {
        /// Exact area average.
        Box = "box",
        /// Tent that extends over two texels of the coarser level each way.
        Triangle = "triangle",
        /// The B-spline of order three, similar to a Gaussian with a standard deviation of half a texel of the coarser
        /// level.
        Gaussian = "gaussian",
    }
}

/// How a map is converted to slopes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
#[non_exhaustive]
pub struct SourceOptions {
    /// What the pixels represent.
    pub kind: Kind,
    /// Direction of a normal map's green channel.
    pub green: Green,
    /// Direction of a normal map's red channel.
    pub red: Red,
    /// Factor of a normal's x and y, which also scales the slope: glTF's `normalTexture.scale`. Height maps use
    /// [`SourceOptions::height_scale`] instead.
    pub normal_scale: f32,
    /// The range in which a normal's components are stored.
    pub range: NormalRange,
    /// The channels that hold a normal's components.
    pub normal_channels: NormalChannels,
    /// A height value v represents `v * height_scale * width` texels.
    pub height_scale: f32,
    /// Whether white is high or deep.
    pub height_sense: HeightSense,
    /// How the gradient of heights is estimated.
    pub gradient: Gradient,
    /// What lies beyond the edge.
    pub wrap: Wrap,
    /// Maximum length of a slope. Steeper slopes are scaled back to it, with their direction kept, and counted.
    pub max_slope: MaxSlope,
}

setters!(SourceOptions {
    with_kind(kind: Kind),
    with_green(green: Green),
    with_red(red: Red),
    with_normal_scale(normal_scale: f32),
    with_range(range: NormalRange),
    with_normal_channels(normal_channels: NormalChannels),
    with_height_scale(height_scale: f32),
    with_height_sense(height_sense: HeightSense),
    with_gradient(gradient: Gradient),
    with_wrap(wrap: Wrap),
    with_max_slope(max_slope: MaxSlope),
});

/// The maximum length of a slope.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum MaxSlope {
    /// [`MaxSlope::OF_ANY_MAP`], or less if a few steep texels make the range of unsigned texels much larger than the
    /// rest needs. If the steepest 0.1 % cost more than a factor of 4 in usable specular power, the limit is the slope
    /// that they exceed, but at least [`MaxSlope::LEAST_AUTOMATIC`].
    ///
    /// It is only lowered if the layout stores slopes or variances over a range that depends on the map. Float texels,
    /// and layouts that store normals and roughness, have no such range and keep every slope up to
    /// [`MaxSlope::OF_ANY_MAP`].
    Auto,
    /// A fixed limit: above 0, at most [`MaxSlope::LARGEST`].
    Limit(f32),
}

impl MaxSlope {
    /// The default maximum slope: 89.55 degrees.
    pub const OF_ANY_MAP: f32 = 128.0;
    /// The smallest limit that [`MaxSlope::Auto`] chooses, 45 degrees. The steep texels of a gentle map may be few and
    /// still be its most important feature, such as the screws of a panel. With this limit 16 bits support specular
    /// powers above 25 000.
    pub const LEAST_AUTOMATIC: f32 = 1.0;
    /// The largest limit that can be set. The square of a slope must be finite.
    pub const LARGEST: f32 = 1e9;

    /// The limit before the map has been analysed.
    pub fn before_survey(self) -> f32 {
        match self {
            MaxSlope::Auto => Self::OF_ANY_MAP,
            MaxSlope::Limit(limit) => limit,
        }
    }
}

impl SourceOptions {
    /// Default height of a full-range height map, as a fraction of its width.
    pub const DEFAULT_HEIGHT_SCALE: f32 = 0.02;

    /// The factors by which x and y of a normal are multiplied when it is read.
    pub fn normal_factors(&self) -> [f32; 2] {
        let x = if self.red == Red::Left { -self.normal_scale } else { self.normal_scale };
        let y = if self.green == Green::Down { -self.normal_scale } else { self.normal_scale };
        [x, y]
    }
}

impl Default for SourceOptions {
    /// An OpenGL normal map that repeats.
    fn default() -> Self {
        Self {
            kind: Kind::Normal,
            green: Green::Up,
            red: Red::Right,
            normal_scale: 1.0,
            range: NormalRange::Unorm,
            normal_channels: NormalChannels::Xyz,
            height_scale: Self::DEFAULT_HEIGHT_SCALE,
            height_sense: HeightSense::WhiteHigh,
            gradient: Gradient::Sobel,
            wrap: Wrap::Repeat,
            max_slope: MaxSlope::Auto,
        }
    }
}

/// The range of slopes that unsigned texels cover: found automatically or fixed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum ScaleChoice {
    /// The smallest range that holds every texel.
    Auto,
    /// A fixed range. Steeper texels are scaled back to it and counted.
    Fixed(f32),
}

/// What to bake from a map.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
#[non_exhaustive]
pub struct BakeOptions {
    /// The layout.
    pub layout: Layout,
    /// The type of its texels.
    pub sample_type: SampleType,
    /// The range of its slopes, for unsigned types.
    pub scale: ScaleChoice,
    /// Whether base roughness is folded into the second moments.
    pub base: Base,
    /// The reflectance function that the roughness is meant for.
    pub brdf: Brdf,
    /// Options for [`Layout::Pbr`]; other layouts ignore them.
    pub pbr: PbrOptions,
    /// Whether the texture is shaped for block compression.
    pub blocks: Blocks,
    /// The kernel of the pyramid.
    pub filter: PyramidFilter,
}

setters!(BakeOptions {
    with_layout(layout: Layout),
    with_sample_type(sample_type: SampleType),
    with_scale(scale: ScaleChoice),
    with_base(base: Base),
    with_brdf(brdf: Brdf),
    with_pbr(pbr: PbrOptions),
    with_blocks(blocks: Blocks),
    with_filter(filter: PyramidFilter),
});

impl Default for BakeOptions {
    /// LEAN in 16 bits with the smallest safe scale, without base roughness, box filter. `pbr` is as glTF expects it.
    fn default() -> Self {
        Self {
            layout: Layout::Lean,
            sample_type: SampleType::U16,
            scale: ScaleChoice::Auto,
            base: Base::None,
            brdf: Brdf::Ggx,
            pbr: PbrOptions::default(),
            blocks: Blocks::None,
            filter: PyramidFilter::Box,
        }
    }
}
