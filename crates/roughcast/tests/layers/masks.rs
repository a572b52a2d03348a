//! Masks against ground truth: at every point one layer is seen.

use roughcast::layers::*;
use roughcast::texture::MomentLevel;
use roughcast::{Image, Moments, PyramidFilter, SampleType, Slope, Wrap};

use crate::common::compare::{EPS, expect};
use crate::common::level::Level;
use crate::common::maps::{self, Random};
use crate::common::pyramid_oracle::pyramid;
use crate::common::slope_oracle::Slopes;
use crate::support::*;

/// The levels of `Σ m b` and `Σ m b bᵀ` over `Σ m`, each averaged from level 0.
fn ground_truth(layers: &[Slopes], masks: &[Vec<f64>], filter: PyramidFilter) -> Vec<Level> {
    let (width, height) = (layers[0].width, layers[0].height);
    let plane = |quantity: &dyn Fn([f64; 2]) -> f64| {
        let value = |i: usize| layers.iter().zip(masks).map(|(l, m)| m[i] * quantity(l.texels[i])).sum();
        let values = (0..width * height).map(value).collect();
        pyramid(crate::common::level::Plane { width, height, values }, filter, Wrap::Repeat)
    };
    let area = plane(&|_| 1.0);
    let planes = [
        plane(&|b| b[0]),
        plane(&|b| b[1]),
        plane(&|b| b[0] * b[0]),
        plane(&|b| b[1] * b[1]),
        plane(&|b| b[0] * b[1]),
    ];
    (0..area.len())
        .map(|level| Level {
            width: area[level].width,
            height: area[level].height,
            planes: std::array::from_fn(|k| {
                let values = planes[k][level].values.iter().zip(&area[level].values);
                values.map(|(sum, area)| if *area > 0.0 { sum / area } else { 0.0 }).collect()
            }),
        })
        .collect()
}

fn picture((width, height): (usize, usize), values: &[f64]) -> Image {
    maps::image(width, height, 1, maps::samples(values, SampleType::F32))
}

fn masked_with(maps: &Maps, masks: &[Option<&Image>], filter: PyramidFilter) -> Vec<MomentLevel> {
    let layers = maps.layers(&vec![1.0; maps.maps.len()]).into_iter().zip(masks);
    let layers = layers.map(|(layer, mask)| layer.mask(mask.map(Image::view))).collect();
    masked_levels(&Layers::new(layers).filter(filter).masked_textures().expect("valid")).expect("valid")
}

/// Where the first layer falls to the right, as where one layer shows through another: a mask of zeros and ones that is
/// correlated with the bumps.
fn where_it_falls(slopes: &[Slopes]) -> Vec<f64> {
    slopes[0].texels.iter().map(|[x, _]| f64::from(u8::from(*x > 0.0))).collect()
}

#[test]
fn a_mask_correlated_with_the_bumps_is_ground_truth_on_every_level() {
    for maps in cases() {
        let slopes = maps.slopes();
        let (size, largest) = ((slopes[0].width, slopes[0].height), largest_moment(&slopes));
        let decal = where_it_falls(&slopes);
        let count = slopes.len() as f64;
        // The first layer where it falls; the others share the rest.
        let rest = decal.iter().map(|m| (1.0 - m) / (count - 1.0)).collect::<Vec<_>>();
        let masks: Vec<Vec<f64>> =
            slopes.iter().enumerate().map(|(i, _)| if i == 0 { &decal } else { &rest }.clone()).collect();
        for filter in PyramidFilter::ALL {
            let wanted = ground_truth(&slopes, &masks, *filter);
            let picture = picture(size, &decal);
            let mut pictures = vec![None; slopes.len()];
            pictures[0] = Some(&picture);
            let got = masked_with(&maps, &pictures, *filter);
            expect(compare(&got, &wanted, largest), &(maps.name, filter));
        }
        // Moments that are not premultiplied are wrong: those of whole layers, mixed by the filtered masks.
        let wanted = ground_truth(&slopes, &masks, PyramidFilter::Box);
        let layers = Layers::new(maps.layers(&vec![1.0; slopes.len()]));
        let own = alone(&layers, PyramidFilter::Box, Wrap::Repeat);
        let area = |mask: &Vec<f64>| {
            let plane = crate::common::level::Plane { width: size.0, height: size.1, values: mask.clone() };
            pyramid(plane, PyramidFilter::Box, Wrap::Repeat)
        };
        let areas: Vec<_> = masks.iter().map(area).collect();
        let level = |number: usize| {
            let texel = |i: usize| {
                own.iter().zip(&areas).fold(Moments::default(), |sum, (levels, areas)| {
                    sum + levels[number].moments()[i] * areas[number].values[i] as f32
                })
            };
            let (width, height) = (wanted[number].width, wanted[number].height);
            MomentLevel::new(width, height, (0..width * height).map(texel).collect()).expect("full")
        };
        let got: Vec<_> = (0..wanted.len()).map(level).collect();
        assert!(compare(&got, &wanted, largest).is_err(), "{}", maps.name);
        expect(compare(&got[..1], &wanted[..1], largest), &maps.name);
    }
}

#[test]
fn masks_of_parts_are_areas_and_need_not_sum_to_one() {
    let maps = &cases()[1];
    let slopes = maps.slopes();
    let size = (slopes[0].width, slopes[0].height);
    let mut random = Random(4);
    let masks: Vec<Vec<f64>> = (0..3)
        .map(|_| (0..size.0 * size.1).map(|_| f64::from((random.unit() / 3.0) as f32)).collect())
        .collect();
    let pictures: Vec<Image> = masks.iter().map(|mask| picture(size, mask)).collect();
    let got = masked_with(maps, &pictures.iter().map(Some).collect::<Vec<_>>(), PyramidFilter::Box);
    let wanted = ground_truth(&slopes, &masks, PyramidFilter::Box);
    // A few texels are seen by little: rounding of premultiplied moments is divided by the mask.
    let smallest = (0..size.0 * size.1).map(|i| masks.iter().map(|m| m[i]).sum::<f64>()).fold(1.0, f64::min);
    assert!(smallest > 0.01, "{smallest}");
    expect(compare(&got, &wanted, largest_moment(&slopes) / smallest), &"areas");
}

#[test]
fn a_coarse_mask_is_resampled_and_one_above_one_is_scaled_back() {
    let maps = &cases()[0];
    let slopes = maps.slopes();
    let largest = largest_moment(&slopes);
    let constant = |value: f64| vec![value; slopes[0].texels.len()];
    for (first, second, wanted) in [(0.25, 0.75, [0.25, 0.75]), (0.5, 1.5, [0.25, 0.75])] {
        let pictures = [first, second].map(|value| picture((1, 1), &[value]));
        let got = masked_with(maps, &pictures.each_ref().map(Some), PyramidFilter::Box);
        let truth = ground_truth(&slopes, &wanted.map(constant), PyramidFilter::Box);
        expect(compare(&got, &truth, largest), &(first, second));
    }
}

/// A mask's distribution keeps the layers apart: a glossy decal on rough ground has two lobes.
#[test]
fn every_layer_that_is_seen_has_its_own_gaussian() {
    let layer = |mask: f32, x: f32| MaskedMoments::of(mask, Moments::of_slope(Slope { x, y: 0.0 }));
    let both = masked(&[layer(0.25, 1.0), layer(0.0, 7.0), layer(0.75, -1.0)]).expect("valid");
    let parts: Vec<_> = both.gaussians().iter().map(|part| (part.weight, part.mean.x)).collect();
    assert_eq!(parts, [(0.25, 1.0), (0.75, -1.0)]);
    let whole = both.whole();
    assert!(
        (f64::from(whole.mean.x) + 0.5).abs() < EPS && (f64::from(whole.covariance.xx) - 0.75).abs() < EPS
    );
}
