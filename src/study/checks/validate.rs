//! From the text of a study file to a [`Study`]: calls the checks of all tables, and tells all that is wrong at once.

use std::path::Path;

use serde_json::Value;

use super::check::Check;
use super::replaced::replaced;
use super::to_study_file::resolved;
use super::validate_accuracy::{accuracy, with_accuracy};
use super::validate_contact::contact_variations;
use super::validate_damping::{damping, nodal_diameter_damping};
use super::validate_excitation::excitation;
use super::validate_loads::{contacts, rotation};
use super::validate_mistuning::mistuning;
use super::validate_solver::solver;
use super::validate_stop::stop;
use crate::input::{Finding, Problem, SourceMap};
use crate::model::reduction::{Basis, ReductionOptions};
use crate::model::sector::{Damper, DamperBody, DamperShape, ParametricOptions};
use crate::response::forced_response::SearchHarmonics;
use crate::response::friction::{ContactLaw, ContactOptions, Ring};
use crate::study::keys::contact::ContactTable;
use crate::study::keys::study_file::{HeadTable, SCHEMA, StudyFile};
use crate::study::keys::{ModelKind, ModelTable, ReductionTable};
use crate::study::rotation::pressed_by;
use crate::study::{
    AccuracyOptions, Given, MistuningSource, ModelSource, OutputOptions, RotationOptions, Study,
    StudyError,
};

impl Study {
    /// Reads and checks the study file `path`.
    ///
    /// # Errors
    /// The file cannot be read, or everything in it that is not accepted.
    pub fn read(path: &Path) -> Result<Self, StudyError> {
        Self::read_with(path, None)
    }

    /// Reads and checks the study file `path` as if it had these `[accuracy]`, if there are any.
    ///
    /// # Errors
    /// The file cannot be read, or everything in it that is not accepted.
    pub fn read_with(path: &Path, accuracy: Option<AccuracyOptions>) -> Result<Self, StudyError> {
        let text = std::fs::read_to_string(path).map_err(|source| StudyError::Unreadable {
            path: path.to_owned(),
            source,
        })?;
        match accuracy {
            None => Self::parse(path, &text),
            Some(accuracy) => {
                // A file that is no TOML is described when it is parsed.
                let written = SourceMap::new(&text).ok();
                let line = written
                    .filter(|map| map.holds("accuracy"))
                    .map(|map| map.line("accuracy"));
                if let Some(line) = line {
                    let reason = "--accuracy is given too; accepted: one of the two".to_owned();
                    return Err(StudyError::Invalid {
                        path: path.to_owned(),
                        findings: vec![Finding {
                            line,
                            key: "accuracy".to_owned(),
                            problem: Problem::Conflict { reason },
                            excerpt: None,
                        }],
                    });
                }
                Self::parse(path, &accuracy.appended_to(&text))
            }
        }
    }

    /// Checks the text of the study file `path`; files it names are sought beside it.
    ///
    /// # Errors
    /// Everything in it that is not accepted.
    pub fn parse(path: &Path, text: &str) -> Result<Self, StudyError> {
        Self::parse_with(path, text, Given::default())
    }

    /// The study with every default filled in, key by key as in a study file.
    #[must_use]
    pub fn resolved(&self) -> Value {
        resolved(self)
    }

    /// Checks a text that leaves out what is `given` in memory.
    ///
    /// # Errors
    /// Everything in it that is not accepted.
    pub(crate) fn parse_with(path: &Path, text: &str, given: Given) -> Result<Self, StudyError> {
        let invalid = |findings| StudyError::Invalid {
            path: path.to_owned(),
            findings,
        };
        let map = SourceMap::new(text).map_err(|finding| invalid(vec![*finding]))?;
        let replaced = replaced(&map);
        if !replaced.is_empty() {
            return Err(invalid(replaced));
        }
        let file: StudyFile =
            toml::from_str(text).map_err(|error| invalid(vec![map.describe(&error)]))?;
        let mut check = Check {
            map: &map,
            findings: Vec::new(),
        };
        let study = resolve(&mut check, path, file, given)?;
        match study {
            Some((study, rotation)) if check.findings.is_empty() => {
                let map = map.clone();
                pressed_by(Self { map, ..study }, rotation)
            }
            _ => {
                check.findings.sort_by_key(|finding| finding.line);
                Err(invalid(check.findings))
            }
        }
    }
}

/// None where a study cannot even be put together; the findings then say why.
fn resolve(
    check: &mut Check,
    path: &Path,
    file: StudyFile,
    given: Given,
) -> Result<Option<(Study, Option<RotationOptions>)>, StudyError> {
    match file.schema {
        Some(SCHEMA) => {}
        Some(_) => check.refuse("schema"),
        None => check.missing("schema"),
    }
    let head = file.study.unwrap_or_default();
    let (name, seed) = identity(check, &head);
    let model = match given.model {
        Some(sector) => Some(ModelSource::Given(sector)),
        None => model(check, path, file.model.unwrap_or_default()),
    };
    let reduction = reduction(check, file.reduction);
    let damping = damping(check, file.damping);
    let nodal_diameter_damping = file
        .nodal_diameter_damping
        .and_then(|table| nodal_diameter_damping(check, table));
    let excited = excitation(check, path, file.excitation.unwrap_or_default());
    let (amplitude_n, amplitudes_n) = excited.amplitudes;
    let sweep = file.sweep.unwrap_or_default();
    let normal_load = file
        .contact
        .as_ref()
        .and_then(|table| table.normal_load.as_ref());
    let contacts = contacts(check, &sweep, normal_load.is_some());
    let rotation = normal_load.and_then(|table| rotation(check, table));
    let solver = solver(check, file.solver);
    let contact = file
        .contact
        .as_ref()
        .map(|table| contact_options(check, table));
    if let Some(contact) = &contact {
        normal_stiffness(check, contact);
    }
    let variation = file
        .contact
        .as_ref()
        .and_then(|table| table.variation.as_ref());
    let contact_variations = match (variation, &contact) {
        (Some(table), Some(contact)) => contact_variations(check, table, contact),
        _ => Vec::new(),
    };
    let is_creeping = contact.as_ref().map(|contact| contact.ring) == Some(Ring::Creeping);
    if let (SearchHarmonics::Set(_), true) = (&solver.search_harmonics, is_creeping) {
        let reason = "is for a locked ring; peaks of a creeping one are sought with all harmonics; \
                      accepted: \"auto\" or \"all\"";
        check.conflict("solver.search_harmonics", reason);
    }
    let patterns = (head.patterns, given.records);
    let mistuning = mistuning(check, path, file.mistuning, &sweep, patterns)?;
    let (Some(model), Some(damping), Some(mistuning)) = (model, damping, mistuning) else {
        return Ok(None);
    };
    let is_of_file = matches!(mistuning.mistuning.source, MistuningSource::File { .. });
    let stop = file
        .stop
        .and_then(|table| stop(check, &table, mistuning.patterns, is_of_file));
    let accuracy = file
        .accuracy
        .map(|table| accuracy(check, table, reduction.basis));
    let mut output = OutputOptions::default();
    check.put("output", file.output, &mut output, &[]);
    let study = Study {
        path: path.to_owned(),
        map: SourceMap::default(),
        name,
        seed,
        patterns: mistuning.patterns,
        model,
        reduction,
        contact,
        contact_variations,
        damping,
        nodal_diameter_damping,
        engine_orders: excited.engine_orders,
        amplitude_n,
        amplitudes_n,
        load_cases: excited.load_cases,
        rotation: None,
        mistuning: mistuning.mistuning,
        contacts,
        standard_deviations: mistuning.standard_deviations,
        solver,
        accuracy: None,
        stop,
        output,
    };
    let study = with_accuracy(study, accuracy, |key| check.is_written(key));
    Ok(Some((study, rotation)))
}

fn identity(check: &mut Check, head: &HeadTable) -> (String, u64) {
    let name = head.name.clone().unwrap_or_default();
    let well_formed = name
        .chars()
        .all(|c| c.is_ascii_alphanumeric() || c == '-' || c == '_')
        && name.starts_with(|c: char| c.is_ascii_alphanumeric());
    if head.name.is_none() {
        check.missing("study.name");
    } else if !well_formed || name.len() > 100 {
        check.refuse("study.name");
    }
    if head.seed.is_none() {
        check.missing("study.seed");
    }
    (name, head.seed.unwrap_or_default())
}

/// Refuses shape and body of an underplatform damper beside another damper.
fn check_damper(check: &mut Check, options: &ParametricOptions) {
    let damper = match options.damper {
        Damper::Underplatform => return,
        Damper::Ring => "ring",
        Damper::Shroud => "shroud",
        Damper::BladeToGround => "blade_to_ground",
    };
    // A resolved study writes the defaults of every key.
    let keys = [
        (
            "damper_shape",
            options.damper_shape != DamperShape::default(),
        ),
        ("damper_body", options.damper_body != DamperBody::default()),
    ];
    for (key, is_chosen) in keys {
        if is_chosen {
            check.conflict(
                &format!("model.parametric.{key}"),
                &format!("it is not used with damper = \"{damper}\"; accepted: damper = \"underplatform\", or no {key}"),
            );
        }
    }
}

fn model(check: &mut Check, study_file: &Path, table: ModelTable) -> Option<ModelSource> {
    let Some(kind) = table.source else {
        check.missing("model.source");
        return None;
    };
    let tables = [
        (
            "parametric",
            ModelKind::Parametric,
            table.parametric.is_some(),
        ),
        ("lumped", ModelKind::Lumped, table.lumped.is_some()),
        ("bundle", ModelKind::Bundle, table.bundle.is_some()),
    ];
    for (name, of_kind, given) in tables {
        if given && of_kind != kind {
            let reason = format!(
                "it is not used with source = {}",
                check.map.value("model.source")
            );
            check.conflict(&format!("model.{name}"), &reason);
        }
    }
    match kind {
        ModelKind::Parametric => {
            let options = table.parametric.unwrap_or_default();
            check_damper(check, &options);
            Some(ModelSource::Parametric(options))
        }
        ModelKind::Lumped => {
            if table.lumped.is_none() {
                check.missing_for(
                    "model.lumped",
                    "a table with sectors, blade_mass_kg, blade_stiffness_n_per_m",
                );
            }
            table.lumped.map(ModelSource::Lumped)
        }
        ModelKind::Bundle => {
            let path = table.bundle.and_then(|bundle| bundle.path);
            if path.is_none() {
                check.missing_for(
                    "model.bundle.path",
                    "the folder of a sector bundle, relative to the study file",
                );
            }
            path.map(|written| ModelSource::Bundle {
                path: Study::beside(study_file, &written),
                written,
            })
        }
    }
}

fn reduction(check: &mut Check, table: Option<ReductionTable>) -> ReductionOptions {
    let mut options = ReductionOptions::default();
    check.put("reduction", table, &mut options, &[]);
    let stick = ("reduction.stick_modes", options.stick_modes.is_some());
    let slide = ("reduction.slide_modes", options.slide_modes.is_some());
    let mut refuse = |keys: &[(&str, bool)], reason: &str| {
        for (key, _) in keys.iter().filter(|(_, is_given)| *is_given) {
            check.conflict(key, reason);
        }
    };
    match options.basis {
        Basis::TunedReceptances => refuse(
            &[stick, slide],
            "basis = \"tuned_receptances\" has no modes to choose; accepted: neither stick_modes nor \
             slide_modes",
        ),
        Basis::Auto => refuse(
            &[stick, slide],
            "basis = \"auto\" chooses the number of modes; accepted: reduction.error, or \
             basis = \"stick_slide\" with fixed numbers",
        ),
        Basis::StickAttachment => refuse(
            &[slide],
            "basis = \"stick_attachment\" has none; accepted: stick_modes",
        ),
        Basis::StickSlide => {
            let accepted = "a whole number from 1 to 1000, beside";
            if stick.1 && !slide.1 {
                check.missing_for(slide.0, &format!("{accepted} stick_modes"));
            }
            if slide.1 && !stick.1 {
                check.missing_for(stick.0, &format!("{accepted} slide_modes"));
            }
        }
    }
    options
}

fn contact_options(check: &mut Check, table: &ContactTable) -> ContactOptions {
    ContactOptions {
        law: table.law.unwrap_or(ContactLaw::Simplified3d),
        friction_coefficient: check
            .required("contact.friction_coefficient", table.friction_coefficient),
        tangential_stiffness_n_per_m: check.required(
            "contact.tangential_stiffness_n_per_m",
            table.tangential_stiffness_n_per_m,
        ),
        normal_stiffness_n_per_m: table.normal_stiffness_n_per_m,
        ring: table.ring.unwrap_or_default(),
    }
}

fn normal_stiffness(check: &mut Check, contact: &ContactOptions) {
    let key = "contact.normal_stiffness_n_per_m";
    match contact.normal_stiffness_n_per_m {
        None if contact.law.has_variable_load() => {
            check.missing(key);
        }
        Some(value) => {
            check.judged(key, value);
        }
        None => {}
    }
}
