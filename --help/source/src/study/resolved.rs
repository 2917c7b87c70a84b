//! A study in which every key has a value and all of them fit together.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde_json::{Value, json};

use super::accuracy::KEYS_OF_ACCURACY;
use super::load_cases::amplitude_value;
use super::raw::SCHEMA;
use super::{AccuracyOptions, LoadCase, Mistuning, NodalDiameterTable, RotationLoad};
use crate::input::SourceMap;
use crate::model::reduction::{NodalDiameterDamping, ReductionOptions};
use crate::model::reduction_digest;
use crate::model::sector::{LumpedOptions, ParametricOptions, SectorModel};
use crate::population::monte_carlo::{LoadCaseName, Scenario};
use crate::population::statistics::StopOptions;
use crate::population::table::Compression;
use crate::response::forced_response::{
    ContactCondition, FrequencyBand, Harmonics, SearchHarmonics, SolverOptions,
};
use crate::response::friction::ContactOptions;
use crate::response::harmonic_balance::Damping;
use crate::response::mistuning::{ContactVariation, Distribution, FactorLaw};

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

/// What is written beside the statistics, and how.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct OutputOptions {
    /// Whether `patterns.parquet` is written; absent: up to 10,000 patterns.
    pub patterns: Option<bool>,
    /// Compression of the tables.
    pub compression: Compression,
    /// Stress per amplitude of the observed node, Pa/m.
    pub stress_pa_per_m: Option<f64>,
    /// Rows round every percentile whose motions are looked at for their stability; 0: none, and no tuned wheel.
    pub stability: u32,
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

    /// The study with every default filled in, key by key as in a study file.
    #[must_use]
    pub fn resolved(&self) -> Value {
        let mut study = json!({
            "schema": SCHEMA,
            "study": { "name": self.name, "seed": self.seed, "patterns": self.patterns },
            "model": self.model_value(),
            "reduction": self.reduction,
            "damping": match self.damping {
                Damping::StructuralLossFactor(factor) => json!({ "structural_loss_factor": factor }),
                Damping::ModalRatio(ratio) => json!({ "modal_ratio": ratio }),
                Damping::Rayleigh { mass_per_s, stiffness_s } => {
                    json!({ "rayleigh": { "mass_per_s": mass_per_s, "stiffness_s": stiffness_s } })
                }
            },
            "excitation": self.excitation_value(),
            "mistuning": self.mistuning.resolved(),
            "sweep": self.sweep_value(),
            "solver": {
                "harmonics": match &self.solver.harmonics {
                    Harmonics::Auto => json!("auto"),
                    Harmonics::Set(harmonics) => json!(harmonics),
                },
                "search_harmonics": match &self.solver.search_harmonics {
                    SearchHarmonics::Auto => json!("auto"),
                    SearchHarmonics::All => json!("all"),
                    SearchHarmonics::Set(harmonics) => json!(harmonics),
                },
                "harmonic_tolerance": self.solver.harmonic_tolerance,
                "rows_beyond_tolerance": self.solver.rows_beyond_tolerance,
                "samples_per_period": self.solver.samples_per_period,
                "residual_tolerance": self.solver.residual_tolerance,
                "peak_tolerance": self.solver.peak_tolerance,
                "amplitude": self.solver.amplitude,
                "time_samples": self.solver.time_samples,
                "frequency_band_hz": match self.solver.frequency_band {
                    FrequencyBand::Auto => json!("auto"),
                    FrequencyBand::Fixed { start_hz, stop_hz } => json!([start_hz, stop_hz]),
                },
            },
            "output": self.output_value(),
        });
        // A number would be taken for one that was asked for.
        if !self.solver.residual_is_stated {
            without(&mut study, ["solver.residual_tolerance"].into_iter());
        }
        if let Some(accuracy) = &self.accuracy {
            study["accuracy"] = json!(accuracy);
            let chosen = KEYS_OF_ACCURACY.into_iter();
            without(&mut study, chosen.filter(|key| !self.states(key)));
        }
        if let Some(table) = &self.nodal_diameter_damping {
            study["nodal_diameter_damping"] = table.resolved();
        }
        if let Some(stop) = &self.stop {
            study["stop"] = json!(stop);
        }
        if let Some(contact) = &self.contact {
            study["contact"] = json!(contact);
            if let Some(rotation) = &self.rotation {
                study["contact"]["normal_load"] = rotation.resolved();
            }
            if !self.contact_variations.is_empty() {
                study["contact"]["variation"] = variation_value(&self.contact_variations);
            }
        }
        study
    }

    /// `[excitation]` with every default filled in.
    fn excitation_value(&self) -> Value {
        if self.load_cases.is_empty() {
            return json!({
                "engine_orders": self.engine_orders,
                "amplitude_n": amplitude_value(self.amplitude_n, &self.amplitudes_n),
            });
        }
        let cases: Vec<Value> = self.load_cases.iter().map(LoadCase::resolved).collect();
        json!({ "load_case": cases })
    }

    fn output_value(&self) -> Value {
        let OutputOptions {
            patterns,
            compression,
            stress_pa_per_m,
            stability,
        } = self.output;
        let mut output = json!({ "patterns": patterns, "compression": compression });
        if let Some(scale) = stress_pa_per_m {
            output["stress_pa_per_m"] = json!(scale);
        }
        if stability > 0 {
            output["stability"] = json!(stability);
        }
        output
    }

    fn model_value(&self) -> Value {
        match &self.model {
            ModelSource::Parametric(options) => {
                json!({ "source": "parametric", "parametric": options })
            }
            ModelSource::Lumped(options) => json!({ "source": "lumped", "lumped": options }),
            ModelSource::Bundle { written, .. } => {
                json!({ "source": "bundle", "bundle": { "path": written } })
            }
            ModelSource::Given(model) => {
                json!({ "source": "given", "digest": reduction_digest(model, "") })
            }
        }
    }

    fn sweep_value(&self) -> Value {
        let by_rotation = |contact: &ContactCondition| {
            let rotation = self.rotation.as_ref();
            rotation.is_some_and(|rotation| rotation.speed_rpm(*contact).is_some())
        };
        let loads: Vec<Value> = self
            .contacts
            .iter()
            .filter(|contact| !by_rotation(contact))
            .map(|contact| match contact {
                ContactCondition::Full { normal_load_n } => json!(normal_load_n),
                limit => json!(limit.name()),
            })
            .collect();
        let deviations: Vec<f64> = self.standard_deviations.iter().flatten().copied().collect();
        let mut sweep = json!({});
        if !loads.is_empty() {
            sweep["normal_load_n"] = json!(loads);
        }
        if !deviations.is_empty() {
            sweep["standard_deviation"] = json!(deviations);
        }
        sweep
    }
}

/// Takes keys of tables out of a study.
fn without(study: &mut Value, keys: impl Iterator<Item = &'static str>) {
    for key in keys {
        if let Some((table, key)) = key.split_once('.')
            && let Some(fields) = study[table].as_object_mut()
        {
            fields.remove(key);
        }
    }
}

fn variation_value(variations: &[ContactVariation]) -> Value {
    let mut value = json!({});
    for variation in variations {
        let kind = match &variation.law {
            FactorLaw::Relative(distribution) => distribution.name(),
            FactorLaw::Lognormal => "lognormal",
        };
        let own = &mut value[variation.quantity.name()];
        *own = json!({
            "kind": kind,
            "standard_deviation": variation.standard_deviation,
            "per": variation.per,
        });
        if let FactorLaw::Relative(Distribution::TruncatedNormal { truncation }) = variation.law {
            own["truncation"] = json!(truncation);
        }
    }
    value
}
