//! The force vectors of a study: read for its sector model, and the study under each of them alone.

use super::{ForceSource, LoadCase, Problem, Study, StudyError};
use crate::linalg::Complex64;
use crate::model::ReducedModel;
use crate::model::sector::bundle::read_force;
use crate::model::sector::{Component, ModelError, SectorModel, validate_force};
use crate::population::monte_carlo::{LoadCaseName, LoadCaseSolver, LoadCaseSolvers};

/// A study under one of its force vectors.
#[derive(Debug, Clone)]
pub(crate) struct Excitation {
    /// The load case; none in a study without.
    pub(crate) name: Option<LoadCaseName>,
    /// The study with this force vector alone.
    pub(crate) study: Study,
    column: usize,
}

impl Excitation {
    /// A reduced model of the study under this force vector.
    pub(crate) fn of(&self, model: &ReducedModel) -> ReducedModel {
        match self.name {
            None => model.clone(),
            Some(_) => model.under(self.column, self.study.force_factors()),
        }
    }
}

/// The solvers of all of `excitations`.
pub(crate) fn solver_under<E>(
    excitations: &[Excitation],
    solver: impl FnMut(&Excitation) -> Result<LoadCaseSolver, E>,
) -> Result<LoadCaseSolvers, E> {
    let mut solvers = excitations
        .iter()
        .map(solver)
        .collect::<Result<Vec<_>, E>>()?;
    let others = solvers.split_off(1);
    let names = excitations.iter().skip(1).map(|case| case.name);
    let others = names
        .zip(others)
        .filter_map(|(name, solver)| Some((name?, solver)));
    Ok(LoadCaseSolvers::new(solvers.remove(0), others.collect()))
}

/// `study` under each of its force vectors; of a study without load cases, the study itself.
pub(crate) fn excitations(study: &Study) -> Vec<Excitation> {
    if study.load_cases.is_empty() {
        return vec![Excitation {
            name: None,
            study: study.clone(),
            column: 0,
        }];
    }
    let cases = study.load_cases.iter().enumerate();
    cases
        .map(|(column, case)| Excitation {
            name: Some(case.name),
            column,
            study: Study {
                engine_orders: case.engine_orders.clone(),
                amplitude_n: case.amplitude_n,
                amplitudes_n: case.amplitudes_n.clone(),
                load_cases: Vec::new(),
                ..study.clone()
            },
        })
        .collect()
}

/// `model` with the force vectors of the load cases of `study`.
///
/// # Errors
/// A force that cannot be read, or that the model refuses.
pub(super) fn with_load_cases(
    study: &Study,
    model: SectorModel,
) -> Result<SectorModel, StudyError> {
    let load_case_forces = study
        .load_cases
        .iter()
        .enumerate()
        .map(|(place, case)| force_of(study, case, place, &model))
        .collect::<Result<_, _>>()?;
    Ok(SectorModel {
        load_case_forces,
        ..model
    })
}

fn force_of(
    study: &Study,
    case: &LoadCase,
    place: usize,
    model: &SectorModel,
) -> Result<Vec<(usize, Complex64)>, StudyError> {
    let refused = |key: &str, reason: String| {
        let key = format!("excitation.load_case[{place}].{key}");
        StudyError::Invalid {
            path: study.path.clone(),
            findings: vec![study.map.finding(&key, Problem::Conflict { reason })],
        }
    };
    let (key, force) = match &case.force {
        ForceSource::Model => return Ok(model.force.clone()),
        ForceSource::File { path, .. } => {
            let force = read_force(path).map_err(|error| match error {
                ModelError::File { path, source } => StudyError::Input { path, source },
                error => refused("force", error.to_string()),
            })?;
            ("force", force)
        }
        ForceSource::Node { node, direction } => {
            ("direction", at_node(node, *direction, model, &refused)?)
        }
    };
    validate_force(model, &force).map_err(|error| refused(key, error.to_string()))?;
    Ok(force)
}

/// 1 N at an observed node.
fn at_node(
    name: &str,
    direction: [f64; 3],
    model: &SectorModel,
    refused: &dyn Fn(&str, String) -> StudyError,
) -> Result<Vec<(usize, Complex64)>, StudyError> {
    let Some(node) = model.observed.iter().find(|node| node.name == name) else {
        let names: Vec<String> = model
            .observed
            .iter()
            .map(|node| format!("{:?}", node.name))
            .collect();
        let reason = format!(
            "the model observes no node {name:?}; accepted: {}",
            names.join(", ")
        );
        return Err(refused("node", reason));
    };
    let length = direction.iter().map(|part| part * part).sum::<f64>().sqrt();
    let mut force = Vec::new();
    for ((component, word), part) in Component::DISPLACEMENTS
        .into_iter()
        .zip(["r", "theta", "z"])
        .zip(direction)
    {
        match model.dof_of(node.node, component) {
            Some(dof) if part != 0.0 => force.push((dof, Complex64::new(part / length, 0.0))),
            None if part != 0.0 => {
                let reason = format!(
                    "node {name:?} does not move along {word}; accepted: 0 there, and another component other than 0"
                );
                return Err(refused("direction", reason));
            }
            _ => {}
        }
    }
    Ok(force)
}
