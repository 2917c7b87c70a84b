//! A Jacobian that is factored once and serves for many steps, whole or without the couplings that cost most.
//!
//! On a wheel every harmonic has hundreds of unknowns. What the higher harmonics do to the lower ones is
//! left out of
//!
//! ```text
//! P = [J_11, 0, 0; J_31, J_33, 0; J_51, J_53, J_55]
//! ```
//!
//! and comes in through the residual alone: a step with P takes one LU factorisation a harmonic instead of one
//! of all together, and half of the couplings need not be assembled.
//!
//! Near a solution less will do: `J_cc` of the leading harmonics c, 0 and 1, whole, and of every other harmonic k
//! by itself the part of `J_kk` that is linear in complex unknowns, all couplings between left out:
//!
//! ```text
//! P = [J_cc, 0; 0, diag_k (part of J_kk)]
//! ```

use super::{HarmonicSystem, SystemWorkspace};
use crate::linalg::{Complex64, LuWorkspace, add_times};

/// Which factors are at hand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Held {
    Nothing,
    Whole,
    Triangle,
    ByHarmonic,
}

/// Factors of the Jacobian of one system.
pub(super) struct KeptJacobian {
    held: Held,
    whole: Option<LuWorkspace<f64>>,
    triangle: Vec<BlockColumn>,
    /// A block column of J before it is taken apart.
    assembled: Vec<f64>,
    negative: Vec<f64>,
    /// `J_cc` and the blocks of the harmonics beyond.
    leading: Option<LuWorkspace<f64>>,
    beyond: Vec<LuWorkspace<Complex64>>,
}

/// The column of one harmonic in P.
struct BlockColumn {
    diagonal: LuWorkspace<f64>,
    /// What stands below the diagonal block, column-major.
    below: Vec<f64>,
}

impl KeptJacobian {
    /// No factors yet.
    pub(super) fn new() -> Self {
        Self {
            held: Held::Nothing,
            whole: None,
            triangle: Vec::new(),
            assembled: Vec::new(),
            negative: Vec::new(),
            leading: None,
            beyond: Vec::new(),
        }
    }

    /// Lets go of the factors at hand.
    pub(super) fn forget(&mut self) {
        self.held = Held::Nothing;
    }

    /// Whether there are factors, of this or of an earlier point.
    pub(super) fn is_factored(&self) -> bool {
        self.held != Held::Nothing
    }

    /// Factors the whole Jacobian at the point last given to [`HarmonicSystem::residual`] with derivative; false if
    /// it is singular.
    pub(super) fn factor_whole(
        &mut self,
        system: &HarmonicSystem,
        omega: f64,
        workspace: &mut SystemWorkspace,
    ) -> bool {
        let whole = self
            .whole
            .get_or_insert_with(|| LuWorkspace::new(system.unknowns()));
        system.jacobian(omega, workspace, whole.matrix_mut());
        let regular = whole.factor();
        self.hold(Held::Whole, regular)
    }

    /// Factors P, see [`self`], at the same point; false if it is singular.
    pub(super) fn factor_triangle(
        &mut self,
        system: &HarmonicSystem,
        omega: f64,
        workspace: &mut SystemWorkspace,
    ) -> bool {
        let count = system.blocks.len();
        if self.triangle.is_empty() {
            self.triangle = (0..count).map(|at| BlockColumn::new(system, at)).collect();
            let widest = self.triangle.iter().map(|c| c.diagonal.dimension()).max();
            self.assembled = vec![0.0; system.unknowns() * widest.unwrap_or(0)];
            self.negative = vec![0.0; system.unknowns()];
        }
        let mut regular = true;
        for (at, column) in self.triangle.iter_mut().enumerate() {
            let size = column.diagonal.dimension();
            let height = system.unknowns() - system.start[at];
            let assembled = &mut self.assembled[..height * size];
            system.jacobian_of(at..count, at..at + 1, omega, workspace, assembled);
            let diagonal = column.diagonal.matrix_mut().chunks_exact_mut(size);
            for (from, to) in assembled.chunks_exact(height).zip(diagonal) {
                to.copy_from_slice(&from[..size]);
            }
            if height > size {
                let below = column.below.chunks_exact_mut(height - size);
                for (from, to) in assembled.chunks_exact(height).zip(below) {
                    to.copy_from_slice(&from[size..]);
                }
            }
            regular &= column.diagonal.factor();
        }
        self.hold(Held::Triangle, regular)
    }

    /// Factors the leading harmonics and every other one by itself, see [`self`], at the same point, for which the
    /// derivatives of pairs are those of [`HarmonicSystem::couple_leading`]; false if a block is singular.
    pub(super) fn factor_by_harmonic(
        &mut self,
        system: &HarmonicSystem,
        omega: f64,
        workspace: &mut SystemWorkspace,
    ) -> bool {
        let (count, leading) = (system.blocks.len(), system.leading());
        let factors = self
            .leading
            .get_or_insert_with(|| LuWorkspace::new(system.start[leading]));
        system.jacobian_of(
            0..leading,
            0..leading,
            omega,
            workspace,
            factors.matrix_mut(),
        );
        let mut regular = factors.factor();
        if self.beyond.is_empty() {
            let size = |index: usize| system.blocks[index].structure.size();
            self.beyond = (leading..count)
                .map(|index| LuWorkspace::new(size(index)))
                .collect();
        }
        for (index, factors) in (leading..count).zip(&mut self.beyond) {
            system.complex_jacobian_of(index, omega, workspace, factors.matrix_mut());
            regular &= factors.factor();
        }
        self.hold(Held::ByHarmonic, regular)
    }

    fn hold(&mut self, held: Held, regular: bool) -> bool {
        self.held = if regular { held } else { Held::Nothing };
        regular
    }

    /// `J^-1 residual` or `P^-1 residual` with the factors at hand, in place.
    pub(super) fn solve(&mut self, residual: &mut [f64]) {
        match (self.held, &mut self.whole) {
            (Held::Whole, Some(whole)) => whole.solve(residual),
            (Held::ByHarmonic, _) => {
                let mut rest = residual;
                if let Some(factors) = &mut self.leading {
                    let (own, beyond) = rest.split_at_mut(factors.dimension());
                    factors.solve(own);
                    rest = beyond;
                }
                for factors in &mut self.beyond {
                    let (own, beyond) = rest.split_at_mut(2 * factors.dimension());
                    solve_complex(factors, own);
                    rest = beyond;
                }
            }
            (Held::Triangle, _) => {
                let mut rest = residual;
                for column in &mut self.triangle {
                    let size = column.diagonal.dimension();
                    let (own, below) = rest.split_at_mut(size);
                    column.diagonal.solve(own);
                    let negative = &mut self.negative[..size];
                    negative.iter_mut().zip(&*own).for_each(|(n, x)| *n = -x);
                    let shape = (below.len(), 1, size);
                    add_times(below, &column.below, negative, shape);
                    rest = below;
                }
            }
            _ => {}
        }
    }
}

impl BlockColumn {
    fn new(system: &HarmonicSystem, at: usize) -> Self {
        let size = system.start[at + 1] - system.start[at];
        let below = system.unknowns() - system.start[at + 1];
        Self {
            diagonal: LuWorkspace::new(size),
            below: vec![0.0; below * size],
        }
    }
}

/// Solves for the unknowns of one harmonic, in place: real parts, then imaginary ones where it is not harmonic 0.
pub(super) fn solve_complex(factors: &mut LuWorkspace<Complex64>, unknowns: &mut [f64]) {
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
