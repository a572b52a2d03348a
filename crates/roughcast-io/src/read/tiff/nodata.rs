//! Texels without data: GDAL's tag 42113, a number as text, and its masks, which are separate images in the same file
//! (<https://gdal.org/drivers/raster/gtiff.html>, "Nodata value" and "Internal nodata masks").

use half::f16;
use roughcast::Samples;

use super::directory::{Directory, tag};
use super::layout::{Layout, Numbers};
use super::samples::Stored;
use crate::ReadError;
use crate::read::memory::zeros;

/// Maximum relative difference at which a float matches the value in the tag. Writers shorten the digits
/// (`-3.40282e+38`); GDAL allows 10 float steps of 2^-23 each.
const SAME: f32 = 10.0 / (1 << 23) as f32;

/// A file's marking of texels without data.
pub(super) struct Nodata {
    /// The marker value, as text and as stored, if the sample type can represent it.
    text: String,
    word: Option<u64>,
    /// The mask: 0 for each texel without data.
    mask: Option<Vec<u8>>,
}

impl Nodata {
    pub fn of(directory: &Directory<'_>, layout: &Layout, mask: Option<Vec<u8>>) -> Self {
        let text = directory.text(tag::GDAL_NODATA).unwrap_or_default().trim().to_owned();
        let word = text.parse().ok().and_then(|value| word_of(value, layout));
        Self { text, word, mask }
    }

    /// The marker value as stored; `None` if there is none or the sample type cannot represent it.
    pub fn word(&self) -> Option<u64> {
        self.word
    }

    /// Sets texels without data to NaN. If there are any, the samples become floats. `value` is the marker's decoded
    /// sample value.
    pub fn apply(&self, stored: &mut Stored, value: f32, layout: &Layout) -> Result<(), ReadError> {
        if self.word.is_none() && self.mask.is_none() {
            return Ok(());
        }
        let is_value = |sample: f32| {
            sample == value
                || (value.is_nan() && sample.is_nan())
                || (sample - value).abs() <= SAME * value.abs()
        };
        let channels = layout.channels.len();
        let colours: Vec<usize> =
            (0..channels).filter(|&channel| !layout.channels[channel].is_alpha).collect();
        let samples = &stored.samples;
        let is_empty = |pixel: usize| {
            let is_masked = self.mask.as_ref().is_some_and(|mask| mask[pixel] == 0);
            let has_value = || {
                self.word.is_some()
                    && colours.iter().all(|colour| is_value(samples.get(pixel * channels + colour)))
            };
            is_masked || has_value()
        };
        let count = (0..samples.len() / channels).filter(|&pixel| is_empty(pixel)).count();
        if count == 0 {
            return Ok(());
        }
        let mut floats = zeros::<f32>(samples.len())?;
        for (pixel, target) in floats.chunks_exact_mut(channels).enumerate() {
            let empty = is_empty(pixel);
            for (channel, value) in target.iter_mut().enumerate() {
                let blank = empty && colours.contains(&channel);
                *value = if blank { f32::NAN } else { samples.get(pixel * channels + channel) };
            }
        }
        stored.samples = Samples::F32(floats);
        stored.warnings.push(self.words(count));
        Ok(())
    }

    fn words(&self, count: usize) -> String {
        let by = match (&self.word, &self.mask) {
            (Some(_), None) => format!("the value {}", self.text),
            (None, _) => "by its mask".to_owned(),
            (Some(_), Some(_)) => format!("by its mask, or the value {}", self.text),
        };
        let (texels, have, they) =
            if count == 1 { ("texel", "has", "it and its") } else { ("texels", "have", "they and their") };
        format!("{count} {texels} {have} no data ({by}): {they} neighbours are taken as flat")
    }
}

/// The stored bits of a number; `None` if the sample type cannot represent it.
fn word_of(value: f64, layout: &Layout) -> Option<u64> {
    let bits = layout.bits;
    let is_integer = value.fract() == 0.0;
    match (layout.numbers, bits) {
        (Numbers::Unsigned, _) if is_integer && (0.0..2f64.powi(bits as i32)).contains(&value) => {
            Some(value as u64)
        }
        (Numbers::Signed, _) if is_integer && value.abs() <= 2f64.powi(bits as i32 - 1) => {
            Some(value as i64 as u64 & (u64::MAX >> (64 - bits)))
        }
        (Numbers::Float, 16) => Some(f16::from_f64(value).to_bits().into()),
        (Numbers::Float, 32) => Some((value as f32).to_bits().into()),
        (Numbers::Float, 64) => Some(value.to_bits()),
        _ => None,
    }
}
