//! Converts rows to little-endian and undoes predictors: TIFF 6.0, section 14, and Adobe's Photoshop TIFF Technical
//! Note 3.

/// The transform that the writer applied to the rows before compression.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Predictor {
    /// Nothing.
    None,
    /// Each sample minus that of the previous pixel.
    Horizontal,
    /// Floats with their bytes grouped by significance over the whole row, then each byte minus the previous one.
    FloatingPoint,
}

/// How the samples of a row are stored.
#[derive(Clone, Copy)]
pub(super) struct RowLayout {
    pub bits: u32,
    /// Whether the samples form one bit stream, most significant bit first, whatever the byte order of the file.
    pub is_bit_stream: bool,
    /// Samples of a pixel.
    pub samples: usize,
    pub is_big_endian: bool,
}

/// Undoes the predictor. Afterwards samples of whole bytes are little-endian. `scratch` is any buffer.
pub(super) fn undo(predictor: Predictor, row: &mut [u8], layout: RowLayout, scratch: &mut Vec<u8>) {
    match predictor {
        Predictor::None => to_little_endian(row, layout),
        Predictor::Horizontal => {
            to_little_endian(row, layout);
            match layout.bits {
                8 => sum_up::<1>(row, layout.samples, |sum, step| [sum[0].wrapping_add(step[0])]),
                16 => sum_up(row, layout.samples, |sum, step| {
                    u16::from_le_bytes(sum).wrapping_add(u16::from_le_bytes(step)).to_le_bytes()
                }),
                32 => sum_up(row, layout.samples, |sum, step| {
                    u32::from_le_bytes(sum).wrapping_add(u32::from_le_bytes(step)).to_le_bytes()
                }),
                _ => sum_up(row, layout.samples, |sum, step| {
                    u64::from_le_bytes(sum).wrapping_add(u64::from_le_bytes(step)).to_le_bytes()
                }),
            }
        }
        Predictor::FloatingPoint => {
            sum_up::<1>(row, layout.samples, |sum, step| [sum[0].wrapping_add(step[0])]);
            scratch.clear();
            scratch.extend_from_slice(row);
            let bytes = layout.bits as usize / 8;
            let count = row.len() / bytes;
            // The most significant bytes of all samples come first, whatever the byte order of the file.
            for (index, sample) in row.chunks_exact_mut(bytes).enumerate() {
                for (significance, byte) in sample.iter_mut().rev().enumerate() {
                    *byte = scratch[significance * count + index];
                }
            }
        }
    }
}

/// Whether a predictor is defined for samples of this many bits.
pub(super) fn is_defined(predictor: Predictor, bits: u32, is_float: bool) -> bool {
    match predictor {
        Predictor::None => true,
        Predictor::Horizontal => matches!(bits, 8 | 16 | 32 | 64),
        Predictor::FloatingPoint => is_float,
    }
}

fn to_little_endian(row: &mut [u8], layout: RowLayout) {
    let bytes = layout.bits as usize / 8;
    if layout.is_big_endian && !layout.is_bit_stream && bytes > 1 {
        row.chunks_exact_mut(bytes).for_each(<[u8]>::reverse);
    }
}

/// Adds to each sample of `N` bytes the sample `stride` samples before it.
fn sum_up<const N: usize>(row: &mut [u8], stride: usize, add: impl Fn([u8; N], [u8; N]) -> [u8; N]) {
    let (samples, _) = row.as_chunks_mut::<N>();
    for index in stride..samples.len() {
        samples[index] = add(samples[index - stride], samples[index]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_of_sixteen_bits_are_summed_channel_by_channel_in_either_byte_order() {
        for is_big_endian in [false, true] {
            let stored = [1000u16, 5, 65535, 1, 300, 2];
            let bytes = stored.map(|v| if is_big_endian { v.to_be_bytes() } else { v.to_le_bytes() });
            let mut row = bytes.concat();
            let layout = RowLayout { bits: 16, is_bit_stream: false, samples: 2, is_big_endian };
            undo(Predictor::Horizontal, &mut row, layout, &mut Vec::new());
            assert_eq!(row, [1000u16, 5, 999, 6, 1299, 8].map(u16::to_le_bytes).concat());
        }
    }

    #[test]
    fn sorted_bytes_of_floats_are_reassembled() {
        let floats = [1.5f32, -2.25, 1e-20];
        let sorted: Vec<u8> = (0..4).flat_map(|i| floats.map(|v| v.to_be_bytes()[i])).collect();
        let mut row = sorted.clone();
        (1..row.len()).for_each(|i| row[i] = sorted[i].wrapping_sub(sorted[i - 1]));
        let layout = RowLayout { bits: 32, is_bit_stream: false, samples: 1, is_big_endian: false };
        undo(Predictor::FloatingPoint, &mut row, layout, &mut Vec::new());
        assert_eq!(row, floats.map(f32::to_le_bytes).concat());
    }
}
