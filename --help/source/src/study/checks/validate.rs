//! From the study file as written to a [`Study`]: ranges, defaults and cross-checks, all at once.

use std::path::Path;

use super::check::Check;
use super::replaced::replaced;
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
use crate::response::forced_response::{Harmonics, SolverOptions};
use crate::response::friction::{ContactLaw, ContactOptions, Ring};
use crate::response::receptance::HIGHEST_HARMONIC;
use crate::study::raw::{RawContact, RawHead, RawModel, RawModelKind, RawOutput, RawStudy, SCHEMA};
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
        let raw: RawStudy =
            toml::from_str(text).map_err(|error| invalid(vec![map.describe(&error)]))?;
        let mut check = Check {
            map: &map,
            findings: Vec::new(),
        };
        let study = resolve(&mut check, path, raw, given)?;
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
    mut raw: RawStudy,
    given: Given,
) -> Result<Option<(Study, Option<RotationOptions>)>, StudyError> {
    match raw.schema {
        Some(SCHEMA) => {}
        Some(_) => check.refuse("schema", "1"),
        None => check.missing("schema", "1"),
    }
    let head = raw.study.unwrap_or_default();
    let (name, seed) = identity(check, &head);
    let model = match given.model {
        Some(sector) => Some(ModelSource::Given(sector)),
        None => model(check, path, raw.model.unwrap_or_default()),
    };
    reduction(check, &raw.reduction);
    let damping = damping(check, raw.damping);
    let nodal_diameter_damping = raw
        .nodal_diameter_damping
        .and_then(|raw| nodal_diameter_damping(check, raw));
    let excited = excitation(check, path, raw.excitation.unwrap_or_default());
    let (amplitude_n, amplitudes_n) = excited.amplitudes;
    let sweep = raw.sweep.unwrap_or_default();
    let normal_load = raw.contact.as_mut().and_then(|raw| raw.normal_load.take());
    let contacts = contacts(check, &sweep, normal_load.is_some());
    let rotation = normal_load.and_then(|raw| rotation(check, &raw));
    let solver = solver(check, raw.solver);
    let variation = raw
        .contact
        .as_mut()
        .map(|raw| std::mem::take(&mut raw.variation));
    let contact = raw.contact.map(|raw| contact_options(check, &raw));
    if let Some(contact) = &contact {
        normal_stiffness(check, contact);
        if contact.law == ContactLaw::Coulomb3d && contact.ring == Ring::Creeping {
            check.conflict(
                "contact.ring",
                "coulomb_3d is solved with a locked ring only; accepted: \"locked\"",
            );
        }
    }
    let contact_variations = match (&variation, &contact) {
        (Some(raw), Some(contact)) => contact_variations(check, raw, contact),
        _ => Vec::new(),
    };
    if raw.reduction.basis == Basis::TunedReceptances {
        let ring = contact.as_ref().map(|own| own.ring);
        for (key, reason) in against_receptances(ring, &solver) {
            check.conflict(key, &format!("basis = \"tuned_receptances\" {reason}"));
        }
    }
    let patterns = (head.patterns, given.records);
    let mistuning = mistuning(check, path, raw.mistuning, &sweep, patterns)?;
    let (Some(model), Some(damping), Some(mistuning)) = (model, damping, mistuning) else {
        return Ok(None);
    };
    let is_of_file = matches!(mistuning.mistuning.source, MistuningSource::File { .. });
    let stop = raw
        .stop
        .and_then(|raw| stop(check, &raw, mistuning.patterns, is_of_file));
    let accuracy = raw
        .accuracy
        .and_then(|own| accuracy(check, &own, raw.reduction.basis));
    let study = Study {
        path: path.to_owned(),
        map: SourceMap::default(),
        name,
        seed,
        patterns: mistuning.patterns,
        model,
        reduction: raw.reduction,
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
        output: output(check, &raw.output),
    };
    let study = with_accuracy(study, accuracy, |key| check.is_written(key));
    Ok(Some((study, rotation)))
}

fn output(check: &mut Check, raw: &RawOutput) -> OutputOptions {
    OutputOptions {
        patterns: raw.patterns,
        compression: raw.compression.unwrap_or_default(),
        stress_pa_per_m: raw.stress_pa_per_m.map(|scale| {
            check.within(
                "output.stress_pa_per_m",
                scale,
                scale.is_finite() && scale > 0.0,
                "a finite number above 0, in Pa/m",
            )
        }),
        stability: raw.stability.map_or(0, |rows| {
            let accepted = "a whole number from 0 to 1000";
            check.within("output.stability", rows, rows <= 1000, accepted) as u32
        }),
    }
}

fn identity(check: &mut Check, head: &RawHead) -> (String, u64) {
    let accepted = "a name of letters, digits, - and _, beginning with a letter or digit";
    let name = head.name.clone().unwrap_or_default();
    let well_formed = name
        .chars()
        .all(|c| c.is_ascii_alphanumeric() || c == '-' || c == '_')
        && name.starts_with(|c: char| c.is_ascii_alphanumeric());
    if head.name.is_none() {
        check.missing("study.name", accepted);
    } else if !well_formed || name.len() > 100 {
        check.refuse("study.name", accepted);
    }
    if head.seed.is_none() {
        let accepted = "a whole number from 0 to 9223372036854775807; there is no default, so that \
                        every study says which patterns it has";
        check.missing("study.seed", accepted);
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

fn model(check: &mut Check, study_file: &Path, raw: RawModel) -> Option<ModelSource> {
    let Some(kind) = raw.source else {
        check.missing("model.source", "\"parametric\", \"lumped\" or \"bundle\"");
        return None;
    };
    let tables = [
        (
            "parametric",
            RawModelKind::Parametric,
            raw.parametric.is_some(),
        ),
        ("lumped", RawModelKind::Lumped, raw.lumped.is_some()),
        ("bundle", RawModelKind::Bundle, raw.bundle.is_some()),
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
        RawModelKind::Parametric => {
            let options = raw.parametric.unwrap_or_default();
            check_damper(check, &options);
            Some(ModelSource::Parametric(options))
        }
        RawModelKind::Lumped => {
            if raw.lumped.is_none() {
                check.missing(
                    "model.lumped",
                    "a table with sectors, blade_mass_kg, blade_stiffness_n_per_m",
                );
            }
            raw.lumped.map(ModelSource::Lumped)
        }
        RawModelKind::Bundle => {
            let path = raw.bundle.and_then(|bundle| bundle.path);
            if path.is_none() {
                check.missing(
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

fn reduction(check: &mut Check, options: &ReductionOptions) {
    let error = options.error;
    check.within(
        "reduction.error",
        error,
        error > 0.0 && error <= 0.5,
        "a number above 0 and at most 0.5",
    );
    let counts = [
        ("reduction.stick_modes", options.stick_modes, 1),
        ("reduction.slide_modes", options.slide_modes, 1),
        (
            "reduction.craig_bampton_modes",
            options.craig_bampton_modes,
            1,
        ),
        (
            "reduction.sensitivity_vectors",
            options.sensitivity_vectors,
            0,
        ),
    ];
    for (key, count, least) in counts {
        if count.is_some_and(|count| !(least..=1000).contains(&count)) {
            check.refuse(key, &format!("a whole number from {least} to 1000"));
        }
    }
    match options.basis {
        Basis::TunedReceptances => {
            for (key, given) in [
                ("reduction.stick_modes", options.stick_modes.is_some()),
                ("reduction.slide_modes", options.slide_modes.is_some()),
            ] {
                if given {
                    check.conflict(
                        key,
                        "basis = \"tuned_receptances\" has no modes to choose; accepted: neither stick_modes nor \
                         slide_modes",
                    );
                }
            }
        }
        Basis::Auto => {
            for (key, given) in [
                ("reduction.stick_modes", options.stick_modes.is_some()),
                ("reduction.slide_modes", options.slide_modes.is_some()),
            ] {
                if given {
                    check.conflict(
                        key,
                        "basis = \"auto\" chooses the number of modes; accepted: reduction.error, or \
                         basis = \"stick_slide\" with fixed numbers",
                    );
                }
            }
        }
        Basis::StickSlide => {
            if options.stick_modes.is_some() && options.slide_modes.is_none() {
                check.missing(
                    "reduction.slide_modes",
                    "a whole number from 1 to 1000, beside stick_modes",
                );
            }
            if options.slide_modes.is_some() && options.stick_modes.is_none() {
                check.missing(
                    "reduction.stick_modes",
                    "a whole number from 1 to 1000, beside slide_modes",
                );
            }
        }
        Basis::StickAttachment => {
            if options.slide_modes.is_some() {
                check.conflict(
                    "reduction.slide_modes",
                    "basis = \"stick_attachment\" has none; accepted: stick_modes",
                );
            }
        }
    }
}

/// Keys by which a study cannot be solved on tuned receptances, each with what would be accepted.
pub(crate) fn against_receptances(
    ring: Option<Ring>,
    solver: &SolverOptions,
) -> Vec<(&'static str, String)> {
    let mut found = Vec::new();
    if ring == Some(Ring::Creeping) {
        let reason = "is solved with a locked ring only; accepted: \"locked\", or another basis";
        found.push(("contact.ring", reason.to_owned()));
    }
    if let Harmonics::Set(set) = &solver.harmonics
        && set.iter().any(|&harmonic| harmonic > HIGHEST_HARMONIC)
    {
        let reason =
            format!("has harmonics up to {HIGHEST_HARMONIC}; accepted: these, or another basis");
        found.push(("solver.harmonics", reason));
    }
    found
}

fn contact_options(check: &mut Check, raw: &RawContact) -> ContactOptions {
    ContactOptions {
        law: raw.law.unwrap_or(ContactLaw::Simplified3d),
        friction_coefficient: check.required(
            "contact.friction_coefficient",
            raw.friction_coefficient,
            |value| (0.0..=10.0).contains(&value),
            "a number from 0 to 10",
        ),
        tangential_stiffness_n_per_m: check.required(
            "contact.tangential_stiffness_n_per_m",
            raw.tangential_stiffness_n_per_m,
            |value| value.is_finite() && value > 0.0,
            "a finite number above 0, in N/m",
        ),
        normal_stiffness_n_per_m: raw.normal_stiffness_n_per_m,
        ring: raw.ring.unwrap_or_default(),
        in_place_of: None,
    }
}

fn normal_stiffness(check: &mut Check, contact: &ContactOptions) {
    let key = "contact.normal_stiffness_n_per_m";
    match (contact.law, contact.normal_stiffness_n_per_m) {
        (ContactLaw::Simplified3d | ContactLaw::Coulomb3d, None) => {
            check.missing(key, "a finite number above 0, in N/m");
        }
        (_, Some(value)) if !(value.is_finite() && value > 0.0) => {
            check.refuse(key, "a finite number above 0, in N/m");
        }
        _ => {}
    }
}
