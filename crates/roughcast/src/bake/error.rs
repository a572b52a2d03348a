//! Reasons for refusing a bake.

use crate::SampleType;
use crate::progress::Stopped;
use crate::source::SourceError;
use crate::texture::{BlockCompression, Layout};

/// Why a map was not baked.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BakeError {
    /// The map or the base roughness cannot be read.
    #[error(transparent)]
    Source(#[from] SourceError),
    /// The layout holds floats, but another sample type was requested.
    #[error("the layout '{layout}' holds floats, not {sample_type} bits: choose half or single floats")]
    FloatsOnly {
        /// The layout.
        layout: Layout,
        /// The requested type.
        sample_type: SampleType,
    },
    /// Folding in the base roughness was requested, but no base roughness was given.
    #[error("folding in the base roughness needs a roughness: give one")]
    NoBaseToFoldIn,
    /// The layout cannot be made without a base roughness.
    #[error("the layout '{layout}' needs a base roughness: give one")]
    NeedsBase {
        /// The layout.
        layout: Layout,
    },
    /// Roughness was to be stored as specular powers in unsigned texels.
    #[error("specular powers do not fit into 0 to 1: choose floats, or another way to store roughness")]
    SpecularPowersNeedFloats {
        /// The requested type.
        sample_type: SampleType,
    },
    /// A scale was chosen for a layout without slopes.
    #[error("the layout '{layout}' stores normals, not slopes: it has no scale to choose")]
    NoScale {
        /// The layout.
        layout: Layout,
    },
    /// A scale was chosen for floats.
    #[error("float texels hold slopes as they are: they have no scale to choose")]
    ScaleOfFloats {
        /// The type asked for.
        sample_type: SampleType,
    },
    /// A scale is not above zero, or not finite.
    #[error("the scale must be above zero, not {scale}")]
    InvalidScale {
        /// The scale.
        scale: f32,
    },
    /// Textures shaped for block compression were requested in a type other than 8 bits.
    #[error("blocks are compressed from 8 bits, not from {sample_type}")]
    BlocksNeedEightBits {
        /// The type asked for.
        sample_type: SampleType,
    },
    /// The layout cannot be block-compressed.
    #[error("the layout '{layout}' cannot be block-compressed{}", in_words(*reason))]
    NotCompressible {
        /// The layout.
        layout: Layout,
        /// Why.
        reason: BlockCompression,
    },
    /// The largest allowed slope has a square that half floats cannot hold.
    #[error(
        "the square of a slope of {max_slope} does not fit into a half float: allow slopes up to {largest}, or choose single floats"
    )]
    SlopeBeyondHalf {
        /// The largest slope allowed.
        max_slope: f32,
        /// The largest slope whose square fits.
        largest: f32,
    },
    /// The bake was stopped by its watcher: see [`Bake::watched`](crate::Bake::watched).
    #[error("the bake was stopped")]
    Stopped,
    /// The base roughness that is folded in leaves no room for slopes.
    #[error(
        "the base roughness alone has a variance of {base_variance}, which a scale of {scale} cannot hold: choose a larger scale"
    )]
    BaseBeyondScale {
        /// The largest slope variance of the base.
        base_variance: f32,
        /// The scale that was chosen.
        scale: f32,
    },
}

impl From<Stopped> for BakeError {
    fn from(_: Stopped) -> Self {
        Self::Stopped
    }
}

fn in_words(reason: BlockCompression) -> &'static str {
    match reason {
        BlockCompression::WouldLoseVariance => {
            ": its variance is a small difference of large numbers, and the blocks' errors are larger than it"
        }
        BlockCompression::FromEightBits | BlockCompression::Undefined => "",
    }
}
