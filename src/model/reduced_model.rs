//! The reduced model: what the Monte Carlo loop needs of a bladed disk, and nothing else.

use serde::{Deserialize, Serialize};

use super::blade_energy::BladeEnergy;
use super::cyclic::{ContactGeometry, NodalDiameter};
use crate::linalg::{Complex64, Matrix};

/// A basis of definite size; the same for every nodal diameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum BasisChoice {
    /// Modes under global sticking and global sliding contact (Tang & Epureanu).
    StickSlide {
        /// Stick modes.
        stick: usize,
        /// Slide modes.
        slide: usize,
    },
    /// Stick modes and one attachment vector per contact direction.
    StickAttachment {
        /// Stick modes.
        stick: usize,
    },
    /// The whole Craig-Bampton space: the reference that every other basis is compared with.
    CraigBampton,
}

impl std::fmt::Display for BasisChoice {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::StickSlide { stick, slide } => write!(f, "stick_slide {stick}+{slide}"),
            Self::StickAttachment { stick } => write!(f, "stick_attachment {stick}"),
            Self::CraigBampton => write!(f, "craig_bampton"),
        }
    }
}

/// Linear contact springs of a sector, N/m, one per contact row, under the two extreme states.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ContactSprings {
    /// Sticking: normal and tangential springs.
    pub stick: Vec<f64>,
    /// Sliding: normal springs only.
    pub slide: Vec<f64>,
}

/// Cantilevered-blade modes: the blade alone, its root held (component mode mistuning,
/// Lim, Bladh, Castanier & Pierre 2007, AIAA J. 45(9)).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CantileverModes {
    /// Eigenvalues `omega_r^2`, (rad/s)^2, ascending.
    pub eigenvalues: Vec<f64>,
    /// Participation `q_h = diag(1/omega_r^2) U^T K_blade B_h` of each nodal diameter 0..=N/2,
    /// `n_cantilever x n_modes`.
    pub participation: Vec<Matrix<Complex64>>,
}

/// One nodal diameter in its own tuned contact-free modes: `M = I`, `K = diag(eigenvalues)`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ReducedNodalDiameter {
    /// Eigenvalues of the tuned contact-free structure, (rad/s)^2, ascending, length `n_modes`.
    pub eigenvalues: Vec<f64>,
    /// Viscous damping of each mode besides the damping model of the structure, 1/s, length `n_modes`.
    pub added_damping_per_s: Vec<f64>,
    /// Relative motion at the contact rows of a sector, `n_rows x n_modes`.
    pub contact: Matrix<Complex64>,
    /// Displacement r, theta, z of the first observed node, `3 x n_modes`; zero where it has none.
    pub observed: Matrix<Complex64>,
    /// `B^H f` of the sector's force amplitude, `n_modes x 1`; a column per load case where there are several.
    pub force: Matrix<Complex64>,
    /// `B^T f`: the same for the conjugate wave.
    pub conjugate_force: Matrix<Complex64>,
}

/// What the reduction of one nodal diameter came to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NodalDiameterReport {
    /// Nodal diameter h.
    pub nodal_diameter: usize,
    /// Size of the Craig-Bampton model.
    pub craig_bampton_size: usize,
    /// Number of vectors offered to the basis.
    pub candidates: usize,
    /// Rank: number of basis vectors kept.
    pub rank: usize,
    /// Ratio of the largest to the smallest singular value kept.
    pub condition: f64,
    /// Lowest frequencies under sticking contact, Hz.
    pub stick_frequencies_hz: Vec<f64>,
    /// Lowest frequencies under sliding contact, Hz.
    pub slide_frequencies_hz: Vec<f64>,
    /// Lowest frequencies without contact, Hz.
    pub free_frequencies_hz: Vec<f64>,
}

/// A wheel in reduced coordinates.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ReducedModel {
    /// Name of the sector model.
    pub name: String,
    /// Number of sectors N.
    pub sectors: usize,
    /// Basis that was used.
    pub basis: BasisChoice,
    /// Whether the basis spans every independent dof, so that nothing is lost.
    pub whole_space: bool,
    /// Nodal diameters 0..=N/2.
    pub nodal_diameters: Vec<ReducedNodalDiameter>,
    /// The contact interface of a sector.
    pub contact: ContactGeometry,
    /// Linear contact springs of a sector's rows, stick and slide.
    pub springs: ContactSprings,
    /// Strain energy of the blade; not known in a model made for the tuned wheel alone.
    pub blade_energy: BladeEnergy,
    /// Cantilevered-blade modes, where the study projects through them.
    pub cantilever: Option<CantileverModes>,
    /// Factors on the force vector under single engine orders; 1 under the others.
    pub force_factors: Vec<(u32, f64)>,
    /// What the reduction came to, per nodal diameter.
    pub report: Vec<NodalDiameterReport>,
}

impl ReducedModel {
    /// Factor on the force vector under an engine order.
    #[must_use]
    pub fn force_factor(&self, engine_order: u32) -> f64 {
        let of = |&&(order, _): &&(u32, f64)| order == engine_order;
        self.force_factors
            .iter()
            .find(of)
            .map_or(1.0, |&(_, factor)| factor)
    }

    /// Copy of this model under one of several load cases: the one in column `column` of its forces, with
    /// `force_factors` on the force vector under single engine orders.
    #[must_use]
    pub fn under(&self, column: usize, force_factors: Vec<(u32, f64)>) -> Self {
        let mut model = self.clone();
        for nd in &mut model.nodal_diameters {
            nd.force = nd.force.column_range(column, column + 1);
            nd.conjugate_force = nd.conjugate_force.column_range(column, column + 1);
        }
        Self {
            force_factors,
            ..model
        }
    }

    /// Number of real modal coordinates of the wheel: every nodal diameter but 0 and N/2 twice.
    #[must_use]
    pub fn wheel_size(&self) -> usize {
        self.nodal_diameters
            .iter()
            .enumerate()
            .map(|(h, nd)| nd.eigenvalues.len() * if self.is_standing(h) { 1 } else { 2 })
            .sum()
    }

    /// The basis in words; the whole space is no choice.
    #[must_use]
    pub fn basis_name(&self) -> String {
        if self.whole_space {
            "whole space".to_owned()
        } else {
            self.basis.to_string()
        }
    }

    /// Whether nodal diameter h is a standing wave (0 or N/2), with a real basis.
    #[must_use]
    pub fn is_standing(&self, h: usize) -> bool {
        h == 0 || 2 * h == self.sectors
    }

    /// Number of contact rows of a sector.
    #[must_use]
    pub fn contact_rows(&self) -> usize {
        self.contact.row_count()
    }

    /// Bytes of its matrices.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        let complex = |entries: usize| 16 * entries;
        let diameters: usize = self
            .nodal_diameters
            .iter()
            .map(|nd| {
                16 * nd.eigenvalues.len()
                    + complex(nd.contact.as_slice().len() + nd.observed.as_slice().len())
                    + complex(2 * nd.eigenvalues.len())
            })
            .sum();
        diameters + self.blade_energy.memory_bytes()
    }

    /// The travelling wave of a nodal diameter: contact, observation and force of one sector.
    #[must_use]
    pub fn wave(&self, nodal_diameter: NodalDiameter) -> ReducedNodalDiameter {
        let nd = &self.nodal_diameters[nodal_diameter.index];
        if !nodal_diameter.conjugate {
            return nd.clone();
        }
        ReducedNodalDiameter {
            eigenvalues: nd.eigenvalues.clone(),
            added_damping_per_s: nd.added_damping_per_s.clone(),
            contact: nd.contact.conjugate(),
            observed: nd.observed.conjugate(),
            force: nd.conjugate_force.clone(),
            conjugate_force: nd.force.clone(),
        }
    }
}
