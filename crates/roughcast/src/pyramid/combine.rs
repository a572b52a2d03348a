//! Averages of rows and columns, by the law of total covariance: the covariance of a union is the mean of the
//! covariances plus the covariance of the means.

use crate::row::{CORE_PLANES, Row};

/// The equal average of two rows.
pub(super) fn average_two_rows(a: &Row, b: &Row, out: &mut Row) {
    let [abx, aby, axx, ayy, axy, a_extras @ ..] = &a.planes[..] else { unreachable!("core planes") };
    let [bbx, bby, bxx, byy, bxy, b_extras @ ..] = &b.planes[..] else { unreachable!("core planes") };
    let [bx, by, xx, yy, xy, extras @ ..] = &mut out.planes[..] else { unreachable!("core planes") };
    let n = bx.len();
    // Equal lengths known to the compiler: no bounds checks inside, and the loops vectorise.
    let (abx, aby, axx, ayy, axy) = (&abx[..n], &aby[..n], &axx[..n], &ayy[..n], &axy[..n]);
    let (bbx, bby, bxx, byy, bxy) = (&bbx[..n], &bby[..n], &bxx[..n], &byy[..n], &bxy[..n]);
    let (by, xx, yy, xy) = (&mut by[..n], &mut xx[..n], &mut yy[..n], &mut xy[..n]);
    for i in 0..n {
        // The mean lies half a difference from either, so both add the same square.
        let dx = 0.5 * (abx[i] - bbx[i]);
        let dy = 0.5 * (aby[i] - bby[i]);
        bx[i] = 0.5 * (abx[i] + bbx[i]);
        by[i] = 0.5 * (aby[i] + bby[i]);
        xx[i] = 0.5 * (axx[i] + bxx[i]) + dx * dx;
        yy[i] = 0.5 * (ayy[i] + byy[i]) + dy * dy;
        xy[i] = 0.5 * (axy[i] + bxy[i]) + dx * dy;
    }
    for ((a, b), out) in a_extras.iter().zip(b_extras).zip(extras) {
        for ((a, b), out) in a.iter().zip(b).zip(out) {
            *out = 0.5 * (a + b);
        }
    }
}

/// The equal average of each pair of neighbours; `out` is half as wide.
pub(super) fn average_two_columns(row: &Row, out: &mut Row) {
    let [rbx, rby, rxx, ryy, rxy, row_extras @ ..] = &row.planes[..] else { unreachable!("core planes") };
    let [bx, by, xx, yy, xy, extras @ ..] = &mut out.planes[..] else { unreachable!("core planes") };
    let n = bx.len();
    fn pairs(plane: &[f32], n: usize) -> &[[f32; 2]] {
        &plane.as_chunks::<2>().0[..n]
    }
    let (rbx, rby, rxx, ryy, rxy) =
        (pairs(rbx, n), pairs(rby, n), pairs(rxx, n), pairs(ryy, n), pairs(rxy, n));
    let (by, xx, yy, xy) = (&mut by[..n], &mut xx[..n], &mut yy[..n], &mut xy[..n]);
    for i in 0..n {
        let dx = 0.5 * (rbx[i][0] - rbx[i][1]);
        let dy = 0.5 * (rby[i][0] - rby[i][1]);
        bx[i] = 0.5 * (rbx[i][0] + rbx[i][1]);
        by[i] = 0.5 * (rby[i][0] + rby[i][1]);
        xx[i] = 0.5 * (rxx[i][0] + rxx[i][1]) + dx * dx;
        yy[i] = 0.5 * (ryy[i][0] + ryy[i][1]) + dy * dy;
        xy[i] = 0.5 * (rxy[i][0] + rxy[i][1]) + dx * dy;
    }
    for (plane, out) in row_extras.iter().zip(extras) {
        for (pair, out) in pairs(plane, n).iter().zip(out) {
            *out = 0.5 * (pair[0] + pair[1]);
        }
    }
}

/// The weighted average of rows. Weights sum to one; means are taken relative to the first row, so that equal rows
/// average to themselves to the last bit.
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

/// The weighted average of columns: texel j of `out` takes the texels of `row` that `taps[j]` names.
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
