//! A sector under cyclic symmetry: its independent dofs and its matrices per nodal diameter.

use std::collections::BTreeSet;

use super::contact_rows::{ContactGeometry, ContactRow, RowEntry, contact_rows};
use super::nodal_diameter::phase;
use crate::linalg::{Complex64, HermitianSparse, Matrix, SymmetricSparse};
use crate::model::sector::{Component, SectorModel};

/// A sector model seen through its independent dofs: all but those of the high face.
///
/// Everything that is not a matrix per nodal diameter (contact, observed nodes, force, blade
/// stiffness) lies on independent dofs of the sector itself.
#[derive(Debug, Clone)]
pub struct CyclicSector<'a> {
    model: &'a SectorModel,
    /// For each dof its independent dof, and whether it lies on the high face.
    independent: Vec<(usize, bool)>,
    /// Sector dof of each independent dof.
    sector_dof: Vec<usize>,
    rows: Vec<ContactRow>,
    geometry: ContactGeometry,
}

impl<'a> CyclicSector<'a> {
    /// Prepares a validated sector model.
    #[must_use]
    pub fn new(model: &'a SectorModel) -> Self {
        let mut low_of_high = vec![None; model.dofs.len()];
        for &(low, high) in &model.cyclic_pairs {
            low_of_high[high] = Some(low);
        }
        let mut place = vec![usize::MAX; model.dofs.len()];
        let mut sector_dof = Vec::new();
        for dof in 0..model.dofs.len() {
            if low_of_high[dof].is_none() {
                place[dof] = sector_dof.len();
                sector_dof.push(dof);
            }
        }
        let independent = (0..model.dofs.len())
            .map(|dof| match low_of_high[dof] {
                Some(low) => (place[low], true),
                None => (place[dof], false),
            })
            .collect();
        let (rows, geometry) = contact_rows(model);
        Self {
            model,
            independent,
            sector_dof,
            rows,
            geometry,
        }
    }

    /// Number of sectors N.
    #[must_use]
    pub fn sectors(&self) -> usize {
        self.model.sectors
    }

    /// Number of independent dofs.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.sector_dof.len()
    }

    /// Stiffness of nodal diameter h, N/m, structure only.
    #[must_use]
    pub fn stiffness(&self, h: usize) -> HermitianSparse {
        self.matrix(&self.model.stiffness, h)
    }

    /// Mass of nodal diameter h, kg.
    #[must_use]
    pub fn mass(&self, h: usize) -> HermitianSparse {
        self.matrix(&self.model.mass, h)
    }

    /// Blade stiffness, N/m; the same for every nodal diameter.
    #[must_use]
    pub fn blade_stiffness(&self) -> HermitianSparse {
        self.matrix(&self.model.blade_stiffness, 0)
    }

    /// Independent dofs that the blade stiffness acts on, ascending.
    #[must_use]
    pub fn blade_dofs(&self) -> Vec<usize> {
        let mut touched = vec![false; self.dimension()];
        for (row, column, value) in self.model.blade_stiffness.lower_entries() {
            if value != 0.0 {
                touched[self.independent[row].0] = true;
                touched[self.independent[column].0] = true;
            }
        }
        (0..self.dimension()).filter(|&dof| touched[dof]).collect()
    }

    /// Blade dofs on which nothing but the blade's stiffness acts: those that move when the
    /// blade's root is held. Entries of `K - K_blade` below 1e-9 of the diagonal are rounding.
    #[must_use]
    pub fn free_blade_dofs(&self) -> Vec<usize> {
        let diagonal = self.model.stiffness.diagonal();
        let mut rest = vec![0.0_f64; self.model.dofs.len()];
        let pairs = SymmetricSparse::from_lower_triplets(
            self.model.dofs.len(),
            &self
                .model
                .stiffness
                .lower_entries()
                .chain(
                    self.model
                        .blade_stiffness
                        .lower_entries()
                        .map(|(row, column, value)| (row, column, -value)),
                )
                .collect::<Vec<_>>(),
        );
        for (row, column, value) in pairs.lower_entries() {
            rest[row] = rest[row].max(value.abs());
            rest[column] = rest[column].max(value.abs());
        }
        let mut free = vec![false; self.dimension()];
        for dof in self.blade_dofs() {
            let at = self.sector_dof[dof];
            free[dof] = rest[at] <= 1e-9 * diagonal[at];
        }
        (0..self.dimension()).filter(|&dof| free[dof]).collect()
    }

    /// The contact interface.
    #[must_use]
    pub fn contact(&self) -> &ContactGeometry {
        &self.geometry
    }

    /// Relative-motion rows of the sector's contact in nodal diameter h, `C_h = C_0 + C_1 e^{i h alpha}` with
    /// `C_1` what moves in the next sector; `rows x dimension`, as sparse rows of `(independent dof, factor)`.
    #[must_use]
    pub fn contact_rows(&self, h: usize) -> Vec<Vec<(usize, Complex64)>> {
        let next = phase(h, 1, self.model.sectors);
        let entry = |entry: &RowEntry| {
            let wave = if entry.is_next { next } else { Complex64::ONE };
            (self.independent[entry.dof].0, wave * entry.factor)
        };
        let rows = self.rows.iter();
        rows.map(|row| row.entries.iter().map(entry).collect())
            .collect()
    }

    /// `C_h^H diag(springs) C_h` over the independent dofs.
    #[must_use]
    pub fn contact_stiffness(&self, springs: &[f64], h: usize) -> HermitianSparse {
        let rows = self.contact_rows(h);
        HermitianSparse::from_triplets(
            self.dimension(),
            rows.iter().zip(springs).flat_map(|(row, &spring)| {
                row.iter().flat_map(move |&(i, a)| {
                    row.iter().map(move |&(j, b)| (i, j, spring * a.conj() * b))
                })
            }),
        )
    }

    /// Independent dofs of the nodes in contact and of the rigid bodies in contact, ascending: the boundary of the Craig-Bampton model.
    #[must_use]
    pub fn contact_dofs(&self) -> Vec<usize> {
        let pairs = self.model.contact_pairs.iter();
        let moving: BTreeSet<usize> = pairs
            .flat_map(|pair| [pair.first.node(), pair.second.node()])
            .flatten()
            .map(|node| self.model.moved_by(node))
            .collect();
        let mut boundary: Vec<usize> = self
            .model
            .dofs
            .iter()
            .enumerate()
            .filter(|(_, dof)| moving.contains(&dof.node))
            .map(|(index, _)| self.independent[index].0)
            .collect();
        boundary.sort_unstable();
        boundary.dedup();
        boundary
    }

    /// Independent dof of r, theta and z of the first observed node; none where the node has no
    /// such component.
    #[must_use]
    pub fn observed_dofs(&self) -> [Option<usize>; 3] {
        Component::DISPLACEMENTS.map(|component| {
            let node = self.model.observed.first()?.node;
            let dof = self.model.dof_of(node, component)?;
            Some(self.independent[dof].0)
        })
    }

    /// Number of force vectors: that of the model, or one per load case.
    #[must_use]
    pub fn load_cases(&self) -> usize {
        self.model.load_case_forces.len().max(1)
    }

    /// Complex force amplitudes on the independent dofs of sector 0, N, each `n_dofs x 1`: that of the
    /// model, or one per load case.
    #[must_use]
    pub fn forces(&self) -> Vec<Matrix<Complex64>> {
        let column = |entries: &Vec<(usize, Complex64)>| {
            let mut force = Matrix::zeros(self.dimension(), 1);
            for &(dof, value) in entries {
                force[(self.independent[dof].0, 0)] += value;
            }
            force
        };
        match self.model.load_case_forces.as_slice() {
            [] => vec![column(&self.model.force)],
            load_cases => load_cases.iter().map(column).collect(),
        }
    }

    fn matrix(&self, sector: &SymmetricSparse, h: usize) -> HermitianSparse {
        let face = phase(h, 1, self.model.sectors);
        let entries = sector.entries().map(|(row, column, value)| {
            let (i, row_high) = self.independent[row];
            let (j, column_high) = self.independent[column];
            // T^H A T with T = e^{i h alpha} on the high face.
            let mut factor = Complex64::new(value, 0.0);
            if row_high {
                factor *= face.conj();
            }
            if column_high {
                factor *= face;
            }
            (i, j, factor)
        });
        HermitianSparse::from_triplets(self.dimension(), entries)
    }
}
