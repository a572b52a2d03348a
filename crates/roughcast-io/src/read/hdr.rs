//! Radiance HDR (`.hdr`, `.pic`), following the Radiance file format document and Radiance's `color.c`.
//!
//! The `image` crate is not used: it knows only one of the two signatures in use, and its counter for old-style run
//! lengths overflows on damaged files.

use std::collections::BTreeMap;

use roughcast::{Image, Samples};

use super::memory::{check_size, malformed, unsupported, zeros};
use crate::metadata::insert;
use crate::{Decoded, FileInfo, Limits, ReadError, ValueRange};

const FORMAT: &str = "HDR";
/// A pixel as stored: three mantissas and their common exponent.
type Rgbe = [u8; 4];

/// Reads an HDR as three floats per pixel.
pub(super) fn read(bytes: &[u8], limits: &Limits) -> Result<Decoded, ReadError> {
    let mut input = Input(bytes);
    let metadata = read_header(&mut input)?;
    let resolution = Resolution::parse(&input.line()?)?;
    let (width, height) = check_size(FORMAT, resolution.width(), resolution.height(), limits)?;
    let (lines, line_length) = if resolution.in_columns { (width, height) } else { (height, width) };

    let scale: Vec<f32> = (0..=u8::MAX).map(scale_of_exponent).collect();
    let mut line = zeros::<Rgbe>(line_length)?;
    let mut samples = zeros::<f32>(width * height * 3)?;
    for line_index in 0..lines {
        read_line(&mut input, &mut line)?;
        for (index, &[r, g, b, exponent]) in line.iter().enumerate() {
            let (x, y) = resolution.place(line_index, index, (width, height));
            let scale = scale[usize::from(exponent)];
            let pixel = &mut samples[(y * width + x) * 3..][..3];
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

/// The value of one mantissa step: `2^(exponent - 128 - 8)`, or 0 for exponent 0.
fn scale_of_exponent(exponent: u8) -> f32 {
    if exponent == 0 { 0.0 } else { 2f64.powi(i32::from(exponent) - 136) as f32 }
}

/// The remaining bytes.
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

/// The order of the pixels in the file, from a line like `-Y 512 +X 1024`: the axis from line to line and the axis
/// along a line, each with its length and the sign of its direction. Y points up.
struct Resolution {
    /// Lines are columns of the image.
    in_columns: bool,
    lines: u64,
    line_length: u64,
    /// Whether x runs from right to left.
    from_right: bool,
    /// Whether y runs from bottom to top.
    from_bottom: bool,
}

impl Resolution {
    fn parse(line: &str) -> Result<Self, ReadError> {
        let fault = || malformed(FORMAT, format_args!("its resolution line reads '{line}'"));
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        let [first, lines, second, line_length] = words[..] else { return Err(fault()) };
        let (in_columns, x, y) = match (first, second) {
            ("-Y" | "+Y", "-X" | "+X") => (false, second, first),
            ("-X" | "+X", "-Y" | "+Y") => (true, first, second),
            _ => return Err(fault()),
        };
        let number = |word: &str| word.parse().map_err(|_| fault());
        Ok(Self {
            in_columns,
            lines: number(lines)?,
            line_length: number(line_length)?,
            from_right: x == "-X",
            from_bottom: y == "+Y",
        })
    }

    fn width(&self) -> u64 {
        if self.in_columns { self.lines } else { self.line_length }
    }

    fn height(&self) -> u64 {
        if self.in_columns { self.line_length } else { self.lines }
    }

    /// The position in the image of the pixel at this line and index.
    fn place(&self, line: usize, index: usize, (width, height): (usize, usize)) -> (usize, usize) {
        let (x, y) = if self.in_columns { (line, index) } else { (index, line) };
        let x = if self.from_right { width - 1 - x } else { x };
        let y = if self.from_bottom { height - 1 - y } else { y };
        (x, y)
    }
}

/// Reads one line, stored in either of the two encodings.
fn read_line(input: &mut Input<'_>, row: &mut [Rgbe]) -> Result<(), ReadError> {
    // Rows of these widths may be stored channel by channel. They then begin with 2, 2 and the width.
    const PLANAR_WIDTHS: std::ops::Range<usize> = 8..0x8000;
    let first = input.rgbe()?;
    if PLANAR_WIDTHS.contains(&row.len()) && first[0] == 2 && first[1] == 2 && first[2] < 128 {
        let stated = usize::from(u16::from_be_bytes([first[2], first[3]]));
        if stated != row.len() {
            return Err(malformed(FORMAT, format_args!("a row of {} pixels states {stated}", row.len())));
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

/// Whole pixels, where (1, 1, 1, n) repeats the last pixel n times. The k-th consecutive marker counts in units of
/// 256^(k - 1).
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
        // No row is long enough for a fifth consecutive marker.
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
    fn every_orientation_is_turned() {
        // Pixels 1 to 6 in file order, and the rows of the image from the top.
        let pixels: Vec<u8> = (1..=6).flat_map(|red| [red, 0, 0, 136]).collect();
        let cases = [
            ("-Y 2 +X 3", 3, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]),
            ("+Y 2 +X 3", 3, [4.0, 5.0, 6.0, 1.0, 2.0, 3.0]),
            ("-Y 2 -X 3", 3, [3.0, 2.0, 1.0, 6.0, 5.0, 4.0]),
            ("+Y 2 -X 3", 3, [6.0, 5.0, 4.0, 3.0, 2.0, 1.0]),
            ("+X 2 -Y 3", 2, [1.0, 4.0, 2.0, 5.0, 3.0, 6.0]),
            ("+X 2 +Y 3", 2, [3.0, 6.0, 2.0, 5.0, 1.0, 4.0]),
            ("-X 2 -Y 3", 2, [4.0, 1.0, 5.0, 2.0, 6.0, 3.0]),
            ("-X 2 +Y 3", 2, [6.0, 3.0, 5.0, 2.0, 4.0, 1.0]),
        ];
        for (resolution, width, rows) in cases {
            let decoded = read_file(resolution, &pixels).unwrap();
            let red: Vec<f32> = floats(&decoded).iter().step_by(3).copied().collect();
            assert_eq!((decoded.image.width(), &red[..]), (width, &rows[..]), "{resolution}");
        }
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
        assert!(matches!(read_file("+X 2 -X 2", &[]), Err(ReadError::Malformed { .. })));
        assert!(matches!(read_file("-Y 99999999 +X 99999999", &[]), Err(ReadError::TooLarge { .. })));
    }
}
