//! Radiance HDR (`.hdr`, `.pic`), after the Radiance file format document and `color.c` of Radiance.
//!
//! Read here instead of by the `image` crate, which knows only one of the two signatures in use and whose count of
//! old run lengths overflows on damaged files.

use std::collections::BTreeMap;

use roughcast::{Image, Samples};

use super::memory::{check_size, malformed, unsupported, zeros};
use crate::metadata::insert;
use crate::{Decoded, FileInfo, Limits, ReadError, ValueRange};

const FORMAT: &str = "HDR";
/// A pixel as stored: three mantissas and their common exponent.
type Rgbe = [u8; 4];

/// Reads an HDR as three floats a pixel.
pub(super) fn read(bytes: &[u8], limits: &Limits) -> Result<Decoded, ReadError> {
    let mut input = Input(bytes);
    let metadata = read_header(&mut input)?;
    let (height, width, bottom_up) = parse_resolution(&input.line()?)?;
    let (width, height) = check_size(FORMAT, width, height, limits)?;

    let scale: Vec<f32> = (0..=u8::MAX).map(scale_of_exponent).collect();
    let mut row = zeros::<Rgbe>(width)?;
    let mut samples = zeros::<f32>(width * height * 3)?;
    for stored_y in 0..height {
        read_row(&mut input, &mut row)?;
        let y = if bottom_up { height - 1 - stored_y } else { stored_y };
        let target = &mut samples[y * width * 3..(y + 1) * width * 3];
        for (pixel, &[r, g, b, exponent]) in target.chunks_exact_mut(3).zip(&row) {
            let scale = scale[usize::from(exponent)];
            pixel.copy_from_slice(&[r, g, b].map(|mantissa| f32::from(mantissa) * scale));
        }
    }
    let image = Image::new(width, height, 3, Samples::F32(samples)).map_err(|e| malformed(FORMAT, e))?;
    let format = "RGBE 8-bit mantissas and a common exponent".to_owned();
    let info = FileInfo {
        range: ValueRange::Float,
        metadata,
        ..FileInfo::of_picture(FORMAT, format, (width, height), &["R", "G", "B"])
    };
    Ok(Decoded { image, info })
}

/// What one step of a mantissa is worth: `2^(exponent - 128 - 8)`, and nothing at all for exponent 0.
fn scale_of_exponent(exponent: u8) -> f32 {
    if exponent == 0 { 0.0 } else { 2f64.powi(i32::from(exponent) - 136) as f32 }
}

/// The bytes that are left.
struct Input<'a>(&'a [u8]);

impl<'a> Input<'a> {
    fn take(&mut self, len: usize) -> Result<&'a [u8], ReadError> {
        let (head, tail) =
            self.0.split_at_checked(len).ok_or_else(|| malformed(FORMAT, "the file ends too early"))?;
        self.0 = tail;
        Ok(head)
    }

    fn byte(&mut self) -> Result<u8, ReadError> {
        Ok(self.take(1)?[0])
    }

    fn rgbe(&mut self) -> Result<Rgbe, ReadError> {
        let b = self.take(4)?;
        Ok([b[0], b[1], b[2], b[3]])
    }

    /// The text up to the next line break.
    fn line(&mut self) -> Result<String, ReadError> {
        let end = self.0.iter().position(|&byte| byte == b'\n');
        let end = end.ok_or_else(|| malformed(FORMAT, "the file ends within its header"))?;
        let line = String::from_utf8_lossy(self.take(end)?).into_owned();
        self.byte()?;
        Ok(line)
    }
}

/// The header's `KEY=VALUE` lines, up to the empty line that ends it.
fn read_header(input: &mut Input<'_>) -> Result<BTreeMap<String, String>, ReadError> {
    let mut pairs = BTreeMap::new();
    loop {
        let line = input.line()?;
        if line.is_empty() {
            return Ok(pairs);
        }
        let Some((key, value)) = line.split_once('=') else { continue };
        let (key, value) = (key.trim(), value.trim());
        if key == "FORMAT" && value != "32-bit_rle_rgbe" {
            return Err(unsupported(FORMAT, format_args!("the format {value}"), "save it as RGBE"));
        }
        insert(&mut pairs, key, value);
    }
}

/// Height, width, and whether the first row stored is the bottom one, of a line like `-Y 512 +X 1024`.
fn parse_resolution(line: &str) -> Result<(u64, u64, bool), ReadError> {
    let words: Vec<&str> = line.split_ascii_whitespace().collect();
    let [vertical, height, horizontal, width] = words[..] else {
        return Err(malformed(FORMAT, format_args!("its resolution line reads '{line}'")));
    };
    let bottom_up = match (vertical, horizontal) {
        ("-Y", "+X") => false,
        ("+Y", "+X") => true,
        ("+Y" | "-Y" | "+X" | "-X", "+Y" | "-Y" | "+X" | "-X") => {
            let what = format!("the orientation {vertical} {horizontal}");
            return Err(unsupported(FORMAT, what, "save it with rows from the left, top to bottom (-Y +X)"));
        }
        _ => return Err(malformed(FORMAT, format_args!("its resolution line reads '{line}'"))),
    };
    match (height.parse(), width.parse()) {
        (Ok(height), Ok(width)) => Ok((height, width, bottom_up)),
        _ => Err(malformed(FORMAT, format_args!("its resolution line reads '{line}'"))),
    }
}

/// One row, in whichever of the two ways it is stored.
fn read_row(input: &mut Input<'_>, row: &mut [Rgbe]) -> Result<(), ReadError> {
    // Rows of these widths may be stored channel by channel; they then begin with 2, 2 and the width.
    const PLANAR_WIDTHS: std::ops::Range<usize> = 8..0x8000;
    let first = input.rgbe()?;
    if PLANAR_WIDTHS.contains(&row.len()) && first[0] == 2 && first[1] == 2 && first[2] < 128 {
        let stated = usize::from(u16::from_be_bytes([first[2], first[3]]));
        if stated != row.len() {
            return Err(malformed(
                FORMAT,
                format_args!("a row of {} pixels says it has {stated}", row.len()),
            ));
        }
        (0..4).try_for_each(|channel| read_channel(input, row, channel))
    } else {
        read_interleaved(input, first, row)
    }
}

/// One channel of a row: runs (a count above 128, then the value) and literals (a count, then the values).
fn read_channel(input: &mut Input<'_>, row: &mut [Rgbe], channel: usize) -> Result<(), ReadError> {
    let mut x = 0;
    while x < row.len() {
        let count = usize::from(input.byte()?);
        let (len, is_run) = if count > 128 { (count - 128, true) } else { (count, false) };
        let values = input.take(if is_run { 1 } else { len })?;
        let target = row.get_mut(x..x + len).filter(|target| !target.is_empty());
        let target = target.ok_or_else(|| malformed(FORMAT, "a run of pixels passes the end of its row"))?;
        for (i, pixel) in target.iter_mut().enumerate() {
            pixel[channel] = values[if is_run { 0 } else { i }];
        }
        x += len;
    }
    Ok(())
}

/// Whole pixels, where (1, 1, 1, n) repeats the last one n times; more such in a row count in steps of 256.
fn read_interleaved(input: &mut Input<'_>, first: Rgbe, row: &mut [Rgbe]) -> Result<(), ReadError> {
    let mut next = Some(first);
    let mut last = None;
    let mut shift = 0;
    let mut x = 0;
    while x < row.len() {
        let pixel = match next.take() {
            Some(pixel) => pixel,
            None => input.rgbe()?,
        };
        let [1, 1, 1, count] = pixel else {
            row[x] = pixel;
            (last, shift, x) = (Some(pixel), 0, x + 1);
            continue;
        };
        // No row is so long that a fifth marker could still count.
        let count = if shift < 32 { usize::from(count) << shift } else { usize::MAX };
        let end = x.checked_add(count).filter(|&end| end <= row.len());
        match (last, end) {
            (Some(last), Some(end)) => row[x..end].fill(last),
            _ => return Err(malformed(FORMAT, "a run of pixels passes the end of its row")),
        }
        (shift, x) = (shift + 8, x + count);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_file(resolution: &str, pixels: &[u8]) -> Result<Decoded, ReadError> {
        let header = format!("#?RGBE\n# note\nEXPOSURE=2\nFORMAT=32-bit_rle_rgbe\n\n{resolution}\n");
        read(&[header.as_bytes(), pixels].concat(), &Limits::default())
    }

    fn floats(decoded: &Decoded) -> &[f32] {
        match decoded.image.samples() {
            Samples::F32(samples) => samples,
            other => panic!("HDR gives floats, not {:?}", other.sample_type()),
        }
    }

    #[test]
    fn plain_pixels_and_old_runs() {
        // Exponent 129 makes a mantissa of 128 the value 1; the marker repeats it 2 + 256 * 1 times.
        let pixels = [&[128, 64, 0, 129][..], &[1, 1, 1, 2], &[1, 1, 1, 1], &[0, 0, 128, 128]].concat();
        let decoded = read_file("-Y 1 +X 260", &pixels).unwrap();
        assert_eq!(&floats(&decoded)[..3], &[1.0, 0.5, 0.0]);
        assert_eq!(&floats(&decoded)[258 * 3..], &[1.0, 0.5, 0.0, 0.0, 0.0, 0.5]);
        assert_eq!(decoded.info.metadata["EXPOSURE"], "2");
    }

    #[test]
    fn planar_rows() {
        let pixels = [2, 2, 0, 8, 128 + 8, 128, 4, 1, 2, 3, 4, 128 + 4, 5, 128 + 8, 0, 128 + 8, 136];
        let decoded = read_file("-Y 1 +X 8", &pixels).unwrap();
        let green: Vec<f32> = floats(&decoded).iter().skip(1).step_by(3).copied().collect();
        assert_eq!(green, [1.0, 2.0, 3.0, 4.0, 5.0, 5.0, 5.0, 5.0]);
        assert_eq!(floats(&decoded)[0], 128.0);
    }

    #[test]
    fn rows_from_the_bottom_are_turned() {
        let decoded = read_file("+Y 2 +X 1", &[1, 0, 0, 136, 2, 0, 0, 136]).unwrap();
        assert_eq!(floats(&decoded), [2.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
    }

    #[test]
    fn exponents_reach_from_subnormal_to_huge() {
        assert_eq!(scale_of_exponent(0), 0.0);
        assert_eq!(f64::from(scale_of_exponent(1)), 2f64.powi(-135));
        assert_eq!(f64::from(scale_of_exponent(255)), 2f64.powi(119));
    }

    #[test]
    fn damage_is_an_error() {
        let markers = [&[9, 9, 9, 9][..], &[1, 1, 1, 0].repeat(9)].concat();
        let cases: [(&str, &[u8]); 8] = [
            ("-Y 1 +X 4", &[1, 1, 1, 1]),
            ("-Y 1 +X 4", &[9, 9, 9, 9, 1, 1, 1, 4]),
            ("-Y 1 +X 40", &markers),
            ("-Y 1 +X 8", &[2, 2, 0, 9]),
            ("-Y 1 +X 8", &[2, 2, 0, 8, 128 + 9, 1]),
            ("-Y 1 +X 8", &[2, 2, 0, 8, 0]),
            ("-Y 1 +X 2", &[9, 9, 9, 9, 9, 9, 9]),
            ("-Y 1 X 2", &[9, 9, 9, 9, 9, 9, 9, 9]),
        ];
        for (resolution, pixels) in cases {
            let result = read_file(resolution, pixels);
            assert!(
                matches!(result, Err(ReadError::Malformed { .. })),
                "{resolution} {pixels:?}: {result:?}"
            );
        }
        assert!(matches!(read_file("+X 2 -Y 2", &[]), Err(ReadError::Unsupported { .. })));
        assert!(matches!(read_file("-Y 99999999 +X 99999999", &[]), Err(ReadError::TooLarge { .. })));
    }
}
