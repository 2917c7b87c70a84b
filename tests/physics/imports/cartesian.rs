//! The reference wheel as a finite-element code would have it: Cartesian directions, numbers from 1.

use std::collections::BTreeMap;
use std::path::Path;

use blisk::model::sector::{Body, Component, SectorModel, bundle};

/// Node and direction (0, 1, 2) of each row, and the lower triangle of a matrix.
pub struct CartesianMatrix {
    pub rows: Vec<(usize, usize)>,
    /// `(row, column, value)`, `row >= column`, by column then row.
    pub lower: Vec<(usize, usize, f64)>,
}

/// The sector of `tests/data/wheel8`.
pub fn wheel8() -> SectorModel {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/wheel8");
    bundle::read(&folder).unwrap()
}

/// Positions of the nodes, numbered from 1.
pub fn nodes(model: &SectorModel) -> BTreeMap<usize, [f64; 3]> {
    let positions = model.dofs.iter().map(|dof| (dof.node + 1, dof.position_m));
    positions.collect()
}

/// Low and high nodes of a body's cyclic faces, numbered from 1.
pub fn faces(model: &SectorModel, body: Body) -> [Vec<usize>; 2] {
    let side = |dof: fn(&(usize, usize)) -> usize| {
        let mut nodes: Vec<usize> = model
            .cyclic_pairs
            .iter()
            .map(|pair| &model.dofs[dof(pair)])
            .filter(|dof| dof.body == body)
            .map(|dof| dof.node + 1)
            .collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    };
    [side(|pair| pair.0), side(|pair| pair.1)]
}

/// Direction cosines of component `i` of a node along x, y and z.
fn direction(model: &SectorModel, dof: usize) -> [f64; 3] {
    let [x, y, _] = model.dofs[dof].position_m;
    let r = x.hypot(y);
    match model.dofs[dof].component {
        Component::Radial => [x / r, y / r, 0.0],
        Component::Tangential => [-y / r, x / r, 0.0],
        Component::Axial => [0.0, 0.0, 1.0],
        _ => unreachable!("a solid has no rotations"),
    }
}

/// `A_cartesian = sum over dofs i, j of d_i A_ij d_j^T`, node block by node block; nodes that no entry
/// touches have no rows unless `all`.
pub fn cartesian(
    model: &SectorModel,
    entries: impl Iterator<Item = (usize, usize, f64)>,
    all: bool,
) -> CartesianMatrix {
    let mut blocks: BTreeMap<(usize, usize), [[f64; 3]; 3]> = BTreeMap::new();
    for (row, column, value) in entries {
        let (a, b) = (direction(model, row), direction(model, column));
        let key = (model.dofs[row].node + 1, model.dofs[column].node + 1);
        let block = blocks.entry(key).or_default();
        for i in 0..3 {
            for j in 0..3 {
                block[i][j] += a[i] * value * b[j];
            }
        }
    }
    let touched: Vec<usize> = if all {
        nodes(model).into_keys().collect()
    } else {
        let mut touched: Vec<usize> = blocks.keys().map(|key| key.0).collect();
        touched.dedup();
        touched
    };
    let rows: Vec<(usize, usize)> = touched
        .iter()
        .flat_map(|&node| [0, 1, 2].map(|i| (node, i)))
        .collect();
    let place = |node: usize| 3 * touched.binary_search(&node).unwrap();
    let mut lower = Vec::new();
    for ((a, b), block) in blocks {
        for (i, values) in block.iter().enumerate() {
            for (j, &value) in values.iter().enumerate() {
                let (row, column) = (place(a) + i, place(b) + j);
                if row >= column {
                    lower.push((row, column, value));
                }
            }
        }
    }
    lower.sort_by_key(|&(row, column, _)| (column, row));
    CartesianMatrix { rows, lower }
}
