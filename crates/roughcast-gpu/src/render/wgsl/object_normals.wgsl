// Object-space normal maps: normals in the axes of the mesh. The second texture holds their squares xx, yy and zz, the
// third their products xy, xz and yz. As in `ObjectNormalDetail` of the CPU renderer.

// The slope of a normal of the front.
fn slope_of_object_normal(at: DetailPoint, normal: vec3f) -> vec2f {
    let gradient = surface_gradient_of_normal(at.side * at.frame[2], normal);
    return at.side * slope_of_gradient(at.frame[0], at.frame[1], gradient);
}

fn detail_slope(at: DetailPoint) -> vec2f {
    return slope_of_object_normal(at, finest0(at).xyz);
}

// The slope of the mean normal, and the covariance of the normals seen from it: a slope is (n.t, n.b) / (n.m) with the
// surface's normal m, which is linearised about the mean.
fn detail_distribution(at: DetailPoint) -> Distribution {
    let mean = texel0(at).xyz;
    let squares = texel1(at).xyz;
    let products = texel2(at).xyz;
    let spread = mat3x3f(
        vec3f(squares.x, products.x, products.y) - mean * mean.x,
        vec3f(products.x, squares.y, products.z) - mean * mean.y,
        vec3f(products.y, products.z, squares.z) - mean * mean.z,
    );
    let slope = slope_of_object_normal(at, mean);
    let along = abs(dot(at.frame[2], mean));
    let x = (at.frame[0] - slope.x * at.frame[2]) / along;
    let y = (at.frame[1] - slope.y * at.frame[2]) / along;
    let sigma = vec3f(dot(x, spread * x), dot(y, spread * y), dot(x, spread * y));
    let is_finite = along > 0.0 && sigma.x + sigma.y < LARGEST_TRACE;
    let repaired = select(vec3f(0.0), positive_semidefinite(sigma), is_finite);
    return one_gaussian(slope_normal(slope) * length(mean), slope, repaired, MAPS_WITHOUT_BASE);
}

// Larger traces are infinite.
const LARGEST_TRACE: f32 = 1e30;
