//! Runs every WGSL function of the shading library on the GPU for thousands of arguments and compares it with its Rust
//! twin.

#[path = "../common/mod.rs"]
mod common;
mod distribution_table;
mod footprint_table;
mod harness;
mod inputs;
mod layers_table;
mod noise_table;
mod surface_table;
mod table;
mod texel_table;
mod wave_table;

use std::collections::BTreeSet;

use common::gpu;
use harness::{Case, Twin, first_difference, library, modules, run, wanted_and_allowed};
use inputs::Inputs;
use pollster::block_on;
use roughcast_gpu::Gpu;
use table::twins;

/// Number of cases for each function.
const CASES: usize = 6000;

fn cases(twin: &Twin) -> Vec<Case> {
    let mut inputs = Inputs::new(11);
    let case = |_| {
        inputs.next_case();
        let arguments = (twin.arguments)(&mut inputs);
        Case { packing: inputs.packing, options: inputs.options, arguments }
    };
    (0..CASES).map(case).collect()
}

/// The first difference between a library and its Rust twin.
fn difference(gpu: &Gpu, library: &str, twin: &Twin) -> Option<String> {
    let cases = cases(twin);
    first_difference(twin, &cases, &block_on(run(gpu, library, twin, &cases)))
}

fn twin(name: &str) -> Twin {
    twins().into_iter().find(|twin| twin.name == name).expect("it is in the table")
}

#[test]
fn the_table_has_every_function_of_the_library_once() {
    let library = library();
    let functions: BTreeSet<&str> = library
        .split("\nfn ")
        .skip(1)
        .chain(library.strip_prefix("fn "))
        .filter_map(|text| text.split('(').next())
        .collect();
    assert!(functions.len() > modules().count(), "more functions than modules: {functions:?}");
    let twins = twins();
    let tested: BTreeSet<&str> = twins.iter().map(|twin| twin.name).collect();
    assert_eq!(functions, tested);
    assert_eq!(tested.len(), twins.len());
    for twin in twins {
        assert!(twin.call.contains(&format!("{}(", twin.name)), "{}", twin.name);
    }
}

#[test]
fn every_function_gives_what_its_rust_twin_gives() {
    let (gpu, library) = (gpu(), library());
    let differences: Vec<String> =
        twins().iter().filter_map(|twin| difference(&gpu, &library, twin)).collect();
    assert!(differences.is_empty(), "{}", differences.join("\n"));
}

#[test]
fn the_cases_of_every_lobe_include_its_highlight() {
    // Otherwise a twin that always returns zero would pass.
    const LEAST: f64 = 0.2;
    for twin in twins().iter().filter(|twin| twin.name.ends_with("_lobe")) {
        let cases = cases(twin);
        let value = |case: &Case| (twin.rust)(&case.arguments, &case.options, &case.packing)[0];
        let bright = cases.iter().filter(|case| value(case) > 1e-6).count();
        assert!(bright as f64 > LEAST * CASES as f64, "{}: {bright}", twin.name);
    }
}

/// Largest fraction of a function's results whose tolerance may exceed a hundredth of the value, because the function
/// is ill-conditioned there.
fn far_results_allowed(name: &str) -> f64 {
    match name {
        // Differences between moments of steep slopes; one slope in ten reaches up to 128.
        "lean_moments" => 0.15,
        "clean_moments" => 0.06,
        // For a third of the texels z follows from x and y, which determine the z of a steep normal poorly.
        "pbr_normal" => 0.2,
        "pbr_moments" => 0.12,
        // Covariances of rank one (one case in ten): their determinants and their smaller variances.
        "slope_gaussian" => 0.006,
        "shaded_gaussian" | "gaussian_surface" => 0.0015,
        "mixture_surface" => 0.001,
        "principal_axes" => 0.05,
        "ggx_surface" => 0.02,
        // A tangent across a normal that is nearly in the surface, a slope of one.
        "ggx_facet" | "off_centre_surface" => 0.015,
        // Components that happen to be close to zero.
        "surface_gradient" | "surface_gradient_of_volume" | "surface_gradient_of_normal" => 6e-4,
        "surface_gradient_of_neighbours" | "displaced_normal" | "blinn_normal" => 3e-4,
        // A change that is small beside the distance of the ray.
        "position_derivative" => 0.006,
        "transformed_gaussian"
        | "distribution_sum"
        | "sum_of_bumps"
        | "transformed_bumps"
        | "any_tangents" => 8e-5,
        "texture_gradients" | "slope_matrix" => 5e-5,
        "transformed_distribution" => 2e-5,
        // Means that nearly cancel.
        "weighted_covariance" => 2e-4,
        "whole_gaussian" => 1e-4,
        "pixel_mixture" => 2e-5,
        // Nearly circular footprints have no longer axis.
        "footprint_axes" => 1e-3,
        // Magnifications close to zero.
        "footprint_ratio" => 0.02,
        // Stored normals whose value is a small difference between code and offset.
        "bump_normal" | "toksvig_normal" => 0.004,
        "schilling_moments" | "toksvig_moments" => 0.002,
        // Flanks of the narrowest lobes: their exponents multiply the rounding errors of the half vectors.
        "blinn_phong_lobe" | "beckmann_lobe" | "mixture_lobe" | "gaussian_lobe" => 0.006,
        "ggx_lobe" => 1e-3,
        // Values and slopes of noise near their zeros, and those far from the origin in the finest octaves.
        "noise_blend" => 2e-4,
        "gradient_noise" => 0.003,
        "noise_octave" | "noise_sample" => 0.02,
        "noise_height" => 0.008,
        // And what large footprints leave of slopes, or small ones hide: little, of the size of the roundings of one.
        "noise_distribution" => 0.15,
        "noise_kept" => 0.04,
        // Nearly round footprints have no longer axis.
        "noise_footprint" => 5e-4,
        // Sines near their zeros, and what large footprints leave of waves, or small ones hide.
        "sine_of_turns" | "wave_turns" => 0.001,
        "cosine_of_turns" | "wave_height" => 0.002,
        "wave_slope" | "gerstner_part" => 0.006,
        "wave_distribution" => 0.3,
        // Kernels near their ends.
        "gabor_kernel" | "gabor_kernels" | "gabor_sample" => 0.02,
        // Means and products that nearly cancel, and normals with a component near zero.
        "cross_moments" | "blend_partial_derivatives" => 3e-4,
        "blend_reoriented" => 1e-4,
        "masked_layers" => 3e-5,
        _ => 0.0,
    }
}

/// The fraction of a function's results whose tolerance exceeds a hundredth of the value.
fn far_results(twin: &Twin) -> f64 {
    const FAR: f32 = 0.01;
    let (mut results, mut far) = (0_u32, 0_u32);
    for case in cases(twin) {
        let (wanted, allowed) = wanted_and_allowed(twin, &case);
        for (wanted, allowed) in wanted.iter().zip(&allowed).filter(|(wanted, _)| wanted.abs() > 1e-6) {
            results += 1;
            far += u32::from(*allowed > FAR * wanted.abs());
        }
    }
    f64::from(far) / f64::from(results)
}

#[test]
fn few_results_have_loose_tolerances() {
    /// A limit this many times the measured value is too loose.
    const LOOSEST: f64 = 4.0;
    let mut faults = Vec::new();
    for twin in twins() {
        let (far, allowed) = (far_results(&twin), far_results_allowed(twin.name));
        if far > allowed {
            faults.push(format!("{}: {far} of the results may be far off, and not {allowed}", twin.name));
        }
        if allowed > LOOSEST * far {
            faults.push(format!("{}: the limit {allowed} is loose for {far}", twin.name));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn wrong_twins_are_detected() {
    let (gpu, right) = (gpu(), library());
    // Typical mistakes: a wrong sign, a wrong factor, a swapped axis, a forgotten normalisation, a wrong form, a
    // missing clamp and too coarse a rounding.
    let mistakes = [
        ("gaussian_lobe", "d.y - surface.covariance * inverse_xx", "d.y + surface.covariance * inverse_xx"),
        ("mixture_lobe", "rest * rest * (surface.variance.x", "rest * rest * (surface.variance.y"),
        ("squared_deviations", "1.0 / surface.variance.x", "1.0 / surface.variance.y"),
        ("lean_moments", "fma(-mean.xyx, mean.xyy, moments)", "moments"),
        ("clean_moments", "0.5 * max(trace, 0.0)", "max(trace, 0.0)"),
        ("positive_semidefinite", "sqrt(variances.x) * sqrt(variances.y)", "variances.x * variances.y"),
        ("base_covariance", "slope.x * slope.y);", "-slope.x * slope.y);"),
        (
            "ggx_lobe",
            "cross(surface.normal, surface.tangent), h) / surface.alpha_across",
            "cross(surface.normal, surface.tangent), h) / surface.alpha_along",
        ),
        ("pbr_moments", "anisotropy.z * anisotropy.z", "anisotropy.z"),
        ("ggx_surface", "mean - radius, radius", "mean + radius, radius"),
        (
            "principal_axes",
            "vec2f(sigma.z, radius - half_difference)",
            "vec2f(-sigma.z, radius - half_difference)",
        ),
        ("mixture_lobe", "surface.weights.z *", "surface.weights.y *"),
        ("whole_gaussian", "gaussian.weight * (vec3f(", "(vec3f("),
        ("schilling_moments", "d13.x * d13.x + d2 * d2", "d13.x * d13.x"),
        ("specular_radiance", "dot(view, normalize(view + light))", "dot(view, view + light)"),
        ("beckmann_lobe", "0.5 * surface.specular_power", "surface.specular_power"),
        ("cosine_lobe", "(exponent + 2.0)", "(exponent + 1.0)"),
        ("phong_lobe", "2.0 * dot(surface.normal, view)", "dot(surface.normal, view)"),
        ("toksvig_moments", "(gloss * options.specular_power)", "options.specular_power"),
        ("specular_radiance", "0.25 * light.z", "0.25 * view.z"),
        ("diffuse_radiance", "max(dot(normal, light), 0.0)", "dot(normal, light)"),
        ("log_one_plus", "select(log(1.0 + x), 2.0 * z * series, x < 0.5)", "log(1.0 + x)"),
        ("cosine_power", "exp(-0.5 * exponent * log_one_plus(tangent_squared))", "pow(cosine, exponent)"),
        ("schlick", "square * square * rest", "square * square"),
        ("gaussian_lambda", "let width = sqrt(2.0 * variance)", "let width = sqrt(variance)"),
        ("gaussian_visible_part", "projected_variance(sigma, light)", "projected_variance(sigma, view)"),
        ("facet_visible_part", "1.0 - of_light * of_light", "1.0 - of_light"),
        ("ggx_lambda", "sqrt(cosine * cosine + squared)", "sqrt(cosine + squared)"),
        (
            "visible_part",
            "1.0 + lambda_of_view + lambda_of_light",
            "(1.0 + lambda_of_view) * (1.0 + lambda_of_light)",
        ),
        ("footprint_axes", "vec2f(-u.y, u.x)", "vec2f(u.y, u.x)"),
        ("level_variances", "power / 4.0 - 1.0 / 12.0", "power / 4.0"),
        ("hardware_variances", "1.0 / (taps * taps)", "1.0 / taps"),
        ("pixel_part", "min(variances, pixel)", "pixel"),
        (
            "surface_gradient",
            "basis[0] * height_s + basis[1] * height_t",
            "basis[0] * height_s - basis[1] * height_t",
        ),
        ("surface_basis", "cross(sigma_t, normal)", "cross(normal, sigma_t)"),
        ("surface_gradient_of_volume", "gradient - normal * dot(normal, gradient)", "gradient"),
        ("blinn_normal", "tilt / length(normal)", "tilt"),
        ("slope_matrix", "gradients[0] * -height_per_uv.x", "gradients[0] * height_per_uv.x"),
        ("geometric_covariance", "bent * ((limit - smaller) / apart)", "bent * (limit / apart)"),
        ("transformed_gaussian", "new_from_old * sigma * transpose(new_from_old)", "new_from_old * sigma"),
        (
            "distribution_sum",
            "filtered_slope(one.normal) + filtered_slope(other.normal)",
            "filtered_slope(one.normal)",
        ),
        ("pixel_distribution", "part, base_in_map(filtered.base, options)", "part, 0.0"),
        ("pixel_covariance", "(1.0 - ratio.magnified) * pixel_factor", "pixel_factor"),
        (
            "footprint_ratio",
            "0.5 * log2(1.0 + 12.0 * filtered.variances.x)",
            "log2(1.0 + 12.0 * filtered.variances.x)",
        ),
        ("gradient_noise", "30.0 * hump * hump", "30.0 * hump"),
        ("noise_sample", "noise.seed + octave", "noise.seed"),
        ("noise_octave", "sign(value.w) * value", "abs(value)"),
        ("noise_kept", "max(footprint.centre - swing, vec2f(0.0))", "vec2f(footprint.centre)"),
        ("noise_distribution", "c.y * g.x - c.x * g.y", "c.x * g.y - c.y * g.x"),
        ("sine_of_turns", "-1.0 / 5040.0 + s *", "s *"),
        ("wave_slope", "return -wave.z", "return wave.z"),
        ("wave_distribution", "0.5 * (1.0 + squared)", "0.5"),
        (
            "gerstner_part",
            "roundness * sine_of_turns(turns) * length(wave.xy)",
            "roundness * sine_of_turns(turns)",
        ),
        ("gabor_cell_hash", "((cell % side) + side) % side", "cell % side"),
        ("gabor_impulse_count", "gabor_hash(hash + count)", "hash + count"),
        ("gabor_kernel", "2.0 * GABOR_EXPONENT", "GABOR_EXPONENT"),
        ("gabor_sample", "noise.cells * heights.xy", "heights.xy"),
        ("cross_moments", "a.x * b.y + b.x * a.y", "a.x * b.y"),
        ("cross_covariance", "fma(-2.0 * mean_a, mean_b, raw.xy)", "fma(-mean_a, mean_b, raw.xy)"),
        ("scaled_distribution", "with_power_of_length(scaled, factor * factor)", "scaled"),
        ("correlated_layers", "max((sigma.x + sigma.y) / before, 0.0)", "1.0"),
        (
            "without_base",
            "select(0.0, variance, distribution.base == MAPS_WITH_BASE)",
            "select(variance, 0.0, distribution.base == MAPS_WITH_BASE)",
        ),
        ("masked_gaussian", "second_moments / mask", "second_moments"),
        ("masked_layers", "masks.y / area", "masks.y"),
        ("blend_reoriented", "vec3f(-detail.xy, detail.z)", "detail"),
        (
            "blend_whiteout",
            "vec3f(base.xy + detail.xy, base.z * detail.z)",
            "vec3f(base.xy + detail.xy, base.z)",
        ),
    ];
    for (name, from, to) in mistakes {
        assert_eq!(right.matches(from).count(), 1, "{from}");
        let wrong = right.replace(from, to);
        assert!(difference(&gpu, &wrong, &twin(name)).is_some(), "{name} with {to} is not caught");
    }
}
