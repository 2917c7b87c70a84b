//! A study in which every key has a value and all of them fit together.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::{
    AccuracyOptions, LoadCase, Mistuning, NodalDiameterTable, OutputOptions, RotationLoad,
};
use crate::input::SourceMap;
use crate::model::reduction::{NodalDiameterDamping, ReductionOptions};
use crate::model::sector::{LumpedOptions, ParametricOptions, SectorModel};
use crate::population::monte_carlo::{LoadCaseName, Scenario};
use crate::population::statistics::StopOptions;
use crate::response::forced_response::{ContactCondition, SolverOptions};
use crate::response::friction::ContactOptions;
use crate::response::harmonic_balance::Damping;
use crate::response::mistuning::ContactVariation;

/// Where the sector model comes from.
#[derive(Debug, Clone, PartialEq)]
pub enum ModelSource {
    /// The built-in bladed disk.
    Parametric(ParametricOptions),
    /// Masses and springs.
    Lumped(LumpedOptions),
    /// A sector bundle.
    Bundle {
        /// The folder as written in the study.
        written: String,
        /// The folder, resolved against the study file.
        path: PathBuf,
    },
    /// In memory, from a program that uses the library.
    Given(Arc<SectorModel>),
}

/// A study that has been read, checked and filled in.
#[derive(Debug, Clone)]
pub struct Study {
    /// The study file.
    pub path: PathBuf,
    /// Where its keys stand.
    pub(super) map: SourceMap,
    /// Name; also of the results folder.
    pub name: String,
    /// Seed of the patterns.
    pub seed: u64,
    /// Number of patterns; the most of them where the study may stop before.
    pub patterns: u32,
    /// Source of the model.
    pub model: ModelSource,
    /// Settings of the reduction.
    pub reduction: ReductionOptions,
    /// Contact law; none for a model without contact.
    pub contact: Option<ContactOptions>,
    /// What of the contact varies from wheel to wheel, sector to sector or pair to pair.
    pub contact_variations: Vec<ContactVariation>,
    /// Damping of the structure.
    pub damping: Damping,
    /// Damping of the tuned modes by nodal diameter, besides.
    pub nodal_diameter_damping: Option<NodalDiameterTable>,
    /// Engine orders, as written; with load cases those of all, each once.
    pub engine_orders: Vec<u32>,
    /// Factor on the model's force vector.
    pub amplitude_n: f64,
    /// Factors of the engine orders in their order, each besides `amplitude_n`; empty: all alike.
    pub amplitudes_n: Vec<f64>,
    /// Load cases, as written; empty: the model's force vector alone, as the three keys above say.
    pub load_cases: Vec<LoadCase>,
    /// Mistuning and its source.
    pub mistuning: Mistuning,
    /// Normal loads by rotation; none where all are written in newtons.
    pub rotation: Option<RotationLoad>,
    /// Contact conditions of the sweep, as written, then those by rotation.
    pub contacts: Vec<ContactCondition>,
    /// Standard deviations of the sweep, as written; one `None` for patterns from a file.
    pub standard_deviations: Vec<Option<f64>>,
    /// Settings of the solution.
    pub solver: SolverOptions,
    /// Error by which the program chooses basis, harmonics and tolerances itself.
    pub accuracy: Option<AccuracyOptions>,
    /// When the study may stop before all patterns are solved.
    pub stop: Option<StopOptions>,
    /// Settings of the output.
    pub output: OutputOptions,
}

impl Study {
    /// The scenarios in product order load case, engine order, standard deviation, normal load.
    #[must_use]
    pub fn scenarios(&self) -> Vec<Scenario> {
        let mut scenarios = Vec::new();
        for (load_case, engine_orders) in self.excited_orders() {
            for &engine_order in engine_orders {
                for &standard_deviation in &self.standard_deviations {
                    for &contact in &self.contacts {
                        scenarios.push(Scenario {
                            index: scenarios.len(),
                            load_case,
                            engine_order,
                            standard_deviation,
                            contact,
                        });
                    }
                }
            }
        }
        scenarios
    }

    /// Load cases with their engine orders; one without name where the study has none.
    pub(crate) fn excited_orders(&self) -> Vec<(Option<LoadCaseName>, &[u32])> {
        if self.load_cases.is_empty() {
            return vec![(None, &self.engine_orders)];
        }
        let cases = self.load_cases.iter();
        cases
            .map(|case| (Some(case.name), case.engine_orders.as_slice()))
            .collect()
    }

    /// Factors on the force vector of engine orders that have one of their own.
    #[must_use]
    pub fn force_factors(&self) -> Vec<(u32, f64)> {
        let orders = self.engine_orders.iter();
        orders
            .zip(&self.amplitudes_n)
            .map(|(&engine_order, &factor)| (engine_order, factor))
            .collect()
    }

    /// What damps the modes of the tuned wheel besides `[damping]`.
    #[must_use]
    pub fn added_damping(&self) -> NodalDiameterDamping {
        let table = self.nodal_diameter_damping.as_ref();
        table.map_or_else(NodalDiameterDamping::default, NodalDiameterTable::damping)
    }

    /// Whether a scenario is under the nonlinear contact law.
    #[must_use]
    pub fn has_friction(&self) -> bool {
        self.contacts
            .iter()
            .any(|contact| matches!(contact, ContactCondition::Full { .. }))
    }

    /// Whether the study file says the key `key`, which nothing chosen takes the place of.
    pub(crate) fn states(&self, key: &str) -> bool {
        self.map.holds(key)
    }

    /// `path` as seen from the folder of the study file.
    #[must_use]
    pub fn beside(study_file: &Path, path: &str) -> PathBuf {
        study_file
            .parent()
            .map_or_else(|| PathBuf::from(path), |folder| folder.join(path))
    }
}
