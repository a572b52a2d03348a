// How to read stored texels: value = stored * x + y for each kind of quantity; (1, 0) for float textures.
// Uploaded: 48 bytes, the twelve numbers in the order of the fields.

struct Packing {
    slope: vec2f,       // a component of a slope
    second: vec2f,      // Mxx, Myy
    mixed: vec2f,       // Mxy
    trace: vec2f,       // Mxx + Myy
    variance: vec2f,    // a stored variance
    unit: vec2f,        // a component of a unit vector
}
