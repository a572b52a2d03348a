//! Decides from pixels what a map is: normals or heights, in which channels and range, green up or down.
//!
//! The caller may act on the answers or overrule them: if the pixels do not decide, the answer
//! says so. All of it is deterministic; large images are judged by a regular sample of their texels.

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
