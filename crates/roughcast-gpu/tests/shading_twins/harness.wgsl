// Runs one function of the library for many cases: words in, words out. The entry points are made by the harness.

@group(0) @binding(0) var<storage, read> input_words: array<u32>;
@group(0) @binding(1) var<storage, read_write> output_words: array<u32>;

var<private> input_at: u32;
var<private> output_at: u32;

fn f(i: u32) -> f32 {
    return bitcast<f32>(input_words[input_at + i]);
}

fn f2(i: u32) -> vec2f {
    return vec2f(f(i), f(i + 1u));
}

fn f3(i: u32) -> vec3f {
    return vec3f(f2(i), f(i + 2u));
}

fn f4(i: u32) -> vec4f {
    return vec4f(f3(i), f(i + 3u));
}

// The options stand before the arguments.
fn o() -> ShadingOptions {
    let i = input_at - OPTION_WORDS;
    return ShadingOptions(
        bitcast<f32>(input_words[i]),
        input_words[i + 1u],
        input_words[i + 2u],
        input_words[i + 3u],
        input_words[i + 4u],
        input_words[i + 5u],
        vec2u(0u),
    );
}

// And the packing before the options.
fn p() -> Packing {
    let before = input_at;
    let i = before - OPTION_WORDS - 16u;
    input_at = i;
    let packing = Packing(
        f2(0u),
        f2(2u),
        f2(4u),
        f2(6u),
        f2(8u),
        f2(10u),
        f2(12u),
        input_words[i + 14u],
        input_words[i + 15u],
    );
    input_at = before;
    return packing;
}

fn put(value: f32) {
    output_words[output_at] = bitcast<u32>(value);
    output_at += 1u;
}

fn put2(v: vec2f) {
    put(v.x);
    put(v.y);
}

fn put3(v: vec3f) {
    put2(v.xy);
    put(v.z);
}

fn put_part(part: PixelPart) {
    put(part.ratio);
    put(part.linear_trace);
}

fn put_ratio(ratio: FootprintRatio) {
    put_part(ratio.moments);
    put_part(ratio.variances);
    put3(ratio.linear_covariance);
    put(ratio.magnified);
}

fn put_variances(filtered: FilterVariances) {
    put2(filtered.moments);
    put2(filtered.variances);
}

fn put_axes(axes: FootprintAxes) {
    put2(axes.squared_lengths);
    put2(axes.along);
    put2(axes.across);
}

fn part(i: u32) -> PixelPart {
    return PixelPart(f(i), f(i + 1u));
}

fn ratio(i: u32) -> FootprintRatio {
    return FootprintRatio(part(i), part(i + 2u), f3(i + 4u), f(i + 7u));
}

fn axes(i: u32) -> FootprintAxes {
    return FootprintAxes(f2(i), f2(i + 2u), f2(i + 4u));
}

fn put_facet(surface: BumpFacet) {
    put3(surface.normal);
    put(surface.specular_power);
}

fn put_gaussian(surface: SlopeGaussian) {
    put2(surface.mean);
    put2(surface.variance);
    put(surface.covariance);
    put(surface.det);
}

fn put_ggx(surface: GgxSurface) {
    put3(surface.normal);
    put(surface.alpha_along);
    put3(surface.tangent);
    put(surface.alpha_across);
}

fn facet(i: u32) -> BumpFacet {
    return BumpFacet(f3(i), f(i + 3u));
}

fn gaussian(i: u32) -> SlopeGaussian {
    return SlopeGaussian(f2(i), f2(i + 2u), f(i + 4u), f(i + 5u));
}

fn ggx(i: u32) -> GgxSurface {
    return GgxSurface(f3(i), f(i + 3u), f3(i + 4u), f(i + 7u));
}

fn weighted(i: u32) -> WeightedGaussian {
    return WeightedGaussian(f2(i), f2(i + 2u), f(i + 4u), f(i + 5u));
}

// The whole numbers are rounded, since the tolerance moves all arguments.
fn distribution(i: u32) -> Distribution {
    return Distribution(
        f3(i),
        u32(f(i + 3u) + 0.5),
        weighted(i + 4u),
        weighted(i + 10u),
        weighted(i + 16u),
        weighted(i + 22u),
    );
}

fn put_weighted(gaussian: WeightedGaussian) {
    put2(gaussian.mean);
    put2(gaussian.variance);
    put(gaussian.covariance);
    put(gaussian.weight);
}

fn put_distribution(d: Distribution) {
    put3(d.normal);
    put(f32(d.base));
    put_weighted(d.first);
    put_weighted(d.second);
    put_weighted(d.third);
    put_weighted(d.fourth);
}

fn put_mixture(surface: MixtureSurface) {
    put2(surface.weights.xy);
    put2(surface.weights.zw);
    put_gaussian(surface.first);
    put_gaussian(surface.second);
    put_gaussian(surface.third);
    put_gaussian(surface.fourth);
}

// Frequency, amplitude, and three whole numbers.
fn noise(i: u32) -> Noise {
    return Noise(f(i), f(i + 1u), u32(f(i + 2u) + 0.5), u32(f(i + 3u) + 0.5), u32(f(i + 4u) + 0.5), 0u, vec2u(0u));
}

// Six numbers and two whole numbers.
fn gabor(i: u32) -> GaborNoise {
    return GaborNoise(f(i), f(i + 1u), f(i + 2u), f(i + 3u), f(i + 4u), f(i + 5u), u32(f(i + 6u) + 0.5), u32(f(i + 7u) + 0.5));
}
