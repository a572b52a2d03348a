//! Interleaves planes of stored values into samples, rounded to nearest.

use half::f16;
use half::slice::HalfFloatSliceExt;

use crate::vectorised::vectorised;

/// 2^23: adding it to a number in 0 ..= 65535 leaves the number, rounded to nearest (ties to even), in the low bits
/// of the float. This takes one addition instead of a saturating conversion, and it vectorises.
const ROUND: f32 = 8_388_608.0;

/// `value` in 0 ..= 1 as one of `steps + 1` codes; NaN and values below 0 give 0, values above 1 give `steps`.
#[inline(always)]
fn code(value: f32, steps: f32) -> u32 {
    let above = if value > 0.0 { value } else { 0.0 };
    let clamped = if above < 1.0 { above } else { 1.0 };
    (clamped * steps + ROUND).to_bits() & 0xffff
}

vectorised! {
    /// 8-bit unsigned normalised.
    pub(crate) fn unorm8(planes: &[Vec<f32>], out: &mut [u8]) {
        interleave(planes, out, |v| code(v, 255.0) as u8);
    }
}

vectorised! {
    /// 16-bit unsigned normalised.
    pub(crate) fn unorm16(planes: &[Vec<f32>], out: &mut [u16]) {
        interleave(planes, out, |v| code(v, 65535.0) as u16);
    }
}

vectorised! {
    /// Single floats.
    pub(crate) fn single(planes: &[Vec<f32>], out: &mut [f32]) {
        interleave(planes, out, |v| v);
    }
}

/// The maximum number of channels of a texture of any layout.
const MOST_CHANNELS: usize = 8;

/// Half floats. The slice conversion uses the processor's instructions if available, so each plane is converted block
/// by block and then interleaved.
pub(crate) fn half(planes: &[Vec<f32>], out: &mut [f16]) {
    const BLOCK: usize = 256;
    let channels = planes.len();
    assert!(channels <= MOST_CHANNELS, "no layout has more channels in one texture");
    let mut buffer = [[f16::ZERO; BLOCK]; MOST_CHANNELS];
    for (block, texels) in out.chunks_mut(BLOCK * channels).enumerate() {
        let width = texels.len() / channels;
        for (plane, halves) in planes.iter().zip(&mut buffer) {
            halves[..width].convert_from_f32_slice(&plane[block * BLOCK..][..width]);
        }
        let halves: [&[f16]; MOST_CHANNELS] = std::array::from_fn(|channel| &buffer[channel][..width]);
        interleave_halves(&halves[..channels], texels);
    }
}

vectorised! {
    fn interleave_halves(planes: &[&[f16]], out: &mut [f16]) {
        interleave(planes, out, |v| v);
    }
}

// Inlined into the functions above, so that it is compiled for each of their instruction sets.
#[inline(always)]
fn interleave<P: AsRef<[V]>, V: Copy, T: Copy>(planes: &[P], out: &mut [T], to: impl Fn(V) -> T + Copy) {
    match planes.len() {
        1 => interleave_n::<1, P, V, T>(planes, out, to),
        2 => interleave_n::<2, P, V, T>(planes, out, to),
        3 => interleave_n::<3, P, V, T>(planes, out, to),
        4 => interleave_n::<4, P, V, T>(planes, out, to),
        5 => interleave_n::<5, P, V, T>(planes, out, to),
        6 => interleave_n::<6, P, V, T>(planes, out, to),
        7 => interleave_n::<7, P, V, T>(planes, out, to),
        8 => interleave_n::<8, P, V, T>(planes, out, to),
        _ => unreachable!("no layout has so many channels in one texture"),
    }
}

/// The number of channels is a compile-time constant, so the inner loop is unrolled and bounds checks are removed.
#[inline(always)]
fn interleave_n<const C: usize, P: AsRef<[V]>, V: Copy, T: Copy>(
    planes: &[P],
    out: &mut [T],
    to: impl Fn(V) -> T + Copy,
) {
    let (texels, _) = out.as_chunks_mut::<C>();
    let n = texels.len();
    let planes: [&[V]; C] = std::array::from_fn(|channel| &planes[channel].as_ref()[..n]);
    for i in 0..n {
        texels[i] = std::array::from_fn(|channel| to(planes[channel][i]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_the_nearest_for_every_16_bit_value() {
        for code_wanted in 0..=65535_u32 {
            let value = code_wanted as f32 / 65535.0;
            assert_eq!(code(value, 65535.0), code_wanted);
            assert_eq!(code(value, 255.0), (f64::from(value) * 255.0).round_ties_even() as u32);
        }
    }

    #[test]
    fn out_of_range_values_saturate() {
        for (value, wanted) in
            [(f32::NAN, 0), (-1.0, 0), (f32::NEG_INFINITY, 0), (2.0, 255), (f32::INFINITY, 255)]
        {
            assert_eq!(code(value, 255.0), wanted, "{value}");
        }
    }

    #[test]
    fn every_layout_can_be_packed() {
        for layout in crate::texture::Layout::ALL {
            assert!((1..=MOST_CHANNELS).contains(&layout.most_channels()), "{layout}");
        }
    }

    #[test]
    fn every_number_of_channels_interleaves() {
        for channels in 1..=MOST_CHANNELS {
            let width = 300; // more than one block of the half conversion
            let planes: Vec<Vec<f32>> =
                (0..channels).map(|c| (0..width).map(|x| (c * width + x) as f32).collect()).collect();
            let mut singles = vec![0.0; channels * width];
            single(&planes, &mut singles);
            let mut halves = vec![f16::ZERO; channels * width];
            half(&planes, &mut halves);
            for x in 0..width {
                for c in 0..channels {
                    assert_eq!(singles[x * channels + c], planes[c][x]);
                    assert_eq!(halves[x * channels + c], f16::from_f32(planes[c][x]));
                }
            }
        }
    }
}
