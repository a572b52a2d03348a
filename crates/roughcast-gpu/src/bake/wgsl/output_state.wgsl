// What a pass makes: the next level as floats. Defined elsewhere: next_footprint.

struct Output {
    @location(0) low: vec4f,
    @location(1) high: vec4f,
}

@fragment
fn fragment(corner: Corner) -> Output {
    opaque_zero = params.zero;
    let footprint = next_footprint(vec2u(corner.position.xy));
    return Output(
        vec4f(footprint.mean, footprint.covariance.xy),
        vec4f(footprint.covariance.z, footprint.normal),
    );
}
