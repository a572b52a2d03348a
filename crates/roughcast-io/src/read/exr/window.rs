//! The display window of an EXR, which is the texture, and the data window, which covers the pixels in the file.

use exr::math::Vec2;
use exr::meta::attribute::IntegerBounds;
use exr::meta::header::Header;

use super::super::memory::{check_size, unsupported, zeros};
use super::FORMAT;
use crate::{Limits, ReadError};

/// Both windows of a part.
pub(super) struct Windows {
    data: IntegerBounds,
    display: IntegerBounds,
}

impl Windows {
    /// # Errors
    /// [`ReadError::Unsupported`] if the windows do not overlap, [`ReadError::TooLarge`].
    pub(super) fn of(header: &Header, limits: &Limits) -> Result<Self, ReadError> {
        let data = IntegerBounds::new(header.own_attributes.layer_position, header.layer_size);
        let display = header.shared_attributes.display_window;
        for window in [data, display] {
            check_size(FORMAT, window.size.width() as u64, window.size.height() as u64, limits)?;
        }
        let windows = Self { data, display };
        let meet = |axis: fn(&Windows) -> [i64; 4]| {
            let [data, data_end, display, display_end] = axis(&windows);
            data < display_end && display < data_end
        };
        if meet(Self::columns) && meet(Self::rows) {
            Ok(windows)
        } else {
            let what =
                format!("a data window, {}, outside of the display window, {}", words(data), words(display));
            Err(unsupported(FORMAT, what, "move one of the two, for instance with `oiiotool --fullpixels`"))
        }
    }

    fn columns(&self) -> [i64; 4] {
        let ends = |window: IntegerBounds| {
            let start = i64::from(window.position.x());
            [start, start + window.size.width() as i64]
        };
        let ([data, data_end], [display, display_end]) = (ends(self.data), ends(self.display));
        [data, data_end, display, display_end]
    }

    fn rows(&self) -> [i64; 4] {
        let ends = |window: IntegerBounds| {
            let start = i64::from(window.position.y());
            [start, start + window.size.height() as i64]
        };
        let ([data, data_end], [display, display_end]) = (ends(self.data), ends(self.display));
        [data, data_end, display, display_end]
    }

    /// Width and height of the texture.
    pub(super) fn size(&self) -> (usize, usize) {
        (self.display.size.width(), self.display.size.height())
    }

    /// Width and height of the data.
    pub(super) fn data_size(&self) -> (usize, usize) {
        (self.data.size.width(), self.data.size.height())
    }

    /// A description of what was cropped or is missing; `None` if the windows are equal.
    pub(super) fn warning(&self) -> Option<String> {
        let [left, right, from, to] = self.columns();
        let [top, bottom, first, last] = self.rows();
        let cut = left < from || right > to || top < first || bottom > last;
        let missing = left > from || right < to || top > first || bottom < last;
        let what = match (cut, missing) {
            (false, false) => return None,
            (true, false) => "what lies outside is cut off",
            (false, true) => "the pixels that are missing are 0",
            (true, true) => "what lies outside is cut off, and the pixels that are missing are 0",
        };
        let (data, display) = (words(self.data), words(self.display));
        Some(format!("its pixels cover {data}, and the texture is the display window, {display}: {what}"))
    }

    /// Converts the pixels of the data window, each of `channels` samples, to those of the display window. Missing
    /// pixels are 0, as in OpenImageIO.
    pub(super) fn placed<T: Copy + bytemuck::Zeroable>(
        &self,
        pixels: Vec<T>,
        channels: usize,
    ) -> Result<Vec<T>, ReadError> {
        if self.data == self.display {
            return Ok(pixels);
        }
        let (width, height) = self.size();
        let mut placed = zeros::<T>(width * height * channels)?;
        let [left, right, from, to] = self.columns();
        let [top, bottom, first, last] = self.rows();
        let (start, end) = (left.max(from), right.min(to));
        let len = (end - start) as usize * channels;
        for y in top.max(first)..bottom.min(last) {
            let source = ((y - top) as usize * self.data.size.width() + (start - left) as usize) * channels;
            let target = ((y - first) as usize * width + (start - from) as usize) * channels;
            placed[target..target + len].copy_from_slice(&pixels[source..source + len]);
        }
        Ok(placed)
    }
}

/// `44x40 at (8, 4)`.
fn words(window: IntegerBounds) -> String {
    let Vec2(width, height) = window.size;
    let Vec2(x, y) = window.position;
    format!("{width}x{height} at ({x}, {y})")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn windows(data: IntegerBounds) -> Windows {
        Windows { data, display: IntegerBounds::new((0, 0), (3, 2)) }
    }

    #[test]
    fn crops_are_padded_with_zeros() {
        let crop = windows(IntegerBounds::new((1, 1), (2, 1)));
        assert_eq!(crop.placed(vec![1, 2], 1).unwrap(), [0, 0, 0, 0, 1, 2]);
        assert!(crop.warning().unwrap().contains("2x1 at (1, 1)"));
    }

    #[test]
    fn overscan_is_cut_off() {
        let pixels = (0..4 * 5 * 2).collect();
        let overscan = windows(IntegerBounds::new((-1, -2), (4, 5)));
        assert_eq!(overscan.placed(pixels, 2).unwrap(), [18, 19, 20, 21, 22, 23, 26, 27, 28, 29, 30, 31]);
        assert!(overscan.warning().unwrap().contains("cut off"));
    }

    #[test]
    fn equal_windows_are_left_alone() {
        let equal = windows(IntegerBounds::new((0, 0), (3, 2)));
        assert_eq!((equal.warning(), equal.placed(vec![7; 6], 1).unwrap()), (None, vec![7; 6]));
    }
}
