// Bump mapping where derivative instructions do not exist (Mikkelsen 2010, section 5): over a buffer of points, which may be
// the pixels of a deferred pass or the vertices of a grid. `noise` and `surface-gradient` come before.

struct Point {
    position: vec3f,
    height: f32,
    normal: vec3f,
    covered: f32,   // 1 for a point of the surface, 0 for the background
}

@group(0) @binding(0) var<storage, read> points: array<Point>;
@group(0) @binding(1) var<storage, read_write> normals: array<vec4f>;
@group(0) @binding(2) var<uniform> bumps: Noise;

// Neighbours whose normals differ by more than this cosine, or that lie out of the tangent plane, are on another surface.
const SAME_SURFACE: f32 = 0.8;

// The offset to a neighbour, and its weight: 0 outside of the grid and on another surface.
fn neighbour(here: Point, column: i32, row: i32, width: i32) -> vec4f {
    let height = i32(arrayLength(&points)) / width;
    if column < 0 || row < 0 || column >= width || row >= height {
        return vec4f(0.0);
    }
    let there = points[row * width + column];
    let offset = there.position - here.position;
    let away = abs(dot(offset, here.normal)) > 0.5 * length(offset);
    if there.covered == 0.0 || away || dot(here.normal, there.normal) < SAME_SURFACE {
        return vec4f(0.0);
    }
    return vec4f(offset, 1.0 / max(dot(offset, offset), 1e-20));
}

fn height_at(column: i32, row: i32, width: i32) -> f32 {
    return points[clamp(row * width + column, 0, i32(arrayLength(&points)) - 1)].height;
}

// Writes the normal of the noise, by its gradient in space (Listing 3), and that of the buffer's heights, by neighbours.
@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= arrayLength(&points) {
        return;
    }
    let here = points[id.x];
    let width = WIDTH;
    let column = i32(id.x) % width;
    let row = i32(id.x) / width;
    let gradient = surface_gradient_of_volume(here.normal, noise_sample(bumps, here.position).xyz);
    normals[2u * id.x] = vec4f(perturbed_normal(here.normal, gradient), 1.0);
    let a = neighbour(here, column + 1, row, width);
    let b = neighbour(here, column - 1, row, width);
    let c = neighbour(here, column, row + 1, width);
    let d = neighbour(here, column, row - 1, width);
    let heights = vec4f(
        height_at(column + 1, row, width), height_at(column - 1, row, width),
        height_at(column, row + 1, width), height_at(column, row - 1, width),
    ) - here.height;
    let weights = vec4f(a.w, b.w, c.w, d.w);
    let around = surface_gradient_of_neighbours(here.normal, mat4x3f(a.xyz, b.xyz, c.xyz, d.xyz), heights, weights);
    normals[2u * id.x + 1u] = vec4f(perturbed_normal(here.normal, around), 1.0);
}
