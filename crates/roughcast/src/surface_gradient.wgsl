// The surface gradient: bump mapping without a parametrization of the surface.
//
// Source: Mikkelsen, Bump Mapping Unparametrized Surfaces on the GPU, 2010. s and t are any local parametrization, such as
// the screen: sigma_s is then dpdxFine(position), height_s is dpdxFine(height), and so on.

// Sine of the angle between the derivatives of the position below which they count as parallel.
const LEAST_SINE: f32 = 1e-6;
// Cosine between two normals below which one is not a bump on the surface of the other.
const LEAST_BUMP_COSINE: f32 = 0.001953125;
// Vectors of this length or longer, and those that are not numbers, count as undetermined.
const LONGEST_SQUARED: f32 = 1e30;

// The gradient, or zero if it is not finite: a flat bump.
fn finite_or_flat(gradient: vec3f) -> vec3f {
    return select(vec3f(0.0), gradient, dot(gradient, gradient) < LONGEST_SQUARED);
}

// The gradients of s and t on the surface, as columns; zero if the derivatives are parallel. Eq. 3.
fn surface_basis(sigma_s: vec3f, sigma_t: vec3f, normal: vec3f) -> mat2x3f {
    let r1 = cross(sigma_t, normal);
    let r2 = cross(normal, sigma_s);
    let det = dot(sigma_s, r1);
    let least = LEAST_SINE * length(sigma_s) * length(sigma_t);
    // False for NaN.
    if abs(det) > least && abs(det) < LONGEST_SQUARED {
        return mat2x3f(r1 / det, r2 / det);
    }
    return mat2x3f(vec3f(0.0), vec3f(0.0));
}

// The surface gradient from derivatives of position and height with respect to the same parameters. Eq. 3, Listing 1.
fn surface_gradient(sigma_s: vec3f, sigma_t: vec3f, normal: vec3f, height_s: f32, height_t: f32) -> vec3f {
    let basis = surface_basis(sigma_s, sigma_t, normal);
    return finite_or_flat(basis[0] * height_s + basis[1] * height_t);
}

// The surface gradient of a height function in space, from its gradient there. Eq. 2, Listing 3.
fn surface_gradient_of_volume(normal: vec3f, gradient: vec3f) -> vec3f {
    return finite_or_flat(gradient - normal * dot(normal, gradient));
}

// The surface gradient of the bump that has this normal, of any length, in place of `normal`.
fn surface_gradient_of_normal(normal: vec3f, bump_normal: vec3f) -> vec3f {
    let along = dot(normal, bump_normal);
    if along > LEAST_BUMP_COSINE * length(bump_normal) {
        return finite_or_flat(normal - bump_normal / along);
    }
    return vec3f(0.0);
}

// The surface gradient from the heights of four neighbours, by weighted least squares: for stages without derivatives.
// Offsets and heights are relative to the point.
fn surface_gradient_of_neighbours(normal: vec3f, offsets: mat4x3f, heights: vec4f, weights: vec4f) -> vec3f {
    let tangents = any_tangents(normal);
    let x = tangents[0] * offsets;
    let y = tangents[1] * offsets;
    let xx = dot(weights * x, x);
    let yy = dot(weights * y, y);
    let xy = dot(weights * x, y);
    let along = vec2f(dot(weights * x, heights), dot(weights * y, heights));
    let det = xx * yy - xy * xy;
    if det > LEAST_SINE * xx * yy {
        let gradient = vec2f(yy * along.x - xy * along.y, xx * along.y - xy * along.x) / det;
        return finite_or_flat(tangents * gradient);
    }
    return vec3f(0.0);
}

// The unit normal of the displaced surface. Eq. 4.
fn perturbed_normal(normal: vec3f, gradient: vec3f) -> vec3f {
    return unit_vector_or(normal - gradient, normal);
}

// Perlin's older perturbation with the negated gradient, for comparison only: it may point into the surface. Section 5.
fn perlin_normal(normal: vec3f, gradient: vec3f) -> vec3f {
    return unit_vector_or(finite_or_flat(normal - gradient), normal);
}

// The unit normal of the displaced facet, for comparison only: it shows the edges of triangles. Section 4.
fn displaced_normal(sigma_s: vec3f, sigma_t: vec3f, normal: vec3f, height_s: f32, height_t: f32) -> vec3f {
    let displaced = cross(sigma_s + normal * height_s, sigma_t + normal * height_t);
    let side = select(1.0, -1.0, dot(cross(sigma_s, sigma_t), normal) < 0.0);
    return side * unit_vector_or(displaced, side * normal);
}

// The unit normal of the facet, on the side that `towards` points to. Section 4.
fn face_normal(sigma_s: vec3f, sigma_t: vec3f, towards: vec3f) -> vec3f {
    let normal = unit_vector_or(cross(sigma_s, sigma_t), towards);
    return select(normal, -normal, dot(normal, towards) < 0.0);
}

// Blinn's formula for a known parametrization that preserves the orientation. Blinn, Simulation of Wrinkled Surfaces, 1978.
fn blinn_normal(sigma_s: vec3f, sigma_t: vec3f, height_s: f32, height_t: f32) -> vec3f {
    let normal = cross(sigma_s, sigma_t);
    let tilt = cross(normal, sigma_t) * height_s - cross(normal, sigma_s) * height_t;
    return unit_vector_or(finite_or_flat(normal + tilt / length(normal)), vec3f(0.0));
}

// The slope in a frame of perpendicular unit tangents.
fn slope_of_gradient(tangent: vec3f, bitangent: vec3f, gradient: vec3f) -> vec2f {
    return -vec2f(dot(gradient, tangent), dot(gradient, bitangent));
}

// The gradients of u and v on the surface, as columns, from their derivatives by s and t.
fn texture_gradients(basis: mat2x3f, uv_s: vec2f, uv_t: vec2f) -> mat2x3f {
    return mat2x3f(basis[0] * uv_s.x + basis[1] * uv_t.x, basis[0] * uv_s.y + basis[1] * uv_t.y);
}

// The gradients of u and v divided by the length of the longer: a frame for bumps without a size of their own.
// Schueler, Normal Mapping Without Precomputed Tangents, 2006 and 2013.
fn scale_free_gradients(gradients: mat2x3f) -> mat2x3f {
    let longest = max(dot(gradients[0], gradients[0]), dot(gradients[1], gradients[1]));
    let scale = select(0.0, inverseSqrt(longest), (longest > 1e-37) & (longest < 1e37));
    return mat2x3f(gradients[0] * scale, gradients[1] * scale);
}

// The matrix that transforms slopes of a texture to a frame of perpendicular unit tangents. A slope of one along a whole
// unit of u and of v is a height of `height_per_uv`.
fn slope_matrix(gradients: mat2x3f, height_per_uv: vec2f, tangent: vec3f, bitangent: vec3f) -> mat2x2f {
    return mat2x2f(
        slope_of_gradient(tangent, bitangent, finite_or_flat(gradients[0] * -height_per_uv.x)),
        slope_of_gradient(tangent, bitangent, finite_or_flat(gradients[1] * height_per_uv.y)),
    );
}

// The change of the position to where the ray of an adjacent pixel meets the tangent plane: a derivative of the position where
// there are no derivative instructions. Zero if the ray does not meet the plane.
fn position_derivative(position: vec3f, normal: vec3f, origin: vec3f, direction: vec3f) -> vec3f {
    // The difference of two distant points, direction * distance - offset, written as one product.
    let offset = position - origin;
    return finite_or_flat(cross(normal, cross(direction, offset)) / dot(normal, direction));
}

// Two unit vectors perpendicular to a unit normal and to each other, as columns.
// Duff et al., Building an Orthonormal Basis, Revisited, 2017.
fn any_tangents(normal: vec3f) -> mat2x3f {
    let side = select(1.0, -1.0, normal.z < 0.0);
    let a = -1.0 / (side + normal.z);
    let b = normal.x * normal.y * a;
    return mat2x3f(
        vec3f(1.0 + side * normal.x * normal.x * a, side * b, -side * normal.x),
        vec3f(b, side + normal.y * normal.y * a, -normal.y),
    );
}
