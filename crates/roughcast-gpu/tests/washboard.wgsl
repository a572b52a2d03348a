// Waves along a direction in world space, far finer than a pixel or coarse, as a source of bumps.

const WAVE: vec3f = vec3f(2.0, 0.5, 1.0);   // radians per unit of length
const HEIGHT: f32 = 0.2;

// The gradient of HEIGHT * sin(WAVE . position), in the tangent frame; a slope is minus it.
fn detail_slope(at: DetailPoint) -> vec2f {
    return -((HEIGHT * cos(dot(WAVE, at.position)) * WAVE) * at.frame).xy;
}

// Half of the waves are taken to be hidden under a pixel.
fn detail_distribution(at: DetailPoint) -> Distribution {
    let mean = 0.5 * detail_slope(at);
    let along = HEIGHT * (WAVE * at.frame).xy;
    return one_gaussian(slope_normal(mean), mean, 0.25 * along.xyx * along.xyy, MAPS_WITHOUT_BASE);
}
