//! Decides from pixels what a map is: normals or heights, in which channels and range, green up or down.
//!
//! The caller may act on the answers or overrule them: if the pixels do not decide, the answer
//! says so. All of it is deterministic; large images are judged by a regular sample of their texels.
//!
//! ```
//! use roughcast::detect::{KindGuess, guess_channels, guess_kind, guess_range};
//! use roughcast::{Image, Kind, NormalChannels, Samples};
//!
//! // Unit normals that lean to the right by several angles, in 8 bits.
//! let texel = |i: usize| {
//!     let (sin, cos) = (0.1 * (i % 7) as f32).sin_cos();
//!     [sin, 0.0, cos].map(|v| (v * 127.5 + 127.5).round() as u8)
//! };
//! let map = Image::new(16, 16, 3, Samples::U8((0..256).flat_map(texel).collect()))?;
//! let range = guess_range(&map);
//! assert_eq!(guess_kind(&map, &["R", "G", "B"], range), KindGuess::Certain(Kind::Normal));
//! assert_eq!(guess_channels(&map, &["R", "G", "B"], range), NormalChannels::Xyz);
//! # Ok::<(), roughcast::ImageError>(())
//! ```

mod channels;
mod correlation;
mod field;
mod green;
mod heights;
mod kind;
mod order;
mod sample;
mod vectors;

pub use channels::{guess_channels, guess_range};
pub use green::{GreenTest, GreenVerdict, test_green, test_green_against_height, test_green_of_map};
pub use heights::{HeightRange, height_range, height_scale_for_units};
pub use kind::{KindGuess, guess_kind};
pub use order::guess_order;
