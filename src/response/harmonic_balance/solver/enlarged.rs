//! What a solution would become with finer sampling, and with the harmonics outside of its set.
//!
//! With s the harmonics of the set, o those outside and the residual `R` of the enlarged system,
//!
//! ```text
//! R_s(x_s, x_o) = 0,    R_o(x_s, x_o) = 0,    from (x_s, 0) where R_s(x_s, 0) = 0
//! P = J    or    P = [J_ss, 0; 0, diag_k (part of J_kk linear in complex unknowns)]
//! ```
//!
//! is solved by the fixed-point iteration `x <- x - P^-1 R(x)` with Anderson's acceleration (Anderson
//! 1965; Walker & Ni 2011, SIAM J. Numer. Anal. 49(4)). P is the whole enlarged Jacobian where that is
//! small (one sector of a tuned wheel): the first step is then Newton's. On a wheel it would cost more
//! than the solution itself, and P leaves out the coupling between harmonics, which comes in through
//! the residual alone. Either holds the derivative of the contact forces, so that a resonance of
//! slipping contact in harmonic k is in it.

use std::sync::Arc;

use super::NewtonWorkspace;
use super::anderson::Anderson;
use super::newton_workspace::WholeJacobian;
use crate::linalg::{Complex64, LuWorkspace};
use crate::response::harmonic_balance::equation::{HarmonicBlock, HarmonicSystem, SystemWorkspace};
use crate::response::harmonic_balance::{HarmonicTransform, TransformError};

/// Highest harmonic that is looked at, and where a set has all up to that one.
const HIGHEST_HARMONIC: u32 = 15;
const HIGHEST_BEYOND: u32 = 25;
/// Unknowns of a wheel up to which the whole Jacobian is factored.
const SMALL_WHEEL: usize = 1200;
/// Samples per period of the enlarged set at least, and per period of its highest harmonic.
const SAMPLES: usize = 256;
const SAMPLES_OF_HIGHEST: usize = 16;
/// Samples per period of the derivatives in P at least, and per period of the highest harmonic.
const LINEARISED_SAMPLES: usize = 128;
const LINEARISED_SAMPLES_OF_HIGHEST: usize = 4;
/// Steps of the iteration at most.
const EVALUATIONS: usize = 14;
/// The iteration ends when the next step would change the set by this share of the change so far,
const SETTLED: f64 = 0.03;
/// or by this share of the set itself.
const NEGLIGIBLE: f64 = 5e-5;

/// Transforms of an enlarged set; made once per study.
#[derive(Debug, Clone)]
pub struct EnlargedSet {
    harmonics: Vec<u32>,
    /// The set itself, sampled more finely, and as the enlarged set is.
    fine: Arc<HarmonicTransform>,
    alone: Arc<HarmonicTransform>,
    enlarged: Arc<HarmonicTransform>,
    linearised: Arc<HarmonicTransform>,
    /// The enlarged set with few samples: more than four per period of its highest harmonic.
    tangents: Arc<HarmonicTransform>,
}

impl EnlargedSet {
    /// Harmonics up to 15 that a law excites, ascending: odd ones alone where the normal load is constant.
    #[must_use]
    pub fn everything(variable_load: bool) -> Vec<u32> {
        excited_up_to(HIGHEST_HARMONIC, variable_load)
    }

    /// [`Self::everything`], or the same up to 25 where `set` has it, and the harmonics of `set`, whose sampling is checked with
    /// `samples` per period.
    ///
    /// # Errors
    /// If the harmonics cannot be told apart with the samples asked for.
    pub fn new(set: &[u32], variable_load: bool, samples: usize) -> Result<Self, TransformError> {
        let mut harmonics = Self::everything(variable_load);
        if harmonics.iter().all(|k| set.contains(k)) {
            harmonics = excited_up_to(HIGHEST_BEYOND, variable_load);
        }
        harmonics.extend(set);
        harmonics.sort_unstable();
        harmonics.dedup();
        let transform = |harmonics: &[u32], samples: usize| {
            let numbers: Vec<usize> = harmonics.iter().map(|&k| k as usize).collect();
            HarmonicTransform::new(&numbers, samples).map(Arc::new)
        };
        let highest = harmonics.last().map_or(1, |&k| k as usize);
        let of_highest = |least: usize, per_period: usize| least.max(per_period * highest);
        let of_enlarged = of_highest(SAMPLES, SAMPLES_OF_HIGHEST);
        Ok(Self {
            fine: transform(set, samples)?,
            alone: transform(set, of_enlarged)?,
            enlarged: transform(&harmonics, of_enlarged)?,
            linearised: transform(
                &harmonics,
                of_highest(LINEARISED_SAMPLES, LINEARISED_SAMPLES_OF_HIGHEST),
            )?,
            tangents: transform(&harmonics, (4 * highest + 1).next_multiple_of(4))?,
            harmonics,
        })
    }

    /// The harmonics, ascending.
    #[must_use]
    pub fn harmonics(&self) -> &[u32] {
        &self.harmonics
    }

    /// The set itself, as finely sampled as the enlarged set is, the enlarged set, and the same with few samples.
    #[must_use]
    pub fn transforms(&self) -> [&Arc<HarmonicTransform>; 3] {
        [&self.alone, &self.enlarged, &self.tangents]
    }
}

/// Harmonics that a law excites, ascending.
fn excited_up_to(highest: u32, variable_load: bool) -> Vec<u32> {
    let excited = |k: &u32| variable_load || k % 2 == 1;
    (0..=highest).filter(excited).collect()
}

/// A solution corrected, in the unknowns of the enlarged system.
#[derive(Debug, Clone, PartialEq)]
pub struct Enlarged {
    /// The solution, zero outside of the set.
    pub before: Vec<f64>,
    /// The solution after one Newton correction at the finer sampling, in the set alone.
    pub resampled: Vec<f64>,
    /// The solution in the set alone at the sampling of the enlarged set: what `after` would be without harmonics outside.
    pub alone: Vec<f64>,
    /// The solution with the harmonics outside: the iterate that the next step would change least.
    pub after: Vec<f64>,
    /// What the next step from `after` would still change of the set, relative to the set.
    pub unsettled: f64,
    /// For each harmonic outside, where wanted, what `after` would be in the set without it.
    pub without: Vec<(u32, Vec<f64>)>,
}

/// Which effects of the harmonics outside are wanted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effects {
    /// The effect of all harmonics outside together.
    Together,
    /// The effect of each harmonic outside too.
    Each,
}

/// A solution under correction.
struct Enlargement<'a> {
    system: &'a HarmonicSystem,
    workspace: &'a mut NewtonWorkspace,
    enlarged: HarmonicSystem,
    buffers: SystemWorkspace,
    /// Place in the set of each enlarged block.
    places: Vec<Option<usize>>,
    omega: f64,
    factors: Factors,
}

/// Factors of P.
enum Factors {
    /// Factors of the whole J.
    Whole(WholeJacobian),
    /// Factors of each harmonic outside of the set; those of `J_ss` are in the workspace of the set.
    Blocks(Vec<Option<LuWorkspace<Complex64>>>),
}

/// Corrects the solution `x` of `system` at `omega` towards that of the enlarged set; `blocks` are
/// those of its harmonics. None if a Jacobian is singular or a value not finite.
///
/// The effect of each harmonic outside takes an evaluation each, where it is `wanted`.
pub fn enlarge(
    system: &HarmonicSystem,
    workspace: &mut NewtonWorkspace,
    set: &EnlargedSet,
    blocks: &[HarmonicBlock],
    omega: f64,
    x: &[f64],
    wanted: Effects,
) -> Option<Enlarged> {
    let with = |blocks: &[HarmonicBlock], transform: &Arc<HarmonicTransform>| {
        let mut enlarged = HarmonicSystem::new(
            blocks.to_vec(),
            system.force().to_vec(),
            system.contact.interface.clone(),
            Arc::clone(transform),
        );
        enlarged.set_ring_drift(system.ring_drift_m());
        enlarged
    };
    let fine = with(system.blocks(), &set.fine);
    let enlarged = with(blocks, &set.enlarged);
    let same = |block: &HarmonicBlock| {
        let matches = |other_block: &HarmonicBlock| other_block.harmonic == block.harmonic;
        system.blocks().iter().position(matches)
    };
    let places: Vec<Option<usize>> = blocks.iter().map(same).collect();
    let before = embed(system, &enlarged, &places, x);
    let linearised = with(blocks, &set.linearised);
    let buffers = enlarged.workspace();
    if !workspace.factor_at(system, omega, x) {
        return None;
    }
    let factors = Factors::of(&linearised, &places, omega, &before)?;
    let mut enlargement = Enlargement {
        system,
        workspace,
        enlarged,
        buffers,
        places,
        omega,
        factors,
    };
    let resampled = enlargement.in_set_of(&fine, x)?;
    let alone = if set.alone.n_samples() == set.fine.n_samples() {
        resampled.clone()
    } else {
        enlargement.in_set_of(&with(system.blocks(), &set.alone), x)?
    };
    enlargement.correct(before, [resampled, alone], wanted)
}

impl Enlargement<'_> {
    fn correct(
        mut self,
        before: Vec<f64>,
        [resampled, alone]: [Vec<f64>; 2],
        wanted: Effects,
    ) -> Option<Enlarged> {
        let mut step = self.step(&alone);
        let scale = self.in_set(&alone);
        let mut acceleration = Anderson::new(before.len(), EVALUATIONS);
        let mut iterate = alone.clone();
        let mut next = alone.clone();
        let mut best: Option<(f64, Vec<f64>)> = None;
        for evaluation in 1..=EVALUATIONS {
            let last = self.in_set(&step);
            acceleration.next(&iterate, &step, &mut next);
            std::mem::swap(&mut iterate, &mut next);
            step = self.step(&iterate);
            if !step.iter().all(|s| s.is_finite()) {
                return None;
            }
            // The set feels a step of the harmonics outside one evaluation later.
            let left = last.max(self.in_set(&step)) / scale;
            if best.as_ref().is_none_or(|(least, _)| left < *least) && evaluation > 1 {
                best = Some((left, iterate.clone()));
            }
            let change: Vec<f64> = iterate.iter().zip(&alone).map(|(a, b)| a - b).collect();
            if evaluation > 1
                && left <= f64::max(NEGLIGIBLE, SETTLED * self.in_set(&change) / scale)
            {
                break;
            }
        }
        let (unsettled, after) = best?;
        let without = match wanted {
            Effects::Together => Vec::new(),
            Effects::Each => self.without_each(&after),
        };
        Some(Enlarged {
            before,
            resampled,
            alone,
            after,
            unsettled,
            without,
        })
    }

    fn residual(&mut self, x: &[f64]) -> Vec<f64> {
        let mut residual = vec![0.0; x.len()];
        self.enlarged
            .residual(self.omega, x, &mut residual, false, &mut self.buffers);
        residual
    }

    /// `-P^-1 R(x)`.
    fn step(&mut self, x: &[f64]) -> Vec<f64> {
        let mut step = self.residual(x);
        let set_step = match &self.factors {
            Factors::Blocks(_) => self.set_step(&step),
            Factors::Whole(_) => Vec::new(),
        };
        match &mut self.factors {
            Factors::Whole(factors) => factors.solve(&mut step),
            Factors::Blocks(blocks) => {
                for (index, factors) in blocks.iter_mut().enumerate() {
                    let place = range(&self.enlarged, index);
                    match factors {
                        Some(factors) => solve_complex(factors, &mut step[place]),
                        None => step[place.clone()].copy_from_slice(&set_step[place]),
                    }
                }
            }
        }
        for step in &mut step {
            *step = -*step;
        }
        step
    }

    /// `J_ss^-1 residual_s`, zero outside of the set.
    fn set_step(&mut self, residual: &[f64]) -> Vec<f64> {
        let mut restricted = self.restricted(residual);
        self.workspace.solve_linear(&mut restricted);
        embed(self.system, &self.enlarged, &self.places, &restricted)
    }

    /// The solution of `other`, which has the harmonics of the set, near its solution `x` at another sampling, in the
    /// unknowns of the enlarged system: by one Newton correction. None if it is not finite.
    fn in_set_of(&mut self, other: &HarmonicSystem, x: &[f64]) -> Option<Vec<f64>> {
        let mut step = vec![0.0; x.len()];
        let mut buffers = other.workspace();
        other.residual(self.omega, x, &mut step, false, &mut buffers);
        self.workspace.solve_linear(&mut step);
        let corrected: Vec<f64> = x.iter().zip(&step).map(|(x, s)| x - s).collect();
        let is_finite = step.iter().all(|s| s.is_finite());
        is_finite.then(|| embed(self.system, &self.enlarged, &self.places, &corrected))
    }

    /// The unknowns of the set.
    fn restricted(&self, x: &[f64]) -> Vec<f64> {
        let mut restricted = vec![0.0; self.system.unknowns()];
        for (index, place) in self.places.iter().enumerate() {
            if let Some(place) = *place {
                restricted[range(self.system, place)]
                    .copy_from_slice(&x[range(&self.enlarged, index)]);
            }
        }
        restricted
    }

    /// One Newton correction in the set of `after` less each harmonic outside.
    fn without_each(&mut self, after: &[f64]) -> Vec<(u32, Vec<f64>)> {
        let with_all = self.residual(after);
        let mut changed = Vec::new();
        for index in 0..self.places.len() {
            if self.places[index].is_some() {
                continue;
            }
            let mut less = after.to_vec();
            less[range(&self.enlarged, index)].fill(0.0);
            let mut residual = self.residual(&less);
            residual
                .iter_mut()
                .zip(&with_all)
                .for_each(|(r, all)| *r -= all);
            let step = self.set_step(&residual);
            let corrected = after.iter().zip(step).map(|(x, s)| x - s).collect();
            changed.push((self.enlarged.blocks()[index].harmonic, corrected));
        }
        changed
    }

    /// Norm of the part in the set.
    fn in_set(&self, x: &[f64]) -> f64 {
        let square = |(index, place): (usize, &Option<usize>)| match place {
            Some(_) => x[range(&self.enlarged, index)].iter().map(|x| x * x).sum(),
            None => 0.0,
        };
        self.places
            .iter()
            .enumerate()
            .map(square)
            .sum::<f64>()
            .sqrt()
    }
}

/// Solves for the unknowns of one harmonic, in place: real parts, then imaginary ones where it is not harmonic 0.
fn solve_complex(factors: &mut LuWorkspace<Complex64>, unknowns: &mut [f64]) {
    let n = factors.dimension();
    let imaginary = |i: usize| unknowns.get(n + i).copied().unwrap_or(0.0);
    let mut right: Vec<Complex64> = (0..n)
        .map(|i| Complex64::new(unknowns[i], imaginary(i)))
        .collect();
    factors.solve(&mut right);
    for (i, solution) in right.iter().enumerate() {
        unknowns[i] = solution.re;
        if let Some(imaginary) = unknowns.get_mut(n + i) {
            *imaginary = solution.im;
        }
    }
}

fn range(system: &HarmonicSystem, block: usize) -> std::ops::Range<usize> {
    system.block_start(block)..system.block_start(block + 1)
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

impl Factors {
    /// Factors of P at `x`: of the whole Jacobian for one sector or a small wheel, else of a block for each harmonic outside of
    /// the set; none if one is singular.
    fn of(
        system: &HarmonicSystem,
        places: &[Option<usize>],
        omega: f64,
        x: &[f64],
    ) -> Option<Self> {
        let one_sector = system.blocks()[0].structure.sectors() == 1;
        let whole = one_sector || system.unknowns() <= SMALL_WHEEL;
        let mut buffers = system.workspace();
        if !whole {
            buffers.couple_first(0);
        }
        let mut residual = vec![0.0; system.unknowns()];
        system.residual(omega, x, &mut residual, true, &mut buffers);
        if whole {
            let mut factors = WholeJacobian::default();
            let regular = factors.factor(system, omega, &mut buffers);
            return regular.then_some(Self::Whole(factors));
        }
        let mut blocks = Vec::with_capacity(places.len());
        for (index, place) in places.iter().enumerate() {
            if place.is_some() {
                blocks.push(None);
                continue;
            }
            let mut factors = LuWorkspace::new(system.blocks()[index].structure.size());
            system.complex_jacobian_of(index, omega, &mut buffers, factors.matrix_mut());
            blocks.push(factors.factor().then_some(Some(factors))?);
        }
        Some(Self::Blocks(blocks))
    }
}
