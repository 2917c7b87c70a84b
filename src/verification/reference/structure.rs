//! Contact-free structure of the whole wheel in travelling-wave coordinates, mistuning included.
//!
//! Sector n moves as `u_n = (1/sqrt N) sum_h B_h q_h e^{i h n alpha}`, h = 0..N-1, with `B_h` the tuned
//! contact-free modes of wave h (those of `N - h` are the complex conjugates). In these coordinates
//!
//! ```text
//! M = I,   K_{h h'} = delta_{h h'} diag(lambda_h) + dhat_{h-h'} B_h^H K_blade B_h'
//! dhat_m = (1/N) sum_n delta_n e^{-i m n alpha}
//! ```
//!
//! A travelling wave of the tuned wheel is one block, and one sector stands for all.

use crate::linalg::{Complex64, Matrix};
use crate::model::ReducedModel;
use crate::model::cyclic::{NodalDiameter, nodal_diameter_of, phase};
use crate::response::harmonic_balance::Damping;
use crate::response::mistuning::{Deviations, Pattern, Projection};

/// Stiffness, damping, contact and observed rows of a wheel, or of one travelling wave.
#[derive(Debug, Clone)]
pub struct FullStructure {
    /// K with its mistuning, Hermitian, `n x n`, (rad/s)^2.
    pub(super) stiffness: Matrix<Complex64>,
    /// Structural loss factor on K.
    pub(super) loss_factor: f64,
    /// Viscous damping of the tuned structure, diagonal in these coordinates, 1/s, length n.
    pub(super) viscous: Vec<f64>,
    /// Relative motion C at the contact rows, sector after sector, `n_rows x n`.
    pub(super) contact: Matrix<Complex64>,
    /// Displacement r, theta, z of the observed node, blade after blade, `3 n_blades x n`.
    pub(super) observed: Matrix<Complex64>,
}

impl FullStructure {
    /// One travelling wave of the tuned wheel.
    #[must_use]
    pub fn tuned_wave(
        model: &ReducedModel,
        nodal_diameter: NodalDiameter,
        damping: Damping,
    ) -> Self {
        let wave = model.wave(nodal_diameter);
        let n = wave.eigenvalues.len();
        let stiffness = Matrix::from_fn(n, n, |i, j| {
            Complex64::new(if i == j { wave.eigenvalues[i] } else { 0.0 }, 0.0)
        });
        Self {
            stiffness,
            loss_factor: loss_factor(damping),
            viscous: viscous(damping, &wave.eigenvalues, &wave.added_damping_per_s),
            contact: wave.contact,
            observed: wave.observed,
        }
    }

    /// The whole wheel with `pattern` applied; none if a blade would not keep a positive stiffness
    /// or the model lacks the cantilever modes that the projection goes through.
    #[must_use]
    pub fn mistuned_wheel(
        model: &ReducedModel,
        pattern: &Pattern,
        projection: Projection,
        damping: Damping,
    ) -> Option<Self> {
        let possible = |&(_, _, deviation): &(u32, Option<u32>, f64)| {
            deviation > -1.0 && deviation.is_finite()
        };
        if !pattern.entries().iter().all(possible) {
            return None;
        }
        let waves = Waves::new(model);
        let mut stiffness = Matrix::<Complex64>::zeros(waves.size, waves.size);
        for (i, lambda) in waves.eigenvalues.iter().enumerate() {
            stiffness[(i, i)].re = *lambda;
        }
        waves.add_mistuning(pattern, projection, &mut stiffness)?;
        Some(Self {
            stiffness,
            loss_factor: loss_factor(damping),
            viscous: viscous(damping, &waves.eigenvalues, &waves.added_damping_per_s),
            contact: waves.rows(|nd| &nd.contact),
            observed: waves.rows(|nd| &nd.observed),
        })
    }

    /// Coordinates n.
    #[must_use]
    pub fn size(&self) -> usize {
        self.stiffness.rows()
    }

    /// Number of contact rows over all sectors.
    #[must_use]
    pub fn contact_rows(&self) -> usize {
        self.contact.rows()
    }

    /// Number of blades that the rows stand for.
    #[must_use]
    pub fn blades(&self) -> usize {
        self.observed.rows() / 3
    }
}

/// Force `f e^{i EO n alpha}` scaled by `amplitude_n` in the coordinates of the wheel
/// (`mistuned`), or of the one travelling wave that it excites.
pub(super) fn force(
    model: &ReducedModel,
    engine_order: u32,
    amplitude_n: f64,
    mistuned: bool,
) -> Vec<Complex64> {
    let excited = nodal_diameter_of(1, engine_order, model.sectors);
    let amplitude_n = amplitude_n * model.force_factor(engine_order);
    let wave = model.wave(excited).force;
    let of_wave = |scale: f64| wave.column(0).iter().map(move |f| f * scale);
    if !mistuned {
        return of_wave(amplitude_n).collect();
    }
    // (1/sqrt N) sum_n B_h^H f e^{i (EO - h) n alpha} = sqrt N B_h^H f for h = EO mod N, else 0.
    let scale = amplitude_n * (model.sectors as f64).sqrt();
    let waves = Waves::new(model);
    let mut force = vec![Complex64::default(); waves.size];
    let start = waves.start[engine_order as usize % model.sectors];
    for (entry, f) in force[start..].iter_mut().zip(of_wave(scale)) {
        *entry = f;
    }
    force
}

fn loss_factor(damping: Damping) -> f64 {
    match damping {
        Damping::StructuralLossFactor(eta) => eta,
        Damping::ModalRatio(_) | Damping::Rayleigh { .. } => 0.0,
    }
}

/// Viscous damping of tuned modes with these eigenvalues, and `added` to it, 1/s.
fn viscous(damping: Damping, eigenvalues: &[f64], added: &[f64]) -> Vec<f64> {
    let of_mode = |lambda: f64| match damping {
        Damping::StructuralLossFactor(_) => 0.0,
        Damping::ModalRatio(zeta) => 2.0 * zeta * lambda.max(0.0).sqrt(),
        Damping::Rayleigh {
            mass_per_s,
            stiffness_s,
        } => mass_per_s + stiffness_s * lambda,
    };
    let modes = eigenvalues.iter().zip(added);
    modes
        .map(|(&lambda, added)| of_mode(lambda) + added)
        .collect()
}

/// The coordinates of a wheel, wave after wave, h = 0..N-1.
struct Waves<'a> {
    model: &'a ReducedModel,
    /// First coordinate of each wave.
    start: Vec<usize>,
    eigenvalues: Vec<f64>,
    added_damping_per_s: Vec<f64>,
    size: usize,
}

impl<'a> Waves<'a> {
    fn new(model: &'a ReducedModel) -> Self {
        let mut start = Vec::new();
        let mut eigenvalues = Vec::new();
        let mut added_damping_per_s = Vec::new();
        for h in 0..model.sectors {
            start.push(eigenvalues.len());
            let index = h.min(model.sectors - h);
            let diameter = &model.nodal_diameters[index];
            eigenvalues.extend_from_slice(&diameter.eigenvalues);
            added_damping_per_s.extend_from_slice(&diameter.added_damping_per_s);
        }
        Self {
            size: eigenvalues.len(),
            model,
            start,
            eigenvalues,
            added_damping_per_s,
        }
    }

    /// Index of the stored nodal diameter of wave h, and whether the wave is its conjugate.
    fn stored(&self, h: usize) -> (usize, bool) {
        let mirrored = self.model.sectors - h;
        (h.min(mirrored), mirrored < h)
    }

    /// Rows of every sector from rows of one sector per nodal diameter.
    fn rows<'b>(
        &self,
        of: impl Fn(&'b crate::model::ReducedNodalDiameter) -> &'b Matrix<Complex64>,
    ) -> Matrix<Complex64>
    where
        'a: 'b,
    {
        let sectors = self.model.sectors;
        let model: &'b ReducedModel = self.model;
        let per_sector = of(&model.nodal_diameters[0]).rows();
        let scale = 1.0 / (sectors as f64).sqrt();
        let mut rows = Matrix::zeros(sectors * per_sector, self.size);
        for h in 0..sectors {
            let (index, conjugate) = self.stored(h);
            let source = of(&model.nodal_diameters[index]);
            for mode in 0..source.columns() {
                for n in 0..sectors {
                    let turn = phase(h, n, sectors) * scale;
                    for row in 0..per_sector {
                        let entry = source[(row, mode)];
                        let entry = if conjugate { entry.conj() } else { entry };
                        rows[(n * per_sector + row, self.start[h] + mode)] = entry * turn;
                    }
                }
            }
        }
        rows
    }

    /// Adds the stiffness that the pattern changes; none if the model lacks cantilever modes.
    fn add_mistuning(
        &self,
        pattern: &Pattern,
        projection: Projection,
        stiffness: &mut Matrix<Complex64>,
    ) -> Option<()> {
        match (&pattern.deviations, projection) {
            (Deviations::PerBlade(values), Projection::Exact) => {
                let spectrum = self.spectrum(|blade| values[blade]);
                self.add_blocks(stiffness, |h, other| {
                    let weight = spectrum[(h + self.model.sectors - other) % self.model.sectors];
                    scaled(self.blade_block(h, other), |_| weight)
                });
            }
            (Deviations::PerBlade(values), Projection::CantileverModes) => {
                self.add_cantilever(stiffness, |blade, _| values[blade])?;
            }
            (Deviations::PerMode { modes, values }, _) => {
                self.add_cantilever(stiffness, |blade, mode| {
                    let place = modes.iter().position(|&number| number as usize == mode);
                    place.map_or(0.0, |place| values[blade * modes.len() + place])
                })?;
            }
        }
        Some(())
    }

    /// `dhat_m`, m = 0..N-1.
    fn spectrum(&self, deviation: impl Fn(usize) -> f64) -> Vec<Complex64> {
        let sectors = self.model.sectors;
        (0..sectors)
            .map(|m| {
                (0..sectors)
                    .map(|n| phase(m, n, sectors).conj() * deviation(n))
                    .sum::<Complex64>()
                    / sectors as f64
            })
            .collect()
    }

    fn add_blocks(
        &self,
        stiffness: &mut Matrix<Complex64>,
        block: impl Fn(usize, usize) -> Matrix<Complex64>,
    ) {
        for h in 0..self.model.sectors {
            for other in 0..self.model.sectors {
                let part = block(h, other);
                for j in 0..part.columns() {
                    for i in 0..part.rows() {
                        stiffness[(self.start[h] + i, self.start[other] + j)] += part[(i, j)];
                    }
                }
            }
        }
    }

    /// `B_h^H K_blade B_h'` from the Gram matrix over `[Re B_0, Im B_0, Re B_1, ...]`.
    fn blade_block(&self, h: usize, other: usize) -> Matrix<Complex64> {
        let place = |h: usize| {
            let (index, conjugate) = self.stored(h);
            let sizes = self.model.nodal_diameters.iter();
            let before: usize = sizes.take(index).map(|nd| nd.eigenvalues.len()).sum();
            let size = self.model.nodal_diameters[index].eigenvalues.len();
            (2 * before, size, if conjugate { -1.0 } else { 1.0 })
        };
        let ((row, rows, left), (column, columns, right)) = (place(h), place(other));
        let gram = self.model.blade_energy.gram();
        // (R - i s I)^T K_blade (R' + i s' I')
        Matrix::from_fn(rows, columns, |i, j| {
            let real_real = gram[(row + i, column + j)];
            let real_imaginary = gram[(row + i, column + columns + j)];
            let imaginary_real = gram[(row + rows + i, column + j)];
            let imaginary_imaginary = gram[(row + rows + i, column + columns + j)];
            Complex64::new(
                real_real + left * right * imaginary_imaginary,
                right * real_imaginary - left * imaginary_real,
            )
        })
    }

    /// `q_h^H diag_r(dhat_{h-h',r} lambda_r) q_h'`: component mode mistuning.
    fn add_cantilever(
        &self,
        stiffness: &mut Matrix<Complex64>,
        deviation: impl Fn(usize, usize) -> f64,
    ) -> Option<()> {
        let cantilever = self.model.cantilever.as_ref()?;
        let spectra: Vec<Vec<Complex64>> = (0..cantilever.eigenvalues.len())
            .map(|mode| self.spectrum(|blade| deviation(blade, mode)))
            .collect();
        let participation = |h: usize| {
            let (index, conjugate) = self.stored(h);
            let stored = &cantilever.participation[index];
            if conjugate {
                stored.conjugate()
            } else {
                stored.clone()
            }
        };
        self.add_blocks(stiffness, |h, other| {
            let step = (h + self.model.sectors - other) % self.model.sectors;
            let weighted = scaled(participation(other), |mode| {
                spectra[mode][step] * cantilever.eigenvalues[mode]
            });
            participation(h).adjoint_times(&weighted)
        });
        Some(())
    }
}

/// Row i of a matrix times `factor(i)`.
fn scaled(mut matrix: Matrix<Complex64>, factor: impl Fn(usize) -> Complex64) -> Matrix<Complex64> {
    let rows = matrix.rows().max(1);
    for (at, entry) in matrix.as_mut_slice().iter_mut().enumerate() {
        *entry *= factor(at % rows);
    }
    matrix
}
