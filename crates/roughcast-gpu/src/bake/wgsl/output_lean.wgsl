// What a pass makes: LEAN's texels of the level that is read.

struct Output {
    @location(0) lean1: vec4f,
    @location(1) lean2: vec4f,
}

@fragment
fn fragment(corner: Corner) -> Output {
    opaque_zero = params.zero;
    let footprint = input_footprint(vec2u(corner.position.xy));
    let stores = unpacked_stores(packed_stores);
    return Output(
        nearest(lean1_from_footprint(footprint, stores)),
        nearest(lean2_from_footprint(footprint, stores)),
    );
}
