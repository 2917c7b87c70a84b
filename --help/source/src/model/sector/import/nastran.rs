//! Nodes, solid elements and sets from Nastran bulk data: `GRID`, `CTETRA`, `CPENTA`, `CHEXA`, `SET1`.

use std::collections::BTreeSet;
use std::path::Path;

use super::bulk::{self, Entry};
use super::mesh::{Element, ElementKind, Mesh};
use super::problem::ImportProblem;
use super::source::{Source, real};
use crate::model::sector::error::ModelError;
use crate::model::sector::line_problem::LineProblem;
use crate::model::sector::matrix_market::integer;

/// A `SET1` entry: its line, its id, and the ranges of nodes in it.
struct Set {
    line: usize,
    name: String,
    ranges: Vec<(usize, usize)>,
}

/// Reads bulk data. Other entries than those above, and elements that are no such solids, are passed over.
pub(super) fn read(path: &Path) -> Result<Mesh, ModelError> {
    let source = Source::read(path)?;
    let mut mesh = Mesh::default();
    let mut sets: Vec<Set> = Vec::new();
    for entry in bulk::entries(&source) {
        match entry.name.as_str() {
            "GRID" => grid(&source, &entry, &mut mesh)?,
            "CTETRA" | "CPENTA" | "CHEXA" => element(&source, &entry, &mut mesh)?,
            "SET1" => {
                let ranges = ranges(&source, &entry)?;
                let name = entry.field(0).to_owned();
                sets.push(Set {
                    line: entry.line,
                    name,
                    ranges,
                });
            }
            _ => {}
        }
    }
    for Set { line, name, ranges } in sets {
        let mut nodes = BTreeSet::new();
        for (first, last) in ranges {
            let what = "node";
            if !mesh.nodes.contains_key(&first) {
                return Err(source.refuse(
                    line,
                    ImportProblem::Undefined {
                        what,
                        number: first,
                    },
                ));
            }
            if first <= last {
                nodes.extend(mesh.nodes.range(first..=last).map(|(&node, _)| node));
            }
        }
        mesh.node_sets.entry(name).or_default().extend(nodes);
    }
    for element in mesh.elements.values() {
        if let Some(&number) = element
            .nodes
            .iter()
            .find(|node| !mesh.nodes.contains_key(node))
        {
            let what = "node";
            return Err(source.refuse_whole(ImportProblem::Undefined { what, number }));
        }
    }
    Ok(mesh)
}

/// `GRID, id, cp, x, y, z, cd`.
fn grid(source: &Source, entry: &Entry<'_>, mesh: &mut Mesh) -> Result<(), ModelError> {
    let refuse = |problem: LineProblem| source.refuse(entry.line, problem);
    let number = integer("the grid point", entry.field(0)).map_err(refuse)?;
    for (index, field) in [(1, "CP"), (5, "CD")] {
        if !matches!(entry.field(index), "" | "0") {
            return Err(refuse(LineProblem::NotAWord {
                field,
                found: entry.field(index).to_owned(),
                accepted: "0 or nothing: the basic coordinate system",
            }));
        }
    }
    let mut position = [0.0; 3];
    for (axis, value) in position.iter_mut().enumerate() {
        let word = entry.field(2 + axis);
        if !word.is_empty() {
            *value = real(["x", "y", "z"][axis], word).map_err(refuse)?;
        }
    }
    if !mesh.add_node(number, position) {
        let what = "node";
        return Err(source.refuse(entry.line, ImportProblem::Redefined { what, number }));
    }
    Ok(())
}

/// `CHEXA, id, property, corners, midsides`; the midsides of upright edges come before those of the top.
fn element(source: &Source, entry: &Entry<'_>, mesh: &mut Mesh) -> Result<(), ModelError> {
    let number = integer("the element number", entry.field(0))
        .map_err(|problem| source.refuse(entry.line, problem))?;
    let mut nodes = Vec::new();
    for &(line, word) in entry.fields_from(2) {
        // Continuation marks and midside nodes left out.
        if !word.is_empty() && !word.starts_with(['+', '*']) {
            let node =
                integer("a grid point", word).map_err(|problem| source.refuse(line, problem))?;
            nodes.push(node);
        }
    }
    let (kind, order): (ElementKind, &[usize]) = match (entry.name.as_str(), nodes.len()) {
        ("CTETRA", 4) => (ElementKind::Tetrahedron4, &[0, 1, 2, 3]),
        ("CTETRA", 10) => (ElementKind::Tetrahedron10, &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9]),
        ("CPENTA", 6) => (ElementKind::Wedge6, &[0, 1, 2, 3, 4, 5]),
        ("CPENTA", 15) => (
            ElementKind::Wedge15,
            &[0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 13, 14, 9, 10, 11],
        ),
        ("CHEXA", 8) => (ElementKind::Brick8, &[0, 1, 2, 3, 4, 5, 6, 7]),
        ("CHEXA", 20) => (
            ElementKind::Brick20,
            &[
                0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 16, 17, 18, 19, 12, 13, 14, 15,
            ],
        ),
        (_, found) => {
            let expected = match entry.name.as_str() {
                "CTETRA" => 10,
                "CPENTA" => 15,
                _ => 20,
            };
            let problem = ImportProblem::ElementNodes {
                element: number,
                found,
                expected,
            };
            return Err(source.refuse(entry.line, problem));
        }
    };
    let element = Element {
        kind,
        nodes: order.iter().map(|&at| nodes[at]).collect(),
    };
    if mesh.elements.insert(number, element).is_some() {
        let what = "element";
        return Err(source.refuse(entry.line, ImportProblem::Redefined { what, number }));
    }
    Ok(())
}

/// `SET1, id, n1, n2, "THRU", n3, ...` as ranges.
fn ranges(source: &Source, entry: &Entry<'_>) -> Result<Vec<(usize, usize)>, ModelError> {
    let mut ranges: Vec<(usize, usize)> = Vec::new();
    let mut through = false;
    for &(line, word) in entry.fields_from(1) {
        if word.is_empty() || word.starts_with('+') {
            continue;
        }
        if word.eq_ignore_ascii_case("THRU") {
            through = true;
            continue;
        }
        let number =
            integer("a grid point", word).map_err(|problem| source.refuse(line, problem))?;
        match ranges.last_mut() {
            Some(range) if through => range.1 = number,
            _ => ranges.push((number, number)),
        }
        through = false;
    }
    Ok(ranges)
}
