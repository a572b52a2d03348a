//! Converts stored samples to image samples, and decides what the numbers mean.

use half::f16;
use roughcast::Samples;

use super::chunks::Chunks;
use super::directory::Directory;
use super::layout::{Channel, Colours, Layout, Numbers};
use super::nodata::Nodata;
use super::palette;
use super::words::{f32_from_f24, signed};
use crate::{ReadError, ValueRange};

/// Samples with their meaning.
pub(super) struct Stored {
    pub samples: Samples,
    pub range: ValueRange,
    pub warnings: Vec<String>,
}

/// Decodes the samples of an image. `mask` is 0 for texels without data.
pub(super) fn read(
    directory: &Directory<'_>,
    chunks: &Chunks<'_>,
    layout: &Layout,
    mask: Option<Vec<u8>>,
) -> Result<Stored, ReadError> {
    if layout.colours == Colours::Palette {
        let samples = palette::read(directory, chunks, layout)?;
        return Ok(Stored { samples, range: ValueRange::Unorm, warnings: Vec::new() });
    }
    let nodata = Nodata::of(directory, layout, mask);
    let meaning = Meaning::of(layout);
    let (samples, nothing) = decode(chunks, layout, meaning, nodata.word())?;
    let mut stored = Stored { samples, range: meaning.range(), warnings: Vec::new() };
    if let Some(warning) = inversion_warning(layout, meaning) {
        stored.warnings.push(warning.to_owned());
    }
    if meaning == Meaning::SignedNormalised {
        stored.warnings.push("its signed integers are read as -1 to 1".to_owned());
    }
    if layout.is_premultiplied && has_transparency(&stored.samples, &layout.channels) {
        stored.warnings.push("its colours are multiplied by its alpha, and are read unchanged".to_owned());
    }
    nodata.apply(&mut stored, nothing, layout)?;
    if meaning == Meaning::Undecided {
        normalise_if_full_range(&mut stored, layout.bits);
    }
    Ok(stored)
}

/// What the numbers of an image mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Meaning {
    /// Unsigned integers whose maximum stands for 1.
    Normalised,
    /// Signed integers whose maximum stands for 1.
    SignedNormalised,
    /// The numbers themselves.
    Plain,
    /// Unsigned integers that may be normalised or plain.
    Undecided,
}

impl Meaning {
    fn of(layout: &Layout) -> Self {
        let colours = layout.channels.iter().filter(|channel| !channel.is_alpha).count();
        match layout.numbers {
            Numbers::Float => Self::Plain,
            Numbers::Signed if colours == 1 => Self::Plain,
            Numbers::Signed => Self::SignedNormalised,
            Numbers::Unsigned if layout.bits > 16 && colours == 1 => Self::Undecided,
            Numbers::Unsigned => Self::Normalised,
        }
    }

    fn range(self) -> ValueRange {
        match self {
            Self::Normalised => ValueRange::Unorm,
            Self::SignedNormalised => ValueRange::Snorm,
            Self::Plain | Self::Undecided => ValueRange::Float,
        }
    }
}

/// The warning for an image where 0 is white. For 8 bits all programs agree.
fn inversion_warning(layout: &Layout, meaning: Meaning) -> Option<&'static str> {
    match meaning {
        _ if layout.colours != Colours::GreyInverted => None,
        Meaning::Normalised if layout.bits <= 8 => None,
        Meaning::Normalised => {
            Some("its 0 is white (photometric interpretation 0), so its values are inverted")
        }
        _ => Some(
            "its 0 is said to be white (photometric interpretation 0), which is ignored for its type of numbers",
        ),
    }
}

/// Decodes the samples. `nothing` is the stored value of texels without data; its decoded value is returned with the
/// samples.
fn decode(
    chunks: &Chunks<'_>,
    layout: &Layout,
    meaning: Meaning,
    nothing: Option<u64>,
) -> Result<(Samples, f32), ReadError> {
    let nothing = nothing.unwrap_or(0);
    let bits = layout.bits;
    let largest = u64::MAX >> (64 - bits);
    let largest_signed = (largest >> 1) as f64;
    let upright =
        move |word: u64| if layout.colours == Colours::GreyInverted { largest - word } else { word };
    macro_rules! decoded {
        ($samples:path, $convert:expr) => {{
            let convert = $convert;
            let value = $samples(vec![convert(nothing)]).get(0);
            ($samples(chunks.decode(layout, convert(nothing), convert)?), value)
        }};
    }
    Ok(match (layout.numbers, meaning) {
        (Numbers::Unsigned, Meaning::Normalised) => match bits {
            // The factors are exact: 255, 85, 17 and 1.
            1 | 2 | 4 | 8 => decoded!(Samples::U8, |word| (upright(word) * (255 / largest)) as u8),
            ..=16 => decoded!(Samples::U16, |word| ((upright(word) * 65535 + largest / 2) / largest) as u16),
            _ => decoded!(Samples::F32, |word| (upright(word) as f64 / largest as f64) as f32),
        },
        (Numbers::Unsigned, _) => decoded!(Samples::F32, |word| word as f32),
        // As in graphics APIs, the smallest integer and the one above it both stand for -1.
        (Numbers::Signed, Meaning::SignedNormalised) => {
            decoded!(Samples::F32, |word| (signed(word, bits) as f64 / largest_signed).max(-1.0) as f32)
        }
        (Numbers::Signed, _) => decoded!(Samples::F32, |word| signed(word, bits) as f32),
        (Numbers::Float, _) => match bits {
            16 => decoded!(Samples::F16, |word| f16::from_bits(word as u16)),
            24 => decoded!(Samples::F32, f32_from_f24),
            32 => decoded!(Samples::F32, |word| f32::from_bits(word as u32)),
            _ => decoded!(Samples::F32, |word| f64::from_bits(word) as f32),
        },
    })
}

/// Normalises grey of more than 16 bits if it uses the whole range, as pictures do; heights in any unit leave the
/// highest bits unused.
fn normalise_if_full_range(stored: &mut Stored, bits: u32) {
    /// Number of highest bits; a picture uses at least one of them.
    const HIGH_BITS: u32 = 8;
    let Samples::F32(samples) = &mut stored.samples else { return };
    let largest = samples.iter().copied().fold(0.0, f32::max);
    if largest >= 2f32.powi((bits - HIGH_BITS) as i32) {
        let white = 2f64.powi(bits as i32) - 1.0;
        samples.iter_mut().for_each(|sample| *sample = (f64::from(*sample) / white) as f32);
        stored.range = ValueRange::Unorm;
    }
}

fn has_transparency(samples: &Samples, channels: &[Channel]) -> bool {
    let Some(alpha) = channels.iter().position(|channel| channel.is_alpha) else { return false };
    (alpha..samples.len()).step_by(channels.len()).any(|index| samples.get(index) < 1.0)
}
