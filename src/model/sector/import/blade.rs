//! The blade's share of the stiffness: from a run with the blade alone, or assembled here.

use std::collections::HashMap;

use super::cylindrical::Frames;
use super::import_file::ImportFile;
use super::matrices::{self, Triplets};
use super::mesh::{ElementKind, Mesh};
use super::problem::ImportProblem;
use super::report::BladeSource;
use super::run::Run;
use super::source::refuse;
use crate::model::sector::assembly::{SolidElement, SolidMesh};
use crate::model::sector::error::ModelError;
use crate::model::sector::error_place::Matrix;
use crate::model::sector::hexahedron20::{Material, NODES};
use crate::model::sector::sector_model::Body;

/// Lower triangle of `K_blade` over the dofs of `frames`, N/m.
pub(super) fn stiffness(
    file: &ImportFile,
    run: &Run,
    frames: &Frames,
) -> Result<(Triplets, BladeSource), ModelError> {
    if let Some(files) = &file.blade_files {
        let (mut rows, matrix) = matrices::read_stiffness(files)?;
        let path = &files.stiffness;
        run.place_rows(file, &mut rows)
            .map_err(|problem| refuse(path, problem))?;
        for (index, &(node, direction)) in rows.iter().enumerate() {
            if frames.dof(node, direction).is_none() {
                let problem = ImportProblem::BladeRow {
                    row: index + 1,
                    node,
                    direction: direction + 1,
                };
                return Err(refuse(path, problem));
            }
        }
        run.require_couplings(Matrix::BladeStiffness, path, &rows, &matrix)?;
        let triplets = frames.turn(&rows, &matrix, file.units.stiffness_and_mass());
        return Ok((triplets, BladeSource::Matrices));
    }
    let name = file.blisk.blade_elements.as_deref().unwrap_or_default();
    let elements = run.element_set(name);
    let mesh = &run.mesh;
    let (nodes, solid) = solid_mesh(file, run, mesh, &elements)?;
    let assembled = solid.assemble()?;
    // `assemble` has turned the matrices to the same frames; only the numbers differ.
    let dof_of = |dof: usize| {
        let assembled_dof = &assembled.dofs[dof];
        frames.dof(nodes[assembled_dof.node], assembled_dof.component as usize)
    };
    let mut triplets = Vec::new();
    for (row, column, value) in assembled.blade_stiffness.lower_entries() {
        // Held nodes of the blade have no dof.
        if let (Some(row), Some(column)) = (dof_of(row), dof_of(column)) {
            triplets.push((row.max(column), row.min(column), value));
        }
    }
    Ok((triplets, BladeSource::Elements))
}

/// The blade's elements as a mesh of this program, and the wheel's number of each of its nodes.
fn solid_mesh(
    file: &ImportFile,
    run: &Run,
    mesh: &Mesh,
    elements: &std::collections::BTreeSet<usize>,
) -> Result<(Vec<usize>, SolidMesh), ModelError> {
    let positions = run.nodes(file);
    let numbers: Vec<usize> = mesh
        .nodes_of_elements(elements)
        .into_iter()
        .map(|node| node + run.offset)
        .collect();
    let place: HashMap<usize, usize> = numbers.iter().enumerate().map(|(i, &n)| (n, i)).collect();
    let mut solid = SolidMesh {
        nodes_m: numbers
            .iter()
            .map(|node| positions[node].position_m)
            .collect(),
        ..SolidMesh::default()
    };
    let [pascal, density] = file.units.stress_and_density();
    for &number in elements {
        let element = &mesh.elements[&number];
        let nodes = <[usize; NODES]>::try_from(element.nodes.as_slice())
            .ok()
            .filter(|_| element.kind == ElementKind::Brick20);
        let Some(nodes) = nodes else {
            let problem = ImportProblem::BladeElement {
                element: number,
                found: element.kind.name(),
            };
            return Err(refuse(&run.mesh_path, problem));
        };
        let properties = mesh
            .material_of(number)
            .and_then(|material| material.elastic);
        let Some((modulus, ratio)) = properties else {
            let problem = ImportProblem::NoMaterial { element: number };
            return Err(refuse(&run.mesh_path, problem));
        };
        let material = Material {
            youngs_modulus_pa: pascal * modulus,
            poisson_ratio: ratio,
            density_kg_per_m3: density
                * mesh
                    .material_of(number)
                    .and_then(|m| m.density)
                    .unwrap_or(0.0),
        };
        let index = solid.materials.iter().position(|other| *other == material);
        let material = index.unwrap_or_else(|| {
            solid.materials.push(material);
            solid.materials.len() - 1
        });
        solid.elements.push(SolidElement {
            nodes: nodes.map(|node| place[&(node + run.offset)]),
            material,
            body: Body::Blisk,
            blade: true,
        });
    }
    Ok((numbers, solid))
}
