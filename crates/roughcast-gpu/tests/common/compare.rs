//! Compares stored textures texel by texel, in steps of their format.

use half::f16;
use roughcast::Samples;
use roughcast::texture::TextureArray;

/// The largest difference between two textures that should be equal, in steps of the format, and its location.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    pub steps: u32,
    pub place: String,
    pub texels_that_differ: usize,
    pub texels: usize,
}

/// Compares all layers, levels and channels.
///
/// # Errors
/// If the two differ in shape.
pub fn difference(a: &TextureArray, b: &TextureArray) -> Result<Difference, String> {
    let mut found = Difference { steps: 0, place: String::new(), texels_that_differ: 0, texels: 0 };
    if a.layers().len() != b.layers().len() {
        return Err(format!("{} layers and {}", a.layers().len(), b.layers().len()));
    }
    for (a, b) in a.layers().iter().zip(b.layers()) {
        if (a.name(), a.channel_names(), a.levels().len()) != (b.name(), b.channel_names(), b.levels().len())
        {
            return Err(format!(
                "{} of {} levels and {} of {}",
                a.name(),
                a.levels().len(),
                b.name(),
                b.levels().len()
            ));
        }
        for (level, (image_a, image_b)) in a.levels().iter().zip(b.levels()).enumerate() {
            let shape = |image: &roughcast::Image| (image.width(), image.height(), image.channels());
            if shape(image_a) != shape(image_b) {
                return Err(format!("level {level}: {:?} and {:?}", shape(image_a), shape(image_b)));
            }
            let steps = steps(image_a.samples(), image_b.samples())?;
            found.texels += steps.len();
            for (index, steps) in steps.into_iter().enumerate() {
                found.texels_that_differ += usize::from(steps > 0);
                if steps > found.steps {
                    let (texel, channel) = (index / 4, index % 4);
                    let (x, y) = (texel % image_a.width(), texel / image_a.width());
                    let (va, vb) = (image_a.samples().get(index), image_b.samples().get(index));
                    found.steps = steps;
                    found.place = format!(
                        "{} level {level} ({x}, {y}) {}: {va:e} and {vb:e}",
                        a.name(),
                        a.channel_names()[channel]
                    );
                }
            }
        }
    }
    Ok(found)
}

fn steps(a: &Samples, b: &Samples) -> Result<Vec<u32>, String> {
    match (a, b) {
        (Samples::U8(a), Samples::U8(b)) => Ok(pairs(a, b, |v| i64::from(*v))),
        (Samples::U16(a), Samples::U16(b)) => Ok(pairs(a, b, |v| i64::from(*v))),
        (Samples::F16(a), Samples::F16(b)) => Ok(pairs(a, b, half_in_order)),
        (a, b) => Err(format!("{:?} and {:?}", a.sample_type(), b.sample_type())),
    }
}

fn pairs<T>(a: &[T], b: &[T], order: impl Fn(&T) -> i64) -> Vec<u32> {
    a.iter().zip(b).map(|(a, b)| order(a).abs_diff(order(b)) as u32).collect()
}

/// Maps neighbouring half floats to neighbouring integers, across zero as well; both zeros are equal. NaN is far from
/// everything.
fn half_in_order(v: &f16) -> i64 {
    if v.is_nan() {
        return 1 << 20;
    }
    let magnitude = i64::from(v.to_bits() & 0x7fff);
    if v.is_sign_negative() { -magnitude } else { magnitude }
}
