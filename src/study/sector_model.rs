//! The sector model that a study names, and the checks that need both.

use super::excitation::with_load_cases;
use super::rotation_load::pressed_body;
use super::{MistuningSource, ModelSource, PipelineError, Problem, Study, StudyError};
use crate::model::cyclic::{pair_tangents, ring_free};
use crate::model::sector::{
    Body, ContactSide, ModelError, SectorModel, bundle, lumped, parametric, validate,
};
use crate::response::forced_response::ContactCondition;
use crate::response::friction::{ContactLaw, ContactOptions, Ring};
use crate::response::mistuning::{ContactSource, Pattern, PatternSource};

/// Loads and validates the sector model of `study`.
///
/// # Errors
/// The model is refused, its files cannot be read, or the study does not fit to it.
pub fn load_sector_model(study: &Study) -> Result<SectorModel, PipelineError> {
    let model = sector_of(study).map_err(|error| match error {
        StudyError::Model(error) => PipelineError::Model(*error),
        error => PipelineError::Study(error),
    })?;
    check_contact(study, &model)?;
    check_nodal_diameters(study, &model)?;
    let model = with_load_cases(study, model)?;
    Ok(match &study.rotation {
        Some(rotation) => rotation.applied_to(model),
        None => model,
    })
}

/// The sector model as its source has it.
pub(super) fn sector_of(study: &Study) -> Result<SectorModel, StudyError> {
    match &study.model {
        ModelSource::Parametric(options) => parametric::build(options),
        ModelSource::Lumped(options) => lumped::build(options),
        ModelSource::Bundle { path, .. } => bundle::read(path),
        ModelSource::Given(model) => validate(model).map(|()| SectorModel::clone(model)),
    }
    .map_err(|error| refused(study, error))
}

/// The patterns of `study` for wheels of `model`.
///
/// # Errors
/// The file of patterns does not fit to the wheel.
pub fn pattern_source(study: &Study, model: &SectorModel) -> Result<PatternSource, StudyError> {
    let sectors = model.sectors;
    let blades = match &study.mistuning.source {
        MistuningSource::Law(distribution) => PatternSource::Random {
            seed: study.seed,
            count: study.patterns,
            sectors,
            distribution: *distribution,
        },
        MistuningSource::File { records, .. } => {
            let modes = study.mistuning.cantilever_mode_count.unwrap_or(0);
            PatternSource::Table(records.for_wheel(sectors, modes)?)
        }
    };
    if study.contact_variations.is_empty() {
        return Ok(blades);
    }
    Ok(PatternSource::WithContact {
        blades: Box::new(blades),
        contact: ContactSource {
            seed: study.seed,
            sectors,
            pairs: model.contact_pairs.len(),
            variations: study.contact_variations.clone(),
        },
    })
}

/// Mistuned wheels by which the settings of `study` are chosen: of its law, but none of its population, or the first of its
/// file and the one that deviates most.
///
/// # Errors
/// The file of patterns does not fit to the wheel.
pub(crate) fn judging_patterns(
    study: &Study,
    model: &SectorModel,
) -> Result<Vec<Pattern>, StudyError> {
    let (source, ids): (PatternSource, Vec<u32>) = match &study.mistuning.source {
        MistuningSource::Law(_) => {
            let all = Study {
                patterns: u32::MAX,
                ..study.clone()
            };
            let last = u32::MAX - JUDGING_PATTERNS;
            (pattern_source(&all, model)?, (last..u32::MAX).collect())
        }
        MistuningSource::File { .. } => {
            let source = pattern_source(study, model)?;
            let deviates = |id: u32| {
                let pattern = source.pattern(id, None);
                pattern.map_or(0.0, |pattern| pattern.deviations.root_mean_square())
            };
            let mut ids = source.ids();
            let most = { ids.iter().copied() }.max_by(|&a, &b| deviates(a).total_cmp(&deviates(b)));
            ids.truncate(JUDGING_PATTERNS as usize);
            ids.extend(most.filter(|most| !ids.contains(most)));
            (source, ids)
        }
    };
    let sigma = study.standard_deviations.iter().flatten().copied();
    let sigma = sigma.reduce(f64::max);
    let patterns = ids.into_iter().filter_map(|id| source.pattern(id, sigma));
    Ok(patterns.collect())
}

/// A refused option is a mistake of the study file, which has its line.
fn refused(study: &Study, error: ModelError) -> StudyError {
    let not_accepted = |value: f64, accepted: String| Problem::NotAccepted {
        value: value.to_string(),
        accepted,
        suggestion: None,
    };
    let (key, problem) = match error {
        ModelError::Option {
            key,
            value,
            accepted,
        } => (key, not_accepted(value, accepted.to_string())),
        ModelError::NeedsMass {
            key,
            value,
            mass_key,
        } => {
            let accepted = format!("0, or a positive {mass_key} that holds it");
            (key, not_accepted(value, accepted))
        }
        ModelError::Chain { key, problem } => {
            let reason = problem.to_string();
            (key, Problem::Conflict { reason })
        }
        error => return StudyError::Model(Box::new(error)),
    };
    StudyError::Invalid {
        path: study.path.clone(),
        findings: vec![study.map.finding(&key, problem)],
    }
}

/// Mistuned wheels by which settings are chosen.
const JUDGING_PATTERNS: u32 = 2;

fn check_contact(study: &Study, model: &SectorModel) -> Result<(), StudyError> {
    let finding = |key: &str, problem: Problem| {
        Err(StudyError::Invalid {
            path: study.path.clone(),
            findings: vec![study.map.finding(key, problem)],
        })
    };
    let only_free = study
        .contacts
        .iter()
        .all(|&contact| contact == ContactCondition::Free);
    let has_contact = !model.contact_pairs.is_empty();
    if !has_contact && !only_free {
        return finding(
            "sweep.normal_load_n",
            Problem::NotAccepted {
                value: study.map.value("sweep.normal_load_n"),
                accepted: "[\"free\"], because the model has no contact".to_owned(),
                suggestion: None,
            },
        );
    }
    if !has_contact && study.contact.is_some() {
        return finding(
            "contact",
            Problem::Conflict {
                reason: "the model has no contact; accepted: no [contact]".to_owned(),
            },
        );
    }
    if has_contact && !only_free && study.contact.is_none() {
        return finding(
            "contact",
            Problem::Missing {
                accepted: "a table with friction_coefficient, tangential_stiffness_n_per_m and \
                           normal_stiffness_n_per_m, because the model has contact"
                    .to_owned(),
            },
        );
    }
    if let Some(law) = study.contact.as_ref().map(|contact| contact.law)
        && let Some(accepted) = law_for_tangents(law, model)
    {
        return finding(
            "contact.law",
            Problem::NotAccepted {
                value: study.map.value("contact.law"),
                accepted,
                suggestion: None,
            },
        );
    }
    let creeping = |contact: &ContactOptions| contact.ring == Ring::Creeping;
    if study.contact.as_ref().is_some_and(creeping) && !ring_free(model).contains(&true) {
        let held = if pressed_body(model) == Some(Body::Ring) {
            "springs or contact normals hold the ring of this model"
        } else {
            "this model has no ring"
        };
        return finding(
            "contact.ring",
            Problem::NotAccepted {
                value: study.map.value("contact.ring"),
                accepted: format!("\"locked\", because {held}"),
                suggestion: None,
            },
        );
    }
    Ok(())
}

/// What is accepted in the place of a law along the first tangent, where a pair rubs along the second alone; none for other laws, and
/// where no pair does.
fn law_for_tangents(law: ContactLaw, model: &SectorModel) -> Option<String> {
    if law.tangents() > 1 {
        return None;
    }
    let tangents = pair_tangents(model);
    let pair = tangents.iter().position(|moves| *moves == [false, true])?;
    let contact_pair = &model.contact_pairs[pair];
    let name = |side: &ContactSide| {
        side.node()
            .map_or("the ground".to_owned(), |node| format!("node {node}"))
    };
    Some(format!(
        "\"macro_slip_2d\", because contact pair {pair} ({} on {}) does not move along its first tangent, on which \
         this law acts",
        name(&contact_pair.first),
        name(&contact_pair.second)
    ))
}

/// Refuses nodal diameters that the wheel does not have.
fn check_nodal_diameters(study: &Study, model: &SectorModel) -> Result<(), StudyError> {
    let last = model.sectors / 2;
    let findings: Vec<_> = study
        .nodal_diameter_damping
        .iter()
        .flat_map(|table| table.ratios.iter().enumerate())
        .filter(|(_, (h, _))| *h as usize > last)
        .map(|(place, _)| {
            let key = format!("nodal_diameter_damping.damping_ratios[{place}]");
            let problem = Problem::NotAccepted {
                value: study.map.value(&key),
                accepted: format!(
                    "nodal diameters from 0 to {last}, those of {} sectors",
                    model.sectors
                ),
                suggestion: None,
            };
            study.map.finding(&key, problem)
        })
        .collect();
    if findings.is_empty() {
        return Ok(());
    }
    Err(StudyError::Invalid {
        path: study.path.clone(),
        findings,
    })
}
