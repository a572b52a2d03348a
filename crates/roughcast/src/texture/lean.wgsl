// LEAN mapping: mean slope and raw second moments, in two RGBA textures. Twin of lean.rs.
// Source: Olano & Baker, "LEAN Mapping", 2010, Eq. 3 to 6, Figures 15 and 16, with the listing's two faults mended.

// N.x, N.y, N.z, Mxy.
fn lean1_from_footprint(footprint: Footprint, stores: Stores) -> vec4f {
    let mixed = footprint.covariance.z + rounded(footprint.mean.x * footprint.mean.y);
    return vec4f(
        stored(footprint.normal.x, stores.unit),
        stored(footprint.normal.y, stores.unit),
        footprint.normal.z,
        stored(mixed, stores.mixed),
    );
}

// B.x, B.y, Mxx, Myy.
fn lean2_from_footprint(footprint: Footprint, stores: Stores) -> vec4f {
    let second = footprint.covariance.xy + rounded2(footprint.mean * footprint.mean);
    return vec4f(
        stored(footprint.mean.x, stores.slope),
        stored(footprint.mean.y, stores.slope),
        stored(second.x, stores.second),
        stored(second.y, stores.second),
    );
}
