use super::*;

/// A few roundings of numbers near one.
const ROUNDING: f64 = 1e-12;

fn waves() -> [Wave; 3] {
    [
        Wave::new(2.0, 0.4, 0.03).with_phase(0.7),
        Wave::new(0.6, -1.9, 0.01).with_phase(4.0),
        Wave::tiling([3, -2], 2.5, 0.02),
    ]
}

fn positions() -> impl Iterator<Item = DVec2> {
    (0..50).map(|i| DVec2::new(0.37 * f64::from(i) - 7.0, 0.61 * f64::from(i * i % 17)))
}

#[test]
fn slopes_are_minus_the_gradient_of_the_height() {
    const STEP: f64 = 1e-5;
    for (wave, p) in waves().iter().flat_map(|wave| positions().map(move |p| (wave, p))) {
        let along =
            |axis: DVec2| (wave.height(p - axis * STEP) - wave.height(p + axis * STEP)) / (2.0 * STEP);
        let off = wave.slope(p) - DVec2::new(along(DVec2::X), along(DVec2::Y));
        assert!(off.length() < 1e-9, "{off}");
    }
}

#[test]
fn crests_travel_at_the_speed_of_deep_water() {
    // 1.25 times the root of the wavelength in metres, in metres a second.
    let wave = Wave::new(9.0, 0.3, 0.1);
    let speed = wave.angular_frequency(EARTH_GRAVITY) / wave.vector.length();
    assert!((speed - 1.2495 * 3.0).abs() < 1e-3, "{speed}");
    let moved = DVec2::from_angle(0.3) * speed * 100.0;
    for p in positions() {
        let later = wave.at(100.0, EARTH_GRAVITY);
        assert!((later.height(p + moved) - wave.height(p)).abs() < 1e-10);
        assert!((0.0..TAU).contains(&later.phase));
    }
}

#[test]
fn tiles_repeat() {
    let wave = Wave::tiling([3, -2], 2.5, 0.02);
    for p in positions() {
        let next = p + DVec2::new(2.5, -5.0);
        assert!((wave.height(p) - wave.height(next)).abs() < ROUNDING);
    }
}

/// The mean of a function under a Gaussian with this covariance's square roots along two axes.
fn gaussian_mean(of: impl Fn(DVec2) -> f64, axes: [DVec2; 2]) -> f64 {
    const STEPS: i32 = 60;
    let (mut sum, mut weights) = (0.0, 0.0);
    for (i, j) in (-STEPS..=STEPS).flat_map(|i| (-STEPS..=STEPS).map(move |j| (i, j))) {
        let at = DVec2::new(f64::from(i), f64::from(j)) * 0.125;
        let weight = (-0.5 * at.length_squared()).exp();
        sum += weight * of(axes[0] * at.x + axes[1] * at.y);
        weights += weight;
    }
    sum / weights
}

#[test]
fn filtered_slopes_are_the_moments_under_the_footprint() {
    let pixel = f64::from(PIXEL_STANDARD_DEVIATION);
    for wave in waves() {
        for (p, size) in positions().step_by(9).zip([0.1, 0.3, 0.8, 1.5, 0.05, 0.5]) {
            let footprint = [DVec2::new(size, 0.3 * size), DVec2::new(-0.2 * size, 0.6 * size)];
            let axes = footprint.map(|change| change * pixel);
            let mean = |of: &dyn Fn(DVec2) -> f64| gaussian_mean(|offset| of(wave.slope(p + offset)), axes);
            let (x, y) = (mean(&|b| b.x), mean(&|b| b.y));
            let wanted = [
                x,
                y,
                mean(&|b| b.x * b.x) - x * x,
                mean(&|b| b.y * b.y) - y * y,
                mean(&|b| b.x * b.y) - x * y,
            ];
            let got = wave.slopes(p, footprint);
            let got = [got.mean[0], got.mean[1], got.covariance[0], got.covariance[1], got.covariance[2]];
            let largest = got.iter().zip(wanted).map(|(g, w)| (g - w).abs()).fold(0.0, f64::max);
            assert!(largest < 1e-9, "{got:?} {wanted:?}");
        }
    }
}

#[test]
fn no_footprint_leaves_the_slope_and_a_large_one_its_variance() {
    for (wave, p) in waves().iter().flat_map(|wave| positions().map(move |p| (wave, p))) {
        let near = wave.slopes(p, [DVec2::ZERO; 2]);
        assert!((DVec2::from_array(near.mean) - wave.slope(p)).length() < ROUNDING);
        assert!(near.covariance.iter().all(|entry| entry.abs() < ROUNDING));
        for long in [1e6, f64::INFINITY] {
            let far = wave.slopes(p, [DVec2::splat(long), DVec2::new(-long, 0.5)]);
            assert!(far.mean.iter().all(|mean| mean.abs() < ROUNDING), "{far:?}");
            let off = far.covariance.iter().zip(wave.slope_covariance()).map(|(a, b)| (a - b).abs());
            assert!(off.fold(0.0, f64::max) < ROUNDING);
        }
    }
}

#[test]
fn the_variance_of_waves_is_the_sum_of_theirs() {
    // Over a tile, waves with different whole numbers of periods are uncorrelated exactly.
    let waves = [Wave::tiling([3, 1], 1.0, 0.02), Wave::tiling([-2, 5], 1.0, 0.01).with_phase(1.0)];
    const SIDE: i32 = 64;
    let mut sums = [0.0; 3];
    for (i, j) in (0..SIDE).flat_map(|i| (0..SIDE).map(move |j| (i, j))) {
        let p = DVec2::new(f64::from(i), f64::from(j)) / f64::from(SIDE);
        let slope = waves.iter().map(|wave| wave.slope(p)).sum::<DVec2>();
        sums.iter_mut().zip(outer(slope)).for_each(|(sum, square)| *sum += square / f64::from(SIDE * SIDE));
    }
    let far = waves_slopes(&waves, DVec2::ZERO, [DVec2::X * 1e4, DVec2::Y * 1e4]);
    assert!(sums.iter().zip(far.covariance).all(|(a, b)| (a - b).abs() < ROUNDING), "{sums:?} {far:?}");
}

#[test]
fn gerstners_slopes_are_those_of_the_displaced_surface() {
    const STEP: f64 = 1e-6;
    let waves = [Wave::new(1.0, 0.7, 0.05), Wave::new(0.4, 0.7, 0.02).with_phase(2.0)];
    let along = DVec2::from_angle(0.7);
    for roundness in [0.0, 0.5, 1.0] {
        // All in one direction: where a point at rest moves to, and its height.
        let moved = |s: f64| {
            let to = |wave: &Wave| roundness * wave.amplitude * wave.angle(along * s).cos();
            s + waves.iter().map(to).sum::<f64>()
        };
        let height = |s: f64| waves.iter().map(|wave| wave.height(along * s)).sum::<f64>();
        for i in 0..40 {
            let s = 0.073 * f64::from(i);
            let wanted = -(height(s + STEP) - height(s - STEP)) / (moved(s + STEP) - moved(s - STEP));
            let got = gerstner_slope(&waves, along * s, roundness);
            assert!((got.dot(along) - wanted).abs() < 1e-6 && got.perp_dot(along).abs() < ROUNDING);
        }
    }
    // Crests are sharper than troughs.
    let wave = [Wave::new(1.0, 0.0, 0.1)];
    let slope = |angle: f64| gerstner_slope(&wave, DVec2::X * angle / TAU, 1.0).x;
    assert!(slope(TAU / 8.0).abs() > 2.0 * slope(-TAU / 8.0).abs());
}
