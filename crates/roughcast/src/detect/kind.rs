//! Guesses from the channels and texels whether a map holds normals or heights.

use super::channels::{Blue, colour_channels, guess_blue, looks_like_slopes, x_is_in_alpha};
use super::order::{GreyAndAlpha, guess_grey_and_alpha};
use super::sample::{SAME, quantile, share, spread, texels};
use super::vectors::{MAX_MEAN_TILT, MAX_XY_LENGTH, UNIT, decoded, length, mean_xy};
use crate::{ImageView, Kind, NormalChannels, NormalRange};

/// In a grey picture, fewer than 1 texel in 1000 has channels that differ by more than this, at a full scale of 1. In
/// the real grey maps, 1 texel in 1000 reaches 5/255 at most; in the greyest coloured albedo, 19 in 1000 exceed 10/255.
const GREY_SPREAD: f32 = 10.0 / 255.0;
const GREY_QUANTILE: f64 = 0.999;

/// Maximum ratio of mean spread to mean brightness in a grey picture; 0.07 for the real grey maps. The spread alone
/// does not suffice, because it is also small in dark pictures.
const GREY_SATURATION: f64 = 0.15;

/// The full scale of a float image is this quantile of its texels.
const FULL_SCALE_QUANTILE: f64 = 0.99;

/// Lengths that count as close to 1. Some real maps were filtered without renormalising (in one, 3 % of the vectors are
/// shorter than 0.5), others went through lossy compression (in one, 1 % are longer than 1.23).
const NEAR_UNIT: std::ops::RangeInclusive<f32> = 0.5..=1.3;

/// Minimum share of valid texels. In the real normal maps, at least 0.95 are near unit length and point outward; in
/// albedo at most 0.56, in other pictures at most 0.85 (a mask, whose colour is far from upright).
const MOST: f64 = 0.9;

/// Minimum share of the texels of a two-channel map that must be normals. Backgrounds are often stored as (0, 0), which
/// decodes to (-1, -1): 40 % of the texels of one real map.
const SHARE_OF_TWO: f64 = 0.5;

const NOTHING_FINITE: &str = "none of its values is finite";

/// The result of [`guess_kind`].
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum KindGuess {
    /// The map is of this kind.
    Certain(Kind),
    /// The map may be neither: the user has to specify the kind.
    Doubtful {
        /// The reason, as one short clause: `it has 6 channels beside alpha`.
        reason: String,
    },
}

impl KindGuess {
    fn doubtful(reason: impl Into<String>) -> Self {
        KindGuess::Doubtful { reason: reason.into() }
    }
}

/// Guesses whether a map holds normals or heights.
///
/// `channels` names each channel of the image, in order; an alpha channel (`A`, or a name that ends in `.A`) does not
/// count. `range` is how the components of normals are stored: use [`crate::detect::guess_range`] if the file does not
/// say.
///
/// One channel is a height, two are a normal's x and y. Three channels are judged by their contents: grey is a height;
/// vectors of about unit length that point out of the surface are normals, and so are x and y combined with a constant
/// instead of z. Maps of roughness or occlusion are grey, too, and are classified as heights: the pixels alone cannot
/// tell them apart.
pub fn guess_kind<'a>(
    image: impl Into<ImageView<'a>>,
    channels: &[impl AsRef<str>],
    range: NormalRange,
) -> KindGuess {
    let image = image.into();
    match guess_grey_and_alpha(image, channels, range) {
        GreyAndAlpha::Normals(_) => return KindGuess::Certain(Kind::Normal),
        GreyAndAlpha::EitherOrder => {
            return KindGuess::doubtful("its grey and its alpha can be x and y of a normal, in either order");
        }
        GreyAndAlpha::Other => {}
    }
    match *colour_channels(image, channels) {
        [_] => KindGuess::Certain(Kind::Height),
        [x, y] => guess_two(&decoded(texels(image, [x, y]), range)),
        [_, _, _] if x_is_in_alpha(image) => {
            if_slopes(image, NormalChannels::Ag, range, "its red and blue are constant")
        }
        [r, g, b] => guess_three(image, [r, g, b], range),
        ref others => KindGuess::doubtful(format!("it has {} channels beside alpha", others.len())),
    }
}

fn guess_two(vectors: &[[f32; 2]]) -> KindGuess {
    if vectors.is_empty() {
        return KindGuess::doubtful(NOTHING_FINITE);
    }
    let inside = share(vectors, |xy| length(xy) <= MAX_XY_LENGTH);
    if inside >= SHARE_OF_TWO {
        return KindGuess::Certain(Kind::Normal);
    }
    let inside = percent(inside);
    KindGuess::doubtful(format!(
        "it has two channels, but x^2 + y^2 is at most 1 in only {inside} of its texels"
    ))
}

fn guess_three(image: ImageView<'_>, channels: [usize; 3], range: NormalRange) -> KindGuess {
    let stored = texels(image, channels);
    if stored.is_empty() {
        return KindGuess::doubtful(NOTHING_FINITE);
    }
    let scale = full_scale(image, &stored);
    if [0, 1, 2].iter().all(|&c| spread(stored.iter().map(|texel| texel[c])) <= SAME * scale) {
        return guess_constant(stored[0], scale, range);
    }
    let vectors = decoded(stored.clone(), range);
    match guess_blue(&vectors, range) {
        Blue::PlainZ => KindGuess::Certain(Kind::Normal),
        Blue::Void => if_slopes(image, NormalChannels::Xy, range, "its blue is constant"),
        Blue::Other if is_grey(&stored, scale) => KindGuess::Certain(Kind::Height),
        Blue::Other => guess_vectors(&vectors),
    }
}

/// Accepts two channels that could be x and y as a normal's if they are slopes; the other channels carry no
/// information.
fn if_slopes(image: ImageView<'_>, channels: NormalChannels, range: NormalRange, seen: &str) -> KindGuess {
    if looks_like_slopes(image, channels, range) {
        KindGuess::Certain(Kind::Normal)
    } else {
        KindGuess::doubtful(format!("{seen}, and the other two channels are not the slopes of a surface"))
    }
}

/// The stored value that represents white: 1 for integers; for floats, estimated from the largest values.
fn full_scale(image: ImageView<'_>, stored: &[[f32; 3]]) -> f32 {
    if !image.samples().sample_type().is_float() {
        return 1.0;
    }
    let mut sizes: Vec<f32> =
        stored.iter().map(|texel| texel.iter().fold(0.0, |a, c| c.abs().max(a))).collect();
    let scale = quantile(&mut sizes, FULL_SCALE_QUANTILE);
    if scale > 0.0 { scale } else { 1.0 }
}

fn guess_constant(stored: [f32; 3], scale: f32, range: NormalRange) -> KindGuess {
    let [x, y, z] = stored.map(|value| range.component_from_stored(value));
    // One step of the stored value is two steps of the component.
    if x.abs() <= 2.0 * SAME && y.abs() <= 2.0 * SAME && UNIT.contains(&z) {
        return KindGuess::Certain(Kind::Normal);
    }
    if spread(stored) <= SAME * scale {
        return KindGuess::Certain(Kind::Height);
    }
    let [r, g, b] = stored;
    KindGuess::doubtful(format!("all of it is one colour, ({r:.2}, {g:.2}, {b:.2}), which is no flat normal"))
}

fn is_grey(stored: &[[f32; 3]], scale: f32) -> bool {
    let mut spreads: Vec<f32> = stored.iter().map(|texel| spread(*texel)).collect();
    // Both sums are over the same texels.
    let total_spread: f64 = spreads.iter().copied().map(f64::from).sum();
    let brightness: f64 = stored.iter().flatten().map(|value| f64::from(value.abs()) / 3.0).sum();
    total_spread <= GREY_SATURATION * brightness
        && quantile(&mut spreads, GREY_QUANTILE) <= GREY_SPREAD * scale
}

/// Judges coloured pictures by whether their colours are normals.
fn guess_vectors(vectors: &[[f32; 3]]) -> KindGuess {
    let unit = share(vectors, |v| UNIT.contains(&length(v)));
    let outward = share(vectors, |[_, _, z]| z > 0.0);
    if unit >= MOST && outward >= MOST {
        return KindGuess::Certain(Kind::Normal);
    }
    if unit >= MOST {
        let inward = percent(1.0 - outward);
        return KindGuess::doubtful(format!(
            "its vectors have unit length, but {inward} point into the surface, like those of an object-space map"
        ));
    }
    let near = share(vectors, |v| NEAR_UNIT.contains(&length(v)) && v[2] > 0.0);
    if near >= MOST && length(mean_xy(vectors)) <= MAX_MEAN_TILT {
        return KindGuess::Certain(Kind::Normal);
    }
    let near = percent(near);
    KindGuess::doubtful(format!(
        "it is not grey, and only {near} of its texels are normals that point out of it"
    ))
}

/// Formats a share as a percentage: `37 %`.
fn percent(share: f64) -> String {
    format!("{:.0} %", share * 100.0)
}
