//! The load cases of a study: several force vectors on one wheel, each with its engine orders and amplitudes.

use std::path::PathBuf;

use serde::Serialize;

use crate::population::monte_carlo::LoadCaseName;

/// Where the force vector of a load case comes from.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub enum ForceSource {
    /// The force vector of the model.
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
#[derive(Debug, Clone, PartialEq, Serialize)]
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
