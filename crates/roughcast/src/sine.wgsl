// Sines that all graphics cards compute alike: their own may be off by 2^-11.

// The sine of a number of turns, to a few roundings.
fn sine_of_turns(turns: f32) -> f32 {
    // Within half a turn of zero, and then within a quarter.
    let near = turns - floor(turns + 0.5);
    let folded = select(near, select(-0.5, 0.5, near > 0.0) - near, abs(near) > 0.25);
    let angle = 6.283185307179586 * folded;
    let s = angle * angle;
    // The series up to the eleventh power; the next term is below 6e-8.
    let series = 1.0 / 120.0 + s * (-1.0 / 5040.0 + s * (1.0 / 362880.0 - s / 39916800.0));
    return angle * (1.0 + s * (-1.0 / 6.0 + s * series));
}

// The cosine of a number of turns.
fn cosine_of_turns(turns: f32) -> f32 {
    return sine_of_turns(turns - floor(turns) + 0.25);
}
