//! Few shapes of a blade that carry the strain of all its motions, and how far the wheel's modes take part in them.
//!
//! A deviation `delta_n` of the stiffness of blade n acts by `delta_n K_blade x_n`. With shapes that are orthonormal in the
//! strain energy, `V^T K_blade V = I`, and the strain coordinates `z_n = V^T K_blade x_n` it acts by `delta_n V z_n`.
//! The shapes are a proper orthogonal decomposition (Sirovich 1987) of the strain in the motions that forces of the contact,
//! the excitation and the blades themselves cause; every kind counts as much as forces of that kind are.

use crate::linalg::{Complex64, Matrix, hermitian_eigen};
use crate::model::ReducedModel;

use super::tuned_diameter::TunedDiameter;
use super::wave_force::WaveForce;

/// Strain coordinates kept at most.
const COORDINATES: usize = 192;
/// Share of the largest strain energy below which what is left of the others is dropped.
const DROPPED: f64 = 1e-13;
/// Rounds in which the forces of the shapes found are taken in.
const ROUNDS: usize = 4;
/// Shapes whose forces are taken in at least: of up to so many, fewer are the first ones of more.
pub(super) const SHAPES_OF_ROUNDS: usize = 8;

/// What the modes of each nodal diameter, 0..=N/2, do to some coordinates of the blade's strain, `r x n`.
pub(super) type Participation = Vec<Matrix<Complex64>>;

/// Strain coordinates of the blade on the motions that count at the angular frequencies `bands`, one band a harmonic: a pivoted
/// Cholesky factorisation of the strain energy (Harbrecht, Peters & Schneider 2012, Appl. Numer. Math. 62(4)).
///
/// A mode counts as much as it answers forces of the contact in the band where it answers most.
pub(super) fn strain_coordinates(
    model: &ReducedModel,
    diameters: &[TunedDiameter],
    bands: &[(f64, f64)],
) -> Participation {
    let energy = &model.blade_energy;
    let energies: Vec<f64> = energy.diagonal().iter().map(|of| of.max(0.0)).collect();
    let sizes: Vec<usize> = diameters.iter().map(TunedDiameter::size).collect();
    let mut weights = vec![0.0_f64; energies.len()];
    for &band in bands {
        let mut answers_of_band = Vec::with_capacity(energies.len());
        for diameter in diameters {
            let answers = diameter.free_answers(band);
            answers_of_band.extend_from_slice(&answers);
            answers_of_band.extend_from_slice(&answers);
        }
        let strain = |(at, answer): (usize, &f64)| answer * energies[at].sqrt();
        let largest = answers_of_band
            .iter()
            .enumerate()
            .map(strain)
            .fold(0.0, f64::max);
        for (weight, answer) in weights.iter_mut().zip(answers_of_band) {
            *weight = weight.max(answer / largest);
        }
    }
    let weighted = weights.iter().zip(&energies);
    let mut left: Vec<f64> = weighted.map(|(weight, of)| weight.powi(2) * of).collect();
    let whole = left.iter().copied().fold(0.0, f64::max);
    // Rows of the factor over the unscaled motions.
    let mut coordinates: Vec<Vec<f64>> = Vec::new();
    while coordinates.len() < COORDINATES {
        let (pivot, &largest) =
            left.iter().enumerate().fold(
                (0, &0.0),
                |best, entry| if entry.1 > best.1 { entry } else { best },
            );
        if largest <= DROPPED * whole {
            break;
        }
        let mut row = energy.column(pivot);
        for coordinate in &coordinates {
            let share = coordinate[pivot];
            row.iter_mut()
                .zip(coordinate)
                .for_each(|(a, b)| *a -= share * b);
        }
        let energy_left = row[pivot];
        left[pivot] = 0.0;
        if energy_left <= 0.0 {
            continue;
        }
        let scale = 1.0 / energy_left.sqrt();
        for a in &mut row {
            *a *= scale;
        }
        for ((left, weight), a) in left.iter_mut().zip(&weights).zip(&row) {
            *left = (*left - (weight * a).powi(2)).max(0.0);
        }
        left[pivot] = 0.0;
        coordinates.push(row);
    }
    let mut first = 0;
    let participation = sizes.iter().map(|&size| {
        let wave_participation = Matrix::from_fn(coordinates.len(), size, |i, mode| {
            let row = &coordinates[i];
            Complex64::new(row[first + mode], row[first + size + mode])
        });
        first += 2 * size;
        wave_participation
    });
    participation.collect()
}

/// `V^T` times the strain coordinates: participation of the modes in the shapes V, `r x q`.
pub(super) fn in_shapes(strain: &Participation, shapes: &Matrix<f64>) -> Participation {
    let transposed = shapes.to_complex().adjoint();
    strain
        .iter()
        .map(|participation| transposed.times(participation))
        .collect()
}

/// Participation in the cantilever modes, `K_blade`-orthonormal; none where the model has none.
pub(super) fn in_cantilever_modes(model: &ReducedModel) -> Option<Participation> {
    let cantilever = model.cantilever.as_ref()?;
    let scaled = |participation: &Matrix<Complex64>| {
        Matrix::from_fn(participation.rows(), participation.columns(), |i, j| {
            participation[(i, j)] * cantilever.eigenvalues[i].sqrt()
        })
    };
    Some(cantilever.participation.iter().map(scaled).collect())
}

/// What the shapes of one harmonic are made for.
pub(super) struct ShapesWanted<'a> {
    /// Angular frequencies, rad/s, of the harmonic; 0 alone for harmonic 0.
    pub(super) frequencies: &'a [f64],
    /// Size of the forces at the contact rows, N: their motion under the excitation times their springs.
    pub(super) contact_forces: &'a [f64],
    /// The excitations, for harmonic 1.
    pub(super) excitations: &'a [WaveForce],
    /// Largest deviation of a blade.
    pub(super) deviation: f64,
    /// Number of shapes.
    pub(super) count: usize,
}

/// The shapes V, `r x q` over the strain coordinates, the strongest first.
pub(super) fn blade_shapes(
    diameters: &[TunedDiameter],
    strain: &Participation,
    wanted: &ShapesWanted<'_>,
) -> Option<Matrix<f64>> {
    let count = strain.first()?.rows();
    let contact_rows = diameters.first()?.spring_count();
    let mut motions_of_forces = Snapshots::new(count);
    // Of every nodal diameter and frequency, with the strain and the number of waves that it stands for.
    let mut factored = Vec::new();
    for (h, (diameter, participation)) in diameters.iter().zip(strain).enumerate() {
        let waves = diameter.waves as f64;
        let motions = diameter.motions(participation);
        for &s in wanted.frequencies {
            let (stiffness, receptance) = diameter.receptance(s, &motions, contact_rows)?;
            for (row, force) in wanted.contact_forces.iter().enumerate() {
                let motion = &receptance.column(row)[contact_rows..contact_rows + count];
                motions_of_forces.add(waves * force.powi(2), motion);
            }
            let excitations = wanted.excitations.iter();
            for force in excitations.filter(|force| force.diameter.index == h) {
                let motion =
                    diameter.response(s, participation, &force.modal, force.diameter.conjugate)?;
                motions_of_forces.add(1.0, &motion);
            }
            factored.push((stiffness, participation, waves));
        }
    }
    let kept = |count: usize, (energies, vectors): (Vec<f64>, Matrix<f64>)| {
        let kept = count.min(energies.len());
        let from = energies.len() - kept;
        let shapes = Matrix::from_fn(vectors.rows(), kept, |i, j| {
            vectors[(i, from + kept - 1 - j)]
        });
        let energies: Vec<f64> = energies[from..].iter().rev().copied().collect();
        (energies, shapes)
    };
    let frequencies = wanted.frequencies.len() as f64;
    let covariance = motions_of_forces.covariance();
    let mut decomposed = hermitian_eigen(&covariance).ok()?;
    for _ in 0..ROUNDS {
        let (energies, shapes) = kept(SHAPES_OF_ROUNDS.max(wanted.count), decomposed);
        let mut motions_of_shapes = Snapshots::new(count);
        let complex = shapes.to_complex();
        for (stiffness, participation, waves) in &factored {
            let strain_forces = participation.adjoint_times(&complex);
            let motions = participation.times(&stiffness.solve(strain_forces));
            for (shape, energy) in energies.iter().enumerate() {
                let force = wanted.deviation.powi(2) * energy.max(0.0) / frequencies;
                motions_of_shapes.add(waves * force, motions.column(shape));
            }
        }
        let mut both = motions_of_shapes.covariance();
        let entries = both.as_mut_slice().iter_mut();
        entries
            .zip(covariance.as_slice())
            .for_each(|(sum, entry)| *sum += entry);
        decomposed = hermitian_eigen(&both).ok()?;
    }
    Some(kept(wanted.count, decomposed).1)
}

/// Strain motions, each with a weight, side by side.
struct Snapshots {
    rows: usize,
    /// Real and imaginary parts times the root of the weight, column after column.
    scaled: Vec<f64>,
}

impl Snapshots {
    fn new(rows: usize) -> Self {
        Self {
            rows,
            scaled: Vec::new(),
        }
    }

    fn add(&mut self, weight: f64, motion: &[Complex64]) {
        let root = weight.sqrt();
        self.scaled.extend(motion.iter().map(|z| root * z.re));
        self.scaled.extend(motion.iter().map(|z| root * z.im));
    }

    /// Sum of `weight (Re x Re x^T + Im x Im x^T)` over the motions x.
    fn covariance(self) -> Matrix<f64> {
        let mut all = Matrix::zeros(self.rows, self.scaled.len() / self.rows.max(1));
        all.as_mut_slice().copy_from_slice(&self.scaled);
        all.times_adjoint(&all)
    }
}
