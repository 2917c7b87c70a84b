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

use super::{HarmonicSystem, SystemWorkspace};
use crate::linalg::{LuWorkspace, add_times};

/// Which factors are at hand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Held {
    Nothing,
    Whole,
    Triangle,
}

/// Factors of the Jacobian of one system.
pub(super) struct KeptJacobian {
    held: Held,
    whole: Option<LuWorkspace<f64>>,
    triangle: Vec<BlockColumn>,
    /// A block column of J before it is taken apart.
    assembled: Vec<f64>,
    negative: Vec<f64>,
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
        }
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

    fn hold(&mut self, held: Held, regular: bool) -> bool {
        self.held = if regular { held } else { Held::Nothing };
        regular
    }

    /// `J^-1 residual` or `P^-1 residual` with the factors at hand, in place.
    pub(super) fn solve(&mut self, residual: &mut [f64]) {
        match (self.held, &mut self.whole) {
            (Held::Whole, Some(whole)) => whole.solve(residual),
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
