//! Newton's method on the condensed equation `r(d) = d - d_0 + Y g(d) = 0` at one frequency.

use super::contact::{ContactForces, PairDerivative};
use super::receptance::{Forced, Receptance};
use super::structure::FullStructure;
use crate::linalg::{Complex64, LuWorkspace};
use crate::response::harmonic_balance::{ContactShares, Status};

/// Largest number of Newton steps.
const ITERATIONS: u64 = 60;
/// Largest number of halvings of a step.
const HALVINGS: i32 = 9;
/// A Jacobian is kept while a step with it is at most so long, relative to the step before.
const KEPT: f64 = 0.1;

/// One harmonic at one frequency.
pub(super) struct CondensedHarmonic<'a> {
    pub(super) harmonic: u32,
    pub(super) structure: &'a FullStructure,
    pub(super) receptance: Receptance,
    /// Response to the excitation with stuck springs; none but for harmonic 1.
    pub(super) forced: Option<Forced>,
}

/// The equation at one frequency.
pub(super) struct CondensedSystem<'a> {
    pub(super) harmonics: Vec<CondensedHarmonic<'a>>,
    pub(super) force_norm: f64,
    pub(super) rows: usize,
}

/// A solution, or how the attempt ended.
pub(super) struct NewtonSolution {
    pub(super) status: Status,
    /// Relative displacement, a vector over the contact, m.
    pub(super) displacement: Vec<f64>,
    /// `g(d)`, a vector over the contact, N.
    pub(super) force: Vec<f64>,
    /// Residual force relative to the excitation.
    pub(super) residual: f64,
    pub(super) shares: ContactShares,
    pub(super) iterations: u64,
}

impl CondensedSystem<'_> {
    /// Length of a vector over the contact.
    pub(super) fn unknowns(&self) -> usize {
        let coefficients: usize = self.harmonics.iter().map(|h| parts(h.harmonic)).sum();
        coefficients * self.rows
    }

    /// `d_0`: the displacement with stuck springs.
    pub(super) fn stuck(&self) -> Vec<f64> {
        let mut stuck = vec![0.0; self.unknowns()];
        for (start, harmonic) in self.places() {
            if let Some(forced) = &harmonic.forced {
                store(&forced.contact, harmonic.harmonic, &mut stuck[start..]);
            }
        }
        stuck
    }

    /// First entry of each harmonic in a vector over the contact.
    pub(super) fn places(&self) -> impl Iterator<Item = (usize, &CondensedHarmonic<'_>)> {
        let mut next = 0;
        self.harmonics.iter().map(move |harmonic| {
            let start = next;
            next += parts(harmonic.harmonic) * self.rows;
            (start, harmonic)
        })
    }

    /// `Y g`.
    fn compliance_times(&self, force: &[f64]) -> Vec<f64> {
        let mut product = vec![0.0; force.len()];
        for (start, harmonic) in self.places() {
            let force = load(&force[start..], harmonic.harmonic, self.rows);
            let moved = harmonic.receptance.contact.times_vector(&force);
            store(&moved, harmonic.harmonic, &mut product[start..]);
        }
        product
    }

    /// `r(d) = d - d_0 + Y g`.
    fn displacement_residual(
        &self,
        displacement: &[f64],
        stuck: &[f64],
        force: &[f64],
    ) -> Vec<f64> {
        let mut residual = self.compliance_times(force);
        for ((r, d), d_0) in residual.iter_mut().zip(displacement).zip(stuck) {
            *r += d - d_0;
        }
        residual
    }

    /// Residual force, relative to the excitation, of the state `x = Y (f - C^H g(d))` that goes with
    /// `d`: with `C x = d - r`, it is `C^H (g(C x) - g(d))` in the coordinates in which M = I.
    fn force_residual(
        &self,
        contact: &ContactForces,
        displacement: &[f64],
        force: &[f64],
        residual: &[f64],
    ) -> f64 {
        let corrected: Vec<f64> = displacement
            .iter()
            .zip(residual)
            .map(|(d, r)| d - r)
            .collect();
        let mut change = vec![0.0; force.len()];
        contact.evaluate(&corrected, &mut change, None);
        for (change, force) in change.iter_mut().zip(force) {
            *change -= force;
        }
        let square: f64 = self
            .places()
            .map(|(start, harmonic)| {
                let change = load(&change[start..], harmonic.harmonic, self.rows);
                let modal = harmonic.structure.contact.adjoint_times_vector(&change);
                modal.iter().map(Complex64::norm_sqr).sum::<f64>()
            })
            .sum();
        square.sqrt() / self.force_norm
    }

    /// Solves from `start`.
    ///
    /// Steps `s = J^-1 r` are shortened until the next step with the same Jacobian would be shorter
    /// (natural monotonicity, Deuflhard 2004): contact forces switch, so the first steps overshoot.
    pub(super) fn solve(
        &self,
        contact: &ContactForces,
        start: Vec<f64>,
        tolerance: f64,
    ) -> NewtonSolution {
        let stuck = self.stuck();
        let mut derivatives = Vec::new();
        let mut force = vec![0.0; start.len()];
        let shares = contact.evaluate(&start, &mut force, Some(&mut derivatives));
        let mut residual = self.displacement_residual(&start, &stuck, &force);
        let mut now = NewtonSolution {
            status: Status::IterationLimit,
            residual: self.force_residual(contact, &start, &force, &residual),
            displacement: start,
            force,
            shares,
            iterations: 0,
        };
        let ended = |now: NewtonSolution, status| NewtonSolution { status, ..now };
        let mut jacobian: Option<CondensedJacobian> = None;
        loop {
            if !now.residual.is_finite() {
                return ended(now, Status::NonFinite);
            }
            if now.residual <= tolerance {
                // Forces of a pair without a periodic state prove nothing.
                let proven = now.shares.unclosed == 0.0;
                return ended(
                    now,
                    if proven {
                        Status::Ok
                    } else {
                        Status::Stagnated
                    },
                );
            }
            if now.iterations == ITERATIONS {
                return now;
            }
            let kept = jacobian.is_some();
            let renewed = jacobian.take().or_else(|| {
                contact.evaluate(&now.displacement, &mut now.force, Some(&mut derivatives));
                CondensedJacobian::new(self, std::mem::take(&mut derivatives))
            });
            let Some(mut factored) = renewed else {
                return ended(now, Status::SingularJacobian);
            };
            now.iterations += 1;
            let step = factored.solve(self, &residual);
            let length = norm(&step);
            let mut trial_force = vec![0.0; now.force.len()];
            let accepted = (0..=if kept { 0 } else { HALVINGS }).find_map(|halving| {
                let factor = 0.5_f64.powi(halving);
                let trial: Vec<f64> = now
                    .displacement
                    .iter()
                    .zip(&step)
                    .map(|(d, s)| d - factor * s)
                    .collect();
                let shares = contact.evaluate(&trial, &mut trial_force, None);
                let trial_residual = self.displacement_residual(&trial, &stuck, &trial_force);
                let force_left =
                    self.force_residual(contact, &trial, &trial_force, &trial_residual);
                let contraction = norm(&factored.solve(self, &trial_residual)) / length;
                (force_left <= tolerance || contraction <= 1.0 - 0.25 * factor).then_some((
                    trial,
                    trial_residual,
                    shares,
                    force_left,
                    contraction,
                ))
            });
            match accepted {
                Some((displacement, next_residual, shares, force_left, contraction)) => {
                    residual = next_residual;
                    now = NewtonSolution {
                        displacement,
                        force: trial_force,
                        residual: force_left,
                        shares,
                        ..now
                    };
                    jacobian = (contraction <= KEPT).then_some(factored);
                }
                None if kept => {}
                None => return ended(now, Status::Stagnated),
            }
        }
    }
}

/// `I + Y dg/dd`, reduced to the unknowns of the pairs that slip or separate: the columns of all
/// others are those of the identity.
struct CondensedJacobian {
    derivatives: Vec<PairDerivative>,
    /// Places of the reduced unknowns in a vector over the contact.
    active: Vec<usize>,
    factors: LuWorkspace<f64>,
}

impl CondensedJacobian {
    /// None if it is singular.
    fn new(system: &CondensedSystem<'_>, derivatives: Vec<PairDerivative>) -> Option<Self> {
        let active: Vec<usize> = derivatives
            .iter()
            .flat_map(|pair| pair.places.iter().copied())
            .collect();
        let mut factors = LuWorkspace::new(active.len());
        let compliance = system.real_compliance();
        let columns = factors.matrix_mut().chunks_exact_mut(active.len().max(1));
        let of_pairs = derivatives
            .iter()
            .flat_map(|pair| (0..pair.places.len()).map(move |column| (pair, column)));
        let mut moved = vec![0.0; system.unknowns()];
        for ((pair, column), target) in of_pairs.zip(columns) {
            moved.fill(0.0);
            for (row, &place) in pair.places.iter().enumerate() {
                let stiffness = pair.stiffness[row * pair.places.len() + column];
                if stiffness != 0.0 {
                    compliance.add_column(place, stiffness, &mut moved);
                }
            }
            moved[pair.places[column]] += 1.0;
            for (entry, &place) in target.iter_mut().zip(&active) {
                *entry = moved[place];
            }
        }
        (active.is_empty() || factors.factor()).then_some(Self {
            derivatives,
            active,
            factors,
        })
    }

    /// `J^-1 r`: the reduced system for the active unknowns `s_a`, then `s = r - Y (dg/dd) s_a`.
    fn solve(&mut self, system: &CondensedSystem<'_>, residual: &[f64]) -> Vec<f64> {
        let mut reduced: Vec<f64> = self.active.iter().map(|&place| residual[place]).collect();
        if !reduced.is_empty() {
            self.factors.solve(&mut reduced);
        }
        let mut force = vec![0.0; residual.len()];
        let mut start = 0;
        for pair in &self.derivatives {
            let size = pair.places.len();
            let pair_shares = &reduced[start..start + size];
            for (row, &place) in pair.places.iter().enumerate() {
                let stiffness = &pair.stiffness[row * size..(row + 1) * size];
                force[place] += stiffness
                    .iter()
                    .zip(pair_shares)
                    .map(|(k, s)| k * s)
                    .sum::<f64>();
            }
            start += size;
        }
        let mut step = system.compliance_times(&force);
        for (step, residual) in step.iter_mut().zip(residual) {
            *step = residual - *step;
        }
        step
    }
}

/// Y as a real matrix over vectors over the contact, column by column.
struct RealCompliance<'a> {
    system: &'a CondensedSystem<'a>,
    /// For each coefficient: first entry of its harmonic, the harmonic, whether it is an imaginary part.
    coefficients: Vec<(usize, &'a CondensedHarmonic<'a>, bool)>,
}

impl CondensedSystem<'_> {
    fn real_compliance(&self) -> RealCompliance<'_> {
        let coefficients = self
            .places()
            .flat_map(|(start, harmonic)| {
                (0..parts(harmonic.harmonic)).map(move |part| (start, harmonic, part == 1))
            })
            .collect();
        RealCompliance {
            system: self,
            coefficients,
        }
    }
}

impl RealCompliance<'_> {
    /// `target += factor Y e_place`.
    fn add_column(&self, place: usize, factor: f64, target: &mut [f64]) {
        let rows = self.system.rows;
        let (start, harmonic, imaginary) = self.coefficients[place / rows];
        let column = harmonic.receptance.contact.column(place % rows);
        let turn = if imaginary {
            Complex64::new(0.0, factor)
        } else {
            Complex64::new(factor, 0.0)
        };
        let target = &mut target[start..start + parts(harmonic.harmonic) * rows];
        let (real, imaginary) = target.split_at_mut(rows);
        for (sum, y) in real.iter_mut().zip(column) {
            *sum += (turn * y).re;
        }
        for (sum, y) in imaginary.iter_mut().zip(column) {
            *sum += (turn * y).im;
        }
    }
}

/// Real coefficients of a harmonic.
pub(super) fn parts(harmonic: u32) -> usize {
    if harmonic == 0 { 1 } else { 2 }
}

/// Complex amplitudes of one harmonic from the head of its part of a vector over the contact.
pub(super) fn load(values: &[f64], harmonic: u32, rows: usize) -> Vec<Complex64> {
    (0..rows)
        .map(|row| {
            let imaginary = if harmonic == 0 {
                0.0
            } else {
                values[rows + row]
            };
            Complex64::new(values[row], imaginary)
        })
        .collect()
}

/// The inverse of [`load`]; harmonic 0 is real.
fn store(amplitudes: &[Complex64], harmonic: u32, values: &mut [f64]) {
    let rows = amplitudes.len();
    for (row, amplitude) in amplitudes.iter().enumerate() {
        values[row] = amplitude.re;
        if harmonic > 0 {
            values[rows + row] = amplitude.im;
        }
    }
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}
