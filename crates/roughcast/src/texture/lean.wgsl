// LEAN mapping: mean slope and raw second moments, in two RGBA textures. Twin of lean.rs.
// Source: Olano & Baker, "LEAN Mapping", 2010, Eq. 3 to 6, Figures 15 and 16, with two errors in the listing
// corrected.

// N.x, N.y, N.z, Mxy.
fn lean1_from_averages(averages: Averages, stores: Stores) -> vec4f {
    let mixed = averages.covariance.z + rounded(averages.mean.x * averages.mean.y);
    return vec4f(
        stored(averages.normal.x, stores.unit),
        stored(averages.normal.y, stores.unit),
        averages.normal.z,
        stored(mixed, stores.mixed),
    );
}

// B.x, B.y, Mxx, Myy.
fn lean2_from_averages(averages: Averages, stores: Stores) -> vec4f {
    let second = averages.covariance.xy + rounded2(averages.mean * averages.mean);
    return vec4f(
        stored(averages.mean.x, stores.slope),
        stored(averages.mean.y, stores.slope),
        stored(second.x, stores.second),
        stored(second.y, stores.second),
    );
}
