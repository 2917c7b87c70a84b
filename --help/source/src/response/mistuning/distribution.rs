//! Draws of a blade's deviation from its law, scaled to zero mean and unit standard deviation.

use std::f64::consts::{PI, SQRT_2};

use rand::{Rng, RngExt};
use rand_distr::StandardNormal;
use statrs::function::erf::erf;
use thiserror::Error;

use super::Distribution;

/// Accepted cut-offs of [`Distribution::TruncatedNormal`], in parent standard deviations.
pub const TRUNCATION_RANGE: [f64; 2] = [0.1, 10.0];

/// A law that cannot be drawn from.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum DistributionError {
    /// The cut-off is outside [`TRUNCATION_RANGE`].
    #[error("truncation = {truncation} is not accepted: a number from {} to {}", TRUNCATION_RANGE[0], TRUNCATION_RANGE[1])]
    Truncation {
        /// The refused cut-off.
        truncation: f64,
    },
}

impl Distribution {
    /// Name in study files and tables.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Normal => "normal",
            Self::Uniform => "uniform",
            Self::TruncatedNormal { .. } => "truncated_normal",
        }
    }

    /// Checks the parameters of the law.
    ///
    /// # Errors
    /// The parameter that is out of range.
    pub fn validate(&self) -> Result<(), DistributionError> {
        match *self {
            Self::TruncatedNormal { truncation }
                if !(TRUNCATION_RANGE[0]..=TRUNCATION_RANGE[1]).contains(&truncation) =>
            {
                Err(DistributionError::Truncation { truncation })
            }
            _ => Ok(()),
        }
    }

    /// Standard deviation of the law before it is rescaled to 1.
    ///
    /// Of a standard normal law cut off at `+-c`:
    /// `s^2 = 1 - 2 c phi(c) / (2 Phi(c) - 1)`, with `phi` and `Phi` its density and distribution
    /// function (Johnson, Kotz & Balakrishnan 1994, section 13.10.1) and `2 Phi(c) - 1 = erf(c/sqrt 2)`.
    #[must_use]
    pub fn parent_standard_deviation(&self) -> f64 {
        match *self {
            Self::Normal | Self::Uniform => 1.0,
            Self::TruncatedNormal { truncation: c } => {
                let phi = (-0.5 * c * c).exp() / (2.0 * PI).sqrt();
                (1.0 - 2.0 * c * phi / erf(c / SQRT_2)).sqrt()
            }
        }
    }

    /// `count` independent draws with zero mean and unit standard deviation, in order.
    ///
    /// Normal: the ziggurat of `rand_distr` (Doornik 2005). Uniform: `sqrt(3) (2 u - 1)`.
    /// Truncated normal: normal draws beyond the cut-off are rejected, the others divided by
    /// [`Self::parent_standard_deviation`].
    #[must_use]
    pub fn unit_draws(&self, stream: &mut impl Rng, count: usize) -> Vec<f64> {
        let scale = 1.0 / self.parent_standard_deviation();
        (0..count)
            .map(|_| match *self {
                Self::Normal => stream.sample(StandardNormal),
                Self::Uniform => 3.0_f64.sqrt() * (2.0 * stream.random::<f64>() - 1.0),
                Self::TruncatedNormal { truncation } => scale * draw_within(stream, truncation),
            })
            .collect()
    }
}

fn draw_within(stream: &mut impl Rng, truncation: f64) -> f64 {
    loop {
        let draw: f64 = stream.sample(StandardNormal);
        if draw.abs() <= truncation {
            return draw;
        }
    }
}
