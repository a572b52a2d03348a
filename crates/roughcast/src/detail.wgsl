// Detail: whatever has bumps. A detail module answers two questions at a point of a surface:
//
//   fn detail_slope(at: DetailPoint) -> vec2f                  the exact slope there, for ground truth
//   fn detail_distribution(at: DetailPoint) -> Distribution    the distribution of slopes under the pixel
//
// A host composes it with a shading model and what the module says it needs.

struct DetailPoint {
    uv: vec2f,          // texture coordinates, repeats included
    position: vec3f,    // in world space
    frame: mat3x3f,     // the tangent frame, in which slopes are: tangent, bitangent and normal, in world space
    side: f32,          // 1 if the front is seen; -1 if the back is, where all three axes are reversed
}
