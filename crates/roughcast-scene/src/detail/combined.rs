//! Bumps on top of others: heights add, so slopes and their moments do.

use roughcast::shading::ShadingOptions;
use roughcast::{Distribution, Slope};

use super::{Detail, DetailPoint};
use crate::Sampler;

/// The sum of several independent sources of bumps, each with a strength that scales its heights.
///
/// The surface gradient is linear, so the normal is perturbed once, by the sum (Mikkelsen 2010, section 4). Mean slopes and
/// covariances add; a strength multiplies slopes, and its square multiplies covariances. The base roughness of the surface is
/// neither scaled nor added twice, if sources have it in their covariances.
#[derive(Clone)]
pub struct Combined<'a> {
    parts: Vec<Strengthened<'a>>,
}

/// A source of bumps whose heights are multiplied by a strength.
#[derive(Clone, Copy)]
pub struct Strengthened<'a> {
    /// The source.
    pub detail: &'a dyn Detail,
    /// What its heights are multiplied by; below zero, bumps become dents.
    pub strength: f32,
}

/// The slope variance per axis of the base roughness that sources may have in their covariances.
pub(super) fn base_variance(options: &ShadingOptions) -> f32 {
    options.specular_power.recip()
}

impl Detail for Strengthened<'_> {
    fn slope(&self, at: &DetailPoint<'_>) -> Slope {
        self.detail.slope(at) * self.strength
    }

    fn distribution(&self, at: &DetailPoint<'_>, options: &ShadingOptions) -> Distribution {
        let distribution = self.detail.distribution(at, options);
        if self.strength == 1.0 {
            return distribution;
        }
        distribution.scaled_bumps(self.strength, base_variance(options))
    }

    fn options(&self, options: ShadingOptions) -> ShadingOptions {
        self.detail.options(options)
    }

    fn sampler(&self) -> Sampler {
        self.detail.sampler()
    }
}

impl<'a> Combined<'a> {
    /// The sum of these sources. None at all is a flat surface.
    pub fn new(parts: Vec<Strengthened<'a>>) -> Self {
        Self { parts }
    }
}

impl Detail for Combined<'_> {
    fn slope(&self, at: &DetailPoint<'_>) -> Slope {
        self.parts.iter().fold(Slope::default(), |sum, part| sum + part.slope(at))
    }

    fn distribution(&self, at: &DetailPoint<'_>, options: &ShadingOptions) -> Distribution {
        let parts = self.parts.iter().map(|part| part.distribution(at, options));
        parts
            .reduce(|sum, part| sum.plus_bumps(part, base_variance(options)))
            .unwrap_or_else(|| Distribution::of_slope(Slope::default()))
    }

    fn options(&self, options: ShadingOptions) -> ShadingOptions {
        self.parts.iter().fold(options, |options, part| part.options(options))
    }

    /// The first source's.
    fn sampler(&self) -> Sampler {
        self.parts.first().map_or_else(Sampler::default, Detail::sampler)
    }
}
