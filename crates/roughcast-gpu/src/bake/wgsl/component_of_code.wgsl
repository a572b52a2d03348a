// Decodes a normal's component from a code.
fn map_component(stored: f32) -> f32 {
    return component_from_code(stored, MAP_STEPS);
}
