//! Arguments for the twins: typical values in shading, and extremes.

use roughcast::Slope;
use roughcast::shading::{
    BaseFrame, FootprintModel, Form, Masking, Repair, ShadingOptions, SlopeGaussian, bump_facet, ggx_surface,
    slope_gaussian,
};
use roughcast::texture::{Base, Packing, RoughnessStored, normal_moments, pbr_moments};
use roughcast::{Covariance, Distribution, MAX_GAUSSIANS, Moments, WeightedGaussian};

/// A source of arguments, the same in every run.
pub struct Inputs {
    state: u64,
    pub options: ShadingOptions,
    pub packing: Packing,
}

/// Unsigned texels of slopes up to 2, and floats.
const SCALED: Packing = Packing {
    slope: [4.0, -2.0],
    second: [4.0, 0.0],
    mixed: [8.0, -4.0],
    trace: [8.0, 0.0],
    spread: [0.5, 0.0],
    signed_spread: [1.0, -0.5],
    unit: [2.0, -1.0],
    ..Packing::IDENTITY
};

impl Inputs {
    pub fn new(seed: u64) -> Self {
        Self { state: seed, options: ShadingOptions::default(), packing: Packing::IDENTITY }
    }

    /// Options and packing of the next case.
    pub fn next_case(&mut self) {
        let power = match self.below(4) {
            0 => [1.0, 2.0, 13.0, 13_777.0, 16_384.0][self.below(5)],
            _ => 2.0_f32.powf(self.between(0.0, 14.0)),
        };
        self.options = ShadingOptions::default()
            .with_specular_power(power)
            .with_form(Form::ALL[self.below(3)])
            .with_base_frame(BaseFrame::ALL[self.below(2)])
            .with_repair(Repair::ALL[self.below(2)])
            .with_masking(Masking::ALL[self.below(2)])
            .with_footprint(FootprintModel::ALL[usize::from(self.below(8) == 0)]);
        self.packing = Packing {
            base: self.base(),
            roughness_stored: RoughnessStored::ALL[self.below(RoughnessStored::ALL.len())],
            ..[Packing::IDENTITY, SCALED][self.below(2)]
        };
    }

    /// Whether the base is baked in, which it is in one case in three.
    fn base(&mut self) -> Base {
        [Base::None, Base::None, Base::Baked][self.below(3)]
    }

    /// A distribution of one to four Gaussians, with a normal of any length.
    pub fn distribution(&mut self) -> Distribution {
        let count = 1 + self.below(4);
        self.mixture(count)
    }

    /// A distribution of `count` Gaussians.
    pub fn mixture(&mut self, count: usize) -> Distribution {
        let mut rest = 1.0;
        let parts: Vec<WeightedGaussian> = (0..count)
            .map(|place| {
                let weight = if place + 1 == count { rest } else { rest * self.unit() };
                rest -= weight;
                let ([x, y], [xx, yy, xy]) = (self.slope(), self.covariance());
                WeightedGaussian { weight, mean: Slope { x, y }, covariance: Covariance { xx, yy, xy } }
            })
            .collect();
        let mixture = Distribution::mixture(&parts).expect("one to four");
        mixture.with_normal(self.normal().into()).with_base(self.base())
    }

    /// A distribution of one to four Gaussians, and directions about the mean of the first.
    pub fn mixture_lobe(&mut self) -> Vec<f32> {
        let distribution = self.distribution();
        let first = distribution.gaussians()[0];
        let width = (first.covariance.trace() + 2.0 / self.options.specular_power).max(0.0).sqrt();
        let [view, light] = self.directions([first.mean.x, first.mean.y, 1.0], width);
        [&distribution_words(&distribution)[..], &view, &light].concat()
    }

    /// A number in 0 .. 1 (splitmix64).
    pub fn unit(&mut self) -> f32 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.state ^ (self.state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 40) as f32 / (1_u64 << 24) as f32
    }

    pub fn below(&mut self, n: usize) -> usize {
        (self.unit() * n as f32) as usize
    }

    pub fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.unit()
    }

    /// A number of any magnitude between the two, with either sign.
    pub fn of_any_size(&mut self, smallest: f32, largest: f32) -> f32 {
        let size = self.between(smallest.log2(), largest.log2()).exp2();
        if self.below(2) == 0 { size } else { -size }
    }

    /// A unit vector above the surface; one in eight nearly in it, one in sixteen the normal, one in sixteen below. The
    /// length of some is off by a few roundings, as a vertex shader leaves it.
    pub fn direction(&mut self) -> [f32; 3] {
        let z = match self.below(16) {
            0 => return [0.0, 0.0, 1.0],
            1 => -self.unit(),
            2 | 3 => self.between(-20.0, -7.0).exp2(),
            _ => self.unit(),
        };
        let angle = self.between(0.0, std::f32::consts::TAU);
        let r = (1.0 - z * z).max(0.0).sqrt();
        let error = 1.0 + f32::EPSILON * self.between(-4.0, 4.0);
        [r * angle.cos() * error, r * angle.sin() * error, z * error]
    }

    /// A filtered normal: of any length up to one, some steep, some zero, some pointing into the surface.
    pub fn normal(&mut self) -> [f32; 3] {
        let slope = self.slope();
        let length = self.between(0.05, 1.0) / (1.0 + slope[0] * slope[0] + slope[1] * slope[1]).sqrt();
        match self.below(24) {
            0 => [0.0; 3],
            1 => [0.6, -0.3, -0.2],
            2 => [0.0, 0.0, 1.0],
            _ => [slope[0] * length, slope[1] * length, length],
        }
    }

    /// A slope: mostly below one, some up to 128, the maximum, some zero.
    pub fn slope(&mut self) -> [f32; 2] {
        match self.below(10) {
            0 => [0.0; 2],
            1 => [self.of_any_size(1.0, 128.0), self.of_any_size(1e-3, 128.0)],
            _ => [self.between(-1.0, 1.0), self.between(-1.0, 1.0)],
        }
    }

    /// A covariance: round, elongated in any direction, of rank one, zero and, in one case in ten, of no valid
    /// distribution.
    pub fn covariance(&mut self) -> [f32; 3] {
        let a = self.of_any_size(1e-6, 1.0).abs();
        match self.below(10) {
            0 => [0.0; 3],
            1 => [a, 0.0, 0.0],
            2 => {
                let b = self.of_any_size(1e-3, 1.0);
                [a, a * b * b, a * b]
            }
            3 => [self.of_any_size(1e-6, 0.1), self.of_any_size(1e-6, 0.1), self.of_any_size(1e-6, 0.1)],
            4 => [a, a, 0.0],
            _ => {
                let b = self.of_any_size(1e-6, 1.0).abs();
                let correlation = self.between(-0.999, 0.999);
                [a, b, correlation * (a * b).sqrt()]
            }
        }
    }

    /// The stored number that decodes to `value`.
    pub fn stored(value: f32, [scale, offset]: [f32; 2]) -> f32 {
        (value - offset) / scale
    }

    /// LEAN's texels for random moments.
    pub fn lean(&mut self) -> Vec<f32> {
        let ([x, y], [xx, yy, xy], normal) = (self.slope(), self.covariance(), self.normal());
        let moments = Moments::from_mean_and_covariance(Slope { x, y }, Covariance { xx, yy, xy });
        let Packing { slope, second, mixed, unit, .. } = self.packing;
        vec![
            Self::stored(normal[0], unit),
            Self::stored(normal[1], unit),
            normal[2],
            Self::stored(moments.xy, mixed),
            Self::stored(x, slope),
            Self::stored(y, slope),
            Self::stored(moments.xx, second),
            Self::stored(moments.yy, second),
        ]
    }

    /// The derivatives of a footprint, in texels: mostly a few texels, round or elongated, some tiny or huge.
    pub fn footprint(&mut self) -> [f32; 4] {
        let long = match self.below(8) {
            0 => self.of_any_size(1e-4, 1e6).abs(),
            _ => self.of_any_size(0.05, 64.0).abs(),
        };
        let short = long * self.between(-6.0, 0.0).exp2();
        let (turned, across) = (self.between(0.0, 6.3).sin_cos(), self.between(0.0, 6.3).sin_cos());
        let (a, b) = ((long * turned.0, short * turned.1), (-long * turned.1, short * turned.0));
        // A rotation of the picture mixes both.
        let mix = |(along, side): (f32, f32)| {
            [across.1 * along + across.0 * side, across.1 * side - across.0 * along]
        };
        let [ax, bx] = mix(a);
        let [ay, by] = mix(b);
        [ax, ay, bx, by]
    }

    /// What a pixel sees, of moments and of variances.
    pub fn ratio(&mut self) -> [f32; 8] {
        let trace = |inputs: &mut Self| inputs.of_any_size(1e-4, 2.0).abs();
        let (xx, yy) = (trace(self), trace(self));
        let xy = self.between(-0.9, 0.9) * (xx * yy).sqrt();
        let magnified = [0.0, 1.0, self.unit()][self.below(3)];
        [self.unit(), trace(self), self.unit(), trace(self), xx, yy, xy, magnified]
    }

    /// The words of a facet, and a pair of directions whose half vector is near its normal.
    pub fn facet_lobe(&mut self) -> Vec<f32> {
        let facet = bump_facet(self.normal(), self.options.specular_power);
        let [view, light] = self.directions(facet.normal, self.options.specular_power.sqrt().recip());
        [&facet.normal[..], &[facet.specular_power], &view, &light].concat()
    }

    /// The words of a Gaussian of slopes, and a pair of directions whose half vector is near its mean.
    pub fn gaussian_lobe(&mut self) -> Vec<f32> {
        let ([x, y], [xx, yy, xy]) = (self.slope(), self.covariance());
        let base = 1.0 / self.options.specular_power;
        let covariance = Covariance { xx: xx + base, yy: yy + base, xy };
        let gaussian = slope_gaussian(Slope { x, y }, covariance, &self.options);
        let [view, light] = self.directions([x, y, 1.0], covariance.trace().max(0.0).sqrt());
        [&gaussian_words(&gaussian)[..], &view, &light].concat()
    }

    /// A Gaussian's words, and an offset of up to four standard deviations along each axis.
    pub fn offset_in_gaussian(&mut self) -> Vec<f32> {
        let [xx, yy] = [self.of_any_size(1e-6, 1.0).abs(), self.of_any_size(1e-6, 1.0).abs()];
        let xy = self.between(-0.999, 0.999) * (xx * yy).sqrt();
        let gaussian =
            slope_gaussian(Slope::default(), Covariance { xx, yy, xy }, &ShadingOptions::default());
        let (along, across) = (self.between(-4.0, 4.0), self.between(-4.0, 4.0));
        let x = along * xx.sqrt();
        let y = x * xy / xx + across * (gaussian.determinant / xx).sqrt();
        [&gaussian_words(&gaussian)[..], &[x, y]].concat()
    }

    /// The words of GGX, and directions.
    pub fn ggx_lobe(&mut self) -> Vec<f32> {
        let distribution = if self.below(2) == 0 {
            normal_moments(self.normal())
        } else {
            let words = self.material();
            let [normal, anisotropy] = [0, 5].map(|i| std::array::from_fn(|j| words[i + j]));
            pbr_moments(normal, words[4], anisotropy, &self.packing)
        };
        let surface = ggx_surface(&distribution, &self.options);
        let [view, light] = self.directions(surface.normal, surface.alpha_across);
        let along = [surface.alpha_along];
        [&surface.normal[..], &along, &surface.tangent, &[surface.alpha_across], &view, &light].concat()
    }

    /// Texels of a material: normal, roughness and anisotropy.
    pub fn material(&mut self) -> Vec<f32> {
        let normal = self.normal();
        let unit = self.packing.unit;
        let z = if self.below(3) == 0 { 0.0 } else { normal[2] };
        let roughness = match self.packing.roughness_stored {
            RoughnessStored::SpecularPower => self.of_any_size(1.0, 1e5).abs(),
            _ => self.unit(),
        };
        let [x, y] = match self.below(8) {
            0 => [0.0, 0.0],
            _ => [self.between(-1.0, 1.0), self.between(-1.0, 1.0)],
        };
        let stored = |value| Self::stored(value, unit);
        let strength = self.unit();
        let normal = [stored(normal[0]), stored(normal[1]), stored(z), 1.0];
        [&normal[..], &[roughness], &[stored(x), stored(y), strength, 1.0]].concat()
    }

    /// Directions to viewer and light. In three of four cases the half vector is within a few widths of `axis`, because
    /// a narrow lobe is zero anywhere else.
    fn directions(&mut self, axis: [f32; 3], width: f32) -> [[f32; 3]; 2] {
        let view = self.direction();
        if self.below(4) == 0 {
            return [view, self.direction()];
        }
        let spread = [self.between(-4.0, 4.0) * width, self.between(-4.0, 4.0) * width];
        let z = axis[2].max(1e-3);
        let half = [axis[0] / z + spread[0], axis[1] / z + spread[1], 1.0];
        let length = half.iter().map(|h| h * h).sum::<f32>().sqrt();
        let half = half.map(|h| h / length);
        let cosine: f32 = half.iter().zip(view).map(|(h, v)| h * v).sum();
        [view, std::array::from_fn(|i| 2.0 * cosine * half[i] - view[i])]
    }
}

pub fn gaussian_words(gaussian: &SlopeGaussian) -> [f32; 6] {
    let SlopeGaussian { mean, covariance, determinant } = *gaussian;
    [mean.x, mean.y, covariance.xx, covariance.yy, covariance.xy, determinant]
}

pub fn weighted_words(gaussian: &WeightedGaussian) -> [f32; 6] {
    let WeightedGaussian { weight, mean, covariance } = *gaussian;
    [mean.x, mean.y, covariance.xx, covariance.yy, covariance.xy, weight]
}

/// The filtered normal, the base as a number, and four Gaussians; unused Gaussians are zero.
pub fn distribution_words(distribution: &Distribution) -> Vec<f32> {
    let parts = distribution.gaussians();
    let part = |place: usize| parts.get(place).copied().unwrap_or_default();
    let gaussians = (0..MAX_GAUSSIANS).flat_map(|place| weighted_words(&part(place)));
    distribution
        .normal()
        .to_array()
        .into_iter()
        .chain([distribution.base() as u32 as f32])
        .chain(gaussians)
        .collect()
}
