//! Whether a matrix couples the nodes of the mesh's elements: one of which a triangle was lost does not.
//!
//! A stiffness couples every two nodes of an element that are free. A mass does so too, or it is lumped and
//! couples none. Where one triangle of a matrix was taken for the other, no coupling is left, or (where the
//! rows were sorted in between) about half of them.

use std::collections::{HashMap, HashSet};

use super::matrices::Rows;
use super::mesh::{Element, Mesh};
use super::problem::ImportProblem;
use crate::linalg::SymmetricSparse;
use crate::model::sector::error_place::Matrix;

/// Least share of the pairs of an element's nodes that are coupled. All are, but for an entry that happens to
/// vanish.
const LEAST_COUPLED: f64 = 0.75;

/// Which nodes a matrix couples.
pub(super) struct Couplings {
    /// Nodes with an entry on the diagonal.
    nodes: HashSet<usize>,
    /// Nodes above each node that it is coupled with, ascending.
    above: HashMap<usize, Vec<usize>>,
}

/// How a matrix couples the nodes of one element.
struct Coupled {
    pairs: usize,
    /// Pairs that the matrix couples.
    joined: usize,
    /// Two nodes that it does not couple.
    apart: Option<(usize, usize)>,
}

impl Coupled {
    fn is_whole(&self) -> bool {
        self.joined as f64 >= LEAST_COUPLED * self.pairs as f64
    }
}

impl Couplings {
    /// The couplings of `matrix`, whose rows are those nodes and directions.
    pub fn new(rows: &Rows, matrix: &SymmetricSparse) -> Self {
        let mut nodes = HashSet::new();
        let mut above: HashMap<usize, Vec<usize>> = HashMap::new();
        for (row, column, value) in matrix.lower_entries() {
            if value == 0.0 {
                continue;
            }
            let (a, b) = (rows[row].0, rows[column].0);
            if row == column {
                nodes.insert(a);
            } else if a != b {
                let list = above.entry(a.min(b)).or_default();
                let other = a.max(b);
                if list.last() != Some(&other) {
                    list.push(other);
                }
            }
        }
        for list in above.values_mut() {
            list.sort_unstable();
            list.dedup();
        }
        Self { nodes, above }
    }

    /// Holds the couplings against the elements of the mesh whose matrix it is.
    pub fn require(&self, kind: Matrix, mesh: &Mesh) -> Result<(), ImportProblem> {
        let elements = || {
            let coupled = |(&number, element)| Some((number, self.of_element(kind, element)?));
            mesh.elements.iter().filter_map(coupled)
        };
        if kind == Matrix::Mass && self.above.is_empty() {
            // Lumped.
            return Ok(());
        }
        if self.above.is_empty() && self.nodes.len() > 1 {
            return Err(ImportProblem::NoCouplings { matrix: kind });
        }
        let broken = || elements().filter(|(_, coupled)| !coupled.is_whole());
        let Some((element, first)) = broken().next() else {
            return Ok(());
        };
        if kind != Matrix::Stiffness {
            // Lumped elements beside others are coupled by their neighbours alone, and so are elements of
            // the disk whose nodes all belong to the blade, too: these are few.
            let touched = elements().filter(|(_, coupled)| coupled.joined > 0).count();
            let partly = broken().filter(|(_, coupled)| coupled.joined > 0).count();
            if 2 * partly <= touched && touched > 0 {
                return Ok(());
            }
        }
        let (a, b) = first.apart.unwrap_or_default();
        Err(ImportProblem::NotCoupled {
            matrix: kind,
            element,
            first: a,
            second: b,
            coupled: first.joined,
            pairs: first.pairs,
        })
    }

    /// How the nodes of an element are coupled; none where fewer than two of them are free, or where the blade's
    /// stiffness does not hold all of them.
    fn of_element(&self, kind: Matrix, element: &Element) -> Option<Coupled> {
        let free = |node: &&usize| self.nodes.contains(node);
        let mut nodes: Vec<usize> = element.nodes.iter().filter(free).copied().collect();
        if kind == Matrix::BladeStiffness && nodes.len() < element.nodes.len() {
            return None;
        }
        nodes.sort_unstable();
        nodes.dedup();
        let mut found = Coupled {
            pairs: 0,
            joined: 0,
            apart: None,
        };
        for (index, &first) in nodes.iter().enumerate() {
            let above = self.above.get(&first).map_or(&[][..], Vec::as_slice);
            for &second in &nodes[index + 1..] {
                found.pairs += 1;
                if above.binary_search(&second).is_ok() {
                    found.joined += 1;
                } else if found.apart.is_none() {
                    found.apart = Some((first, second));
                }
            }
        }
        (found.pairs > 0).then_some(found)
    }
}
