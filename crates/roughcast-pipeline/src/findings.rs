//! What a user should hear about a job, as data. A program puts it into words and says which of its options answers it.

use std::path::PathBuf;

use roughcast::Green;
use roughcast::detect::HeightRange;
use roughcast::texture::Layout;
use roughcast_io::{Container, PixelSize};

use crate::target::TargetFinding;

/// One thing that a user should hear about; the work went on.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Finding {
    /// How the file was read, in one clause.
    File(String),
    /// Writers of the format disagree about which channel of a normal comes first, and the pixels do not tell: the first is
    /// read as x.
    OrderOfNormalOpen {
        /// The pixel format.
        format: String,
    },
    /// Green probably points the other way.
    GreenProbablyWrong {
        /// How it was read.
        read: Green,
        /// What the test measured, -1 ..= 0.
        correlation: f64,
        /// The height map of the same material that says so; `None` if the slopes themselves are not those of a surface.
        heights: Option<PathBuf>,
    },
    /// The name of the file says which way green points, and the slopes say the opposite and are believed.
    GreenNotAsNamed {
        /// What the name says.
        named: Green,
    },
    /// The heights are probably in metres or another unit, and the default height scale is made for 0 to 1.
    HeightsHaveUnits {
        /// The range of the heights.
        range: HeightRange,
        /// Pixels in a row of the map.
        width: usize,
        /// How wide a pixel is, where the file says so.
        pixel_size: Option<PixelSize>,
    },
    /// Nobody named the specular power that the gloss factor is made for.
    SpecularPowerAssumed {
        /// The one that was taken.
        power: f32,
    },
    /// Nobody named the roughness of the material, and it is taken as 0, a mirror.
    RoughnessAssumedZero,
    /// The roughness of the material is only noted in the file, since the layout leaves it to the shader.
    RoughnessNotStored {
        /// The layout.
        layout: Layout,
        /// How the roughness was given.
        given: RoughnessForm,
    },
    /// A file is left from an earlier bake and would be taken for a part of this one.
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
    /// Something works only with restrictions where the textures are going to be used.
    Target {
        /// What.
        finding: TargetFinding,
        /// The container.
        container: Container,
    },
    /// The name of the file says that it is no map of bumps, and it was read as one.
    NamedOtherwise {
        /// What its name says it is: `roughness`.
        what: &'static str,
    },
    /// The name of the file says that it is no map of bumps, but its pixels are normals.
    NormalsNamedOtherwise {
        /// What its name says it is.
        what: &'static str,
    },
    /// The name of the file says normals, but its pixels are grey: it is baked as heights.
    HeightsNamedNormals,
    /// The name of the file says heights, but its pixels are normals: it is baked as these.
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
