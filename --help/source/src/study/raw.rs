//! The study file as written: every key optional, nothing checked but names and types.

use std::fmt;

use serde::Deserialize;
use serde::de::{self, Deserializer, SeqAccess, Visitor};

use super::LoadShare;
use crate::model::cyclic::Hoop;
use crate::model::reduction::{DampedModes, ReductionOptions};
use crate::model::sector::{LumpedOptions, ParametricOptions};
use crate::population::statistics::Quantity;
use crate::population::table::Compression;
use crate::response::forced_response::{AmplitudeMeasure, RowsBeyondTolerance};
use crate::response::friction::{ContactLaw, Ring};
use crate::response::mistuning::{Projection, VariesPer};

/// Version of the study file.
pub(super) const SCHEMA: u64 = 1;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawStudy {
    pub schema: Option<u64>,
    pub study: Option<RawHead>,
    pub model: Option<RawModel>,
    #[serde(default)]
    pub reduction: ReductionOptions,
    pub contact: Option<RawContact>,
    pub damping: Option<RawDamping>,
    pub nodal_diameter_damping: Option<RawNodalDiameterDamping>,
    pub excitation: Option<RawExcitation>,
    pub mistuning: Option<RawMistuning>,
    pub sweep: Option<RawSweep>,
    #[serde(default)]
    pub solver: RawSolver,
    pub accuracy: Option<RawAccuracy>,
    pub stop: Option<RawStop>,
    #[serde(default)]
    pub output: RawOutput,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawHead {
    pub name: Option<String>,
    pub seed: Option<u64>,
    pub patterns: Option<u64>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum RawModelKind {
    Parametric,
    Lumped,
    Bundle,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawModel {
    pub source: Option<RawModelKind>,
    pub parametric: Option<ParametricOptions>,
    pub lumped: Option<LumpedOptions>,
    pub bundle: Option<RawBundle>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawBundle {
    pub path: Option<String>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawContact {
    pub law: Option<ContactLaw>,
    pub friction_coefficient: Option<f64>,
    pub tangential_stiffness_n_per_m: Option<f64>,
    pub normal_stiffness_n_per_m: Option<f64>,
    pub ring: Option<Ring>,
    pub normal_load: Option<RawNormalLoad>,
    #[serde(default)]
    pub variation: RawContactVariation,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum RawLoadSource {
    Rotation,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawNormalLoad {
    pub from: Option<RawLoadSource>,
    pub speed_rpm: Option<RawNumbers>,
    pub hoop: Option<Hoop>,
    pub share: Option<LoadShare>,
    pub ring_mass_factor: Option<f64>,
    pub ring_radius_m: Option<f64>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawContactVariation {
    pub friction_coefficient: Option<RawVariation>,
    pub tangential_stiffness: Option<RawVariation>,
    pub normal_stiffness: Option<RawVariation>,
    pub normal_load: Option<RawVariation>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum RawFactorKind {
    Normal,
    Uniform,
    TruncatedNormal,
    Lognormal,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawVariation {
    pub kind: Option<RawFactorKind>,
    pub standard_deviation: Option<f64>,
    pub truncation: Option<f64>,
    pub per: Option<VariesPer>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawDamping {
    pub structural_loss_factor: Option<f64>,
    pub modal_ratio: Option<f64>,
    pub rayleigh: Option<RawRayleigh>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawNodalDiameterDamping {
    pub damping_ratios: Option<Vec<(u32, f64)>>,
    pub modes: Option<DampedModes>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawRayleigh {
    pub mass_per_s: Option<f64>,
    pub stiffness_s: Option<f64>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawExcitation {
    pub engine_orders: Option<Vec<u32>>,
    pub amplitude_n: Option<RawNumbers>,
    pub load_case: Option<Vec<RawLoadCase>>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawLoadCase {
    pub name: Option<String>,
    pub force: Option<String>,
    pub node: Option<String>,
    pub direction: Option<Vec<f64>>,
    pub engine_orders: Option<Vec<u32>>,
    pub amplitude_n: Option<RawNumbers>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum RawQuantity {
    BladeStiffness,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum RawDistributionKind {
    Normal,
    Uniform,
    TruncatedNormal,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawDistribution {
    pub kind: Option<RawDistributionKind>,
    pub truncation: Option<f64>,
    pub standard_deviation: Option<f64>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawMistuning {
    #[serde(rename = "quantity")]
    pub _quantity: Option<RawQuantity>,
    pub projection: Option<Projection>,
    pub cantilever_mode_count: Option<usize>,
    pub distribution: Option<RawDistribution>,
    pub file: Option<String>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawSweep {
    pub normal_load_n: Option<Vec<RawLoad>>,
    pub standard_deviation: Option<Vec<f64>>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawSolver {
    pub harmonics: Option<RawHarmonics>,
    pub search_harmonics: Option<RawHarmonics>,
    pub harmonic_tolerance: Option<f64>,
    pub rows_beyond_tolerance: Option<RowsBeyondTolerance>,
    pub samples_per_period: Option<usize>,
    pub residual_tolerance: Option<f64>,
    pub peak_tolerance: Option<f64>,
    pub amplitude: Option<AmplitudeMeasure>,
    pub time_samples: Option<usize>,
    pub frequency_band_hz: Option<RawBand>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawAccuracy {
    pub amplitude_error: Option<f64>,
    pub simpler_contact_law: Option<bool>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawStop {
    pub percentile: Option<f64>,
    pub relative_width: Option<f64>,
    pub quantity: Option<Quantity>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawOutput {
    pub patterns: Option<bool>,
    pub compression: Option<Compression>,
    pub stress_pa_per_m: Option<f64>,
    pub stability: Option<u64>,
}

/// A number of newtons or the name of a linear limit.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum RawLoad {
    Number(f64),
    Name(String),
}

/// One number or a list.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum RawNumbers {
    One(f64),
    List(Vec<f64>),
}

/// `"auto"` or a list of harmonics.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum RawHarmonics {
    Name(String),
    List(Vec<u32>),
}

/// `"auto"` or a list of two frequencies.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum RawBand {
    Name(String),
    List(Vec<f64>),
}

struct LoadVisitor;

impl Visitor<'_> for LoadVisitor {
    type Value = RawLoad;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number of newtons of at least 0, \"stuck\", \"slide\" or \"free\"")
    }

    fn visit_f64<E: de::Error>(self, value: f64) -> Result<RawLoad, E> {
        Ok(RawLoad::Number(value))
    }

    fn visit_i64<E: de::Error>(self, value: i64) -> Result<RawLoad, E> {
        Ok(RawLoad::Number(value as f64))
    }

    fn visit_u64<E: de::Error>(self, value: u64) -> Result<RawLoad, E> {
        Ok(RawLoad::Number(value as f64))
    }

    fn visit_str<E: de::Error>(self, value: &str) -> Result<RawLoad, E> {
        Ok(RawLoad::Name(value.to_owned()))
    }
}

impl<'de> Deserialize<'de> for RawLoad {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(LoadVisitor)
    }
}

struct NumbersVisitor;

impl<'de> Visitor<'de> for NumbersVisitor {
    type Value = RawNumbers;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number or a list of numbers")
    }

    fn visit_f64<E: de::Error>(self, value: f64) -> Result<RawNumbers, E> {
        Ok(RawNumbers::One(value))
    }

    fn visit_i64<E: de::Error>(self, value: i64) -> Result<RawNumbers, E> {
        Ok(RawNumbers::One(value as f64))
    }

    fn visit_u64<E: de::Error>(self, value: u64) -> Result<RawNumbers, E> {
        Ok(RawNumbers::One(value as f64))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<RawNumbers, A::Error> {
        let mut numbers = Vec::new();
        while let Some(number) = list.next_element()? {
            numbers.push(number);
        }
        Ok(RawNumbers::List(numbers))
    }
}

impl<'de> Deserialize<'de> for RawNumbers {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(NumbersVisitor)
    }
}

struct HarmonicsVisitor;

impl<'de> Visitor<'de> for HarmonicsVisitor {
    type Value = RawHarmonics;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("\"auto\" or a list of harmonics like [1, 3]")
    }

    fn visit_str<E: de::Error>(self, value: &str) -> Result<RawHarmonics, E> {
        Ok(RawHarmonics::Name(value.to_owned()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<RawHarmonics, A::Error> {
        let mut harmonics = Vec::new();
        while let Some(harmonic) = list.next_element()? {
            harmonics.push(harmonic);
        }
        Ok(RawHarmonics::List(harmonics))
    }
}

impl<'de> Deserialize<'de> for RawHarmonics {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(HarmonicsVisitor)
    }
}

struct BandVisitor;

impl<'de> Visitor<'de> for BandVisitor {
    type Value = RawBand;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("\"auto\" or two frequencies like [540.0, 580.0]")
    }

    fn visit_str<E: de::Error>(self, value: &str) -> Result<RawBand, E> {
        Ok(RawBand::Name(value.to_owned()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<RawBand, A::Error> {
        let mut ends = Vec::new();
        while let Some(end) = list.next_element()? {
            ends.push(end);
        }
        Ok(RawBand::List(ends))
    }
}

impl<'de> Deserialize<'de> for RawBand {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(BandVisitor)
    }
}
