// Coverage weights for reducing a line of `from_size` texels to one of max(1, from_size / 2). Twin of the box in
// weights.rs.

// The weights of the finer texels 2j, 2j + 1 and 2j + 2 in texel j of the coarser line. They sum to one; a texel
// outside the line has weight zero.
fn halving_weights(j: u32, from_size: u32) -> vec3f {
    if from_size == 1u {
        return vec3f(1.0, 0.0, 0.0);
    }
    if from_size % 2u == 0u {
        return vec3f(0.5, 0.5, 0.0);
    }
    let to_size = from_size / 2u;
    let full = f32(from_size);
    return vec3f(
        quotient(f32(to_size - j), full),
        quotient(f32(to_size), full),
        quotient(f32(j + 1u), full),
    );
}
