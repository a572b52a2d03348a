// Repairs the broken texels of a normal map: each gets the mean slope of its unbroken neighbours among the eight.
//
// Defined elsewhere: params, slope_unless_broken(at).

fn neutral_slope(at: vec2i) -> vec2f {
    let size = vec2i(params.size);
    var sum = vec2f(0.0);
    var count = 0.0;
    for (var i = 0; i < 9; i++) {
        let x = neighbour(at.x + i % 3 - 1, size.x, params.wrap);
        let y = neighbour(at.y + i / 3 - 1, size.y, params.wrap);
        let repaired = slope_unless_broken(vec2i(x, y));
        if repaired.fault < FAULT_BEHIND {
            sum += rounded2(repaired.slope);
            count += 1.0;
        }
    }
    let valid = max(count, 1.0);
    return vec2f(quotient(sum.x, valid), quotient(sum.y, valid));
}

fn map_slope(at: vec2u) -> RepairedSlope {
    let repaired = slope_unless_broken(vec2i(at));
    if repaired.fault < FAULT_BEHIND {
        return repaired;
    }
    return RepairedSlope(neutral_slope(vec2i(at)), repaired.fault);
}
