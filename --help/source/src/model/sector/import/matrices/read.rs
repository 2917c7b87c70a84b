//! The matrices of one run, whatever format they have.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::calculix::no_diagonal;
use super::dmig::PointMatrix;
use super::symmetric::{from_full, from_triangle};
use super::{Matrices, Rows, calculix, dmig, dof_table, harwell_boeing, op4};
use crate::linalg::SymmetricSparse;
use crate::model::sector::error::ModelError;
use crate::model::sector::import::problem::ImportProblem;
use crate::model::sector::import::source::refuse;
use crate::model::sector::matrix_market;

/// Format of stiffness and mass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(in crate::model::sector::import) enum MatrixFormat {
    /// `.sti`, `.mas`, `.dof`.
    Calculix,
    /// Matrix Market with a dof table.
    MatrixMarket,
    /// Harwell-Boeing with a dof table (Ansys `HBMAT`).
    HarwellBoeing,
    /// Nastran OUTPUT4, ASCII, with a dof table.
    Op4,
    /// Nastran DMIG, which names its rows itself.
    Dmig,
}

/// Files of one run.
#[derive(Debug, Clone)]
pub(in crate::model::sector::import) struct MatrixFiles {
    pub format: MatrixFormat,
    pub stiffness: PathBuf,
    pub mass: PathBuf,
    pub dofs: PathBuf,
    pub stiffness_name: Option<String>,
    pub mass_name: Option<String>,
}

/// Stiffness and mass.
pub(in crate::model::sector::import) fn read(files: &MatrixFiles) -> Result<Matrices, ModelError> {
    if files.format == MatrixFormat::Dmig {
        let stiffness = dmig::matrix(
            &files.stiffness,
            files.stiffness_name.as_deref().unwrap_or("KAAX"),
        )?;
        let mass = dmig::matrix(&files.mass, files.mass_name.as_deref().unwrap_or("MAAX"))?;
        let rows = points(&[&stiffness, &mass]);
        return Ok(Matrices {
            stiffness: of_points(&stiffness, &rows, &files.stiffness)?,
            mass: of_points(&mass, &rows, &files.mass)?,
            rows,
        });
    }
    let rows = table(files)?;
    let name = files.stiffness_name.as_deref();
    let stiffness = tabled(files, &files.stiffness, name, &rows)?;
    let diagonal = stiffness.diagonal();
    if let Some(row) = diagonal.iter().position(|&value| value == 0.0) {
        return Err(refuse(&files.stiffness, no_diagonal(row, &rows)));
    }
    Ok(Matrices {
        stiffness,
        mass: tabled(files, &files.mass, files.mass_name.as_deref(), &rows)?,
        rows,
    })
}

/// Stiffness alone, of the blade.
pub(in crate::model::sector::import) fn read_stiffness(
    files: &MatrixFiles,
) -> Result<(Rows, SymmetricSparse), ModelError> {
    if files.format == MatrixFormat::Dmig {
        let stiffness = dmig::matrix(
            &files.stiffness,
            files.stiffness_name.as_deref().unwrap_or("KAAX"),
        )?;
        let rows = points(&[&stiffness]);
        let matrix = of_points(&stiffness, &rows, &files.stiffness)?;
        return Ok((rows, matrix));
    }
    let rows = table(files)?;
    let matrix = tabled(
        files,
        &files.stiffness,
        files.stiffness_name.as_deref(),
        &rows,
    )?;
    Ok((rows, matrix))
}

fn table(files: &MatrixFiles) -> Result<Rows, ModelError> {
    let rows = match files.format {
        MatrixFormat::Calculix => calculix::rows(&files.dofs),
        _ => dof_table::rows(&files.dofs),
    }?;
    let mut seen = BTreeSet::new();
    match rows.iter().position(|row| !seen.insert(*row)) {
        None => Ok(rows),
        Some(at) => Err(refuse(
            &files.dofs,
            ImportProblem::Value {
                key: format!("row {}", at + 1),
                found: format!("direction {} of node {}", rows[at].1 + 1, rows[at].0),
                accepted: "a direction of a node that no earlier row has".to_owned(),
            },
        )),
    }
}

fn tabled(
    files: &MatrixFiles,
    path: &Path,
    name: Option<&str>,
    rows: &Rows,
) -> Result<SymmetricSparse, ModelError> {
    match files.format {
        MatrixFormat::HarwellBoeing => harwell_boeing::matrix(path, rows),
        MatrixFormat::Op4 => op4::matrix(path, name, rows),
        MatrixFormat::MatrixMarket => {
            let matrix = matrix_market::read(path)?;
            if matrix.dimension() == rows.len() {
                return Ok(matrix);
            }
            let (found, rows) = (matrix.dimension(), rows.len());
            Err(refuse(path, ImportProblem::RowOutside { found, rows }))
        }
        MatrixFormat::Calculix | MatrixFormat::Dmig => calculix::matrix(path, rows),
    }
}

/// All points of some matrices, in order.
fn points(matrices: &[&PointMatrix]) -> Rows {
    let points: BTreeSet<(usize, usize)> = matrices
        .iter()
        .flat_map(|matrix| matrix.entries.keys())
        .flat_map(|&(row, column)| [row, column])
        .collect();
    points.into_iter().collect()
}

fn of_points(
    matrix: &PointMatrix,
    rows: &Rows,
    path: &Path,
) -> Result<SymmetricSparse, ModelError> {
    let place = |point: (usize, usize)| rows.binary_search(&point).unwrap_or_default();
    let entries: Vec<(usize, usize, f64)> = matrix
        .entries
        .iter()
        .map(|(&(row, column), &value)| (place(row), place(column), value))
        .collect();
    let build = if matrix.symmetric {
        from_triangle
    } else {
        from_full
    };
    calculix::require_diagonal(&entries, rows)
        .and_then(|()| build(rows.len(), &entries))
        .map_err(|problem| refuse(path, problem))
}
