//! The headers of a JPEG, read before decoding: sizes, sampling factors, scans.

use super::{FORMAT, SAVE_PLAIN};
use crate::ReadError;
use crate::read::memory::{malformed, unsupported};

/// Maximum number of scans. A progressive file has about ten; each costs a pass over the whole image, however few bytes
/// it has.
const MAX_SCANS: usize = 500;

/// Side of a cosine-transform block in samples.
const BLOCK: u32 = 8;

/// The frame and the scans of an image.
#[derive(Debug, Default)]
pub(super) struct Layout {
    pub(super) width: u16,
    pub(super) height: u16,
    components: Vec<Component>,
    /// The components of each scan, by index in the frame.
    scans: Vec<Vec<usize>>,
    /// Whether colours are stored as YCbCr, according to Adobe's segment.
    transform: Option<bool>,
}

/// A component's identifier and sampling factors.
#[derive(Debug)]
struct Component {
    id: u8,
    horizontal: u8,
    vertical: u8,
}

impl Layout {
    /// Reads all segments.
    ///
    /// # Errors
    /// [`ReadError::Malformed`] if there is no frame or no scan, a segment is truncated, or the end of the image is
    /// missing; [`ReadError::Unsupported`] for coding processes that are not supported.
    pub(super) fn of(bytes: &[u8]) -> Result<Self, ReadError> {
        let mut layout = Self::default();
        let mut segments = Segments { bytes, at: 2, in_scan: false };
        loop {
            let (marker, content) = segments.next()?;
            match marker {
                0xd9 => break,
                0xc0..=0xc3 => layout.read_frame(content)?,
                0xc5..=0xc7 => return Err(unsupported(FORMAT, "hierarchical coding", SAVE_PLAIN)),
                0xc9..=0xcb | 0xcd..=0xcf => {
                    return Err(unsupported(FORMAT, "arithmetic coding", SAVE_PLAIN));
                }
                0xda => layout.read_scan(content)?,
                0xee if content.starts_with(b"Adobe") => {
                    layout.transform = content.get(11).map(|&code| code != 0)
                }
                _ => {}
            }
        }
        if layout.scans.is_empty() {
            return Err(malformed(FORMAT, "it contains no image"));
        }
        Ok(layout)
    }

    /// The frame header (ITU-T T.81, B.2.2).
    fn read_frame(&mut self, content: &[u8]) -> Result<(), ReadError> {
        let cut = || malformed(FORMAT, "its frame header is cut");
        let [_precision, h1, h0, w1, w0, count, ..] = *content else { return Err(cut()) };
        if !self.components.is_empty() {
            return Err(malformed(FORMAT, "it has two frames"));
        }
        (self.width, self.height) = (u16::from_be_bytes([w1, w0]), u16::from_be_bytes([h1, h0]));
        let components = content.get(6..6 + 3 * usize::from(count)).ok_or_else(cut)?;
        for &[id, factors, _table] in components.as_chunks::<3>().0 {
            let (horizontal, vertical) = (factors >> 4, factors & 15);
            if !(1..=4).contains(&horizontal) || !(1..=4).contains(&vertical) {
                return Err(malformed(FORMAT, format_args!("a sampling factor of {horizontal}x{vertical}")));
            }
            self.components.push(Component { id, horizontal, vertical });
        }
        if self.components.is_empty() {
            Err(malformed(FORMAT, "its frame has no components"))
        } else {
            Ok(())
        }
    }

    /// A scan header (ITU-T T.81, B.2.3).
    fn read_scan(&mut self, content: &[u8]) -> Result<(), ReadError> {
        let count = usize::from(*content.first().unwrap_or(&0));
        let chosen = content.get(1..1 + 2 * count).filter(|chosen| !chosen.is_empty());
        let chosen = chosen.ok_or_else(|| malformed(FORMAT, "a scan header is cut"))?;
        let place = |id: u8| self.components.iter().position(|component| component.id == id);
        let scan: Option<Vec<usize>> = chosen.as_chunks::<2>().0.iter().map(|[id, _]| place(*id)).collect();
        self.scans.push(
            scan.ok_or_else(|| malformed(FORMAT, "a scan of a component that its frame does not have"))?,
        );
        if self.scans.len() > MAX_SCANS {
            return Err(unsupported(
                FORMAT,
                format_args!("an image of more than {MAX_SCANS} scans"),
                SAVE_PLAIN,
            ));
        }
        Ok(())
    }

    /// Refuses files that the decoder would misread. These have a scan of one component whose sampling factor lies
    /// between one and the largest of the image, and the component has fewer blocks than its share of the interleaved
    /// units (MCUs). The decoder expects the larger number.
    pub(super) fn check(&self) -> Result<(), ReadError> {
        let most =
            |factor: fn(&Component) -> u8| u32::from(self.components.iter().map(factor).max().unwrap_or(1));
        let (h_max, v_max) = (most(|c| c.horizontal), most(|c| c.vertical));
        let alone = self.scans.iter().filter(|scan| scan.len() == 1).map(|scan| &self.components[scan[0]]);
        for component in alone {
            let wrong = |side: u16, factor: u8, largest: u32| {
                let (side, factor) = (u32::from(side), u32::from(factor));
                let blocks = (side * factor).div_ceil(largest).div_ceil(BLOCK);
                let expected = (side.div_ceil(largest * BLOCK) * factor).min(side.div_ceil(BLOCK));
                blocks != expected
            };
            if wrong(self.width, component.horizontal, h_max) || wrong(self.height, component.vertical, v_max)
            {
                return Err(unsupported(
                    FORMAT,
                    "a component of an unusual size in a scan of its own",
                    "save it with other sampling factors, such as 4:2:0, or as PNG",
                ));
            }
        }
        Ok(())
    }

    /// The colours as they are stored. Without Adobe's segment, components named R, G and B are RGB (as in libjpeg).
    pub(super) fn colour_words(&self) -> &'static str {
        let named_rgb = self.components.iter().map(|component| component.id).eq(*b"RGB");
        match self.transform {
            Some(false) => "RGB",
            None if named_rgb => "RGB",
            _ => "YCbCr",
        }
    }
}

/// The segments of a file, one after the other; entropy-coded data is skipped.
struct Segments<'a> {
    bytes: &'a [u8],
    at: usize,
    /// Whether entropy-coded data comes before the next marker.
    in_scan: bool,
}

impl<'a> Segments<'a> {
    /// The next marker with the content of its segment, or an error if the file ends before the end of the image.
    fn next(&mut self) -> Result<(u8, &'a [u8]), ReadError> {
        let too_early = || malformed(FORMAT, "the file ends too early");
        loop {
            let rest = self.bytes.get(self.at..).ok_or_else(too_early)?;
            let start = rest.iter().position(|&byte| byte == 0xff).ok_or_else(too_early)?;
            let marker = *rest.get(start + 1).ok_or_else(too_early)?;
            if start > 0 && !self.in_scan {
                return Err(malformed(FORMAT, format_args!("{start} bytes too many between its segments")));
            }
            match marker {
                // A byte of 255 within the data, a byte of padding, or a marker without a segment.
                0x00 | 0x01 | 0xd0..=0xd8 => self.at += start + 2,
                0xff => self.at += start + 1,
                0xd9 => return Ok((marker, &[])),
                _ => {
                    let length = rest.get(start + 2..start + 4).ok_or_else(too_early)?;
                    let length = usize::from(u16::from_be_bytes([length[0], length[1]]));
                    let content = rest.get(start + 4..start + 2 + length).ok_or_else(too_early)?;
                    self.at += start + 2 + length;
                    self.in_scan = marker == 0xda;
                    return Ok((marker, content));
                }
            }
        }
    }
}
