//! The whole wheel in real coordinates: every nodal diameter as a cosine and a sine wave.

use std::sync::Arc;

use crate::linalg::{Complex64, Matrix};
use crate::model::ReducedModel;
use crate::model::cyclic::{NodalDiameter, nodal_diameter_of, phase};

/// Real coordinates of the tuned wheel, in which `M = I` and `K = diag(eigenvalues)`.
///
/// With `B_h` the basis of nodal diameter h, sector n moves in the coordinates `(h, c)` and `(h, s)` as
/// `sqrt(2/N) Re(B_h e^{i h n alpha})` and `sqrt(2/N) Im(B_h e^{i h n alpha})`, and for h = 0 and
/// N/2, whose basis is real, as `(1/sqrt N) B_h e^{i h n alpha}`. The coordinates are orthonormal,
/// so that every matrix of a mistuned wheel is real symmetric. `size` coordinates in all, nodal
/// diameters ascending, cosine before sine.
#[derive(Debug, Clone)]
pub struct WheelBasis {
    model: Arc<ReducedModel>,
    waves: Vec<Wave>,
    eigenvalues: Vec<f64>,
    added_damping_per_s: Vec<f64>,
    contact: Matrix<f64>,
    observed: Matrix<f64>,
}

/// One block of coordinates: nodal diameter h as a cosine, sine or standing wave.
#[derive(Debug, Clone)]
struct Wave {
    nodal_diameter: usize,
    /// First coordinate.
    start: usize,
    /// In sector n the wave is `real[n] Re B_h + imaginary[n] Im B_h`.
    real: Vec<f64>,
    imaginary: Vec<f64>,
}

impl WheelBasis {
    /// Expands a reduced model to its wheel.
    #[must_use]
    pub fn new(model: Arc<ReducedModel>) -> Self {
        let sectors = model.sectors;
        let mut waves = Vec::new();
        let mut eigenvalues = Vec::new();
        let mut added_damping_per_s = Vec::new();
        for (h, nd) in model.nodal_diameters.iter().enumerate() {
            let phases: Vec<Complex64> = (0..sectors).map(|n| phase(h, n, sectors)).collect();
            let standing = model.is_standing(h);
            let scale = if standing { 1.0 } else { 2.0_f64.sqrt() } / (sectors as f64).sqrt();
            // Re(B e^{i t}) = cos t Re B - sin t Im B, Im(B e^{i t}) = sin t Re B + cos t Im B.
            let cosine = Wave {
                nodal_diameter: h,
                start: eigenvalues.len(),
                real: phases.iter().map(|p| scale * p.re).collect(),
                imaginary: phases.iter().map(|p| -scale * p.im).collect(),
            };
            eigenvalues.extend_from_slice(&nd.eigenvalues);
            added_damping_per_s.extend_from_slice(&nd.added_damping_per_s);
            waves.push(cosine);
            if !standing {
                let sine = Wave {
                    nodal_diameter: h,
                    start: eigenvalues.len(),
                    real: phases.iter().map(|p| scale * p.im).collect(),
                    imaginary: phases.iter().map(|p| scale * p.re).collect(),
                };
                eigenvalues.extend_from_slice(&nd.eigenvalues);
                added_damping_per_s.extend_from_slice(&nd.added_damping_per_s);
                waves.push(sine);
            }
        }
        let mut basis = Self {
            model,
            waves,
            eigenvalues,
            added_damping_per_s,
            contact: Matrix::zeros(0, 0),
            observed: Matrix::zeros(0, 0),
        };
        let model = Arc::clone(&basis.model);
        basis.contact = basis.expand(model.contact_rows(), |h| &model.nodal_diameters[h].contact);
        basis.observed = basis.expand(3, |h| &model.nodal_diameters[h].observed);
        basis
    }

    /// The reduced model.
    #[must_use]
    pub fn model(&self) -> &ReducedModel {
        &self.model
    }

    /// Number of coordinates.
    #[must_use]
    pub fn size(&self) -> usize {
        self.eigenvalues.len()
    }

    /// Diagonal of the tuned contact-free stiffness, (rad/s)^2.
    #[must_use]
    pub fn eigenvalues(&self) -> &[f64] {
        &self.eigenvalues
    }

    /// Damping of the coordinates besides the damping model of the structure, 1/s.
    #[must_use]
    pub fn added_damping_per_s(&self) -> &[f64] {
        &self.added_damping_per_s
    }

    /// Relative motion at the contact rows, sector after sector, `N n_rows x size`.
    #[must_use]
    pub fn contact(&self) -> &Matrix<f64> {
        &self.contact
    }

    /// Displacement r, theta, z of the observed node of each blade, `3 N x size`.
    #[must_use]
    pub fn observed(&self) -> &Matrix<f64> {
        &self.observed
    }

    /// Coordinates of the force `f e^{i EO n alpha}`, length `size`.
    #[must_use]
    pub fn force(&self, engine_order: u32) -> Vec<Complex64> {
        let sectors = self.model.sectors;
        let excited = nodal_diameter_of(1, engine_order, sectors).index;
        let factor = self.model.force_factor(engine_order);
        let mut force = vec![Complex64::default(); self.size()];
        for wave in self
            .waves
            .iter()
            .filter(|wave| wave.nodal_diameter == excited)
        {
            let nd = &self.model.nodal_diameters[excited];
            for mode in 0..nd.eigenvalues.len() {
                // sum_n (real_n Re B + imaginary_n Im B)^T f e^{i EO n alpha}, with
                // (Re B)^T f = (B^H f + B^T f)/2 and (Im B)^T f = (B^T f - B^H f)/(2 i).
                let (adjoint, plain) = (nd.force[(mode, 0)], nd.conjugate_force[(mode, 0)]);
                let real_part = (adjoint + plain) * 0.5;
                let imaginary_part = (plain - adjoint) * Complex64::new(0.0, -0.5);
                let sum: Complex64 = (0..sectors)
                    .map(|n| {
                        let turn = phase(engine_order as usize % sectors, n, sectors);
                        (real_part * wave.real[n] + imaginary_part * wave.imaginary[n]) * turn
                    })
                    .sum();
                force[wave.start + mode] = sum * factor;
            }
        }
        force
    }

    /// Coordinates of the wave `B_h x e^{i h n alpha}` of a nodal diameter in sector n (the conjugate
    /// one: `conj(B_h) x e^{-i h n alpha}`), complex amplitudes, length `size`.
    #[must_use]
    pub fn travelling_wave(
        &self,
        nodal_diameter: NodalDiameter,
        amplitudes: &[Complex64],
    ) -> Vec<Complex64> {
        // B e^{i t} = Re(B e^{i t}) + i Im(B e^{i t}), each a coordinate times sqrt(N/2).
        let sectors = self.model.sectors as f64;
        let (cosine, sine) = if self.model.is_standing(nodal_diameter.index) {
            (sectors.sqrt(), Complex64::default())
        } else {
            let scale = (0.5 * sectors).sqrt();
            let sign = if nodal_diameter.conjugate { -1.0 } else { 1.0 };
            (scale, Complex64::new(0.0, sign * scale))
        };
        let mut coordinates = vec![Complex64::default(); self.size()];
        let waves = self
            .waves
            .iter()
            .filter(|wave| wave.nodal_diameter == nodal_diameter.index);
        for (wave, factor) in waves.zip([Complex64::from(cosine), sine]) {
            for (mode, amplitude) in amplitudes.iter().enumerate() {
                coordinates[wave.start + mode] = factor * amplitude;
            }
        }
        coordinates
    }

    /// `sum_n delta_n B_n^T K_blade B_n` in the wheel's coordinates, `size x size`: the exact
    /// projection of a deviation of each blade's stiffness.
    #[must_use]
    pub fn blade_stiffness_change(&self, deviations: &[f64]) -> Matrix<f64> {
        let mut change = Matrix::zeros(self.size(), self.size());
        let gram = self.model.blade_energy.gram();
        for left in &self.waves {
            let (row, rows) = self.gram_place(left);
            for right in &self.waves {
                if right.start > left.start {
                    continue;
                }
                let (column, columns) = self.gram_place(right);
                let weight = |a: &[f64], b: &[f64]| -> f64 {
                    deviations
                        .iter()
                        .zip(a.iter().zip(b))
                        .map(|(delta, (a, b))| delta * a * b)
                        .sum()
                };
                let real_real = weight(&left.real, &right.real);
                let real_imaginary = weight(&left.real, &right.imaginary);
                let imaginary_real = weight(&left.imaginary, &right.real);
                let imaginary_imaginary = weight(&left.imaginary, &right.imaginary);
                for j in 0..columns {
                    for i in 0..rows {
                        let sum = real_real * gram[(row + i, column + j)]
                            + real_imaginary * gram[(row + i, column + columns + j)]
                            + imaginary_real * gram[(row + rows + i, column + j)]
                            + imaginary_imaginary * gram[(row + rows + i, column + columns + j)];
                        change[(left.start + i, right.start + j)] = sum;
                        change[(right.start + j, left.start + i)] = sum;
                    }
                }
            }
        }
        change
    }

    /// `sum_n q_n^T diag_r(delta_{n,r} lambda_r) q_n`: classical component mode mistuning through
    /// the cantilever modes of the model; `deviation(n, r)` is relative in eigenvalue.
    ///
    /// Returns none if the model was reduced without cantilever modes.
    #[must_use]
    pub fn cantilever_stiffness_change(
        &self,
        deviation: impl Fn(usize, usize) -> f64,
    ) -> Option<Matrix<f64>> {
        let cantilever = self.model.cantilever.as_ref()?;
        let count = cantilever.eigenvalues.len();
        let rows = self.expand(count, |h| &cantilever.participation[h]);
        let weighted = Matrix::from_fn(rows.rows(), rows.columns(), |i, j| {
            let (n, r) = (i / count, i % count);
            deviation(n, r) * cantilever.eigenvalues[r] * rows[(i, j)]
        });
        Some(rows.adjoint_times(&weighted))
    }

    /// Rows of every sector in the wheel's coordinates from complex rows per nodal diameter.
    fn expand<'b>(&self, rows: usize, of: impl Fn(usize) -> &'b Matrix<Complex64>) -> Matrix<f64> {
        let mut wheel = Matrix::zeros(self.model.sectors * rows, self.size());
        for wave in &self.waves {
            let source = of(wave.nodal_diameter);
            for mode in 0..source.columns() {
                for n in 0..self.model.sectors {
                    for row in 0..rows {
                        let entry = source[(row, mode)];
                        wheel[(n * rows + row, wave.start + mode)] =
                            wave.real[n] * entry.re + wave.imaginary[n] * entry.im;
                    }
                }
            }
        }
        wheel
    }

    /// First row of a wave's nodal diameter in the blade Gram matrix, and its number of modes.
    fn gram_place(&self, wave: &Wave) -> (usize, usize) {
        let sizes = self
            .model
            .nodal_diameters
            .iter()
            .map(|nd| nd.eigenvalues.len());
        let start = sizes.clone().take(wave.nodal_diameter).sum::<usize>();
        let size = self.model.nodal_diameters[wave.nodal_diameter]
            .eigenvalues
            .len();
        (2 * start, size)
    }
}
