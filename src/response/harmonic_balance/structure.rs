//! The linear part of the equation: a structure in its own modes, its damping and contact springs.
//!
//! ```text
//! Z(omega) = diag(lambda) - omega^2 I + i D(omega),    D = eta diag(lambda)  or  omega C_v
//! ```
//!
//! with `lambda` the contact-free eigenvalues, mistuning included; contact springs are undamped
//! and harmonic 0 has no damping.

use super::Damping;
use crate::linalg::{Complex64, Matrix};
use crate::response::mistuning::{ModalRows, StructuralModes};

/// Damping in modal coordinates.
#[derive(Debug, Clone, PartialEq)]
enum ModalDamping {
    /// `eta diag(lambda)`.
    Structural(f64),
    /// `omega diag(c)`, c in 1/s.
    ViscousDiagonal(Vec<f64>),
    /// `omega C`, C in 1/s.
    ViscousFull(Matrix<f64>),
}

/// A structure in modal coordinates with its contact rows and linear contact springs.
#[derive(Debug, Clone)]
pub struct Structure {
    eigenvalues: Vec<f64>,
    damping: ModalDamping,
    contact: ModalRows,
    observed: ModalRows,
    sectors: usize,
}

/// Linear contact stiffness `C^H diag(springs) C` in modal coordinates.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactStiffnessMatrix {
    /// Real part, symmetric.
    pub real: Matrix<f64>,
    /// Imaginary part, antisymmetric; none where the contact rows are real.
    pub imaginary: Option<Matrix<f64>>,
}

impl Structure {
    /// Modes with damping. Viscous damping is that of the tuned structure, unchanged by mistuning.
    #[must_use]
    pub fn new(modes: StructuralModes, damping: Damping) -> Self {
        let tuned_viscous: Option<Vec<f64>> = match damping {
            Damping::StructuralLossFactor(_) => None,
            Damping::ModalRatio(zeta) => Some(
                modes
                    .tuned_eigenvalues
                    .iter()
                    .map(|lambda| 2.0 * zeta * lambda.max(0.0).sqrt())
                    .collect(),
            ),
            Damping::Rayleigh {
                mass_per_s,
                stiffness_s,
            } => Some(
                modes
                    .tuned_eigenvalues
                    .iter()
                    .map(|lambda| mass_per_s + stiffness_s * lambda)
                    .collect(),
            ),
        };
        let damping = match (damping, tuned_viscous, &modes.rotation) {
            (Damping::StructuralLossFactor(eta), ..) => ModalDamping::Structural(eta),
            (_, Some(viscous), None) => ModalDamping::ViscousDiagonal(viscous),
            (_, Some(viscous), Some(_))
                if viscous
                    .windows(2)
                    .all(|pair| pair[0].total_cmp(&pair[1]).is_eq()) =>
            {
                ModalDamping::ViscousDiagonal(viscous)
            }
            (_, Some(viscous), Some(rotation)) => {
                let scaled = Matrix::from_fn(rotation.rows(), rotation.columns(), |i, j| {
                    viscous[i] * rotation[(i, j)]
                });
                ModalDamping::ViscousFull(rotation.adjoint_times(&scaled))
            }
            (_, None, _) => unreachable!("viscous damping has coefficients"),
        };
        Self {
            eigenvalues: modes.eigenvalues,
            damping,
            contact: modes.contact,
            observed: modes.observed,
            sectors: modes.sectors,
        }
    }

    /// The same structure with viscous damping: `C = eta diag(lambda) / omega` in the place of a
    /// structural loss factor, equal to it at `omega` alone. For comparison with time integration,
    /// in which structural damping has no form; viscous damping stays as it is.
    #[must_use]
    pub fn with_viscous_damping(&self, omega: f64) -> Self {
        let mut structure = self.clone();
        if let ModalDamping::Structural(eta) = self.damping {
            let viscous = self.eigenvalues.iter().map(|lambda| eta * lambda / omega);
            structure.damping = ModalDamping::ViscousDiagonal(viscous.collect());
        }
        structure
    }

    /// Whether the damping is viscous, `D(omega) = omega C`.
    #[must_use]
    pub fn is_viscous(&self) -> bool {
        !matches!(self.damping, ModalDamping::Structural(_))
    }

    /// Number of modes.
    #[must_use]
    pub fn size(&self) -> usize {
        self.eigenvalues.len()
    }

    /// Contact-free eigenvalues, (rad/s)^2.
    #[must_use]
    pub fn eigenvalues(&self) -> &[f64] {
        &self.eigenvalues
    }

    /// Relative motion at the contact rows, sector after sector.
    #[must_use]
    pub fn contact(&self) -> &ModalRows {
        &self.contact
    }

    /// Displacement r, theta, z of the observed node, blade after blade.
    #[must_use]
    pub fn observed(&self) -> &ModalRows {
        &self.observed
    }

    /// Number of sectors the rows stand for.
    #[must_use]
    pub fn sectors(&self) -> usize {
        self.sectors
    }

    /// Whether `Z` is diagonal.
    #[must_use]
    pub fn is_diagonal(&self) -> bool {
        !matches!(self.damping, ModalDamping::ViscousFull(_))
    }

    /// Diagonal entry of the damping `D(omega)`, (rad/s)^2.
    #[must_use]
    pub fn damping_diagonal(&self, mode: usize, omega: f64) -> f64 {
        match &self.damping {
            ModalDamping::Structural(eta) => eta * self.eigenvalues[mode],
            ModalDamping::ViscousDiagonal(viscous) => omega * viscous[mode],
            ModalDamping::ViscousFull(viscous) => omega * viscous[(mode, mode)],
        }
    }

    /// `v^T D(omega) v` for a real vector: the damping of a mode shape given in these modes.
    #[must_use]
    pub fn damping_of(&self, shape: &[f64], omega: f64) -> f64 {
        match &self.damping {
            ModalDamping::ViscousFull(viscous) => {
                let product = viscous.times_vector(shape);
                omega * shape.iter().zip(&product).map(|(a, b)| a * b).sum::<f64>()
            }
            _ => shape
                .iter()
                .enumerate()
                .map(|(mode, v)| v * v * self.damping_diagonal(mode, omega))
                .sum(),
        }
    }

    /// Adds the damping `D(omega)` at the full, column-major `n x n` block through `add(i, j, value)`.
    pub fn for_each_damping(&self, omega: f64, mut add: impl FnMut(usize, usize, f64)) {
        if let ModalDamping::ViscousFull(viscous) = &self.damping {
            for j in 0..self.size() {
                for i in 0..self.size() {
                    add(i, j, omega * viscous[(i, j)]);
                }
            }
        } else {
            for mode in 0..self.size() {
                add(mode, mode, self.damping_diagonal(mode, omega));
            }
        }
    }

    /// Adds `dD/domega`, 1/s, through `add(i, j, value)`; structural damping has none.
    pub fn for_each_damping_rate(&self, mut add: impl FnMut(usize, usize, f64)) {
        match &self.damping {
            ModalDamping::Structural(_) => {}
            ModalDamping::ViscousDiagonal(viscous) => {
                for (mode, &rate) in viscous.iter().enumerate() {
                    add(mode, mode, rate);
                }
            }
            ModalDamping::ViscousFull(viscous) => {
                for j in 0..self.size() {
                    for i in 0..self.size() {
                        add(i, j, viscous[(i, j)]);
                    }
                }
            }
        }
    }

    /// `C^H diag(springs) C`; `springs` are those of one sector, N/m, repeated over the sectors, or
    /// those of all.
    #[must_use]
    pub fn contact_stiffness(&self, springs: &[f64]) -> ContactStiffnessMatrix {
        let scale = |rows: &Matrix<f64>| {
            Matrix::from_fn(rows.rows(), rows.columns(), |i, j| {
                springs[i % springs.len()] * rows[(i, j)]
            })
        };
        let real = &self.contact.real;
        let scaled_real = scale(real);
        let mut stiffness = real.adjoint_times(&scaled_real);
        let imaginary = self.contact.imaginary.as_ref().map(|imaginary| {
            let scaled_imaginary = scale(imaginary);
            let square = imaginary.adjoint_times(&scaled_imaginary);
            for (sum, &part) in stiffness.as_mut_slice().iter_mut().zip(square.as_slice()) {
                *sum += part;
            }
            let mixed = real.adjoint_times(&scaled_imaginary);
            Matrix::from_fn(mixed.rows(), mixed.columns(), |i, j| {
                mixed[(i, j)] - mixed[(j, i)]
            })
        });
        ContactStiffnessMatrix {
            real: stiffness,
            imaginary,
        }
    }

    /// `Z(omega) + C^H k_c C`, column-major into `matrix` (`n x n`); without `contact`, `Z` alone.
    pub fn dynamic_stiffness(
        &self,
        omega: f64,
        contact: Option<&ContactStiffnessMatrix>,
        matrix: &mut [Complex64],
    ) {
        let n = self.size();
        match contact {
            None => matrix.fill(Complex64::default()),
            Some(contact) => {
                for (entry, &real) in matrix.iter_mut().zip(contact.real.as_slice()) {
                    *entry = Complex64::new(real, 0.0);
                }
                if let Some(imaginary) = &contact.imaginary {
                    for (entry, &imaginary) in matrix.iter_mut().zip(imaginary.as_slice()) {
                        entry.im = imaginary;
                    }
                }
            }
        }
        for (mode, lambda) in self.eigenvalues.iter().enumerate() {
            matrix[mode * n + mode] += lambda - omega * omega;
        }
        self.for_each_damping(omega, |i, j, d| matrix[j * n + i].im += d);
    }
}
