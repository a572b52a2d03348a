// The source uses the first set of texture coordinates.
fn source_point(at: ScenePoint) -> DetailPoint {
    return DetailPoint(at.uv, at.position, at.frame, at.side);
}
