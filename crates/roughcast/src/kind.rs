//! What a source map is, and how its numbers stand for normals.

use crate::named::named_enum;

named_enum! {
    /// What a source map holds.
    pub enum Kind: "kind" {
        /// Normals of the tangent frame.
        Normal = "normal",
        /// Heights.
        Height = "height",
    }
}

named_enum! {
    /// How the components of a normal, each in -1 ..= 1, are stored.
    pub enum NormalRange: "normal range" {
        /// With scale and bias: component `c` is stored as `(c + 1) / 2`, in 0 ..= 1.
        Unorm = "unorm",
        /// As they are.
        Signed = "signed",
    }
}

named_enum! {
    /// Which components of a normal are stored.
    pub enum NormalComponents: "normal components" {
        /// x and y alone: z is `sqrt(1 - x^2 - y^2)`. A third channel, if there is one, says nothing.
        Xy = "xy",
        /// x, y and z.
        Xyz = "xyz",
    }
}

impl NormalRange {
    /// The component that a stored value stands for.
    pub fn component_from_stored(self, stored: f32) -> f32 {
        match self {
            NormalRange::Unorm => 2.0 * stored - 1.0,
            NormalRange::Signed => stored,
        }
    }
}
