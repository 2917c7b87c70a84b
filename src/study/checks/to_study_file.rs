//! From a [`Study`] back to a study file in which every key has a value.

use serde_json::{Value, json};

use super::validate_contact::variation_table;
use super::validate_damping::{damping_table, nodal_diameter_damping_table};
use super::validate_excitation::excitation_table;
use super::validate_loads::{normal_load_table, sweep_table};
use super::validate_mistuning::mistuning_table;
use super::validate_stop::stop_table;
use crate::model::sector_digest;
use crate::study::keys::contact::ContactTable;
use crate::study::keys::solver::{AccuracyTable, OutputTable, SolverTable};
use crate::study::keys::study_file::{HeadTable, SCHEMA, StudyFile};
use crate::study::keys::{BundleTable, ModelKind, ModelTable, OptionsTable, ReductionTable, keys};
use crate::study::{ModelSource, OutputOptions, Study};

/// The study with every default filled in, key by key as in a study file.
pub(super) fn resolved(study: &Study) -> Value {
    let mut resolved = json!(study_file(study));
    for key in keys() {
        let Some((table, name)) = key.key.rsplit_once('.') else {
            continue;
        };
        let is_chosen = study.accuracy.is_some() && key.is_of_accuracy && !study.states(&key.key);
        let Some(fields) = resolved.get_mut(table).and_then(Value::as_object_mut) else {
            continue;
        };
        if is_chosen {
            fields.remove(name);
        } else if key.is_or_null && !fields.contains_key(name) {
            fields.insert(name.to_owned(), Value::Null);
        }
    }
    if let ModelSource::Given(model) = &study.model {
        resolved["model"] = json!({ "source": "given", "digest": sector_digest(model) });
    }
    resolved
}

fn study_file(study: &Study) -> StudyFile {
    let mut solver = SolverTable::of(&study.solver);
    // A number would be taken for one that was asked for.
    solver.residual_tolerance = solver
        .residual_tolerance
        .filter(|_| study.solver.residual_is_stated);
    StudyFile {
        schema: Some(SCHEMA),
        study: Some(HeadTable {
            name: Some(study.name.clone()),
            seed: Some(study.seed),
            patterns: Some(u64::from(study.patterns)),
        }),
        model: Some(model_table(&study.model)),
        reduction: Some(ReductionTable::of(&study.reduction)),
        contact: contact_table(study),
        damping: Some(damping_table(study.damping)),
        nodal_diameter_damping: study
            .nodal_diameter_damping
            .as_ref()
            .map(nodal_diameter_damping_table),
        excitation: Some(excitation_table(study)),
        mistuning: Some(mistuning_table(&study.mistuning)),
        sweep: Some(sweep_table(study)),
        solver: Some(solver),
        accuracy: study.accuracy.as_ref().map(AccuracyTable::of),
        stop: study.stop.as_ref().map(stop_table),
        output: Some(output_table(&study.output)),
    }
}

/// A model in memory is in no file.
fn model_table(model: &ModelSource) -> ModelTable {
    let (source, table) = match model {
        ModelSource::Parametric(options) => {
            let parametric = Some(options.clone());
            (
                ModelKind::Parametric,
                ModelTable {
                    parametric,
                    ..ModelTable::default()
                },
            )
        }
        ModelSource::Lumped(options) => {
            let lumped = Some(options.clone());
            (
                ModelKind::Lumped,
                ModelTable {
                    lumped,
                    ..ModelTable::default()
                },
            )
        }
        ModelSource::Bundle { written, .. } => {
            let bundle = Some(BundleTable {
                path: Some(written.clone()),
            });
            (
                ModelKind::Bundle,
                ModelTable {
                    bundle,
                    ..ModelTable::default()
                },
            )
        }
        ModelSource::Given(_) => return ModelTable::default(),
    };
    ModelTable {
        source: Some(source),
        ..table
    }
}

fn contact_table(study: &Study) -> Option<ContactTable> {
    let contact = study.contact.as_ref()?;
    let variations = Some(&study.contact_variations).filter(|variations| !variations.is_empty());
    Some(ContactTable {
        law: Some(contact.law),
        friction_coefficient: Some(contact.friction_coefficient),
        tangential_stiffness_n_per_m: Some(contact.tangential_stiffness_n_per_m),
        normal_stiffness_n_per_m: contact.normal_stiffness_n_per_m,
        ring: Some(contact.ring),
        normal_load: study.rotation.as_ref().map(normal_load_table),
        variation: variations.map(|variations| variation_table(variations)),
    })
}

/// The digests of older studies do not have the key that is left out here at its default.
fn output_table(output: &OutputOptions) -> OutputTable {
    let mut table = OutputTable::of(output);
    table.stability = table.stability.filter(|rows| *rows > 0);
    table
}
