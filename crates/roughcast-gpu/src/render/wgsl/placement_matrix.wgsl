// From the texture's slopes to those in the tangent frame, by the derivatives of position and texture coordinates.
fn placement_matrix(at: DetailPoint) -> mat2x2f {
    let basis = surface_basis(dpdxFine(at.position), dpdyFine(at.position), at.frame[2]);
    let gradients = texture_gradients(basis, dpdxFine(at.uv), dpdyFine(at.uv));
    if source_options.has_height != 0u {
        return slope_matrix(gradients, at.side * source_options.height_per_uv, at.frame[0], at.frame[1]);
    }
    return slope_matrix(scale_free_gradients(gradients), vec2f(at.side), at.frame[0], at.frame[1]);
}
