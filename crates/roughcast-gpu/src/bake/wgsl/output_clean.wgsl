// The output of a pass: CLEAN's texels of the level that is read.
@fragment
fn fragment(corner: Corner) -> @location(0) vec4f {
    opaque_zero = params.zero;
    let averages = input_averages(vec2u(corner.position.xy));
    return nearest(clean_from_averages(averages, unpacked_stores(packed_stores)));
}
