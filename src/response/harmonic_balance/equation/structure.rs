//! The linear part of the equation: a structure in its own modes, its damping and contact springs.
//!
//! ```text
//! Z(omega) = diag(lambda) - omega^2 I + i D(omega),    D = eta diag(lambda) + omega C_v
//! ```
//!
//! with `lambda` the contact-free eigenvalues, mistuning included; contact springs are undamped
//! and harmonic 0 has no damping.

use crate::linalg::{Complex64, Matrix, add_times};
use crate::response::harmonic_balance::Damping;
use crate::response::mistuning::{ModalRows, StructuralModes};

/// Damping `D(omega) = eta diag(lambda) + omega C` in modal coordinates.
#[derive(Debug, Clone, PartialEq)]
struct ModalDamping {
    /// eta.
    loss_factor: f64,
    viscous: Viscous,
}

/// `C`, 1/s.
#[derive(Debug, Clone, PartialEq)]
enum Viscous {
    None,
    Diagonal(Vec<f64>),
    Full(Matrix<f64>),
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
    /// `diag(springs)`, N/m, a spring per contact row.
    pub springs: Vec<f64>,
}

impl Structure {
    /// Modes with damping. Viscous damping is that of the tuned structure, unchanged by mistuning.
    #[must_use]
    pub fn new(modes: StructuralModes, damping: Damping) -> Self {
        let of_mode = |lambda: f64| match damping {
            Damping::StructuralLossFactor(_) => 0.0,
            Damping::ModalRatio(zeta) => 2.0 * zeta * lambda.max(0.0).sqrt(),
            Damping::Rayleigh {
                mass_per_s,
                stiffness_s,
            } => mass_per_s + stiffness_s * lambda,
        };
        let tuned = modes.tuned_eigenvalues.iter();
        let viscous: Vec<f64> = tuned
            .zip(&modes.added_damping_per_s)
            .map(|(&lambda, added)| of_mode(lambda) + added)
            .collect();
        let damping = ModalDamping {
            loss_factor: match damping {
                Damping::StructuralLossFactor(eta) => eta,
                Damping::ModalRatio(_) | Damping::Rayleigh { .. } => 0.0,
            },
            viscous: Viscous::of(viscous, modes.rotation.as_ref()),
        };
        Self {
            eigenvalues: modes.eigenvalues,
            damping,
            contact: modes.contact,
            observed: modes.observed,
            sectors: modes.sectors,
        }
    }

    /// Copy of this structure with viscous damping, `C = eta diag(lambda) / omega` in the place of a structural loss
    /// factor, equal to it at `omega` alone. For comparison with time integration, in which structural damping has no
    /// form; viscous damping stays as it is.
    #[must_use]
    pub fn with_viscous_damping(&self, omega: f64) -> Self {
        let mut structure = self.clone();
        let eta = std::mem::take(&mut structure.damping.loss_factor);
        if eta != 0.0 {
            let added = self.eigenvalues.iter().map(|lambda| eta * lambda / omega);
            structure.damping.viscous.add_diagonal(added.collect());
        }
        structure
    }

    /// Whether the damping is viscous, `D(omega) = omega C`.
    #[must_use]
    pub fn is_viscous(&self) -> bool {
        self.damping.loss_factor == 0.0
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
        !matches!(self.damping.viscous, Viscous::Full(_))
    }

    /// Diagonal entry of the damping `D(omega)`, (rad/s)^2.
    #[must_use]
    pub fn damping_diagonal(&self, mode: usize, omega: f64) -> f64 {
        let viscous = match &self.damping.viscous {
            Viscous::None => 0.0,
            Viscous::Diagonal(viscous) => viscous[mode],
            Viscous::Full(viscous) => viscous[(mode, mode)],
        };
        self.damping.loss_factor * self.eigenvalues[mode] + omega * viscous
    }

    /// `v^T D(omega) v` for every column of `shapes`, real mode shapes given in these modes, at its own omega.
    #[must_use]
    pub fn damping_of(&self, shapes: &Matrix<f64>, omega: &[f64]) -> Vec<f64> {
        let product = match &self.damping.viscous {
            Viscous::Full(viscous) => Some(viscous.times(shapes)),
            Viscous::None | Viscous::Diagonal(_) => None,
        };
        let of_shape = |(column, &omega): (usize, &f64)| {
            let shape = shapes.column(column);
            let diagonal = |of: &dyn Fn(usize) -> f64| -> f64 {
                let shape = shape.iter().enumerate();
                shape.map(|(mode, v)| v * v * of(mode)).sum()
            };
            let Some(product) = &product else {
                return diagonal(&|mode| self.damping_diagonal(mode, omega));
            };
            let viscous = shape.iter().zip(product.column(column));
            let eta = self.damping.loss_factor;
            omega * viscous.map(|(v, force)| v * force).sum::<f64>()
                + diagonal(&|mode| eta * self.eigenvalues[mode])
        };
        omega.iter().enumerate().map(of_shape).collect()
    }

    /// Adds the damping `D(omega)` at the full, column-major `n x n` block through `add(i, j, value)`.
    pub fn for_each_damping(&self, omega: f64, mut add: impl FnMut(usize, usize, f64)) {
        for mode in 0..self.size() {
            add(mode, mode, self.damping_diagonal(mode, omega));
        }
        if let Viscous::Full(viscous) = &self.damping.viscous {
            each_off_diagonal(viscous, |i, j, rate| add(i, j, omega * rate));
        }
    }

    /// Adds the damping force `i D(omega) x` to `sum`; both are real parts, then imaginary ones. `product` is room
    /// for as many numbers.
    pub fn add_damping_force(&self, omega: f64, x: &[f64], sum: &mut [f64], product: &mut [f64]) {
        let Viscous::Full(_) = self.damping.viscous else {
            add_turned(x, sum, |mode| self.damping_diagonal(mode, omega));
            return;
        };
        let eta = self.damping.loss_factor;
        add_turned(x, sum, |mode| eta * self.eigenvalues[mode]);
        self.add_damping_rate(omega, x, sum, product);
    }

    /// Adds `i factor dD/domega x` as [`Self::add_damping_force`]; structural damping does not change with frequency.
    pub fn add_damping_rate(&self, factor: f64, x: &[f64], sum: &mut [f64], product: &mut [f64]) {
        let n = self.size();
        match &self.damping.viscous {
            Viscous::None => {}
            Viscous::Diagonal(viscous) => add_turned(x, sum, |mode| factor * viscous[mode]),
            Viscous::Full(viscous) => {
                product.fill(0.0);
                add_times(product, viscous.as_slice(), x, (n, 2, n));
                add_turned(product, sum, |_| factor);
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
            springs: springs.iter().copied().cycle().take(real.rows()).collect(),
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
        if let Viscous::Full(viscous) = &self.damping.viscous {
            for (entry, rate) in matrix.iter_mut().zip(viscous.as_slice()) {
                entry.im += omega * rate;
            }
            for (mode, lambda) in self.eigenvalues.iter().enumerate() {
                matrix[mode * n + mode].im += self.damping.loss_factor * lambda;
            }
        } else {
            for mode in 0..n {
                matrix[mode * n + mode].im += self.damping_diagonal(mode, omega);
            }
        }
    }
}

impl Viscous {
    /// The damping of tuned coordinates in the modes of `rotation`, none where they are the same.
    fn of(tuned: Vec<f64>, rotation: Option<&Matrix<f64>>) -> Self {
        let alike = |pair: &[f64]| pair[0].total_cmp(&pair[1]).is_eq();
        if tuned.iter().all(|&rate| rate == 0.0) {
            return Self::None;
        }
        match rotation {
            Some(rotation) if !tuned.windows(2).all(alike) => {
                let scaled = Matrix::from_fn(rotation.rows(), rotation.columns(), |i, j| {
                    tuned[i] * rotation[(i, j)]
                });
                Self::Full(rotation.adjoint_times(&scaled))
            }
            _ => Self::Diagonal(tuned),
        }
    }

    fn add_diagonal(&mut self, added: Vec<f64>) {
        match self {
            Self::None => *self = Self::Diagonal(added),
            Self::Diagonal(viscous) => {
                for (sum, part) in viscous.iter_mut().zip(added) {
                    *sum += part;
                }
            }
            Self::Full(viscous) => {
                for (mode, part) in added.into_iter().enumerate() {
                    viscous[(mode, mode)] += part;
                }
            }
        }
    }
}

/// Adds `i rate x`, a rate per mode; both are real parts, then imaginary ones.
fn add_turned(x: &[f64], sum: &mut [f64], rate: impl Fn(usize) -> f64) {
    let (x_real, x_imaginary) = x.split_at(x.len() / 2);
    let (real, imaginary) = sum.split_at_mut(x.len() / 2);
    for mode in 0..real.len() {
        let rate = rate(mode);
        real[mode] -= rate * x_imaginary[mode];
        imaginary[mode] += rate * x_real[mode];
    }
}

fn each_off_diagonal(matrix: &Matrix<f64>, mut add: impl FnMut(usize, usize, f64)) {
    for j in 0..matrix.columns() {
        for i in (0..matrix.rows()).filter(|&i| i != j) {
            add(i, j, matrix[(i, j)]);
        }
    }
}
