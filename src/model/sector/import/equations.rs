//! Equations that tie the cyclic faces in the static step of a prestressed `CalculiX` run.
//!
//! The static step needs the faces tied, the matrices need them free: explicit equations can be
//! removed between the two (`*EQUATION, REMOVE ALL`), `*TIE, CYCLIC SYMMETRY` cannot.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::Path;

use super::build::{cyclic_faces, face_sets};
use super::files::missing;
use super::import_file::ImportFile;
use super::problem::body_name;
use super::run::Run;
use crate::model::sector::error::ModelError;
use crate::model::sector::sector_model::Body;

/// A piece of a deck for the model part: `u_high = u_low` in cylindrical components for the free nodes
/// of both faces of `body`. Nodes with a boundary condition stay out of it: a condition on a
/// transformed node is an equation itself and would be removed with the others.
///
/// # Errors
/// As for an import; the matrices are not read.
pub fn calculix_equations(path: &Path, body: Body) -> Result<String, ModelError> {
    let file = ImportFile::read(path)?;
    let runs = Run::read_meshes(&file)?;
    let nodes = runs.iter().flat_map(|run| run.nodes(&file)).collect();
    let free: BTreeSet<usize> = runs
        .iter()
        .flat_map(|run| {
            let held = &run.mesh.held;
            let nodes = run.mesh.nodes.keys().filter(|node| !held.contains(node));
            nodes.map(|node| node + run.offset)
        })
        .collect();
    let faces = cyclic_faces(&file, &runs, &nodes, &free)?;
    let Some((_, run, _)) = face_sets(&file, &runs).find(|(body_of_run, ..)| *body_of_run == body)
    else {
        return Err(file.refuse(vec![missing("ring", "the files of the ring")]));
    };
    let pairs = &faces[body_name(body)].pairs;
    let set = format!("{}_CYCLIC", body_name(body).to_uppercase());
    let [x, y, z] = file.axis.vector();
    // Writing to a string cannot fail.
    let mut text = format!("*NSET,NSET={set}\n");
    for &(low, high) in pairs {
        let _ = writeln!(text, "{},{},", low - run.offset, high - run.offset);
    }
    let _ = writeln!(
        text,
        "*TRANSFORM,NSET={set},TYPE=C\n0.,0.,0.,{x:.1},{y:.1},{z:.1}"
    );
    text.push_str("*EQUATION\n");
    for &(low, high) in pairs {
        let (low, high) = (low - run.offset, high - run.offset);
        for direction in 1..=3 {
            let _ = writeln!(text, "2\n{high},{direction},1.,{low},{direction},-1.");
        }
    }
    Ok(text)
}
