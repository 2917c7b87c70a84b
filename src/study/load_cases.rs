//! The load cases of a study: several force vectors on one wheel, each with its engine orders and amplitudes.

use std::path::PathBuf;

use serde_json::{Value, json};

use super::{Problem, Study, StudyError};
use crate::linalg::Complex64;
use crate::model::ReducedModel;
use crate::model::sector::bundle::read_force;
use crate::model::sector::{Component, ModelError, SectorModel, validate_force};
use crate::population::monte_carlo::{LoadCaseName, RowSolver};

/// Where the force vector of a load case comes from.
#[derive(Debug, Clone, PartialEq)]
pub enum ForceSource {
    /// That of the model.
    Model,
    /// A file as the force of a bundle: columns `dof`, `re`, `im`, in N.
    File {
        /// The file as written in the study.
        written: String,
        /// The file, resolved against the study file.
        path: PathBuf,
    },
    /// 1 N at an observed node of the model.
    Node {
        /// Name of the node.
        node: String,
        /// Direction in (r, theta, z), as written; of any length above 0.
        direction: [f64; 3],
    },
}

/// One load case.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadCase {
    /// Name.
    pub name: LoadCaseName,
    /// Its force vector.
    pub force: ForceSource,
    /// Engine orders, as written.
    pub engine_orders: Vec<u32>,
    /// Factor on the force vector.
    pub amplitude_n: f64,
    /// Factors of the engine orders in their order, each besides `amplitude_n`; empty: all alike.
    pub amplitudes_n: Vec<f64>,
}

impl LoadCase {
    /// As the study file has it.
    fn resolved(&self) -> Value {
        let mut case = json!({
            "name": self.name,
            "engine_orders": self.engine_orders,
            "amplitude_n": amplitude_value(self.amplitude_n, &self.amplitudes_n),
        });
        match &self.force {
            ForceSource::Model => {}
            ForceSource::File { written, .. } => case["force"] = json!(written),
            ForceSource::Node { node, direction } => {
                case["node"] = json!(node);
                case["direction"] = json!(direction);
            }
        }
        case
    }
}

/// A factor on the force vector as the study file has it.
pub(super) fn amplitude_value(amplitude_n: f64, amplitudes_n: &[f64]) -> Value {
    if amplitudes_n.is_empty() {
        json!(amplitude_n)
    } else {
        json!(amplitudes_n)
    }
}

/// A study under one of its force vectors.
#[derive(Debug, Clone)]
pub(super) struct Excitation {
    /// The load case; none in a study without.
    pub(super) name: Option<LoadCaseName>,
    /// The study with this force vector alone.
    pub(super) study: Study,
    column: usize,
}

impl Excitation {
    /// A reduced model of the study under this force vector.
    pub(super) fn of(&self, model: &ReducedModel) -> ReducedModel {
        match self.name {
            None => model.clone(),
            Some(_) => model.under(self.column, self.study.force_factors()),
        }
    }
}

/// One solver for all of `excitations`, of a solver for each: that of the first, which knows the others.
pub(super) fn solver_under<E>(
    excitations: &[Excitation],
    solver: impl FnMut(&Excitation) -> Result<RowSolver, E>,
) -> Result<RowSolver, E> {
    let mut solvers = excitations
        .iter()
        .map(solver)
        .collect::<Result<Vec<_>, E>>()?;
    let others = solvers.split_off(1);
    let names = excitations.iter().skip(1).map(|case| case.name);
    let others = names
        .zip(others)
        .filter_map(|(name, solver)| Some((name?, solver)));
    Ok(solvers.remove(0).with_load_cases(others.collect()))
}

impl Study {
    /// The study under each of its force vectors; of a study without load cases, the study itself.
    pub(super) fn excitations(&self) -> Vec<Excitation> {
        if self.load_cases.is_empty() {
            return vec![Excitation {
                name: None,
                study: self.clone(),
                column: 0,
            }];
        }
        let cases = self.load_cases.iter().enumerate();
        cases
            .map(|(column, case)| Excitation {
                name: Some(case.name),
                column,
                study: Self {
                    engine_orders: case.engine_orders.clone(),
                    amplitude_n: case.amplitude_n,
                    amplitudes_n: case.amplitudes_n.clone(),
                    load_cases: Vec::new(),
                    ..self.clone()
                },
            })
            .collect()
    }

    /// Load cases with their engine orders; one without name where the study has none.
    pub(super) fn excited_orders(&self) -> Vec<(Option<LoadCaseName>, &[u32])> {
        if self.load_cases.is_empty() {
            return vec![(None, &self.engine_orders)];
        }
        let cases = self.load_cases.iter();
        cases
            .map(|case| (Some(case.name), case.engine_orders.as_slice()))
            .collect()
    }

    /// `[excitation]` with every default filled in.
    pub(super) fn excitation_value(&self) -> Value {
        if self.load_cases.is_empty() {
            return json!({
                "engine_orders": self.engine_orders,
                "amplitude_n": amplitude_value(self.amplitude_n, &self.amplitudes_n),
            });
        }
        let cases: Vec<Value> = self.load_cases.iter().map(LoadCase::resolved).collect();
        json!({ "load_case": cases })
    }

    /// `model` with the force vectors of the load cases.
    ///
    /// # Errors
    /// A force that cannot be read, or that the model refuses.
    pub(super) fn with_load_cases(&self, model: SectorModel) -> Result<SectorModel, StudyError> {
        let load_case_forces = self
            .load_cases
            .iter()
            .enumerate()
            .map(|(place, case)| self.force_of(case, place, &model))
            .collect::<Result<_, _>>()?;
        Ok(SectorModel {
            load_case_forces,
            ..model
        })
    }

    fn force_of(
        &self,
        case: &LoadCase,
        place: usize,
        model: &SectorModel,
    ) -> Result<Vec<(usize, Complex64)>, StudyError> {
        let refused = |key: &str, reason: String| {
            let key = format!("excitation.load_case[{place}].{key}");
            StudyError::Invalid {
                path: self.path.clone(),
                findings: vec![self.map.finding(&key, Problem::Conflict { reason })],
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
    let components = [Component::Radial, Component::Tangential, Component::Axial];
    let mut force = Vec::new();
    for ((component, word), part) in components
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
