// The source uses the second set of texture coordinates.
fn source_point(at: ScenePoint) -> DetailPoint {
    return DetailPoint(at.second_uv, at.position, at.frame, at.side);
}
