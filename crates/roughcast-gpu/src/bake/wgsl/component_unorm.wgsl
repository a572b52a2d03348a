// Decodes a normal's component from a value from 0 to 1.
fn map_component(stored: f32) -> f32 {
    return 2.0 * stored - 1.0;
}
