//! What is solved: contact, damping, excitation, mistuning and scenarios, without a word on how.

use std::path::Path;

use toml::{Table, Value};

use crate::response::forced_response::{AmplitudeMeasure, ContactCondition, FrequencyBand};
use crate::response::friction::ContactOptions;
use crate::response::harmonic_balance::Damping;
use crate::response::mistuning::{Distribution, PatternRecord, PatternRecords};
use crate::study::StudyError;

/// Name of a problem in messages, where that of a study file would stand.
pub(super) const NAME: &str = "problem";

/// Wheels of a problem with random ones for whatever is chosen by them, which are the first few. How many are solved is said by a
/// population.
const JUDGED: i64 = 1000;

/// What is solved. Physics only; [`Numerics`](super::Numerics) says how.
///
/// Every combination of engine order, standard deviation and contact condition is a [`Scenario`](crate::Scenario). What a problem does
/// not have, load cases, normal loads by rotation and contact that varies, a [`Study`](crate::Study) has.
#[derive(Debug, Clone, PartialEq)]
pub struct Problem {
    /// Contact law; none for a sector without contact.
    pub contact: Option<ContactOptions>,
    /// Damping of the structure.
    pub damping: Damping,
    /// Engine orders of the excitation, at least 1.
    pub engine_orders: Vec<u32>,
    /// Factor on the force vector of the sector, N where that one is of unit length.
    pub amplitude_n: f64,
    /// What mistunes the wheels.
    pub mistuning: Mistuning,
    /// Contact conditions: a normal load per sector, or a linear limit.
    pub conditions: Vec<ContactCondition>,
    /// The measure called amplitude.
    pub amplitude: AmplitudeMeasure,
    /// Band in which peaks are sought.
    pub band: FrequencyBand,
}

/// What mistunes the wheels.
#[derive(Debug, Clone, PartialEq)]
pub enum Mistuning {
    /// Wheels drawn at random; wheel `id` depends on the seed and `id` alone.
    Random {
        /// Law of a blade's relative stiffness deviation, scaled to unit standard deviation.
        law: Distribution,
        /// Standard deviations, from 0 to 0.5, each of scenarios of its own.
        standard_deviations: Vec<f64>,
        /// Seed, at most 2^63 - 1.
        seed: u64,
    },
    /// Wheels as measured: of each the relative stiffness deviations of its blades, in blade order. Their ids count from 0.
    Measured(Vec<Vec<f64>>),
}

impl Problem {
    /// A problem without contact under 1 N, with the fundamental amplitude and the band chosen for each wheel.
    #[must_use]
    pub fn new(damping: Damping, engine_orders: &[u32], mistuning: Mistuning) -> Self {
        Self {
            contact: None,
            damping,
            engine_orders: engine_orders.to_vec(),
            amplitude_n: 1.0,
            mistuning,
            conditions: vec![ContactCondition::Free],
            amplitude: AmplitudeMeasure::Fundamental,
            band: FrequencyBand::Auto,
        }
    }

    /// Records of measured wheels; none of random ones.
    ///
    /// # Errors
    /// A deviation that is not a number above -1, or no wheel.
    pub(super) fn records(&self) -> Result<Option<PatternRecords>, StudyError> {
        let Mistuning::Measured(wheels) = &self.mistuning else {
            return Ok(None);
        };
        let mut records = Vec::new();
        for (pattern, wheel) in (0..).zip(wheels) {
            for (blade, &deviation) in (0..).zip(wheel) {
                records.push(PatternRecord {
                    line: records.len() + 1,
                    pattern,
                    blade,
                    mode: None,
                    deviation,
                });
            }
        }
        Ok(Some(PatternRecords::new(Path::new(NAME), records)?))
    }

    /// These tables of a study file are written into `study`.
    pub(super) fn write(&self, study: &mut Table) {
        let table = |entries: Vec<(&str, Value)>| {
            let entries = entries.into_iter();
            Value::Table(
                entries
                    .map(|(key, value)| (key.to_owned(), value))
                    .collect(),
            )
        };
        let mut head = table(vec![("name", NAME.into()), ("seed", Value::Integer(0))]);
        let mut sweep = Table::new();
        let loads = self.conditions.iter().map(|condition| match condition {
            ContactCondition::Full { normal_load_n } => Value::Float(*normal_load_n),
            limit => limit.name().into(),
        });
        sweep.insert("normal_load_n".to_owned(), Value::Array(loads.collect()));
        let mistuning = match &self.mistuning {
            Mistuning::Random {
                law,
                standard_deviations,
                seed,
            } => {
                // One beyond the integers of TOML is refused as it stands.
                let seed = i64::try_from(*seed)
                    .map_or_else(|_| Value::String(seed.to_string()), Value::Integer);
                head = table(vec![
                    ("name", NAME.into()),
                    ("seed", seed),
                    ("patterns", JUDGED.into()),
                ]);
                let deviations = standard_deviations
                    .iter()
                    .map(|&deviation| Value::Float(deviation));
                sweep.insert(
                    "standard_deviation".to_owned(),
                    Value::Array(deviations.collect()),
                );
                let mut distribution = vec![("kind", law.name().into())];
                if let Distribution::TruncatedNormal { truncation } = law {
                    distribution.push(("truncation", Value::Float(*truncation)));
                }
                table(vec![("distribution", table(distribution))])
            }
            Mistuning::Measured(_) => table(vec![("file", NAME.into())]),
        };
        let damping = match self.damping {
            Damping::StructuralLossFactor(factor) => {
                ("structural_loss_factor", Value::Float(factor))
            }
            Damping::ModalRatio(ratio) => ("modal_ratio", Value::Float(ratio)),
            Damping::Rayleigh {
                mass_per_s,
                stiffness_s,
            } => {
                let factors = vec![
                    ("mass_per_s", Value::Float(mass_per_s)),
                    ("stiffness_s", Value::Float(stiffness_s)),
                ];
                ("rayleigh", table(factors))
            }
        };
        let excitation = vec![
            ("engine_orders", list(&self.engine_orders)),
            ("amplitude_n", Value::Float(self.amplitude_n)),
        ];
        let mut solver = Table::new();
        put(
            &mut solver,
            "amplitude",
            Value::try_from(self.amplitude).ok(),
        );
        if let FrequencyBand::Fixed { start_hz, stop_hz } = self.band {
            let band = vec![Value::Float(start_hz), Value::Float(stop_hz)];
            solver.insert("frequency_band_hz".to_owned(), Value::Array(band));
        }
        put(study, "schema", Some(1));
        put(study, "study", Some(head));
        put(
            study,
            "contact",
            self.contact
                .as_ref()
                .and_then(|contact| Value::try_from(contact).ok()),
        );
        put(study, "damping", Some(table(vec![damping])));
        put(study, "excitation", Some(table(excitation)));
        put(study, "mistuning", Some(mistuning));
        put(study, "sweep", Some(sweep));
        put(study, "solver", Some(solver));
    }
}

/// Writes a key that has a value.
pub(super) fn put(table: &mut Table, key: &str, value: Option<impl Into<Value>>) {
    if let Some(value) = value {
        table.insert(key.to_owned(), value.into());
    }
}

/// Whole numbers as a list.
pub(super) fn list(numbers: &[u32]) -> Value {
    let numbers = numbers
        .iter()
        .map(|&number| Value::Integer(i64::from(number)));
    Value::Array(numbers.collect())
}
