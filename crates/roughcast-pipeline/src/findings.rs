//! Findings about a job for the user, as data. The calling program words them and names the option that resolves each.

use std::path::PathBuf;

use roughcast::Green;
use roughcast::detect::HeightRange;
use roughcast::texture::Layout;
use roughcast_io::{Container, PixelSize};

use crate::target::TargetFinding;

/// A finding for the user. The job was not interrupted.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Finding {
    /// How the file was read, in one clause.
    File(String),
    /// Writers of this format disagree on which channel of a normal comes first, and the pixels do not show it. The
    /// first channel is read as x.
    OrderOfNormalOpen {
        /// The pixel format.
        format: String,
    },
    /// Green probably points the opposite way.
    GreenProbablyWrong {
        /// How green was interpreted.
        read: Green,
        /// The measured correlation, -1 ..= 0.
        correlation: f64,
        /// The height map of the same material that shows it; `None` if it follows from the slopes themselves, which do
        /// not form a surface.
        heights: Option<PathBuf>,
    },
    /// The file name states which way green points, but the slopes show the opposite. The slopes take precedence.
    GreenNotAsNamed {
        /// The direction stated in the name.
        named: Green,
    },
    /// The heights are probably in metres or another unit, but the default height scale expects 0 to 1.
    HeightsHaveUnits {
        /// The range of the heights.
        range: HeightRange,
        /// Width of the map in pixels.
        width: usize,
        /// The width of a pixel, if the file states it.
        pixel_size: Option<PixelSize>,
    },
    /// The specular power for the gloss factor was not given.
    SpecularPowerAssumed {
        /// The assumed power.
        power: f32,
    },
    /// The material's roughness was not given; it is assumed to be 0, a mirror.
    RoughnessAssumedZero,
    /// The material's roughness is only recorded in the file's metadata, because the layout leaves it to the shader.
    RoughnessNotStored {
        /// The layout.
        layout: Layout,
        /// How the roughness was given.
        given: RoughnessForm,
    },
    /// A file is left over from an earlier bake and would be mistaken for a part of this one.
    LeftFromEarlierBake {
        /// The file.
        path: PathBuf,
    },
    /// Direct3D cannot create a block-compressed texture whose sides are not multiples of the block size.
    BlocksDoNotFit {
        /// Width of the texture.
        width: usize,
        /// Height of the texture.
        height: usize,
    },
    /// Something works on the target only with restrictions.
    Target {
        /// The restriction.
        finding: TargetFinding,
        /// The container.
        container: Container,
    },
    /// The file name suggests something other than a bump map, but the file was read as one.
    NamedOtherwise {
        /// What the name suggests, such as `roughness`.
        what: &'static str,
    },
    /// The file name suggests something other than a bump map, but the pixels are normals.
    NormalsNamedOtherwise {
        /// What the name suggests.
        what: &'static str,
    },
    /// The file name suggests normals, but the pixels are grey: the map is baked as heights.
    HeightsNamedNormals,
    /// The file name suggests heights, but the pixels are normals: the map is baked as normals.
    NormalsNamedHeights,
}

/// How a material's roughness was given.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum RoughnessForm {
    /// As a Blinn-Phong exponent.
    SpecularPower,
    /// As a roughness, either a number or a picture.
    Roughness,
}
