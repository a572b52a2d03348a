//! The three ways of the paper, on every level of every map.

use roughcast::layers::*;
use roughcast::{Covariance, Distribution, Moments, PyramidFilter, Slope, Wrap};

use crate::common::compare::{EPS, expect};
use crate::common::level::{Level, Texel, from_decoded};
use crate::common::maps::Random;
use crate::common::slope_oracle::Slopes;
use crate::support::*;

const BOX: PyramidFilter = PyramidFilter::Box;

#[test]
fn the_joint_map_and_mixing_textures_are_the_filtered_mix_on_every_level() {
    for maps in cases() {
        let weights = weights(maps.maps.len());
        let largest = largest_moment(&maps.slopes());
        for filter in PyramidFilter::ALL {
            for wrap in [Wrap::Repeat, Wrap::Mirror] {
                let wanted = oracle(&maps, &weights, *filter, wrap);
                let layers = Layers::new(maps.layers(&weights)).filter(*filter).wrap(wrap);
                let joint = layers.joint().expect("valid").moments(*filter, wrap);
                let what = (maps.name, filter, wrap);
                expect(compare(&joint, &wanted, largest), &("joint", what));
                let mixed = by_mixing_textures(&layers, &weights, *filter, wrap).expect("valid");
                expect(compare(&mixed, &wanted, largest), &("mixing textures", what));
                assert_eq!(layers.mixing_textures().expect("valid").len(), pair_count(maps.maps.len()));
            }
        }
    }
}

#[test]
fn weights_that_change_need_no_new_mixing_textures() {
    for maps in cases() {
        let count = maps.maps.len();
        let layers = Layers::new(maps.layers(&weights(count)));
        let (mixing, levels) = (layers.mixing_textures().expect("valid"), alone(&layers, BOX, Wrap::Repeat));
        let mut random = Random(1);
        for _ in 0..5 {
            let parts: Vec<f64> = (0..count).map(|_| random.signed()).collect();
            let rest = (1.0 - parts.iter().sum::<f64>()) / count as f64;
            let weights: Vec<f32> = parts.iter().map(|part| (part + rest) as f32).collect();
            let wanted = oracle(&maps, &weights, BOX, Wrap::Repeat);
            let mixed = mixed_levels(&weighted(&weights, &levels), &mixing).expect("they sum to one");
            let largest = largest_moment(&maps.slopes())
                * f64::from(weights.iter().map(|t| t.abs()).sum::<f32>()).powi(2);
            expect(compare(&mixed, &wanted, largest), &(maps.name, weights));
        }
    }
}

/// The comparison notices cross terms that are left out, halved, or of the wrong pair, a wrong weight, and weights that are
/// not squared.
#[test]
fn mistakes_in_a_mix_are_detected() {
    for maps in cases() {
        let count = maps.maps.len();
        let weights = weights(count);
        let largest = largest_moment(&maps.slopes());
        let wanted = oracle(&maps, &weights, BOX, Wrap::Repeat);
        let layers = Layers::new(maps.layers(&weights));
        let levels = alone(&layers, BOX, Wrap::Repeat);
        let own = weighted(&weights, &levels);
        let mixing = layers.mixing_textures().expect("valid");
        let wrong = |levels: Result<Vec<_>, LayerError>, what: &str| {
            let result = compare(&levels.expect("valid"), &wanted, largest);
            assert!(result.is_err(), "{}: {what} is not detected", maps.name);
        };
        wrong(approximated_levels(&own), "no cross terms");
        if count > 2 {
            let mut turned = mixing.clone();
            turned.swap(0, 1);
            wrong(mixed_levels(&own, &turned), "another order of pairs");
        }
        let mut other = weights.clone();
        (other[0], other[1]) = (other[0] + 1e-3, other[1] - 1e-3);
        wrong(mixed_levels(&weighted(&other, &levels), &mixing), "another weight");
        // M mixed with weights that are not squared: what masks do.
        let linear = |level: usize| {
            let texels = wanted[level].width * wanted[level].height;
            let sum = |i: usize| {
                own.iter().fold(Moments::default(), |sum, (t, levels)| sum + levels[level].moments()[i] * *t)
            };
            let (width, height) = (wanted[level].width, wanted[level].height);
            roughcast::texture::MomentLevel::new(width, height, (0..texels).map(sum).collect()).expect("full")
        };
        wrong(Ok((0..wanted.len()).map(linear).collect()), "weights that are not squared");
    }
}

#[test]
fn the_approximation_is_exact_at_the_texels_of_level_0() {
    for maps in cases() {
        let weights = weights(maps.maps.len());
        let largest = largest_moment(&maps.slopes());
        let layers = Layers::new(maps.layers(&weights));
        let levels = alone(&layers, BOX, Wrap::Repeat);
        let got = approximated_levels(&weighted(&weights, &levels)).expect("valid");
        let wanted = oracle(&maps, &weights, BOX, Wrap::Repeat);
        expect(compare(&got[..1], &wanted[..1], largest), &maps.name);
        // And nowhere else, for layers of noise.
        assert!(compare(&got[1..2], &wanted[1..2], largest).is_err(), "{}", maps.name);
        // Its mean is exact everywhere.
        for (got, wanted) in got.iter().map(from_decoded).zip(&wanted) {
            let off = got.texels().zip(wanted.texels()).map(|(g, w)| (g.b[0] - w.b[0]).abs());
            assert!(off.fold(0.0, f64::max) < ROUNDINGS * EPS * largest.sqrt(), "{}", maps.name);
        }
    }
}

/// The paper's formulas with raw moments in single floats, and the covariances that are mixed here, are the same thing.
#[test]
fn the_papers_formulas_give_the_same_moments() {
    let mut random = Random(2);
    for count in 1..6 {
        for _ in 0..100 {
            let weights = weights(count);
            let mut layers = Vec::new();
            // A footprint of 16 slopes a layer, with means that are small compared with their spread.
            let footprints: Vec<Vec<Slope>> = (0..count)
                .map(|_| {
                    (0..16)
                        .map(|_| Slope { x: random.signed() as f32, y: 0.5 * random.signed() as f32 })
                        .collect()
                })
                .collect();
            let mean_of = |moments: &mut dyn Iterator<Item = Moments>| {
                moments.fold(Moments::default(), |sum, one| sum + one) * (1.0 / 16.0)
            };
            for (footprint, weight) in footprints.iter().zip(&weights) {
                layers.push((*weight, mean_of(&mut footprint.iter().map(|b| Moments::of_slope(*b)))));
            }
            let cross: Vec<CrossMoments> = pairs(count)
                .map(|(i, j)| {
                    let products = footprints[i].iter().zip(&footprints[j]);
                    let sum =
                        products.map(|(a, b)| CrossMoments::of_slopes(*a, *b)).fold([0.0; 3], |sum, c| {
                            [sum[0] + f64::from(c.xx), sum[1] + f64::from(c.yy), sum[2] + f64::from(c.xy)]
                        });
                    let [xx, yy, xy] = sum.map(|value| (value / 16.0) as f32);
                    CrossMoments { xx, yy, xy }
                })
                .collect();
            let exact = mean_of(&mut (0..16).map(|k| {
                let sum =
                    footprints.iter().zip(&weights).fold(Slope::default(), |sum, (b, t)| sum + b[k] * *t);
                Moments::of_slope(sum)
            }));
            let raw = mixed_moments(&layers, &cross).expect("valid");
            let one =
                |(t, m): &(f32, Moments)| (*t, Distribution::gaussian(m.mean, m.covariance_as_stored()));
            let by_covariances =
                mixed(&layers.iter().map(one).collect::<Vec<_>>(), &cross).expect("valid").moments();
            for got in [raw, by_covariances] {
                let errors = [
                    got.mean.x - exact.mean.x,
                    got.mean.y - exact.mean.y,
                    got.xx - exact.xx,
                    got.yy - exact.yy,
                    got.xy - exact.xy,
                ];
                let is_close = errors.iter().all(|e| f64::from(e.abs()) < ROUNDINGS * EPS);
                assert!(is_close, "{count}: {got:?} {exact:?}");
            }
            // With the cross terms of the means, they are the approximation.
            let of_means: Vec<CrossMoments> = pairs(count)
                .map(|(i, j)| CrossMoments::of_slopes(layers[i].1.mean, layers[j].1.mean))
                .collect();
            let raw = mixed_moments(&layers, &of_means).expect("valid").covariance_as_stored();
            let own =
                approximated(&layers.iter().map(one).collect::<Vec<_>>()).expect("valid").whole().covariance;
            let off = raw - own;
            assert!(f64::from(off.xx.abs().max(off.yy.abs()).max(off.xy.abs())) < ROUNDINGS * EPS);
        }
    }
}

/// Small bumps on a steep slope: covariances of the size of a specular power of 10 000 at a slope of 4. The covariances that
/// are mixed are exact to the rounding of the layers; a mix of raw moments in single floats is not.
#[test]
fn small_bumps_on_steep_slopes_keep_their_covariance() {
    let steep = Distribution::gaussian(Slope { x: 4.0, y: -3.0 }, Covariance::isotropic(1e-4));
    let got = approximated(&[(0.3, steep), (0.7, steep)]).expect("valid").whole().covariance;
    let wanted = (f64::from(0.3_f32).powi(2) + f64::from(0.7_f32).powi(2)) * f64::from(1e-4_f32);
    assert!((f64::from(got.xx) / wanted - 1.0).abs() < 4.0 * EPS, "{got:?} {wanted}");
    let moments = Moments::from_mean_and_covariance(steep.whole().mean, steep.whole().covariance);
    let cross = CrossMoments::of_slopes(moments.mean, moments.mean);
    let raw =
        mixed_moments(&[(0.3, moments), (0.7, moments)], &[cross]).expect("valid").covariance_as_stored();
    assert!((f64::from(raw.xx) / wanted - 1.0).abs() > 1e3 * EPS, "{raw:?}");
}

#[test]
fn a_weight_of_one_gives_back_a_layer_on_every_level() {
    for maps in cases() {
        let count = maps.maps.len();
        for only in 0..count {
            let weights: Vec<f32> = (0..count).map(|i| f32::from(u8::from(i == only))).collect();
            let layers = Layers::new(maps.layers(&weights));
            let levels = alone(&layers, BOX, Wrap::Repeat);
            let wanted: Vec<Level> = levels[only].iter().map(from_decoded).collect();
            let largest = largest_moment(&maps.slopes());
            let own = weighted(&weights, &levels);
            let masked = masked_levels(&layers.masked_textures().expect("valid")).expect("valid");
            let ways = [
                ("joint", layers.joint().expect("valid").moments(BOX, Wrap::Repeat)),
                ("mixing", mixed_levels(&own, &layers.mixing_textures().expect("valid")).expect("valid")),
                ("approximate", approximated_levels(&own).expect("valid")),
                ("mask", masked),
            ];
            for (way, got) in ways {
                expect(compare(&got, &wanted, largest), &(maps.name, way, only));
            }
        }
    }
}

#[test]
fn the_order_of_layers_does_not_matter() {
    for maps in cases() {
        let count = maps.maps.len();
        let weights = weights(count);
        let largest = largest_moment(&maps.slopes());
        let ways = |order: &[usize]| {
            let all = maps.layers(&weights);
            let layers = Layers::new(order.iter().map(|i| all[*i]).collect());
            let weights: Vec<f32> = order.iter().map(|i| weights[*i]).collect();
            let levels = alone(&layers, BOX, Wrap::Repeat);
            let own = weighted(&weights, &levels);
            [
                layers.joint().expect("valid").moments(BOX, Wrap::Repeat),
                mixed_levels(&own, &layers.mixing_textures().expect("valid")).expect("valid"),
                approximated_levels(&own).expect("valid"),
                masked_levels(&layers.masked_textures().expect("valid")).expect("valid"),
            ]
        };
        let order: Vec<usize> = (0..count).collect();
        let backwards: Vec<usize> = (0..count).rev().collect();
        for (place, (one, other)) in ways(&order).iter().zip(ways(&backwards)).enumerate() {
            let one: Vec<Level> = one.iter().map(from_decoded).collect();
            expect(compare(&other, &one, largest), &(maps.name, LayerMethod::ALL[place]));
        }
    }
}

/// Layers that move by whole texels are the moved maps; their mixing textures are those of that moment.
#[test]
fn layers_move() {
    let maps = &cases()[0];
    let weights = weights(2);
    let mut layers = maps.layers(&weights);
    // Five texels right and three down a second, and the other way.
    for (layer, sign) in layers.iter_mut().zip([1.0, -1.0]) {
        let velocity = [sign * 5.0 / 64.0, sign * 3.0 / 64.0];
        *layer = layer.transform(LayerTransform::default().with_velocity(velocity));
    }
    let layers = Layers::new(layers);
    let slopes = maps.slopes();
    let (mut previous, largest) = (Vec::new(), largest_moment(&slopes));
    for time in [0_i32, 1, 7] {
        let moved: Vec<Slopes> = slopes
            .iter()
            .zip([1, -1])
            .map(|(map, sign)| {
                let from = |i: usize, step: i32| (i as i32 - sign * step * time).rem_euclid(64) as usize;
                let texels =
                    (0..64 * 64).map(|i| map.texels[from(i / 64, 3) * 64 + from(i % 64, 5)]).collect();
                Slopes { width: 64, height: 64, texels, counts: Default::default() }
            })
            .collect();
        let wanted =
            crate::common::pyramid_oracle::bump_moments(&mixed_slopes(&moved, &weights), BOX, Wrap::Repeat);
        let layers = layers.clone().at(f64::from(time));
        let joint = layers.joint().expect("valid").moments(BOX, Wrap::Repeat);
        expect(compare(&joint, &wanted, largest), &("joint", time));
        let mixed = by_mixing_textures(&layers, &weights, BOX, Wrap::Repeat).expect("valid");
        expect(compare(&mixed, &wanted, largest), &("mixing", time));
        // The mixing textures of another moment are wrong.
        let mixing = layers.mixing_textures().expect("valid");
        if !previous.is_empty() {
            let stale = mixed_levels(&weighted(&weights, &alone(&layers, BOX, Wrap::Repeat)), &previous);
            assert!(compare(&stale.expect("valid"), &wanted, largest).is_err());
        }
        previous = mixing;
    }
}

/// Bumps along x and bumps along y are independent under every square footprint that holds whole periods.
#[test]
fn added_layers_are_the_sum_of_independent_bumps() {
    let side = 32;
    let wave =
        |i: usize, periods: f64| (std::f64::consts::TAU * periods * (i as f64 + 0.5) / side as f64).sin();
    let slopes = |of: &dyn Fn(usize, usize) -> [f64; 2]| Slopes {
        width: side,
        height: side,
        texels: (0..side * side).map(|i| of(i % side, i / side)).collect(),
        counts: Default::default(),
    };
    let one = slopes(&|x, _| [0.1 + wave(x, 4.0), 0.5 * wave(x, 8.0)]);
    let other = slopes(&|_, y| [0.3 * wave(y, 4.0), wave(y, 4.0) - 0.2]);
    let whole = |slopes: &Slopes| {
        let levels = crate::common::pyramid_oracle::bump_moments(slopes, BOX, Wrap::Repeat);
        levels[levels.len() - 1].texel(0)
    };
    // The second at twice and a half of its height: factors need not sum to one.
    let sum = whole(&mixed_slopes(&[one, other], &[1.0, 2.5]));
    let distribution = |texel: Texel| {
        let [xx, yy, xy] = texel.covariance().map(|v| v as f32);
        Distribution::gaussian(
            Slope { x: texel.b[0] as f32, y: texel.b[1] as f32 },
            Covariance { xx, yy, xy },
        )
    };
    let layers = [
        (1.0, distribution(whole(&slopes(&|x, _| [0.1 + wave(x, 4.0), 0.5 * wave(x, 8.0)])))),
        (2.5, distribution(whole(&slopes(&|_, y| [0.3 * wave(y, 4.0), wave(y, 4.0) - 0.2])))),
    ];
    let got = added(&layers).expect("valid").whole();
    let wanted = sum.covariance();
    let errors = [
        f64::from(got.mean.x) - sum.b[0],
        f64::from(got.mean.y) - sum.b[1],
        f64::from(got.covariance.xx) - wanted[0],
        f64::from(got.covariance.yy) - wanted[1],
        f64::from(got.covariance.xy) - wanted[2],
    ];
    // Slopes of up to 2.5 in single floats.
    assert!(errors.iter().all(|error| error.abs() < 2.5 * 2.5 * 4.0 * EPS), "{errors:?}");
    assert!(wanted[1] > 3.0, "{wanted:?}");
}

/// Heights that are added when one map is made, with factors of any sum.
#[test]
fn one_map_of_added_heights_is_the_filtered_sum() {
    for maps in cases() {
        let factors: Vec<f32> = (0..maps.maps.len()).map(|i| 1.5 - i as f32).collect();
        let largest =
            largest_moment(&maps.slopes()) * f64::from(factors.iter().map(|t| t.abs()).sum::<f32>());
        let sum = Layers::new(maps.layers(&factors)).sum().expect("valid").moments(BOX, Wrap::Repeat);
        expect(compare(&sum, &oracle(&maps, &factors, BOX, Wrap::Repeat), largest), &maps.name);
    }
}

/// A shader folds layers and pairs one by one.
#[test]
fn layers_may_be_folded_one_by_one() {
    let mut random = Random(3);
    for count in 1..6 {
        let weights = weights(count);
        let mut number = || random.signed() as f32;
        let layers: Vec<(f32, Distribution)> = weights
            .iter()
            .map(|weight| {
                let mean = Slope { x: number(), y: number() };
                let covariance = Covariance { xx: 0.5 + 0.3 * number(), yy: 0.6, xy: 0.1 * number() };
                (*weight, Distribution::gaussian(mean, covariance))
            })
            .collect();
        let cross: Vec<_> =
            pairs(count).map(|_| CrossMoments { xx: number(), yy: number(), xy: number() }).collect();
        let at_once = mixed(&layers, &cross).expect("valid").whole();
        let sum = layers.iter().map(|(t, layer)| layer.scaled(*t)).reduce(Distribution::plus);
        let in_common = pairs(count).zip(&cross).fold(Covariance::default(), |sum, ((i, j), cross)| {
            let pair = cross.covariance(layers[i].1.whole().mean, layers[j].1.whole().mean);
            sum + pair * (weights[i] * weights[j])
        });
        let folded = correlated_layers(sum.expect("layers"), in_common).whole();
        let off = at_once.covariance - folded.covariance;
        let largest = f64::from(off.xx.abs().max(off.yy.abs()).max(off.xy.abs()));
        assert!(largest < ROUNDINGS * EPS && at_once.mean == folded.mean, "{at_once:?} {folded:?}");
    }
}
