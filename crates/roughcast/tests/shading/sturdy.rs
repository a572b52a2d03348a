//! No lobe is NaN, infinite or negative, for any texels, options and directions.

use roughcast::shading::{
    BaseFrame, FootprintModel, FootprintRatio, Form, Masking, Repair, Shading, ShadingOptions,
    blinn_phong_surface, ggx_surface, ggx_visible_part,
};
use roughcast::texture::{Base, Packing, RoughnessStored, normal_moments};
use roughcast::{Anisotropy, Distribution, Slope};

use super::support::{Frame, Random, narrow, surface_of_texels};

const POWERS: [f32; 4] = [1.0, 100.0, 16_384.0, 1e5];

/// All options, each with a float packing for every statement about the maps.
fn all_options() -> Vec<(ShadingOptions, Packing)> {
    let mut all = Vec::new();
    for specular_power in POWERS {
        for form in Form::ALL.iter().copied() {
            for base_frame in BaseFrame::ALL.iter().copied() {
                for repair in Repair::ALL.iter().copied() {
                    for base_in_maps in Base::ALL.iter().copied() {
                        for roughness_stored in RoughnessStored::ALL.iter().copied() {
                            let options = ShadingOptions::default()
                                .with_specular_power(specular_power)
                                .with_form(form)
                                .with_base_frame(base_frame)
                                .with_repair(repair)
                                .with_masking(Masking::ALL[all.len() % 2])
                                .with_footprint(FootprintModel::Corrected);
                            let packing =
                                Packing { base: base_in_maps, roughness_stored, ..Packing::IDENTITY };
                            all.push((options, packing));
                        }
                    }
                }
            }
        }
    }
    all
}

/// Directions of half vectors: straight up, towards the bump, and nearly horizontal.
fn directions() -> Vec<[f32; 3]> {
    let mut all = vec![[0.0, 0.0, 1.0], [1.0, 0.0, 1e-6], [0.0, -1.0, 1e-20], [-1.0, 0.0, f32::MIN_POSITIVE]];
    all.push([1.0, 0.0, 1e-42]);
    all.extend([[0.3, 0.2], [-40.0, 90.0], [1e3, 1e4]].map(|slope| narrow(Frame::SURFACE.direction(slope))));
    all
}

fn check(shading: Shading, texels: &[[f32; 4]], packing: &Packing, options: &ShadingOptions) {
    let surface = surface_of_texels(shading, texels, &FootprintRatio::WHOLE, packing, options);
    assert!(surface.normal.iter().all(|v| v.is_finite()), "{shading} {texels:?}: {surface:?}");
    let directions = directions();
    for view in &directions {
        for light in &directions {
            let lobe = surface.lobe(*view, *light, options);
            let fine = lobe.is_finite() && lobe >= 0.0;
            assert!(fine, "{shading} {texels:?} {options:?}, {view:?} {light:?}: {lobe} of {surface:?}");
        }
    }
}

#[test]
fn extreme_texels_of_unsigned_textures() {
    let packing = Packing {
        slope: [256.0, -128.0],
        second: [16_384.0, 0.0],
        mixed: [32_768.0, -16_384.0],
        trace: [32_768.0, 0.0],
        spread: [16_384.0, 0.0],
        signed_spread: [32_768.0, -16_384.0],
        unit: [2.0, -1.0],
        ..Packing::IDENTITY
    };
    let ends = [0.0_f32, 0.5, 1.0];
    let mut random = Random(11);
    let options = all_options();
    for shading in Shading::ALL.iter().copied() {
        for _ in 0..400 {
            let reader = shading.layout().texel_reader(shading.wanted(), Anisotropy::Anisotropic);
            let inputs = reader.expect("a model samples its layout").inputs.len();
            let pick = |random: &mut Random| {
                if random.unit() < 0.7 { ends[(3.0 * random.unit()) as usize] } else { random.unit() as f32 }
            };
            let texels = (0..inputs).map(|_| [0; 4].map(|_| pick(&mut random))).collect::<Vec<_>>();
            let (options, of_maps) = options[(random.unit() * options.len() as f64) as usize];
            let Packing { base, roughness_stored, .. } = of_maps;
            check(shading, &texels, &Packing { base, roughness_stored, ..packing }, &options);
        }
    }
}

#[test]
fn the_roughest_lobe_is_finite_for_light_at_the_horizon() {
    // A stored exponent of 1e-3, the smallest that is used: its width is 45.
    let packing =
        Packing { base: Base::Baked, roughness_stored: RoughnessStored::SpecularPower, ..Packing::IDENTITY };
    let options = ShadingOptions::default();
    check(Shading::Ggx, &[[0.0, 0.0, 1.0, 1.0], [0.0; 4], [0.0; 4]], &packing, &options);
    let flat = Distribution::of_slope(Slope::default());
    let surface = ggx_surface(&flat, &options.with_specular_power(1e-3));
    for cosine in [1.2e-18, 1e-15, 1e-6] {
        let light = [1.0, 0.0, cosine];
        let part = ggx_visible_part(&surface, [0.0, 0.6, 0.8], light);
        assert!(part.is_finite() && part >= 0.0, "{cosine}: {part}");
    }
}

#[test]
fn a_mirror_with_its_base_baked_in_is_finite() {
    for shading in [Shading::Lean, Shading::Clean, Shading::Variance, Shading::Ggx] {
        for (options, packing) in all_options().into_iter().filter(|(_, packing)| packing.base == Base::Baked)
        {
            let texels = match shading {
                Shading::Lean => vec![[0.1, 0.0, 0.9, 0.0], [0.25, 0.0, 0.0625, 0.0]],
                Shading::Clean => vec![[0.25, 0.0, 0.0625, 1.0]],
                Shading::Variance => vec![[0.25, 0.0, 0.0, 0.0]],
                _ => vec![[0.0, 0.0, 1.0, 1.0], [0.0; 4], [0.0; 4]],
            };
            check(shading, &texels, &packing, &options);
        }
    }
    // When repaired it still shows a highlight; under the paper's rule it shows none.
    let h = narrow(Frame::SURFACE.direction([0.25, 0.0]));
    let lobe = |repair| {
        let options = ShadingOptions::default().with_repair(repair);
        let packing = Packing { base: Base::Baked, ..Packing::IDENTITY };
        let texels = [[0.1, 0.0, 0.9, 0.0], [0.25, 0.0, 0.0625, 0.0]];
        surface_of_texels(Shading::Lean, &texels, &FootprintRatio::WHOLE, &packing, &options)
            .lobe(h, h, &options)
    };
    assert!(lobe(Repair::Clamp) > 0.0);
    assert_eq!(lobe(Repair::Published), 0.0);
}

#[test]
fn invalid_covariances_are_repaired_or_show_nothing() {
    // M.xx below B.x²: a variance of -0.01, which a base of 1 / 256 does not compensate.
    let texels = [[0.1, 0.0, 0.9, 0.0], [0.25, 0.0, 0.0525, 0.01]];
    let h = narrow(Frame::SURFACE.direction([0.25, 0.0]));
    let lobe = |repair| {
        let options = ShadingOptions::default().with_repair(repair);
        surface_of_texels(Shading::Lean, &texels, &FootprintRatio::WHOLE, &Packing::IDENTITY, &options)
            .lobe(h, h, &options)
    };
    assert!(lobe(Repair::Clamp) > 0.0);
    assert_eq!(lobe(Repair::Published), 0.0);
}

#[test]
fn the_repair_keeps_valid_covariances() {
    let texels = [[0.1, 0.0, 0.9, 0.03], [0.25, 0.1, 0.1, 0.05]];
    let h = narrow(Frame::SURFACE.direction([0.3, 0.05]));
    let lobe = |repair| {
        let options = ShadingOptions::default().with_repair(repair).with_specular_power(1e5);
        surface_of_texels(Shading::Lean, &texels, &FootprintRatio::WHOLE, &Packing::IDENTITY, &options)
            .lobe(h, h, &options)
    };
    assert_eq!(lobe(Repair::Clamp), lobe(Repair::Published));
}

#[test]
fn steep_bumps_of_the_ground_truth_are_finite() {
    for shading in Shading::ALL.iter().copied() {
        for (options, _) in all_options() {
            for slope in [Slope { x: 128.0, y: 0.0 }, Slope { x: -90.0, y: 90.0 }, Slope::default()] {
                let surface = shading.surface_of_slope(slope, &options);
                for h in directions() {
                    let lobe = surface.lobe(h, h, &options);
                    assert!(lobe.is_finite() && lobe >= 0.0, "{shading} {slope:?} {options:?}: {lobe}");
                }
            }
        }
    }
}

#[test]
fn nothing_is_reflected_below_the_surface() {
    let options = ShadingOptions::default();
    let up = [0.0, 0.0, 1.0];
    for shading in Shading::ALL.iter().copied() {
        let surface = shading.surface_of_slope(Slope::default(), &options);
        assert!(surface.lobe(up, up, &options) > 0.0, "{shading}");
        for below in [[0.0, 0.6, -0.8], [1.0, 0.0, 0.0]] {
            assert_eq!(surface.lobe(below, up, &options), 0.0, "{shading}");
            assert_eq!(surface.lobe(up, below, &options), 0.0, "{shading}");
        }
    }
}

#[test]
fn a_normal_without_direction_is_flat() {
    let options = ShadingOptions::default();
    let zero = normal_moments([0.0; 3]);
    assert_eq!(blinn_phong_surface(&zero, &options).normal, [0.0, 0.0, 1.0]);
    let ggx = ggx_surface(&zero, &options);
    assert_eq!((ggx.normal, ggx.tangent), ([0.0, 0.0, 1.0], [1.0, 0.0, 0.0]));
}

#[test]
fn z_of_a_two_channel_normal_is_reconstructed() {
    let packing = Packing { unit: [2.0, -1.0], ..Packing::IDENTITY };
    let options = ShadingOptions::default();
    let normal = |texel| {
        surface_of_texels(Shading::Ggx, &[texel, [0.5; 4]], &FootprintRatio::WHOLE, &packing, &options).normal
    };
    let (two, three) = (normal([0.8, 0.5, 0.0, 1.0]), normal([0.8, 0.5, 0.9, 1.0]));
    for (a, b) in two.iter().zip(three) {
        assert!((a - b).abs() < 1e-6, "{two:?} {three:?}");
    }
}
