//! How much of the slopes of noise a round footprint keeps.

use super::NoiseKind;

/// Entries of the tables per cell of standard deviation.
const STEPS: f64 = 20.0;

/// The last entry of the tables, 1.2 cells.
const LAST: usize = 24;

/// [`noise_fade`] of fractal noise by the standard deviation of the footprint, in twentieths of a cell.
///
/// Measured as the correlation `E[b(p)·b(p + σξ)] / E[b²]` of the slopes `b` on planes of random orientations through
/// random cells, with normally distributed ξ; 12 million pairs leave a standard error of 0.0003. The last entry, 0.0065,
/// is set to zero. The orientation matters little: among planes along two axes of the lattice, along its diagonals and
/// across its space diagonals, entries differ by up to ORIENTATION.
pub(super) const FBM: [f64; LAST + 1] = [
    1.0, 0.9716, 0.8935, 0.7827, 0.6582, 0.5353, 0.4243, 0.3299, 0.2534, 0.1932,
    0.147, 0.112, 0.0857, 0.066, 0.0512, 0.0401, 0.0316, 0.0252, 0.0202, 0.0163,
    0.0133, 0.011, 0.0091, 0.0077, 0.0,
];

/// The same for turbulence, whose creases fade sooner.
pub(super) const TURBULENCE: [f64; LAST + 1] = [
    1.0, 0.8175, 0.6195, 0.4412, 0.301, 0.2008, 0.1331, 0.0888, 0.0601, 0.0415,
    0.0294, 0.0212, 0.0157, 0.012, 0.009, 0.0069, 0.0054, 0.0043, 0.0035, 0.0027,
    0.0023, 0.0017, 0.0014, 0.0012, 0.0,
];

/// The part of the slopes of an octave that a round Gaussian footprint keeps, 0 to 1. `variance` is that of the
/// footprint along each axis, in squared cells of the octave, 0 or more; 0 keeps everything.
///
/// It is the factor of the exact slope at the centre in the best linear estimate of the filtered slope. Interpolated in
/// a measured table, within 0.01; zero from a standard deviation of 1.2 cells on.
pub fn noise_fade(kind: NoiseKind, variance: f64) -> f64 {
    let table = match kind {
        NoiseKind::Fbm => &FBM,
        NoiseKind::Turbulence => &TURBULENCE,
    };
    let place = variance.sqrt() * STEPS;
    let entry = place as usize;
    if entry >= LAST {
        return 0.0;
    }
    table[entry] + (place - entry as f64) * (table[entry + 1] - table[entry])
}
