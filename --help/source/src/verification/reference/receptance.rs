//! Response of the structure with linear contact springs at one frequency, condensed on the contact
//! and the observed rows.

use crate::linalg::{Complex64, LuWorkspace, Matrix};

use super::FullStructure;

/// A structure with linear contact springs, ready for any frequency.
#[derive(Debug, Clone)]
pub(super) struct SprungStructure {
    structure: std::sync::Arc<FullStructure>,
    /// `K + C^H diag(springs) C`, `n x n`.
    sprung: Matrix<Complex64>,
}

/// Condensed dynamic compliance `Y = (Z(k omega) + C^H diag(springs) C)^-1` of one harmonic.
#[derive(Debug, Clone)]
pub(super) struct Receptance {
    /// `C Y C^H`, `n_rows x n_rows`, m/N.
    pub(super) contact: Matrix<Complex64>,
    /// `O Y C^H`, `3 n_blades x n_rows`, m/N.
    pub(super) observed: Matrix<Complex64>,
}

/// Response to the excitation with the springs alone.
#[derive(Debug, Clone)]
pub(super) struct Forced {
    /// `C Y f`, `n_rows`, m.
    pub(super) contact: Vec<Complex64>,
    /// `O Y f`, `3 n_blades`, m.
    pub(super) observed: Vec<Complex64>,
}

/// `Z(k omega) + C^H diag(springs) C`, factored.
pub(super) struct FactoredStiffness<'a> {
    structure: &'a FullStructure,
    factors: LuWorkspace<Complex64>,
}

impl SprungStructure {
    /// `springs` are those of the rows of one sector, N/m, repeated over the sectors; none = free.
    pub(super) fn new(structure: std::sync::Arc<FullStructure>, springs: Option<&[f64]>) -> Self {
        let contact = &structure.contact;
        let mut sprung = structure.stiffness.clone();
        if let Some(springs) = springs.filter(|springs| !springs.is_empty()) {
            let loaded = Matrix::from_fn(contact.rows(), contact.columns(), |i, j| {
                contact[(i, j)] * springs[i % springs.len()]
            });
            let added = contact.adjoint_times(&loaded);
            for (entry, part) in sprung.as_mut_slice().iter_mut().zip(added.as_slice()) {
                *entry += part;
            }
        }
        Self { structure, sprung }
    }

    /// Structure without the springs.
    pub(super) fn structure(&self) -> &FullStructure {
        &self.structure
    }

    /// Factors the dynamic stiffness of harmonic `k` at the excitation frequency `omega`, rad/s;
    /// none if it is singular. `Z = K (1 + i eta) + i k omega C_v - (k omega)^2`, harmonic 0
    /// undamped.
    pub(super) fn factor(&self, harmonic: u32, omega: f64) -> Option<FactoredStiffness<'_>> {
        let structure = &*self.structure;
        let n = structure.size();
        let k_omega = f64::from(harmonic) * omega;
        let mut factors = LuWorkspace::new(n);
        let matrix = factors.matrix_mut();
        matrix.copy_from_slice(self.sprung.as_slice());
        if harmonic > 0 && structure.loss_factor != 0.0 {
            let loss = Complex64::new(0.0, structure.loss_factor);
            for (entry, stiffness) in matrix.iter_mut().zip(structure.stiffness.as_slice()) {
                *entry += loss * stiffness;
            }
        }
        for (i, viscous) in structure.viscous.iter().enumerate() {
            matrix[i * n + i] += Complex64::new(-k_omega * k_omega, k_omega * viscous);
        }
        factors
            .factor()
            .then_some(FactoredStiffness { structure, factors })
    }
}

impl FactoredStiffness<'_> {
    pub(super) fn forced(&self, force: &[Complex64]) -> Forced {
        let mut response = Matrix::from_fn(force.len(), 1, |i, _| force[i]);
        self.factors.solve_columns(&mut response);
        let rows = |rows: &Matrix<Complex64>| rows.times_vector(response.column(0));
        Forced {
            contact: rows(&self.structure.contact),
            observed: rows(&self.structure.observed),
        }
    }

    pub(super) fn receptance(&self) -> Receptance {
        let mut columns = self.structure.contact.adjoint();
        self.factors.solve_columns(&mut columns);
        Receptance {
            contact: self.structure.contact.times(&columns),
            observed: self.structure.observed.times(&columns),
        }
    }
}
