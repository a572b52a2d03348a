// What a pass makes: CLEAN's texels of the level that is read.
@fragment
fn fragment(corner: Corner) -> @location(0) vec4f {
    opaque_zero = params.zero;
    let footprint = input_footprint(vec2u(corner.position.xy));
    return nearest(clean_from_footprint(footprint, unpacked_stores(packed_stores)));
}
