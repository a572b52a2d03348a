//! Rendered pictures.

/// A picture of linear radiance, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Radiance in linear RGB, background included.
    pub radiance: Vec<[f32; 3]>,
    /// The part of the radiance that comes from specular lobes.
    pub specular: Vec<[f32; 3]>,
    /// The fraction of the pixel that a surface covers, 0 ..= 1.
    pub coverage: Vec<f32>,
}

impl Picture {
    /// A black picture that no surface covers.
    pub fn empty(width: usize, height: usize) -> Self {
        let pixels = width * height;
        Self {
            width,
            height,
            radiance: vec![[0.0; 3]; pixels],
            specular: vec![[0.0; 3]; pixels],
            coverage: vec![0.0; pixels],
        }
    }

    /// Number of pixels.
    pub fn len(&self) -> usize {
        self.width * self.height
    }

    /// Whether the picture has no pixels.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// Relative luminance of linear sRGB (Rec. 709 primaries).
pub fn luminance([r, g, b]: [f32; 3]) -> f32 {
    0.212_655_9 * r + 0.715_158_5 * g + 0.072_185_6 * b
}
