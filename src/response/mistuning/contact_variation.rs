//! Random contact: friction coefficient, contact stiffness and normal load of every wheel, drawn
//! beside its blades.

use serde::{Deserialize, Serialize};

use super::stream::contact_stream;
use super::{ContactFactors, Distribution, PairFactors};

/// A contact parameter that can vary.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactQuantity {
    /// Coefficient of friction.
    FrictionCoefficient,
    /// Tangential contact stiffness, both directions alike.
    TangentialStiffness,
    /// Normal contact stiffness.
    NormalStiffness,
    /// Normal load.
    NormalLoad,
}

impl ContactQuantity {
    /// All quantities, in the order of their columns.
    pub const ALL: [Self; 4] = [
        Self::FrictionCoefficient,
        Self::TangentialStiffness,
        Self::NormalStiffness,
        Self::NormalLoad,
    ];

    /// Name in study files and tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::FrictionCoefficient => "friction_coefficient",
            Self::TangentialStiffness => "tangential_stiffness",
            Self::NormalStiffness => "normal_stiffness",
            Self::NormalLoad => "normal_load",
        }
    }

    /// Its factor.
    #[must_use]
    pub fn of(self, factors: &PairFactors) -> f64 {
        match self {
            Self::FrictionCoefficient => factors.friction_coefficient,
            Self::TangentialStiffness => factors.tangential_stiffness,
            Self::NormalStiffness => factors.normal_stiffness,
            Self::NormalLoad => factors.normal_load,
        }
    }

    fn of_mut(self, factors: &mut PairFactors) -> &mut f64 {
        match self {
            Self::FrictionCoefficient => &mut factors.friction_coefficient,
            Self::TangentialStiffness => &mut factors.tangential_stiffness,
            Self::NormalStiffness => &mut factors.normal_stiffness,
            Self::NormalLoad => &mut factors.normal_load,
        }
    }
}

/// What has one value of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum VariesPer {
    /// The wheel: all pairs alike.
    #[default]
    Wheel,
    /// Each sector: its pairs alike.
    Sector,
    /// Each pair.
    Pair,
}

/// Law of a factor on a nominal parameter.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub enum FactorLaw {
    /// `1 + s z`: z of zero mean and unit standard deviation.
    Relative(Distribution),
    /// `exp(s z)`: z standard normal; the median is 1.
    Lognormal,
}

/// How one parameter varies.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ContactVariation {
    /// The parameter.
    pub quantity: ContactQuantity,
    /// Law of its factor.
    pub law: FactorLaw,
    /// Standard deviation s: of the factor, or of its logarithm for a lognormal law.
    pub standard_deviation: f64,
    /// What has a value of its own.
    pub per: VariesPer,
}

impl ContactVariation {
    /// The factor of a unit draw.
    #[must_use]
    pub fn factor(&self, unit: f64) -> f64 {
        match self.law {
            FactorLaw::Relative(_) => 1.0 + self.standard_deviation * unit,
            FactorLaw::Lognormal => (self.standard_deviation * unit).exp(),
        }
    }

    fn units(&self, seed: u64, pattern: u32, count: usize) -> Vec<f64> {
        let distribution = match self.law {
            FactorLaw::Relative(distribution) => distribution,
            FactorLaw::Lognormal => Distribution::Normal,
        };
        let mut stream = contact_stream(seed, self.quantity as usize, pattern);
        distribution.unit_draws(&mut stream, count)
    }
}

/// The random contact of the wheels of a study.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactSource {
    /// Seed of the study.
    pub seed: u64,
    /// Sectors of a wheel.
    pub sectors: usize,
    /// Contact pairs of a sector.
    pub pairs: usize,
    /// What varies, one entry per parameter.
    pub variations: Vec<ContactVariation>,
}

impl ContactSource {
    /// Factors of pattern `id`. They depend on the seed, the parameter and `id` alone: a parameter
    /// that varies as well changes neither the blades nor the other parameters.
    #[must_use]
    pub fn factors(&self, id: u32) -> ContactFactors {
        let mut all = vec![PairFactors::default(); self.sectors * self.pairs];
        for variation in &self.variations {
            let (count, share) = match variation.per {
                VariesPer::Wheel => (1, all.len()),
                VariesPer::Sector => (self.sectors, self.pairs),
                VariesPer::Pair => (all.len(), 1),
            };
            let units = variation.units(self.seed, id, count);
            for (place, factors) in all.iter_mut().enumerate() {
                let unit = units[place / share];
                *variation.quantity.of_mut(factors) = variation.factor(unit);
            }
        }
        ContactFactors::new(all)
    }
}
