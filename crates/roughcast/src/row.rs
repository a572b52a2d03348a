//! A row of texels in the pyramid, stored as planes.
//!
//! The pyramid carries the mean slope and the *covariance*, not the raw second moments. Both are equivalent, but the
//! covariance of a footprint is a sum of squares (law of total covariance, Schilling's recursion), so it is positive
//! semidefinite by construction and keeps its precision even if slopes are steep and bumps are small; `M = Σ + B Bᵀ` is
//! computed once, when a level is stored.

/// An additional quantity that is averaged along with the slopes, for the layouts that store it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Extra {
    /// x of the unit normal.
    NormalX,
    /// y of the unit normal.
    NormalY,
    /// z of the unit normal.
    NormalZ,
    /// The height as stored.
    Height,
    /// Slope variance of the base roughness, kept apart from the covariance.
    BaseVariance,
    /// Ambient occlusion of a material's packed texture.
    Occlusion,
    /// Metalness of a material's packed texture.
    Metalness,
}

/// The maximum number of extras of a layout.
pub(crate) const MAX_EXTRAS: usize = 4;

/// Number of planes that every row has: the mean slope and the covariance.
pub(crate) const CORE_PLANES: usize = 5;

/// One row, or a stretch of one.
#[derive(Clone, Debug, Default)]
pub(crate) struct Row {
    /// Mean slope x, y; covariance xx, yy, xy; then the extras in the requested order.
    pub planes: Vec<Vec<f32>>,
}

impl Row {
    pub fn new(width: usize, extras: usize) -> Self {
        Self { planes: vec![vec![0.0; width]; CORE_PLANES + extras] }
    }

    pub fn width(&self) -> usize {
        self.planes[0].len()
    }

    pub fn view(&self) -> RowView<'_> {
        RowView::new(&self.planes, 0, self.width())
    }
}

/// A borrowed stretch of a row.
#[derive(Clone, Copy)]
pub(crate) struct RowView<'a> {
    pub bx: &'a [f32],
    pub by: &'a [f32],
    pub xx: &'a [f32],
    pub yy: &'a [f32],
    pub xy: &'a [f32],
    pub extras: [&'a [f32]; MAX_EXTRAS],
}

impl<'a> RowView<'a> {
    /// Texels `start .. start + len` of planes that hold consecutive rows.
    pub fn new(planes: &'a [Vec<f32>], start: usize, len: usize) -> Self {
        let plane = |index: usize| planes.get(index).map_or(&[][..], |p| &p[start..start + len]);
        Self {
            bx: plane(0),
            by: plane(1),
            xx: plane(2),
            yy: plane(3),
            xy: plane(4),
            extras: std::array::from_fn(|k| plane(CORE_PLANES + k)),
        }
    }

    pub fn width(&self) -> usize {
        self.bx.len()
    }
}

/// The source of level 0: slopes computed on demand, never stored as a whole image.
pub(crate) trait RowSource: Sync {
    fn width(&self) -> usize;
    fn height(&self) -> usize;
    /// The extras that `fill` writes, in order.
    fn extras(&self) -> &[Extra];
    /// Whether level 0 has a covariance, from a base roughness that is folded in. If not, `fill` does not write the
    /// covariance planes, which are zero in a new row.
    fn has_covariance(&self) -> bool;
    /// Writes the texels of row `y` starting at column `x`, as many as `row` holds.
    fn fill(&self, x: usize, y: usize, row: &mut Row, scratch: &mut SourceScratch) -> crate::SourceCounts;
}

/// Reusable buffers of a source.
#[derive(Default)]
pub(crate) struct SourceScratch {
    /// Decoded components, or the rows of heights above, at and below, each extended by a texel on either side.
    pub planes: [Vec<f32>; 3],
}
