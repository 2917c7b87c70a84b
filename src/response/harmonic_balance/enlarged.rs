//! What a solution would become with the harmonics outside of its set, sampled more finely.
//!
//! With s the harmonics of the set, o those outside and the residual `R` of the enlarged system,
//!
//! ```text
//! R_s(x_s, x_o) = 0,    R_o(x_s, x_o) = 0,    from (x_s, 0)
//! P = [J_ss, 0; 0, diag_k J_kk]
//! ```
//!
//! is solved by the fixed-point iteration `x <- x - P^-1 R(x)` with Anderson's acceleration (Anderson
//! 1965; Walker & Ni 2011, SIAM J. Numer. Anal. 49(4)). P holds the derivative of the contact
//! forces, so a resonance of slipping contact in harmonic k is in it; what it leaves out, the
//! coupling between harmonics, comes in through the residual. The enlarged Jacobian is never formed:
//! its cost would be that of a solution with the enlarged set.

use std::sync::Arc;

use super::{
    HarmonicBlock, HarmonicSystem, HarmonicTransform, NewtonWorkspace, PairJacobian,
    SystemWorkspace, TransformError,
};
use super::transform::dot;
use crate::linalg::LuWorkspace;

/// Highest harmonic that is looked at.
pub const HIGHEST_HARMONIC: u32 = 15;
/// Samples per period of the derivatives in P.
const LINEARISED_SAMPLES: usize = 128;
/// Evaluations of the enlarged residual.
const EVALUATIONS: usize = 12;
/// Earlier iterates that the acceleration combines.
const DEPTH: usize = 6;
/// Share of the change of the set's unknowns by which the last step may still change them.
const SETTLED: f64 = 0.03;
/// Change of the set's unknowns, relative to themselves, that is not worth an iteration.
const NEGLIGIBLE: f64 = 2e-5;

/// Transforms of an enlarged set; made once per study.
#[derive(Debug, Clone)]
pub struct EnlargedSet {
    harmonics: Vec<u32>,
    fine: Arc<HarmonicTransform>,
    linearised: Arc<HarmonicTransform>,
}

impl EnlargedSet {
    /// The harmonics 0 to 15 and those of `set`, with `samples` per period.
    ///
    /// # Errors
    /// If the harmonics cannot be told apart with the samples asked for.
    pub fn new(set: &[u32], samples: usize) -> Result<Self, TransformError> {
        let mut harmonics: Vec<u32> = (0..=HIGHEST_HARMONIC).chain(set.iter().copied()).collect();
        harmonics.sort_unstable();
        harmonics.dedup();
        let numbers: Vec<usize> = harmonics.iter().map(|&k| k as usize).collect();
        let highest = numbers.last().copied().unwrap_or(1);
        Ok(Self {
            fine: Arc::new(HarmonicTransform::new(&numbers, samples)?),
            linearised: Arc::new(HarmonicTransform::new(
                &numbers,
                LINEARISED_SAMPLES.max(4 * highest),
            )?),
            harmonics,
        })
    }

    /// The harmonics, ascending.
    #[must_use]
    pub fn harmonics(&self) -> &[u32] {
        &self.harmonics
    }
}

/// A solution corrected.
#[derive(Debug, Clone, PartialEq)]
pub struct Enlarged {
    /// Blocks of the enlarged system, in the order of its unknowns.
    pub harmonics: Vec<u32>,
    /// The solution in the enlarged unknowns, zero outside of the set.
    pub before: Vec<f64>,
    /// After one Newton correction at the finer sampling, in the set alone.
    pub resampled: Vec<f64>,
    /// With the harmonics outside.
    pub after: Vec<f64>,
    /// Whether the iteration settled.
    pub settled: bool,
}

/// Corrects the solution `x` of `system` at `omega` towards that of the enlarged set; `blocks` are
/// those of its harmonics. None if a Jacobian is singular or a value not finite.
pub fn enlarge(
    system: &HarmonicSystem,
    workspace: &mut NewtonWorkspace,
    set: &EnlargedSet,
    blocks: &[HarmonicBlock],
    omega: f64,
    x: &[f64],
) -> Option<Enlarged> {
    if !workspace.factor_at(system, omega, x) {
        return None;
    }
    let with = |transform: &Arc<HarmonicTransform>| {
        HarmonicSystem::new(
            blocks.to_vec(),
            system.force().to_vec(),
            system.interface.clone(),
            Arc::clone(transform),
        )
    };
    let fine = with(&set.fine);
    let mut buffers = fine.workspace();
    let places: Vec<Option<usize>> = blocks
        .iter()
        .map(|block| {
            let same = |own: &HarmonicBlock| own.harmonic == block.harmonic;
            system.blocks().iter().position(same)
        })
        .collect();
    let before = embed(system, &fine, &places, x);
    let mut residual = vec![0.0; fine.unknowns()];
    fine.residual(omega, &before, &mut residual, false, &mut buffers);
    let linearised = with(&set.linearised);
    let mut outside = OutsideBlocks::new(&linearised, &places, omega, &before)?;
    let mut precondition = |residual: &[f64]| -> Vec<f64> {
        let mut step = vec![0.0; residual.len()];
        let mut own = vec![0.0; x.len()];
        for (index, place) in places.iter().enumerate() {
            if let Some(place) = *place {
                own[range(system, place)].copy_from_slice(&residual[range(&fine, index)]);
            }
        }
        workspace.solve_linear(&mut own);
        for (index, place) in places.iter().enumerate() {
            if let Some(place) = *place {
                step[range(&fine, index)].copy_from_slice(&own[range(system, place)]);
            }
        }
        outside.solve(&fine, residual, &mut step);
        step.iter_mut().for_each(|step| *step = -*step);
        step
    };
    let in_set = |step: &[f64]| -> f64 {
        let square = |(index, place): (usize, &Option<usize>)| match place {
            Some(_) => step[range(&fine, index)].iter().map(|s| s * s).sum(),
            None => 0.0,
        };
        places.iter().enumerate().map(square).sum::<f64>().sqrt()
    };
    let mut step = precondition(&residual);
    let mut resampled = before.clone();
    for (index, _) in places.iter().enumerate().filter(|(_, p)| p.is_some()) {
        let own = range(&fine, index);
        for (x, s) in resampled[own.clone()].iter_mut().zip(&step[own]) {
            *x += s;
        }
    }
    let scale = in_set(&before);
    let mut acceleration = Anderson::new(DEPTH);
    let mut after = before.clone();
    let mut settled = false;
    for evaluation in 1..=EVALUATIONS {
        let next = acceleration.next(&after, &step);
        let moved: Vec<f64> = next.iter().zip(&after).map(|(a, b)| a - b).collect();
        let change: Vec<f64> = next.iter().zip(&resampled).map(|(a, b)| a - b).collect();
        after = next;
        fine.residual(omega, &after, &mut residual, false, &mut buffers);
        step = precondition(&residual);
        if !step.iter().all(|s| s.is_finite()) {
            return None;
        }
        let last = in_set(&moved).max(in_set(&step));
        settled = evaluation > 1 && last <= f64::max(SETTLED * in_set(&change), NEGLIGIBLE * scale);
        if settled {
            break;
        }
    }
    Some(Enlarged {
        harmonics: set.harmonics.clone(),
        before,
        resampled,
        after,
        settled,
    })
}

fn range(system: &HarmonicSystem, block: usize) -> std::ops::Range<usize> {
    system.start[block]..system.start[block + 1]
}

/// `x` in the enlarged unknowns.
fn embed(
    system: &HarmonicSystem,
    enlarged: &HarmonicSystem,
    places: &[Option<usize>],
    x: &[f64],
) -> Vec<f64> {
    let mut all = vec![0.0; enlarged.unknowns()];
    for (index, place) in places.iter().enumerate() {
        if let Some(place) = *place {
            all[range(enlarged, index)].copy_from_slice(&x[range(system, place)]);
        }
    }
    all
}

/// Factored `J_kk` of every harmonic outside of the set.
struct OutsideBlocks {
    factors: Vec<Option<LuWorkspace<f64>>>,
}

impl OutsideBlocks {
    fn new(
        system: &HarmonicSystem,
        places: &[Option<usize>],
        omega: f64,
        x: &[f64],
    ) -> Option<Self> {
        let mut buffers = system.workspace();
        let mut residual = vec![0.0; system.unknowns()];
        system.residual(omega, x, &mut residual, true, &mut buffers);
        let mut factors = Vec::with_capacity(places.len());
        for (index, place) in places.iter().enumerate() {
            factors.push(match place {
                Some(_) => None,
                None => Some(factored_block(system, index, omega, &buffers)?),
            });
        }
        Some(Self { factors })
    }

    fn solve(&mut self, system: &HarmonicSystem, residual: &[f64], step: &mut [f64]) {
        for (index, factors) in self.factors.iter_mut().enumerate() {
            if let Some(factors) = factors {
                let own = range(system, index);
                step[own.clone()].copy_from_slice(&residual[own.clone()]);
                factors.solve(&mut step[own]);
            }
        }
    }
}

/// The Jacobian of one harmonic by itself, factored; none if it is singular.
fn factored_block(
    system: &HarmonicSystem,
    index: usize,
    omega: f64,
    evaluated: &SystemWorkspace,
) -> Option<LuWorkspace<f64>> {
    let block = system.blocks[index].clone();
    let samples = system.transform.n_samples();
    let transform = HarmonicTransform::new(&[block.harmonic as usize], samples).ok()?;
    let alone = HarmonicSystem::new(
        vec![block],
        Vec::new(),
        system.interface.clone(),
        Arc::new(transform),
    );
    let mut buffers = alone.workspace();
    let first = system.coefficient[index];
    let (all, own) = (
        system.transform.n_coefficients(),
        alone.transform.n_coefficients(),
    );
    buffers.active.copy_from_slice(&evaluated.active);
    for (target, source) in buffers.jacobians.iter_mut().zip(&evaluated.jacobians) {
        restrict(source, all, first, own, target);
    }
    let mut factors = LuWorkspace::new(alone.unknowns());
    alone.jacobian(omega, &mut buffers, factors.matrix_mut());
    factors.factor().then_some(factors)
}

/// The blocks of `own` coefficients from `first` on, out of `all`.
fn restrict(source: &PairJacobian, all: usize, first: usize, own: usize, target: &mut PairJacobian) {
    let copy = |from: &[f64], to: &mut [f64]| {
        for (row, to) in to.chunks_exact_mut(own).enumerate() {
            to.copy_from_slice(&from[(first + row) * all + first..][..own]);
        }
    };
    copy(&source.normal_normal, &mut target.normal_normal);
    for tangent in 0..2 {
        copy(
            &source.tangential_tangential[tangent],
            &mut target.tangential_tangential[tangent],
        );
        copy(
            &source.tangential_normal[tangent],
            &mut target.tangential_normal[tangent],
        );
    }
}

/// Anderson's acceleration of `x <- x + f(x)`.
struct Anderson {
    depth: usize,
    /// Last iterate and its step.
    last: Option<(Vec<f64>, Vec<f64>)>,
    /// Differences of iterates and of steps.
    differences: Vec<(Vec<f64>, Vec<f64>)>,
}

impl Anderson {
    fn new(depth: usize) -> Self {
        Self {
            depth,
            last: None,
            differences: Vec::new(),
        }
    }

    /// The next iterate from `x` and `step = f(x)`.
    fn next(&mut self, x: &[f64], step: &[f64]) -> Vec<f64> {
        let minus = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a - b).collect();
        if let Some((last_x, last_step)) = &self.last {
            self.differences
                .push((minus(x, last_x), minus(step, last_step)));
            if self.differences.len() > self.depth {
                self.differences.remove(0);
            }
        }
        self.last = Some((x.to_vec(), step.to_vec()));
        let columns: Vec<&[f64]> = self.differences.iter().map(|(_, f)| f.as_slice()).collect();
        let shares = least_squares(&columns, step);
        let mut next: Vec<f64> = x.iter().zip(step).map(|(x, f)| x + f).collect();
        for (share, (dx, df)) in shares.iter().zip(&self.differences) {
            for ((next, dx), df) in next.iter_mut().zip(dx).zip(df) {
                *next -= share * (dx + df);
            }
        }
        next
    }
}

/// Shares by which the columns come nearest to `target`; a column that depends on those after it,
/// the more recent ones, has none.
fn least_squares(columns: &[&[f64]], target: &[f64]) -> Vec<f64> {
    const DEPENDENT: f64 = 1e-8;
    let n = columns.len();
    // Modified Gram-Schmidt from the last column on: A = Q R, R gathered by columns.
    let mut orthonormal: Vec<Option<Vec<f64>>> = vec![None; n];
    let mut triangle = vec![vec![0.0; n]; n];
    for j in (0..n).rev() {
        let mut q = columns[j].to_vec();
        let length = dot(&q, &q).sqrt();
        for i in (j + 1..n).rev() {
            if let Some(other) = &orthonormal[i] {
                let share = dot(other, &q);
                triangle[i][j] = share;
                q.iter_mut().zip(other).for_each(|(q, o)| *q -= share * o);
            }
        }
        let left = dot(&q, &q).sqrt();
        if left > DEPENDENT * length {
            q.iter_mut().for_each(|q| *q /= left);
            triangle[j][j] = left;
            orthonormal[j] = Some(q);
        }
    }
    let mut shares = vec![0.0; n];
    for i in 0..n {
        if let Some(q) = &orthonormal[i] {
            let known: f64 = (0..i).map(|j| triangle[i][j] * shares[j]).sum();
            shares[i] = (dot(q, target) - known) / triangle[i][i];
        }
    }
    shares
}

#[cfg(test)]
mod tests {
    use super::{Anderson, least_squares};

    #[test]
    fn least_squares_meet_a_target_in_the_span_and_drop_a_repeated_column() {
        let (a, b) = ([1.0, 2.0, 0.0, 1.0], [0.0, 1.0, 1.0, -1.0]);
        let target: Vec<f64> = a.iter().zip(&b).map(|(a, b)| 3.0 * a - 2.0 * b).collect();
        let shares = least_squares(&[&a, &b], &target);
        assert!((shares[0] - 3.0).abs() < 1e-12 && (shares[1] + 2.0).abs() < 1e-12);
        let shares = least_squares(&[&b, &a, &b], &target);
        assert!(shares[0] == 0.0 && (shares[1] - 3.0).abs() < 1e-12);
    }

    #[test]
    fn a_linear_iteration_that_diverges_by_itself_is_solved_in_as_many_steps_as_unknowns() {
        // f(x) = b - A x with eigenvalues 0.2, 1.5 and 4.
        let a = [0.2, 1.5, 4.0];
        let step = |x: &[f64]| -> Vec<f64> { x.iter().zip(a).map(|(x, a)| 1.0 - a * x).collect() };
        let mut acceleration = Anderson::new(6);
        let mut x = vec![0.0; 3];
        for _ in 0..5 {
            x = acceleration.next(&x, &step(&x));
        }
        for (x, a) in x.iter().zip(a) {
            assert!((x - 1.0 / a).abs() < 1e-9, "{x} for {}", 1.0 / a);
        }
    }
}
