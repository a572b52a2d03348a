//! Conventions of maps: what pixels hold, which way channels point, and what lies beyond the edge.

use crate::named::named_enum;

named_enum! {
    /// What the pixels of an input represent.
    pub enum Kind: "kind of map" {
        /// Normals, three channels or two.
        Normal = "normal",
        /// Heights, one channel.
        Height = "height",
    }
}

named_enum! {
    /// Which way a normal map's green channel points.
    pub enum Green: "direction of green" {
        /// Up the picture: OpenGL, glTF.
        Up = "up",
        /// Down the picture: DirectX.
        Down = "down",
    }
}

named_enum! {
    /// Which way a normal map's red channel points.
    pub enum Red: "direction of red" {
        /// To the right of the picture: all common conventions.
        Right = "right",
        /// To the left.
        Left = "left",
    }
}

named_enum! {
    /// The range in which a normal's components are stored.
    pub enum NormalRange: "range" {
        /// 0 ..= 1 represents -1 ..= 1.
        Unorm = "unorm",
        /// The components themselves.
        Signed = "signed",
    }
}

impl NormalRange {
    /// Decodes a stored value into a component.
    #[inline(always)]
    pub fn component_from_stored(self, stored: f32) -> f32 {
        match self {
            NormalRange::Unorm => 2.0 * stored - 1.0,
            NormalRange::Signed => stored,
        }
    }
}

named_enum! {
    /// Which channels hold a normal's components.
    #[non_exhaustive]
    pub enum NormalChannels: "choice of channels" {
        /// Red, green, blue: x, y, z. Only the direction is used; the length does not matter.
        Xyz = "xyz",
        /// The first two: x, y; z is computed. BC5, and RG textures.
        Xy = "xy",
        /// Alpha and green: x, y; z is computed. "DXT5nm", BC3n, and Doom 3's RXGB.
        Ag = "ag",
        /// The first two: y, x; z is computed. The older order of 3Dc and ATI2.
        Yx = "yx",
        /// Red and alpha: x, y; z is computed. KTX's normal mode, which repeats x in red, green and blue.
        Ra = "ra",
    }
}

impl NormalChannels {
    /// Indices of the channels with x, y and, if stored, z.
    pub fn indices(self) -> (usize, usize, Option<usize>) {
        match self {
            NormalChannels::Xyz => (0, 1, Some(2)),
            NormalChannels::Xy => (0, 1, None),
            NormalChannels::Yx => (1, 0, None),
            NormalChannels::Ag => (3, 1, None),
            NormalChannels::Ra => (0, 3, None),
        }
    }

    /// Minimum number of channels that a map must have.
    pub fn needed(self) -> usize {
        let (x, y, z) = self.indices();
        1 + x.max(y).max(z.unwrap_or(0))
    }
}

named_enum! {
    /// Whether white is high or deep.
    pub enum HeightSense: "sense of heights" {
        /// White is high.
        WhiteHigh = "white-high",
        /// White is deep: a depth map.
        WhiteDeep = "white-deep",
    }
}

named_enum! {
    /// What lies beyond the edge of a map, for gradients and for filters wider than the box.
    pub enum Wrap: "wrap mode" {
        /// The map repeats.
        Repeat = "repeat",
        /// The edge texel is repeated, for gradients. The pyramid's filters mirror the map, as for [`Wrap::Mirror`]: an
        /// edge texel repeated without end would count more than the others, and means would drift from level to level.
        Clamp = "clamp",
        /// The map is mirrored at the edge.
        Mirror = "mirror",
    }
}
