// The output of a pass: LEAN's texels of the level that is read.

struct Output {
    @location(0) lean1: vec4f,
    @location(1) lean2: vec4f,
}

@fragment
fn fragment(corner: Corner) -> Output {
    opaque_zero = params.zero;
    let averages = input_averages(vec2u(corner.position.xy));
    let stores = unpacked_stores(packed_stores);
    return Output(
        nearest(lean1_from_averages(averages, stores)),
        nearest(lean2_from_averages(averages, stores)),
    );
}
