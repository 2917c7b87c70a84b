//! Resonances of the linear limits: where a peak can lie, how high it would be and how wide.

use std::f64::consts::TAU;

use crate::linalg::{Complex64, Matrix, hermitian_eigen};
use crate::response::harmonic_balance::{ContactStiffnessMatrix, Structure};
use crate::response::mistuning::ModalRows;
use crate::response::receptance::Resonance;

/// Undamped modes of a structure with linear contact springs, over the structure's own modes.
#[derive(Debug, Clone)]
pub struct LinearModes {
    /// Angular frequencies, rad/s, ascending.
    omega: Vec<f64>,
    /// Shapes, a column per mode; none where they are the structure's own modes.
    shapes: Option<ModalRows>,
    /// Norm over r, theta, z of the observed displacement, `blades x modes`.
    observed: Matrix<f64>,
}

impl LinearModes {
    /// Modes of `structure` with the given contact stiffness, or with none; none if a value is
    /// not finite.
    #[must_use]
    pub fn new(structure: &Structure, contact: Option<&ContactStiffnessMatrix>) -> Option<Self> {
        let (eigenvalues, shapes) = match contact {
            None => (structure.eigenvalues().to_vec(), None),
            Some(contact) => {
                let (eigenvalues, shapes) = coupled_modes(structure, contact)?;
                (eigenvalues, Some(shapes))
            }
        };
        let blades = structure.sectors();
        let components = observed_components(structure.observed(), shapes.as_ref());
        let observed = Matrix::from_fn(blades, eigenvalues.len(), |blade, mode| {
            (0..3)
                .map(|component| components[(3 * blade + component, mode)].norm_sqr())
                .sum::<f64>()
                .sqrt()
        });
        Some(Self {
            omega: eigenvalues.iter().map(|l| l.max(0.0).sqrt()).collect(),
            shapes,
            observed,
        })
    }

    /// Resonances with a frequency above zero under the modal force `force`.
    #[must_use]
    pub fn peaks(&self, structure: &Structure, force: &[Complex64]) -> Vec<Resonance> {
        let damping = self.damping(structure);
        (0..self.omega.len())
            .filter(|&mode| self.omega[mode] > 0.0)
            .map(|mode| {
                let omega = self.omega[mode];
                let (drive, damping) = (self.drive(force, mode), damping[mode]);
                let reach = self
                    .observed
                    .column(mode)
                    .iter()
                    .copied()
                    .fold(0.0, f64::max);
                Resonance {
                    frequency_hz: omega / TAU,
                    amplitude_m: if damping > 0.0 {
                        reach * drive / damping
                    } else {
                        0.0
                    },
                    half_bandwidth_hz: damping / (2.0 * omega) / TAU,
                }
            })
            .collect()
    }

    /// `|v^H f|` of a mode.
    fn drive(&self, force: &[Complex64], mode: usize) -> f64 {
        let Some(shapes) = &self.shapes else {
            return force[mode].norm();
        };
        let along = |rows: &Matrix<f64>| -> Complex64 {
            let shape = rows.column(mode).iter();
            shape.zip(force).map(|(&v, &f)| f * v).sum()
        };
        let mut drive = along(&shapes.real);
        if let Some(imaginary) = &shapes.imaginary {
            drive -= Complex64::i() * along(imaginary);
        }
        drive.norm()
    }

    /// `v^H D v` of every mode at its own frequency.
    fn damping(&self, structure: &Structure) -> Vec<f64> {
        let Some(shapes) = &self.shapes else {
            let modes = self.omega.iter().enumerate();
            let diagonal = modes.map(|(mode, &omega)| structure.damping_diagonal(mode, omega));
            return diagonal.collect();
        };
        let mut damping = structure.damping_of(&shapes.real, &self.omega);
        if let Some(imaginary) = &shapes.imaginary {
            let part = structure.damping_of(imaginary, &self.omega);
            damping
                .iter_mut()
                .zip(part)
                .for_each(|(sum, part)| *sum += part);
        }
        damping
    }
}

/// Eigenvalues and shapes of `diag(lambda) + C^H k C`.
fn coupled_modes(
    structure: &Structure,
    contact: &ContactStiffnessMatrix,
) -> Option<(Vec<f64>, ModalRows)> {
    let lambda = structure.eigenvalues();
    if let Some(imaginary) = &contact.imaginary {
        let stiffness = Matrix::from_fn(lambda.len(), lambda.len(), |i, j| {
            let diagonal = if i == j { lambda[i] } else { 0.0 };
            Complex64::new(contact.real[(i, j)] + diagonal, imaginary[(i, j)])
        });
        let (eigenvalues, shapes) = hermitian_eigen(&stiffness).ok()?;
        let rows = ModalRows {
            real: shapes.real(),
            imaginary: Some(shapes.imaginary()),
        };
        return Some((eigenvalues, rows));
    }
    let mut stiffness = contact.real.clone();
    for (i, eigenvalue) in lambda.iter().enumerate() {
        stiffness[(i, i)] += eigenvalue;
    }
    let (eigenvalues, shapes) = hermitian_eigen(&stiffness).ok()?;
    let rows = ModalRows {
        real: shapes,
        imaginary: None,
    };
    Some((eigenvalues, rows))
}

/// Observed rows times shapes, complex.
fn observed_components(observed: &ModalRows, shapes: Option<&ModalRows>) -> Matrix<Complex64> {
    let join = |rows: &ModalRows| {
        Matrix::from_fn(rows.real.rows(), rows.real.columns(), |i, j| {
            let imaginary = rows.imaginary.as_ref().map_or(0.0, |part| part[(i, j)]);
            Complex64::new(rows.real[(i, j)], imaginary)
        })
    };
    match shapes {
        None => join(observed),
        Some(shapes) if shapes.imaginary.is_none() && observed.imaginary.is_none() => {
            observed.real.times(&shapes.real).to_complex()
        }
        Some(shapes) => join(observed).times(&join(shapes)),
    }
}
