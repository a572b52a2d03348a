// A normal's component as it is.
fn map_component(stored: f32) -> f32 {
    return stored;
}
