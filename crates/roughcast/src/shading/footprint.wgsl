// Footprint correction: the part of the variance under a texture filter that is under the pixel.
//
// In a fragment shader, with the texture's size in texels and the mean slope as sampled:
//   let axes = footprint_axes(dpdx(uv) * size, dpdy(uv) * size);
//   let filtered = hardware_variances(axes, max_anisotropy, mip_bias);
//   let ratio = footprint_ratio(axes, filtered, dpdx(mean), dpdy(mean), options);

// Standard deviation of the pixel filter, in pixels.
const PIXEL_STANDARD_DEVIATION: f32 = 0.5;

// The ratio of the maximum to the mean variance of linear interpolation between two texels: 1/4 over 1/6.
const LARGEST_OVER_MEAN: f32 = 1.5;

// The level at which the correction ends; it fades out from the previous level.
const LAST_LEVEL: f32 = 2.0;

// Smaller squared lengths of an axis, in texels, are clamped to this.
const LEAST_SQUARED_LENGTH: f32 = 1e-12;

struct FootprintAxes {
    squared_lengths: vec2f,     // of the longer and the shorter axis, in texels of level 0
    along: vec2f,               // weights of the derivatives to the right and down in that along the longer axis
    across: vec2f,              // and along the shorter one
}

struct FilterVariances {
    moments: vec2f,     // along the two axes, in squared texels of level 0: for filtered moments
    variances: vec2f,   // for filtered variances
}

struct PixelPart {
    ratio: f32,         // the pixel's part of the variance caused by a linear change of the mean slope
    linear_trace: f32,  // the maximum contribution of such a change to the trace of the covariance
}

struct FootprintRatio {
    moments: PixelPart,     // for filtered moments
    variances: PixelPart,   // for a filtered variance
    linear_covariance: vec3f,   // covariance (xx, yy, xy) under the pixel of the linear change of the mean slope
    magnified: f32,         // the fraction of the covariance replaced by this linear covariance, 0 to 1
}

// The axes of a footprint, given the change of the texture position, in texels of level 0, from one pixel to the next
// on the right and to the one below.
fn footprint_axes(texels_dx: vec2f, texels_dy: vec2f) -> FootprintAxes {
    let xx = texels_dx.x * texels_dx.x + texels_dy.x * texels_dy.x;
    let yy = texels_dx.y * texels_dx.y + texels_dy.y * texels_dy.y;
    let xy = texels_dx.x * texels_dx.y + texels_dy.x * texels_dy.y;
    let half_difference = 0.5 * (xx - yy);
    let radius = sqrt(half_difference * half_difference + xy * xy);
    // The eigenvector of the larger eigenvalue, in the form whose first component is computed without cancellation.
    let wide = vec2f(half_difference + radius, xy);
    let tall = vec2f(xy, radius - half_difference);
    let raw = select(tall, wide, half_difference >= 0.0);
    let squared = dot(raw, raw);
    let u = select(vec2f(1.0, 0.0), raw * inverseSqrt(squared), squared > 0.0);
    let major = max(0.5 * (xx + yy) + radius, LEAST_SQUARED_LENGTH);
    // The determinant is the product of both lengths.
    let area = texels_dx.x * texels_dy.y - texels_dx.y * texels_dy.x;
    let minor = clamp(area * area / major, LEAST_SQUARED_LENGTH, major);
    let along = vec2f(dot(texels_dx, u), dot(texels_dy, u)) / major;
    let v = vec2f(-u.y, u.x);
    let across = vec2f(dot(texels_dx, v), dot(texels_dy, v)) / minor;
    return FootprintAxes(vec2f(major, minor), along, across);
}

// The level of detail of the texels under a filter, derived from the area under each texel. The variance of that area
// is (4^l - 1) / 12.
fn filter_level(filtered: FilterVariances) -> f32 {
    return 0.5 * log2(1.0 + 12.0 * filtered.variances.x);
}

// Variances of trilinear interpolation at a level of detail, 0 or more.
fn level_variances(detail: f32) -> FilterVariances {
    let level = max(detail, 0.0);
    let finer = floor(level);
    let power = exp2(2.0 * finer) * (1.0 + 3.0 * (level - finer));
    return FilterVariances(vec2f(power / 4.0 - 1.0 / 12.0), vec2f((power - 1.0) / 12.0));
}

// Variances of a hardware texture filter: a sampler with this anisotropy, 1 for a trilinear one, and a level bias.
fn hardware_variances(axes: FootprintAxes, max_anisotropy: f32, mip_bias: f32) -> FilterVariances {
    let lengths = sqrt(axes.squared_lengths);
    let most_taps = max(max_anisotropy, 1.0);
    let shorter = max(max(lengths.y, lengths.x / most_taps), 1.0);
    let taps = clamp(ceil(lengths.x / shorter), 1.0, most_taps);
    let level = level_variances(log2(shorter) + mip_bias);
    let between_taps = vec2f(axes.squared_lengths.x / 12.0 * (1.0 - 1.0 / (taps * taps)), 0.0);
    return FilterVariances(level.moments + between_taps, level.variances);
}

// The factor for a covariance of this trace.
fn pixel_factor(part: PixelPart, trace: f32) -> f32 {
    if trace <= 0.0 {
        return 1.0;
    }
    return 1.0 - (1.0 - part.ratio) * min(part.linear_trace / trace, 1.0);
}

// The pixel's part of a covariance (xx, yy, xy) stored in a map; `part` is the ratio's part for the quantity that the
// map stores. The variance of the base along each axis is not reduced.
fn pixel_covariance(ratio: FootprintRatio, part: PixelPart, stored: vec3f, base: f32) -> vec3f {
    let kept = (1.0 - ratio.magnified) * pixel_factor(part, stored.x + stored.y - 2.0 * base);
    let rest = (1.0 - kept) * base;
    return kept * stored + vec3f(rest, rest, 0.0) + ratio.magnified * ratio.linear_covariance;
}

// The pixel's part, given the squared changes of the mean slope per texel along the two axes and the variances of the
// filter and of the pixel along them.
fn pixel_part(changes: vec2f, variances: vec2f, pixel: vec2f) -> PixelPart {
    let covered = dot(changes, variances);
    if covered <= 0.0 {
        return PixelPart(1.0, 0.0);
    }
    return PixelPart(dot(changes, min(variances, pixel)) / covered, LARGEST_OVER_MEAN * covered);
}

// The whole variance, as in the papers.
fn whole_footprint() -> FootprintRatio {
    return FootprintRatio(PixelPart(1.0, 0.0), PixelPart(1.0, 0.0), vec3f(0.0), 0.0);
}

// The part of the variance under a filter that is under the pixel, if the filtered mean slope changes by mean_dx to
// the next pixel on the right and by mean_dy to the one below.
fn footprint_ratio(
    axes: FootprintAxes,
    filtered: FilterVariances,
    mean_dx: vec2f,
    mean_dy: vec2f,
    options: ShadingOptions,
) -> FootprintRatio {
    if options.footprint == FOOTPRINT_PUBLISHED {
        return whole_footprint();
    }
    let along = axes.along.x * mean_dx + axes.along.y * mean_dy;
    let across = axes.across.x * mean_dx + axes.across.y * mean_dy;
    let changes = vec2f(dot(along, along), dot(across, across));
    let pixel = PIXEL_STANDARD_DEVIATION * PIXEL_STANDARD_DEVIATION * axes.squared_lengths;
    let seen = min(pixel, filtered.moments);
    let squares = seen.x * along * along + seen.y * across * across;
    let linear_covariance = vec3f(squares, seen.x * along.x * along.y + seen.y * across.x * across.y);
    let level = filter_level(filtered);
    let reach = clamp(LAST_LEVEL - level, 0.0, 1.0);
    let all_moments = pixel_part(changes, filtered.moments, pixel);
    let all_variances = pixel_part(changes, filtered.variances, pixel);
    let moments = PixelPart(1.0 - reach * (1.0 - all_moments.ratio), all_moments.linear_trace);
    let variances = PixelPart(1.0 - reach * (1.0 - all_variances.ratio), all_variances.linear_trace);
    let finest = clamp(1.0 - level, 0.0, 1.0);
    let near = clamp(2.0 - sqrt(axes.squared_lengths.x), 0.0, 1.0);
    return FootprintRatio(moments, variances, linear_covariance, finest * near * (1.0 - moments.ratio));
}
