//! The contents of a physically based material's textures: normals, roughness, anisotropy, occlusion and metalness.

mod common;

use common::compare::{EPS, compare_planes, expect};
use common::level::{Level, channel_of, combined, eigenvalues, layer, planes, stored};
use common::maps::{self, gentle_map, material_map, variances};
use common::{baked_with, options, oracle_of, pyramid_oracle};
use roughcast::texture::{Base, Layout, Part, RoughnessStored, TextureArray, decode};
use roughcast::{
    AnisotropyOutput, BakeOptions, BaseRoughness, Image, NormalRange, PbrOptions, PyramidFilter,
    RoughnessMap, RoughnessTexture, SampleType,
};

/// Relative rounding of averaging.
const AVERAGING: f64 = 24.0;

/// Sizes that use the fused pass, and sizes that do not.
const SIZES: [(usize, usize); 3] = [(64, 64), (53, 37), (96, 40)];

/// Floats that hold all values exactly, with roughness in a separate texture.
fn floats() -> BakeOptions {
    with_choices(
        SampleType::F32,
        PbrOptions::default()
            .with_roughness_texture(RoughnessTexture::Alone)
            .with_normal_range(NormalRange::Signed),
    )
}

/// The layout `pbr` with these choices.
fn with_choices(bits: SampleType, pbr: PbrOptions) -> BakeOptions {
    options(Layout::Pbr, bits).with_pbr(pbr)
}

/// [`floats`] with direction and strength of the anisotropy.
fn anisotropic_floats() -> BakeOptions {
    let plain = floats();
    plain.with_pbr(plain.pbr.with_anisotropy(Some(AnisotropyOutput::Khr)))
}

fn part(arrays: &[TextureArray], part: Part) -> &TextureArray {
    arrays.iter().find(|array| array.info.part == part).unwrap_or_else(|| panic!("no file is the {part}"))
}

/// `α² = α0² + 2σ²` with `2σ² = tr Σ`, for every way to store it.
#[test]
fn the_roughness_of_a_material_includes_base_and_bumps() {
    /// Up to four roots and powers of a sum, relative, in addition to the pyramid's own roundings.
    const ROUNDINGS: f64 = 60.0;
    for (width, height) in SIZES {
        let (image, source) = gentle_map(width, height);
        let material = material_map(width, height);
        let map = RoughnessMap { image: material.view(), channel: 1, stored: RoughnessStored::Perceptual };
        let mapped = variances(&material, 1, map.stored);
        for (base, variance) in [
            (None, vec![0.0; width * height]),
            (Some(BaseRoughness::Variance(0.02)), vec![f64::from(0.02_f32); width * height]),
            (Some(BaseRoughness::Map(map)), mapped),
        ] {
            let wanted =
                planes(&oracle_of(&image, &source, &variance), |t| t.covariance()[0] + t.covariance()[1]);
            for form in RoughnessStored::ALL {
                let pbr = floats().pbr.with_roughness_stored(*form);
                let bake_options = floats().with_pbr(pbr);
                let arrays = baked_with(&image, &source, base, &bake_options).arrays;
                let file = part(&arrays, Part::Roughness);
                let alpha_squared = combined([stored(&file.layers()[0], "Y")], |[r]| match form {
                    RoughnessStored::Perceptual => r.powi(4),
                    RoughnessStored::Alpha => r * r,
                    RoughnessStored::AlphaSquared => r,
                    RoughnessStored::Gloss => (1.0 - r).powi(4),
                    RoughnessStored::SpecularPower => 2.0 / r,
                    other => panic!("say what {other} means"),
                });
                // Gloss stores one minus the square root of the width: its rounding is absolute, and α² is the fourth
                // power of that root, which matters for the smallest widths.
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

/// Larger roughness, strength and direction reproduce Σ by KHR_materials_anisotropy's rule.
#[test]
fn an_anisotropic_material_gives_both_eigenvalues_and_the_direction_back() {
    /// Roots of differences of eigenvalues: roundings of the larger eigenvalue and of the squared slopes.
    const TOLERANCE: f64 = 100.0 * EPS;
    for (width, height) in SIZES {
        let (image, source) = gentle_map(width, height);
        let base = f64::from(0.01_f32);
        let wanted = oracle_of(&image, &source, &vec![base; width * height]);
        let pbr = anisotropic_floats().pbr.with_roughness_stored(RoughnessStored::Alpha);
        let bake_options = floats().with_pbr(pbr);
        let roughness = Some(BaseRoughness::Variance(base as f32));
        let arrays = baked_with(&image, &source, roughness, &bake_options).arrays;
        let across = stored(&part(&arrays, Part::Roughness).layers()[0], "Y");
        let anisotropy = layer(part(&arrays, Part::Anisotropy), "anisotropy");
        let [x, y, strength] = ["R", "G", "B"].map(|name| stored(anisotropy, name));
        let along = combined([across.clone(), strength], |[b, s]| b + (1.0 - b) * s * s);
        let larger = combined([along.clone()], |[a]| a * a / 2.0);
        let smaller = combined([across.clone()], |[a]| a * a / 2.0);
        let by = |f: fn((f64, f64)) -> f64| planes(&wanted, move |t| f(eigenvalues(t.covariance())));
        expect(compare_planes(&larger, &by(|e| e.0), |_| TOLERANCE).map(|_| ()), &"larger");
        expect(compare_planes(&smaller, &by(|e| e.1), |_| TOLERANCE).map(|_| ()), &"smaller");
        // Σ = λ2 I + (λ1 - λ2) d dᵀ, which tests the direction without its sign, and without ambiguity if both
        // eigenvalues are equal.
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
        let bake_options = anisotropic_floats();
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
    let packed = with_choices(SampleType::F32, floats().pbr.with_roughness_texture(RoughnessTexture::Packed));
    let map = |image, channel| {
        BaseRoughness::Map(RoughnessMap { image, channel, stored: RoughnessStored::Perceptual })
    };
    let channels = |base: Option<BaseRoughness<'_>>| {
        let arrays = baked_with(&image, &source, base, &packed).arrays;
        let file = part(&arrays, Part::OcclusionRoughnessMetallic).clone();
        ["R", "G", "B", "A"].map(|name| stored(layer(&file, "orm"), name))
    };
    let alone = baked_with(&image, &source, Some(map(material.view(), 1)), &floats()).arrays;
    let [occlusion, roughness, metalness, one] = channels(Some(map(material.view(), 1)));
    assert_eq!(roughness, stored(&part(&alone, Part::Roughness).layers()[0], "Y"));
    for (got, channel) in [(occlusion, 0), (metalness, 2)] {
        let wanted = pyramid_oracle::pyramid(channel_of(&material, channel), PyramidFilter::Box, source.wrap);
        expect(compare_planes(&got, &wanted, |_| AVERAGING * EPS).map(|_| ()), &channel);
    }
    assert!(one.iter().all(|plane| plane.values.iter().all(|v| *v == 1.0)));
    // Without further data nothing is occluded and nothing is metallic.
    let grey = maps::image(53, 37, 1, maps::samples(&maps::heights(53, 37, 35), SampleType::U8));
    for base in
        [None, Some(BaseRoughness::Variance(0.1)), Some(map(grey.view(), 0)), Some(map(material.view(), 0))]
    {
        let [occlusion, _, metalness, _] = channels(base);
        assert!(occlusion.iter().all(|plane| plane.values.iter().all(|v| *v == 1.0)), "{base:?}");
        assert!(metalness.iter().all(|plane| plane.values.iter().all(|v| *v == 0.0)), "{base:?}");
    }
}

/// glTF and three.js read roughness from green; a one-channel file would give them 0, a mirror.
#[test]
fn roughness_is_in_the_channel_of_its_layout() {
    let (image, source) = gentle_map(16, 16);
    for bits in [SampleType::U8, SampleType::U16, SampleType::F16] {
        let baked = |roughness_texture| {
            let options = with_choices(bits, PbrOptions::default().with_roughness_texture(roughness_texture));
            baked_with(&image, &source, Some(BaseRoughness::Variance(0.01)), &options).arrays
        };
        let alone = baked(RoughnessTexture::Alone);
        let roughness = part(&alone, Part::Roughness).layers()[0].levels();
        assert_eq!(PbrOptions::default().roughness_texture, RoughnessTexture::Green);
        for (layout, name) in [
            (RoughnessTexture::Green, Part::Roughness),
            (RoughnessTexture::Packed, Part::OcclusionRoughnessMetallic),
        ] {
            let arrays = baked(layout);
            let levels = part(&arrays, name).layers()[0].levels();
            for (level, wanted) in levels.iter().zip(roughness) {
                assert_eq!((level.channels(), wanted.channels()), (4, 1));
                for (x, y) in (0..level.height()).flat_map(|y| (0..level.width()).map(move |x| (x, y))) {
                    let texel = [0, 1, 2, 3].map(|channel| level.get(x, y, channel));
                    assert_eq!(texel, [1.0, wanted.get(x, y, 0), 0.0, 1.0], "{layout} in {bits}");
                }
            }
            assert_eq!(decode(&arrays), decode(&alone), "all layouts decode to the same");
        }
    }
}

/// Mitsuba, Blender and glTF's tools read `n / 2 + 1/2` from floats, too.
#[test]
fn floats_store_normals_in_the_range_of_their_metadata() {
    let (image, source) = gentle_map(16, 16);
    for bits in [SampleType::F16, SampleType::F32] {
        let baked = |normal_range| {
            let anisotropy = Some(AnisotropyOutput::Khr);
            let pbr = PbrOptions::default().with_normal_range(normal_range).with_anisotropy(anisotropy);
            baked_with(&image, &source, None, &with_choices(bits, pbr)).arrays
        };
        let (unorm, signed) = (baked(NormalRange::Unorm), baked(NormalRange::Signed));
        assert_eq!(PbrOptions::default().normal_range, NormalRange::Unorm);
        // Three roundings to the type's 11 or 24 bits: of both stored values, and of half of one.
        let rounding = if bits == SampleType::F16 { 1.5 / 1024.0 } else { 3.0 * f32::EPSILON };
        for name in [Part::Normal, Part::Anisotropy] {
            let levels = |arrays| part(arrays, name).layers()[0].levels().to_vec();
            for (unorm, signed) in levels(&unorm).iter().zip(levels(&signed)) {
                for (x, y) in (0..unorm.height()).flat_map(|y| (0..unorm.width()).map(move |x| (x, y))) {
                    for channel in 0..2 {
                        let wanted = 0.5 * signed.get(x, y, channel) + 0.5;
                        assert!((unorm.get(x, y, channel) - wanted).abs() <= rounding, "{name} in {bits}");
                    }
                }
            }
        }
        assert_eq!(part(&unorm, Part::Normal).info.normal_range, NormalRange::Unorm);
        // The slope of a stored normal changes by 1 + b² times its component's error; b is at most 1 in this map.
        let (from_unorm, from_signed) = (decode(&unorm).expect("parts"), decode(&signed).expect("parts"));
        for (a, b) in
            from_unorm.iter().zip(&from_signed).flat_map(|(a, b)| a.moments().iter().zip(b.moments()))
        {
            let off = (a.mean.x - b.mean.x).abs().max((a.mean.y - b.mean.y).abs());
            assert!(off <= 8.0 * rounding, "{bits}: {off}");
        }
    }
}

/// Renderers with a roughness for each axis of the tangent frame: α² = 2 Σ along each.
#[test]
fn widths_along_the_axes_match_the_variances() {
    let (image, source) = gentle_map(32, 32);
    let base = 0.01_f32;
    let pbr = floats().pbr.with_anisotropy(Some(AnisotropyOutput::Alpha));
    let bake_options = floats().with_pbr(pbr);
    let arrays = baked_with(&image, &source, Some(BaseRoughness::Variance(base)), &bake_options).arrays;
    let wanted = oracle_of(&image, &source, &vec![f64::from(base); 32 * 32]);
    for (axis, name) in [Part::AlphaX, Part::AlphaY].into_iter().enumerate() {
        let squared =
            combined([stored(&part(&arrays, name).layers()[0], "Y")], |[alpha]| alpha * alpha / 2.0);
        let variance = planes(&wanted, |texel| texel.covariance()[axis]);
        expect(compare_planes(&squared, &variance, |_| AVERAGING * EPS).map(|_| ()), &name);
    }
    let isotropic = baked_with(&image, &source, Some(BaseRoughness::Variance(base)), &floats()).arrays;
    let roughness = |arrays| part(arrays, Part::Roughness).layers()[0].levels().to_vec();
    assert_eq!(roughness(&arrays), roughness(&isotropic), "the roughness of both axes is still there");
    let decoded = decode(&arrays).expect("all parts");
    let variances = decoded.iter().flat_map(|level| level.moments()).map(|m| m.covariance());
    let of_oracle = wanted.iter().flat_map(|level| level.texels()).map(|texel| texel.covariance());
    for (got, [xx, yy, _]) in variances.zip(of_oracle) {
        assert!(
            (f64::from(got.xx) - xx).abs() < AVERAGING * EPS
                && (f64::from(got.yy) - yy).abs() < AVERAGING * EPS
        );
    }
}

/// A bilinear lookup at a point of the unit square, without wrapping: the tests stay away from the edge.
fn bilinear(image: &Image, u: f64, v: f64) -> [f64; 2] {
    let (x, y) = (u * image.width() as f64 - 0.5, v * image.height() as f64 - 0.5);
    let (x0, y0) = (x.floor(), y.floor());
    let (s, t) = (x - x0, y - y0);
    [0, 1].map(|channel| {
        let at = |dx: usize, dy: usize| f64::from(image.get(x0 as usize + dx, y0 as usize + dy, channel));
        let row = |dy: usize| at(0, dy) * (1.0 - s) + at(1, dy) * s;
        2.0 * (row(0) * (1.0 - t) + row(1) * t) - 1.0
    })
}

/// Circular brushing: its axis turns slowly through all directions, so that no single reference axis works everywhere.
/// A filter must find the axis between any texels, and between levels.
#[test]
fn directions_of_a_brushed_disc_survive_filtering() {
    const SIDE: usize = 128;
    /// Minimum distance of a lookup from the middle, in texels of the coarser level: there the axis turns by an eighth
    /// of a radian per texel.
    const CLEAR: f64 = 8.0;
    /// The turn within a texel, the effect of unequal slopes under it, and one 8-bit code.
    const TOLERANCE_DEGREES: f64 = 9.0;
    /// Averaging unit vectors within an eighth of a radian of each other hardly shortens them.
    const LEAST_LENGTH: f64 = 0.95;
    let radial = |u: f64, v: f64| (0.5 - v).atan2(u - 0.5);
    // Slopes of both signs along the radius.
    let slopes: Vec<[f64; 2]> = (0..SIDE * SIDE)
        .map(|i| {
            let (x, y) = (i % SIDE, i / SIDE);
            let angle = radial((x as f64 + 0.5) / SIDE as f64, (y as f64 + 0.5) / SIDE as f64);
            let sign = if (x + y) % 2 == 0 { 0.3 } else { -0.3 };
            [sign * angle.cos(), sign * angle.sin()]
        })
        .collect();
    let (image, source) = maps::slope_map(SIDE, SIDE, &slopes);
    for bits in [SampleType::U8, SampleType::U16, SampleType::F16] {
        let anisotropy = Some(AnisotropyOutput::Khr);
        let bake_options = with_choices(bits, PbrOptions::default().with_anisotropy(anisotropy));
        let arrays = baked_with(&image, &source, Some(BaseRoughness::Variance(0.001)), &bake_options).arrays;
        let levels = part(&arrays, Part::Anisotropy).layers()[0].levels();
        let mut looked_up = 0;
        for pair in levels.windows(2) {
            let texel = 1.0 / pair[1].width() as f64;
            // Points between the texels of the finer level, two per texel.
            let steps = 2 * pair[0].width();
            for (i, j) in (0..steps).flat_map(|j| (0..steps).map(move |i| (i, j))) {
                let (u, v) = (i as f64 / steps as f64, j as f64 / steps as f64);
                let radius = (u - 0.5).hypot(v - 0.5);
                if radius < CLEAR * texel || [u, v].iter().any(|at| *at < texel || *at > 1.0 - texel) {
                    continue;
                }
                let (fine, coarse) = (bilinear(&pair[0], u, v), bilinear(&pair[1], u, v));
                for weight in [0.0, 0.5, 1.0] {
                    let [x, y] = [0, 1].map(|k| fine[k] * (1.0 - weight) + coarse[k] * weight);
                    let off = (y.atan2(x) - radial(u, v)).sin().abs().asin().to_degrees();
                    assert!(
                        off < TOLERANCE_DEGREES && x.hypot(y) > LEAST_LENGTH,
                        "{bits}, {} at {u} {v}: {off} degrees off, length {}",
                        pair[0].width(),
                        x.hypot(y)
                    );
                    looked_up += 1;
                }
            }
        }
        assert!(looked_up > 100_000, "{looked_up}");
    }
}

/// Toksvig's factor is baked for one exponent, which is stored in the file; if the exponent varies, compressed textures
/// store the length of the normal as well as the factor.
#[test]
fn the_variance_of_toksvig_is_decoded_from_its_parts_for_any_base() {
    use roughcast::Blocks;
    let (image, source) = gentle_map(32, 32);
    let material = material_map(32, 32);
    let varies = BaseRoughness::Map(RoughnessMap {
        image: material.view(),
        channel: 1,
        stored: RoughnessStored::Perceptual,
    });
    for base in [BaseRoughness::Variance(1.0 / 64.0), varies] {
        let bits = SampleType::U8;
        let whole = baked_with(&image, &source, Some(base), &options(Layout::Toksvig, bits));
        let shaped = options(Layout::Toksvig, bits).with_blocks(Blocks::Bc);
        let parts = baked_with(&image, &source, Some(base), &shaped);
        assert_eq!(whole.arrays[0].info.base, Base::Baked, "the factor holds the base");
        let power = matches!(base, BaseRoughness::Variance(_)).then_some(64.0);
        assert_eq!(whole.arrays[0].info.specular_power(), power);
        let bound = whole.report.bounds.variance + parts.report.bounds.variance;
        assert!(bound.is_finite());
        let (from_whole, from_parts) =
            (decode(&whole.arrays).expect("one"), decode(&parts.arrays).expect("two"));
        let mut largest = 0.0_f32;
        for (a, b) in
            from_whole.iter().zip(&from_parts).flat_map(|(a, b)| a.moments().iter().zip(b.moments()))
        {
            let (a, b) = (a.covariance().xx, b.covariance().xx);
            assert!((a - b).abs() <= bound, "{a} and {b}");
            largest = largest.max(b);
        }
        assert!(largest > 0.04, "the map's bumps are there: {largest}");
    }
}
