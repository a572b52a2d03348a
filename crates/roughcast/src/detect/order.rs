//! Guesses from the pixels which of two channels is x and which is y.
//!
//! The slopes of a surface have no curl (see [`super::green`]). If x and y are exchanged, their mixed derivatives
//! become the second derivatives of the height along the axes, whose correlation is smaller: 1/3 if the bumps have no
//! preferred direction. The order with the larger correlation is therefore the right one, whichever way green points.
//!
//! In all 40 real normal maps the right order has the larger correlation; in 36 the difference is large enough to be
//! sure.

use super::channels::{alpha_of, colour_channels};
use super::green::{GreenTest, test_green_of_map};
use super::sample::{SAME, quantile, share, spread, texels};
use super::vectors::{MAX_MEAN_TILT, MAX_XY_LENGTH, decoded, length, mean_xy};
use crate::{ImageView, Kind, NormalChannels, NormalRange, SourceOptions};

/// The correlations of the two orders must differ by at least this much. Four of the real maps differ by less: two that
/// have no direction, one whose red is lost, and one of long straight seams, whose orders have 0.98 and 0.93.
const CLEAR_DIFFERENCE: f64 = 0.1;

/// Maximum difference between red, green and blue of a grey picture in nearly all texels. Block compression (BC3)
/// stores them with 5, 6 and 5 bits.
const GREY: f32 = 10.0 / 255.0;

/// Minimum share of the texels that must be valid.
const NEARLY_ALL: f64 = 0.99;

/// Picks the one of two ways to read a map whose order of x and y is right; `None` if both are equally good or bad.
///
/// `options` specify all other aspects of reading the map.
pub fn guess_order<'a>(
    image: impl Into<ImageView<'a>>,
    options: &SourceOptions,
    ways: [NormalChannels; 2],
) -> Option<NormalChannels> {
    let image = image.into();
    let [first, second] = ways.map(|normal_channels| correlation(image, options, normal_channels));
    match (first.is_large(), second.is_large()) {
        (true, _) if first.size() >= second.size() + CLEAR_DIFFERENCE => Some(ways[0]),
        (_, true) if second.size() >= first.size() + CLEAR_DIFFERENCE => Some(ways[1]),
        _ => None,
    }
}

/// The result of the curl test for one way to read a map.
struct Correlation(Option<GreenTest>);

impl Correlation {
    fn size(&self) -> f64 {
        self.0.map_or(0.0, |test| test.correlation.abs())
    }

    fn is_large(&self) -> bool {
        self.0.is_some_and(|test| test.is_large())
    }
}

fn correlation(
    image: ImageView<'_>,
    options: &SourceOptions,
    normal_channels: NormalChannels,
) -> Correlation {
    let options = SourceOptions { kind: Kind::Normal, normal_channels, ..*options };
    Correlation(test_green_of_map(image, &options))
}

/// Contents of a grey picture with alpha.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum GreyAndAlpha {
    /// Normals, stored in these channels.
    Normals(NormalChannels),
    /// Normals by all criteria, but either of the two may be x.
    EitherOrder,
    /// Grey with its coverage, or not a grey picture with alpha at all.
    Other,
}

/// Whether grey and alpha are x and y of normals. KTX's normal mode stores x in grey; Unity's textures store it in
/// alpha.
pub(super) fn guess_grey_and_alpha(
    image: ImageView<'_>,
    channels: &[impl AsRef<str>],
    range: NormalRange,
) -> GreyAndAlpha {
    let (grey, ways) = match (&colour_channels(image, channels)[..], alpha_of(image, channels)) {
        ([0, 1, 2], Some(3)) if is_grey(image) => (0, [NormalChannels::Ra, NormalChannels::Ag]),
        ([0], Some(1)) => (0, [NormalChannels::Xy, NormalChannels::Yx]),
        _ => return GreyAndAlpha::Other,
    };
    let stored = texels(image, [grey, image.channels() - 1]);
    let varies = |channel: usize| spread(stored.iter().map(|texel| texel[channel])) > SAME;
    let vectors = decoded(stored.clone(), range);
    let inside = share(&vectors, |xy| length(xy) <= MAX_XY_LENGTH) >= NEARLY_ALL;
    let upright =
        length(mean_xy(&vectors.iter().map(|[x, y]| [*x, *y, 0.0]).collect::<Vec<_>>())) <= MAX_MEAN_TILT;
    if !(varies(0) && varies(1) && inside && upright) {
        return GreyAndAlpha::Other;
    }
    let options = SourceOptions { range, ..SourceOptions::default() };
    match guess_order(image, &options, ways) {
        Some(way) => GreyAndAlpha::Normals(way),
        None if ways.iter().any(|way| correlation(image, &options, *way).is_large()) => {
            GreyAndAlpha::EitherOrder
        }
        None => GreyAndAlpha::Other,
    }
}

fn is_grey(image: ImageView<'_>) -> bool {
    let mut spreads: Vec<f32> = texels(image, [0, 1, 2]).into_iter().map(spread).collect();
    quantile(&mut spreads, NEARLY_ALL) <= GREY
}
