//! Sizes of mip levels.

/// Sizes of all levels, from level 0 down to 1x1, as (width, height).
pub fn level_sizes(width: usize, height: usize) -> Vec<(usize, usize)> {
    let mut sizes = vec![(width, height)];
    while let Some(&(w, h)) = sizes.last()
        && (w > 1 || h > 1)
    {
        sizes.push(((w / 2).max(1), (h / 2).max(1)));
    }
    sizes
}
