// The output of a pass: the next level as floats. Defined elsewhere: next_averages.

struct Output {
    @location(0) low: vec4f,
    @location(1) high: vec4f,
}

@fragment
fn fragment(corner: Corner) -> Output {
    opaque_zero = params.zero;
    let averages = next_averages(vec2u(corner.position.xy));
    return Output(
        vec4f(averages.mean, averages.covariance.xy),
        vec4f(averages.covariance.z, averages.normal),
    );
}
