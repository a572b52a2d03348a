//! What the textures of a physically based material say: normals, roughness, anisotropy, occlusion and metalness.

mod common;

use common::compare::{EPS, compare_planes, expect};
use common::level::{Level, channel_of, combined, eigenvalues, layer, planes, stored};
use common::maps::{self, gentle_map, material_map, variances};
use common::{baked_with, options, oracle_of, pyramid_oracle};
use roughcast::texture::{Base, Layout, Part, RoughnessStored, TextureArray};
use roughcast::{
    BakeOptions, BaseRoughness, Bits, Lobe, PyramidFilter, RoughnessMap, RoughnessTexture, SampleType,
};

/// Roundings of averaging.
const AVERAGING: f64 = 24.0;

/// Sizes on and off the fused pass.
const SIZES: [(usize, usize); 3] = [(64, 64), (53, 37), (96, 40)];

fn part(arrays: &[TextureArray], part: Part) -> &TextureArray {
    arrays.iter().find(|array| array.info.part == part).unwrap_or_else(|| panic!("no file is the {part}"))
}

/// `α² = α0² + 2σ²` with `2σ² = tr Σ`, in every way to store it.
#[test]
fn a_materials_roughness_is_that_of_base_and_bumps() {
    /// Up to four roots and powers of a sum, relative; the pyramid's own roundings beside them.
    const ROUNDINGS: f64 = 60.0;
    for (width, height) in SIZES {
        let (image, source) = gentle_map(width, height);
        let material = material_map(width, height);
        let map = RoughnessMap { image: &material, channel: 1, stored: RoughnessStored::Perceptual };
        let mapped = variances(&material, 1, map.stored);
        for (base, variance) in [
            (None, vec![0.0; width * height]),
            (Some(BaseRoughness::Variance(0.02)), vec![f64::from(0.02_f32); width * height]),
            (Some(BaseRoughness::Map(map)), mapped),
        ] {
            let wanted =
                planes(&oracle_of(&image, &source, &variance), |t| t.covariance()[0] + t.covariance()[1]);
            for form in RoughnessStored::ALL {
                let bake_options =
                    BakeOptions { roughness_stored: *form, ..options(Layout::Pbr, Bits::Float) };
                let arrays = baked_with(&image, &source, base, &bake_options).arrays;
                let file = part(&arrays, Part::Roughness);
                let alpha_squared = combined([stored(&file.layers[0], "Y")], |[r]| match form {
                    RoughnessStored::Perceptual => r.powi(4),
                    RoughnessStored::Alpha => r * r,
                    RoughnessStored::AlphaSquared => r,
                    RoughnessStored::Gloss => (1.0 - r).powi(4),
                    RoughnessStored::SpecularPower => 2.0 / r,
                });
                // Gloss holds one minus the root of the width: its rounding is absolute, and the smallest widths have
                // their fourth power's worth of it.
                let allowed = |a: f64| ROUNDINGS * EPS * (a + a.max(EPS).powf(0.75));
                expect(compare_planes(&alpha_squared, &wanted, allowed).map(|_| ()), &(width, height, form));
                assert_eq!(file.info.base, if base.is_some() { Base::Baked } else { Base::None });
                check_normals(&arrays, &oracle_of(&image, &source, &variance));
            }
        }
    }
}

/// The normal texture holds the unit normal of the mean slope.
fn check_normals(arrays: &[TextureArray], wanted: &[Level]) {
    let texture = layer(part(arrays, Part::Normal), "normal");
    for (channel, component) in [("R", 0), ("G", 1), ("B", 2), ("A", 3)] {
        let wanted = planes(wanted, |t| {
            let length = (1.0 + t.b[0] * t.b[0] + t.b[1] * t.b[1]).sqrt();
            [t.b[0] / length, t.b[1] / length, 1.0 / length, 1.0][component]
        });
        let result = compare_planes(&stored(texture, channel), &wanted, |_| AVERAGING * EPS);
        expect(result.map(|_| ()), &channel);
    }
}

/// Roughness across, strength and direction, by KHR_materials_anisotropy's rule, give Σ back.
#[test]
fn an_anisotropic_material_gives_both_eigenvalues_and_the_direction_back() {
    /// Roots of differences of eigenvalues: roundings of the larger one, and of the slopes' squares.
    const TOLERANCE: f64 = 100.0 * EPS;
    for (width, height) in SIZES {
        let (image, source) = gentle_map(width, height);
        let base = f64::from(0.01_f32);
        let wanted = oracle_of(&image, &source, &vec![base; width * height]);
        let bake_options = BakeOptions {
            lobe: Lobe::Anisotropic,
            roughness_stored: RoughnessStored::Alpha,
            ..options(Layout::Pbr, Bits::Float)
        };
        let roughness = Some(BaseRoughness::Variance(base as f32));
        let arrays = baked_with(&image, &source, roughness, &bake_options).arrays;
        let across = stored(&part(&arrays, Part::Roughness).layers[0], "Y");
        let anisotropy = layer(part(&arrays, Part::Anisotropy), "anisotropy");
        let [x, y, strength] = ["R", "G", "B"].map(|name| stored(anisotropy, name));
        let along = combined([across.clone(), strength], |[b, s]| b + (1.0 - b) * s * s);
        let larger = combined([along.clone()], |[a]| a * a / 2.0);
        let smaller = combined([across.clone()], |[a]| a * a / 2.0);
        let by = |f: fn((f64, f64)) -> f64| planes(&wanted, move |t| f(eigenvalues(t.covariance())));
        expect(compare_planes(&larger, &by(|e| e.0), |_| TOLERANCE).map(|_| ()), &"larger");
        expect(compare_planes(&smaller, &by(|e| e.1), |_| TOLERANCE).map(|_| ()), &"smaller");
        // Σ = λ2 I + (λ1 - λ2) d dᵀ: the direction, without its sign and without trouble where both are equal.
        for (k, name) in ["xx", "yy", "xy"].iter().enumerate() {
            let rebuilt = combined([along.clone(), across.clone(), x.clone(), y.clone()], |[a, b, x, y]| {
                let (larger, smaller) = (a * a / 2.0, b * b / 2.0);
                let round = if k < 2 { smaller } else { 0.0 };
                round + (larger - smaller) * [x * x, y * y, x * y][k]
            });
            let covariance = planes(&wanted, |t| t.covariance()[k]);
            expect(compare_planes(&rebuilt, &covariance, |_| TOLERANCE).map(|_| ()), name);
        }
        let length = combined([x, y], |[x, y]| x * x + y * y);
        let one = combined([across], |_| 1.0);
        expect(compare_planes(&length, &one, |_| 8.0 * EPS).map(|_| ()), &"a direction has unit length");
    }
}

#[test]
fn grooves_point_their_direction_across_themselves() {
    for degrees in [0.0_f64, 30.0, 90.0, 135.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        // Slopes of both signs along one direction.
        let slopes: Vec<[f64; 2]> = (0..64)
            .map(|i| if (i % 8 + i / 8) % 2 == 0 { 0.3 } else { -0.3 })
            .map(|s| [s * cos, s * sin])
            .collect();
        let (image, source) = maps::slope_map(8, 8, &slopes);
        let bake_options = BakeOptions { lobe: Lobe::Anisotropic, ..options(Layout::Pbr, Bits::Float) };
        let arrays = baked_with(&image, &source, Some(BaseRoughness::Variance(0.001)), &bake_options).arrays;
        let anisotropy = layer(part(&arrays, Part::Anisotropy), "anisotropy");
        let at_the_end = |name: &str| stored(anisotropy, name).last().expect("there are levels").values[0];
        let along = at_the_end("R") * cos + at_the_end("G") * sin;
        assert!((along.abs() - 1.0).abs() < 1e-6, "{degrees}: {along}"); // f32 rounding of a unit vector
        assert!(at_the_end("B") > 0.5, "one direction only is strongly anisotropic");
    }
}

#[test]
fn a_packed_texture_keeps_occlusion_and_metalness() {
    let (image, source) = gentle_map(53, 37);
    let material = material_map(53, 37);
    let packed =
        BakeOptions { roughness_texture: RoughnessTexture::Packed, ..options(Layout::Pbr, Bits::Float) };
    let map = |image, channel| {
        BaseRoughness::Map(RoughnessMap { image, channel, stored: RoughnessStored::Perceptual })
    };
    let channels = |base: Option<BaseRoughness<'_>>| {
        let arrays = baked_with(&image, &source, base, &packed).arrays;
        let file = part(&arrays, Part::OcclusionRoughnessMetallic).clone();
        ["R", "G", "B", "A"].map(|name| stored(layer(&file, "orm"), name))
    };
    let alone =
        baked_with(&image, &source, Some(map(&material, 1)), &options(Layout::Pbr, Bits::Float)).arrays;
    let [occlusion, roughness, metalness, one] = channels(Some(map(&material, 1)));
    assert_eq!(roughness, stored(&part(&alone, Part::Roughness).layers[0], "Y"));
    for (got, channel) in [(occlusion, 0), (metalness, 2)] {
        let wanted = pyramid_oracle::pyramid(channel_of(&material, channel), PyramidFilter::Box, source.wrap);
        expect(compare_planes(&got, &wanted, |_| AVERAGING * EPS).map(|_| ()), &channel);
    }
    assert!(one.iter().all(|plane| plane.values.iter().all(|v| *v == 1.0)));
    // Where nothing says otherwise nothing is occluded and nothing is metal.
    let grey = maps::image(53, 37, 1, maps::samples(&maps::heights(53, 37, 35), SampleType::U8));
    for base in [None, Some(BaseRoughness::Variance(0.1)), Some(map(&grey, 0)), Some(map(&material, 0))] {
        let [occlusion, _, metalness, _] = channels(base);
        assert!(occlusion.iter().all(|plane| plane.values.iter().all(|v| *v == 1.0)), "{base:?}");
        assert!(metalness.iter().all(|plane| plane.values.iter().all(|v| *v == 0.0)), "{base:?}");
    }
}
