//! Findings about a job for the user, as data. A program puts them into words and names the option that resolves them.

use std::path::PathBuf;

use roughcast::Green;
use roughcast::detect::HeightRange;
use roughcast::texture::Layout;
use roughcast_io::{Container, PixelSize};

use crate::target::TargetFinding;

/// One finding for the user; the work continued.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Finding {
    /// How the file was read, in one clause.
    File(String),
    /// Writers of the format disagree about which channel of a normal comes first, and the pixels do not show it: the first is
    /// read as x.
    OrderOfNormalOpen {
        /// The pixel format.
        format: String,
    },
    /// Green probably points the other way.
    GreenProbablyWrong {
        /// How green was read.
        read: Green,
        /// The measured correlation, -1 ..= 0.
        correlation: f64,
        /// The height map of the same material that shows it; `None` if the slopes themselves do not belong to a surface.
        heights: Option<PathBuf>,
    },
    /// The name of the file specifies which way green points, but the slopes show the opposite; the slopes decide.
    GreenNotAsNamed {
        /// The direction in the name.
        named: Green,
    },
    /// The heights are probably in metres or another unit, but the default height scale is made for 0 to 1.
    HeightsHaveUnits {
        /// The range of the heights.
        range: HeightRange,
        /// Pixels in a row of the map.
        width: usize,
        /// The width of a pixel, if the file states it.
        pixel_size: Option<PixelSize>,
    },
    /// The specular power for the gloss factor was not given.
    SpecularPowerAssumed {
        /// The assumed one.
        power: f32,
    },
    /// The roughness of the material was not given, and is assumed to be 0, a mirror.
    RoughnessAssumedZero,
    /// The roughness of the material is only recorded in the file, because the layout leaves it to the shader.
    RoughnessNotStored {
        /// The layout.
        layout: Layout,
        /// How the roughness was given.
        given: RoughnessForm,
    },
    /// A file is left from an earlier bake and would be mistaken for a part of this one.
    LeftFromEarlierBake {
        /// The file.
        path: PathBuf,
    },
    /// Direct3D cannot create a block-compressed texture whose sides are not multiples of the blocks' side.
    BlocksDoNotFit {
        /// Width of the texture.
        width: usize,
        /// Height of the texture.
        height: usize,
    },
    /// Something works only with restrictions on the target.
    Target {
        /// What.
        finding: TargetFinding,
        /// The container.
        container: Container,
    },
    /// The name of the file suggests that it is not a map of bumps, but it was read as one.
    NamedOtherwise {
        /// What its name suggests: `roughness`.
        what: &'static str,
    },
    /// The name of the file suggests that it is not a map of bumps, but its pixels are normals.
    NormalsNamedOtherwise {
        /// What its name suggests.
        what: &'static str,
    },
    /// The name of the file suggests normals, but its pixels are grey: it is baked as heights.
    HeightsNamedNormals,
    /// The name of the file suggests heights, but its pixels are normals: it is baked as normals.
    NormalsNamedHeights,
}

/// How a roughness of the material was given.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum RoughnessForm {
    /// As a Blinn-Phong exponent.
    SpecularPower,
    /// As a roughness, a number or a picture.
    Roughness,
}
