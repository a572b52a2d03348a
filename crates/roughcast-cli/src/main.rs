//! The `roughcast` program.
fn main() {}
