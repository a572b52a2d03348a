// A normal's component, unchanged.
fn map_component(stored: f32) -> f32 {
    return stored;
}
