//! Averages of rows and columns, by the law of total covariance: the covariance of a union is the mean of the
//! covariances plus the covariance of the means.

use crate::row::{CORE_PLANES, Row};
use crate::vectorised::vectorised;

/// The equal average of two rows.
pub(super) fn average_two_rows(a: &Row, b: &Row, out: &mut Row) {
    let [abx, aby, axx, ayy, axy, a_extras @ ..] = &a.planes[..] else { unreachable!("core planes") };
    let [bbx, bby, bxx, byy, bxy, b_extras @ ..] = &b.planes[..] else { unreachable!("core planes") };
    let [bx, by, xx, yy, xy, extras @ ..] = &mut out.planes[..] else { unreachable!("core planes") };
    variances_of_two(abx, bbx, axx, bxx, xx);
    variances_of_two(aby, bby, ayy, byy, yy);
    mixed_of_two([abx, bbx], [aby, bby], axy, bxy, xy);
    means_of_two(abx, bbx, bx);
    means_of_two(aby, bby, by);
    for ((a, b), out) in a_extras.iter().zip(b_extras).zip(extras) {
        means_of_two(a, b, out);
    }
}

/// The equal average of two rows of level 0, which have no covariance of their own: only the covariance of their
/// means remains.
pub(super) fn average_two_rows_of_slopes(a: &Row, b: &Row, out: &mut Row) {
    let [abx, aby, _, _, _, a_extras @ ..] = &a.planes[..] else { unreachable!("core planes") };
    let [bbx, bby, _, _, _, b_extras @ ..] = &b.planes[..] else { unreachable!("core planes") };
    let [bx, by, xx, yy, xy, extras @ ..] = &mut out.planes[..] else { unreachable!("core planes") };
    covariance_of_two_slopes([abx, bbx], [aby, bby], xx, yy, xy);
    means_of_two(abx, bbx, bx);
    means_of_two(aby, bby, by);
    for ((a, b), out) in a_extras.iter().zip(b_extras).zip(extras) {
        means_of_two(a, b, out);
    }
}

// Slices are passed as arguments, so that the compiler knows that they do not overlap, and are cut to the same
// length, which removes the bounds checks, so these loops vectorise. The mean is half the difference away from either
// value, so both add the same square.

vectorised! {
    fn means_of_two(a: &[f32], b: &[f32], out: &mut [f32]) {
        for ((a, b), out) in a.iter().zip(b).zip(out) {
            *out = 0.5 * (a + b);
        }
    }
}

vectorised! {
    fn variances_of_two(a: &[f32], b: &[f32], a_variance: &[f32], b_variance: &[f32], out: &mut [f32]) {
        let n = out.len();
        let (a, b, a_variance, b_variance) = (&a[..n], &b[..n], &a_variance[..n], &b_variance[..n]);
        for i in 0..n {
            let half = 0.5 * (a[i] - b[i]);
            out[i] = 0.5 * (a_variance[i] + b_variance[i]) + half * half;
        }
    }
}

vectorised! {
    fn covariance_of_two_slopes(
        x: [&[f32]; 2],
        y: [&[f32]; 2],
        xx: &mut [f32],
        yy: &mut [f32],
        xy: &mut [f32],
    ) {
        let n = xx.len();
        let (ax, bx, ay, by) = (&x[0][..n], &x[1][..n], &y[0][..n], &y[1][..n]);
        let (yy, xy) = (&mut yy[..n], &mut xy[..n]);
        for i in 0..n {
            let (half_x, half_y) = (0.5 * (ax[i] - bx[i]), 0.5 * (ay[i] - by[i]));
            xx[i] = half_x * half_x;
            yy[i] = half_y * half_y;
            xy[i] = half_x * half_y;
        }
    }
}

vectorised! {
    fn mixed_of_two(x: [&[f32]; 2], y: [&[f32]; 2], a_mixed: &[f32], b_mixed: &[f32], out: &mut [f32]) {
        let n = out.len();
        let (ax, bx, ay, by) = (&x[0][..n], &x[1][..n], &y[0][..n], &y[1][..n]);
        let (a_mixed, b_mixed) = (&a_mixed[..n], &b_mixed[..n]);
        for i in 0..n {
            let (half_x, half_y) = (0.5 * (ax[i] - bx[i]), 0.5 * (ay[i] - by[i]));
            out[i] = 0.5 * (a_mixed[i] + b_mixed[i]) + half_x * half_y;
        }
    }
}

/// The equal average of each pair of neighbours; `out` is half as wide.
pub(super) fn average_two_columns(row: &Row, out: &mut Row) {
    let [rbx, rby, rxx, ryy, rxy, row_extras @ ..] = &row.planes[..] else { unreachable!("core planes") };
    let [bx, by, xx, yy, xy, extras @ ..] = &mut out.planes[..] else { unreachable!("core planes") };
    variances_of_pairs(pairs(rbx), pairs(rxx), xx);
    variances_of_pairs(pairs(rby), pairs(ryy), yy);
    mixed_of_pairs(pairs(rbx), pairs(rby), pairs(rxy), xy);
    means_of_pairs(pairs(rbx), bx);
    means_of_pairs(pairs(rby), by);
    for (plane, out) in row_extras.iter().zip(extras) {
        means_of_pairs(pairs(plane), out);
    }
}

fn pairs(plane: &[f32]) -> &[[f32; 2]] {
    plane.as_chunks::<2>().0
}

vectorised! {
    fn means_of_pairs(pairs: &[[f32; 2]], out: &mut [f32]) {
        for (pair, out) in pairs.iter().zip(out) {
            *out = 0.5 * (pair[0] + pair[1]);
        }
    }
}

vectorised! {
    fn variances_of_pairs(pairs: &[[f32; 2]], variances: &[[f32; 2]], out: &mut [f32]) {
        for ((pair, variance), out) in pairs.iter().zip(variances).zip(out) {
            let half = 0.5 * (pair[0] - pair[1]);
            *out = 0.5 * (variance[0] + variance[1]) + half * half;
        }
    }
}

vectorised! {
    fn mixed_of_pairs(x: &[[f32; 2]], y: &[[f32; 2]], mixed: &[[f32; 2]], out: &mut [f32]) {
        for (((x, y), mixed), out) in x.iter().zip(y).zip(mixed).zip(out) {
            *out = 0.5 * (mixed[0] + mixed[1]) + 0.5 * (x[0] - x[1]) * (0.5 * (y[0] - y[1]));
        }
    }
}

/// The weighted average of rows. Weights sum to one; means are computed relative to the first row, so that equal rows
/// average to exactly themselves.
pub(super) fn average_rows(rows: &[(&Row, f32)], out: &mut Row) {
    let (first, rest) = rows.split_first().expect("an average is over one row or more");
    for (plane, out_plane) in out.planes.iter_mut().enumerate() {
        let origin = &first.0.planes[plane];
        out_plane.copy_from_slice(origin);
        for (row, weight) in rest {
            for ((out, value), origin) in out_plane.iter_mut().zip(&row.planes[plane]).zip(origin) {
                *out += weight * (value - origin);
            }
        }
    }
    let (means, others) = out.planes.split_at_mut(2);
    for (row, weight) in rows {
        for i in 0..means[0].len() {
            let dx = row.planes[0][i] - means[0][i];
            let dy = row.planes[1][i] - means[1][i];
            others[0][i] += weight * (dx * dx);
            others[1][i] += weight * (dy * dy);
            others[2][i] += weight * (dx * dy);
        }
    }
}

/// The weighted average of columns: texel j of `out` averages the texels of `row` listed in `taps[j]`.
pub(super) fn average_columns(row: &Row, taps: &[super::weights::Taps], out: &mut Row) {
    for (j, line) in taps.iter().enumerate() {
        let first = line.taps[0].0;
        for (plane, out_plane) in row.planes.iter().zip(&mut out.planes) {
            let origin = plane[first];
            out_plane[j] = origin + line.taps[1..].iter().map(|(i, w)| w * (plane[*i] - origin)).sum::<f32>();
        }
        let (mean_x, mean_y) = (out.planes[0][j], out.planes[1][j]);
        for (i, weight) in &line.taps {
            let dx = row.planes[0][*i] - mean_x;
            let dy = row.planes[1][*i] - mean_y;
            out.planes[2][j] += weight * (dx * dx);
            out.planes[3][j] += weight * (dy * dy);
            out.planes[4][j] += weight * (dx * dy);
        }
    }
    debug_assert!(out.planes.len() >= CORE_PLANES);
}
