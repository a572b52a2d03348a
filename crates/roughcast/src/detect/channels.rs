//! Guesses how normals are stored: in which channels and over which range.

use super::green::test_green_of_map;
use super::order::{GreyAndAlpha, guess_grey_and_alpha};
use super::sample::{SAME, quantile, share, spread, texels};
use super::vectors::{MAX_MEAN_TILT, MAX_XY_LENGTH, UNIT, decoded, length, mean_xy};
use crate::{ImageView, Kind, NormalChannels, NormalRange, SamplesView, SourceOptions};

/// Blue counts as constant if z varies by less than this, ignoring 1 % of the texels at each end. This is 8 of 255
/// steps, because JPEG mixes red and green into a constant blue.
const CONSTANT_BLUE: f32 = 16.0 / 255.0;

/// Constant blues that do not encode z: zero, the middle or the maximum of the stored range.
const VOID_BLUES: [f32; 3] = [-1.0, 0.0, 1.0];

/// A z that differs by more than this from the z computed from x and y does not belong to the same vector.
const WRONG_Z: f32 = 0.1;

/// A constant blue does not encode z if more than this share of the texels has the wrong z. One real map meets this
/// condition; its blue is 255.
const WRONG_Z_SHARE: f64 = 0.01;

/// Range of z of the texels that show how blue encodes z. Near z = 1 all encodings agree; texels almost at the horizon
/// are excluded.
const TILTED: std::ops::Range<f32> = 0.15..0.9;

/// Minimum share of the texels of a map that must be tilted.
const TILTED_SHARE: f64 = 0.01;

/// Blue is z itself if the median difference between the two is below this. The one real map with such a blue has
/// 0.004; the smallest value among the others is 0.03.
const PLAIN_Z_ERROR: f32 = 0.012;

/// Minimum share of the texels whose x and y must be valid for a normal.
const NEARLY_ALL: f64 = 0.99;

/// A value below this is negative by more than the rounding error of a zero.
const NEGATIVE: f32 = -1.0 / 255.0;

/// If more than this share of the texels has a negative value, the map is signed. A smaller share comes from the
/// overshoot of a resampling filter.
const NEGATIVE_SHARE: f64 = 0.01;

/// Index of alpha in a four-channel image.
const ALPHA: usize = 3;

/// Guesses which channels hold the components of a normal map.
///
/// One or two channels hold x and y. With three channels, the first two hold x and y unless blue is z stored with the
/// same scale and bias as x and y: some maps have a constant blue (0, 128 or 255), others store z itself over 0 to 1.
/// Alpha and green hold x and y if red and blue are constant. Grey and alpha hold them, in either order, if the two are
/// the slopes of a surface.
///
/// `channels` and `range` are as for [`crate::detect::guess_kind`].
pub fn guess_channels<'a>(
    image: impl Into<ImageView<'a>>,
    channels: &[impl AsRef<str>],
    range: NormalRange,
) -> NormalChannels {
    let image = image.into();
    if let GreyAndAlpha::Normals(normal_channels) = guess_grey_and_alpha(image, channels, range) {
        return normal_channels;
    }
    match *colour_channels(image, channels) {
        [_, _, _] if x_is_in_alpha(image) => NormalChannels::Ag,
        [r, g, b, ..] => match guess_blue(&decoded(texels(image, [r, g, b]), range), range) {
            Blue::Other => NormalChannels::Xyz,
            Blue::Void | Blue::PlainZ => NormalChannels::Xy,
        },
        _ => NormalChannels::Xy,
    }
}

/// Guesses whether the components of a map's normals are stored as they are or with scale and bias.
///
/// For images whose file does not say. Integers always have scale and bias. Floats with negative values are signed; for
/// float maps without negative values, the range that gives more vectors of unit length is chosen.
pub fn guess_range<'a>(image: impl Into<ImageView<'a>>) -> NormalRange {
    let image = image.into();
    if matches!(image.samples(), SamplesView::U8(_) | SamplesView::U16(_)) {
        return NormalRange::Unorm;
    }
    if image.channels() < 3 {
        let stored = texels(image, [0, image.channels() - 1]);
        let signed = share(&stored, |[x, y]| x.min(y) < NEGATIVE) > NEGATIVE_SHARE;
        return if signed { NormalRange::Signed } else { NormalRange::Unorm };
    }
    let stored = texels(image, [0, 1, 2]);
    if share(&stored, |[x, y, z]| x.min(y).min(z) < NEGATIVE) > NEGATIVE_SHARE {
        return NormalRange::Signed;
    }
    let unit_share = |range: NormalRange| {
        share(&stored, |texel| UNIT.contains(&length(texel.map(|value| range.component_from_stored(value)))))
    };
    if unit_share(NormalRange::Signed) > unit_share(NormalRange::Unorm) {
        NormalRange::Signed
    } else {
        NormalRange::Unorm
    }
}

/// Indices of the channels other than alpha.
pub(super) fn colour_channels(image: ImageView<'_>, channels: &[impl AsRef<str>]) -> Vec<usize> {
    (0..image.channels()).filter(|&i| !is_alpha(channels, i)).collect()
}

/// Index of the alpha channel.
pub(super) fn alpha_of(image: ImageView<'_>, channels: &[impl AsRef<str>]) -> Option<usize> {
    (0..image.channels()).find(|&i| is_alpha(channels, i))
}

fn is_alpha(channels: &[impl AsRef<str>], index: usize) -> bool {
    let name = channels.get(index).map_or("", AsRef::as_ref);
    name == "A" || name.ends_with(".A")
}

/// Whether, in a four-channel image, red and blue are constant while green and alpha vary. Such maps store x in alpha
/// and y in green, the channels that block compression (BC3) stores best.
pub(super) fn x_is_in_alpha(image: ImageView<'_>) -> bool {
    if image.channels() != ALPHA + 1 {
        return false;
    }
    let stored = texels(image, [0, 1, 2, ALPHA]);
    let varies = [0, 1, 2, ALPHA].map(|channel| spread(stored.iter().map(|texel| texel[channel])) > SAME);
    varies == [false, true, false, true]
}

/// Special contents of blue in a three-channel image; usually it is z with scale and bias, or a picture's colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Blue {
    /// A constant that does not encode z, while red and green can be x and y.
    Void,
    /// z itself, over 0 ..= 1, while red and green have scale and bias.
    PlainZ,
    /// Anything else.
    Other,
}

/// Guesses the contents of blue from the components decoded with `range`.
pub(super) fn guess_blue(vectors: &[[f32; 3]], range: NormalRange) -> Blue {
    let in_disc = share(vectors, |[x, y, _]| length([x, y]) <= MAX_XY_LENGTH);
    if in_disc < NEARLY_ALL || length(mean_xy(vectors)) > MAX_MEAN_TILT {
        return Blue::Other;
    }
    let mut blues: Vec<f32> = vectors.iter().map(|v| v[2]).collect();
    let (low, high) = (quantile(&mut blues, 0.01), quantile(&mut blues, 0.99));
    if high - low <= CONSTANT_BLUE {
        let is_void =
            VOID_BLUES.iter().any(|blue| (low - CONSTANT_BLUE..=high + CONSTANT_BLUE).contains(blue));
        let wrong = share(vectors, |[x, y, z]| (z - z_from_xy(x, y)).abs() > WRONG_Z);
        return if is_void && wrong > WRONG_Z_SHARE { Blue::Void } else { Blue::Other };
    }
    let tilted = vectors.iter().filter(|[x, y, _]| TILTED.contains(&z_from_xy(*x, *y)));
    let mut errors: Vec<f32> = tilted.map(|&[x, y, z]| ((z + 1.0) / 2.0 - z_from_xy(x, y)).abs()).collect();
    let tilted_share = errors.len() as f64 / vectors.len() as f64;
    let is_plain = tilted_share >= TILTED_SHARE && quantile(&mut errors, 0.5) <= PLAIN_Z_ERROR;
    if range == NormalRange::Unorm && is_plain { Blue::PlainZ } else { Blue::Other }
}

fn z_from_xy(x: f32, y: f32) -> f32 {
    (1.0 - x * x - y * y).max(0.0).sqrt()
}

/// Whether two channels, read as x and y of normals, are the slopes of a surface, with green up or down. Two channels
/// of an arbitrary picture are not.
pub(super) fn looks_like_slopes(
    image: ImageView<'_>,
    normal_channels: NormalChannels,
    range: NormalRange,
) -> bool {
    let options = SourceOptions { kind: Kind::Normal, range, normal_channels, ..SourceOptions::default() };
    test_green_of_map(image, &options).is_some_and(|test| test.is_large())
}
