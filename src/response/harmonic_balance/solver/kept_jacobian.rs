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

use crate::linalg::{Complex64, LuWorkspace, add_times};
use crate::response::harmonic_balance::condensed::CondensedJacobian;
use crate::response::harmonic_balance::equation::{HarmonicSystem, SystemWorkspace};

/// Which factors are at hand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Held {
    Nothing,
    Whole,
    Condensed,
    Triangle,
    ByHarmonic,
}

/// Factors of the Jacobian of one system.
pub(super) struct KeptJacobian {
    held: Held,
    whole: Option<LuWorkspace<f64>>,
    condensed: CondensedJacobian,
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
            condensed: CondensedJacobian::default(),
            triangle: Vec::new(),
            assembled: Vec::new(),
            negative: Vec::new(),
            leading: None,
            beyond: Vec::new(),
        }
    }

    /// The factors by contact forces and what they are made of.
    pub(super) fn condensed(&mut self) -> &mut CondensedJacobian {
        &mut self.condensed
    }

    /// [`Self::condensed`], to look at.
    pub(super) fn condensed_at_hand(&self) -> &CondensedJacobian {
        &self.condensed
    }

    /// Lets go of the factors at hand.
    pub(super) fn forget(&mut self) {
        self.held = Held::Nothing;
    }

    /// Whether there are factors, of this or of an earlier point.
    pub(super) fn is_factored(&self) -> bool {
        self.held != Held::Nothing
    }

    /// Whether they are those by the forces at the contact.
    pub(super) fn is_condensed(&self) -> bool {
        self.held == Held::Condensed
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

    /// Factors the Jacobian by the forces at the contact where that is cheaper, see [`HarmonicSystem::condenses`], else
    /// whole; false if it is singular. Where contact is much stiffer than what it holds, the step by contact forces
    /// takes the difference of nearly equal numbers.
    pub(super) fn factor_cheaply(
        &mut self,
        system: &HarmonicSystem,
        omega: f64,
        workspace: &mut SystemWorkspace,
    ) -> bool {
        if !system.condenses() {
            return self.factor_whole(system, omega, workspace);
        }
        self.factor_condensed(system, omega, workspace)
    }

    /// Factors the Jacobian by the forces at the contact, at the point last given to [`HarmonicSystem::residual`] with
    /// derivative; false if it is singular.
    pub(super) fn factor_condensed(
        &mut self,
        system: &HarmonicSystem,
        omega: f64,
        workspace: &SystemWorkspace,
    ) -> bool {
        let regular = self.condensed.factor(system, omega, workspace);
        self.hold(Held::Condensed, regular)
    }

    /// Factors P, see [`self`], at the same point; false if it is singular.
    pub(super) fn factor_triangle(
        &mut self,
        system: &HarmonicSystem,
        omega: f64,
        workspace: &mut SystemWorkspace,
    ) -> bool {
        let count = system.blocks().len();
        if self.triangle.is_empty() {
            self.triangle = (0..count).map(|at| BlockColumn::new(system, at)).collect();
            let widest = self.triangle.iter().map(|c| c.diagonal.dimension()).max();
            self.assembled = vec![0.0; system.unknowns() * widest.unwrap_or(0)];
            self.negative = vec![0.0; system.unknowns()];
        }
        let mut regular = true;
        for (at, column) in self.triangle.iter_mut().enumerate() {
            let size = column.diagonal.dimension();
            let height = system.unknowns() - system.block_start(at);
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
    /// derivatives of pairs are those of [`HarmonicSystem::leading_coefficients`]; false if a block is singular.
    pub(super) fn factor_by_harmonic(
        &mut self,
        system: &HarmonicSystem,
        omega: f64,
        workspace: &mut SystemWorkspace,
    ) -> bool {
        let (count, leading) = (system.blocks().len(), system.leading());
        let factors = self
            .leading
            .get_or_insert_with(|| LuWorkspace::new(system.block_start(leading)));
        system.jacobian_of(
            0..leading,
            0..leading,
            omega,
            workspace,
            factors.matrix_mut(),
        );
        let mut regular = factors.factor();
        if self.beyond.is_empty() {
            let size = |index: usize| system.blocks()[index].structure.size();
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
            (Held::Condensed, _) => self.condensed.solve(residual),
            (Held::ByHarmonic, _) => {
                let mut rest = residual;
                if let Some(factors) = &mut self.leading {
                    let (leading, beyond) = rest.split_at_mut(factors.dimension());
                    factors.solve(leading);
                    rest = beyond;
                }
                for factors in &mut self.beyond {
                    let (block, beyond) = rest.split_at_mut(2 * factors.dimension());
                    solve_complex(factors, block);
                    rest = beyond;
                }
            }
            (Held::Triangle, _) => {
                let mut rest = residual;
                for column in &mut self.triangle {
                    let size = column.diagonal.dimension();
                    let (of_column, below) = rest.split_at_mut(size);
                    column.diagonal.solve(of_column);
                    let negative = &mut self.negative[..size];
                    negative
                        .iter_mut()
                        .zip(&*of_column)
                        .for_each(|(n, x)| *n = -x);
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
        let size = system.block_start(at + 1) - system.block_start(at);
        let below = system.unknowns() - system.block_start(at + 1);
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

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::linalg::Matrix;
    use crate::model::cyclic::ContactGeometry;
    use crate::response::friction::{ContactLaw, PairParameters};
    use crate::response::harmonic_balance::equation::{HarmonicBlock, Structure};
    use crate::response::harmonic_balance::pairs::ContactInterface;
    use crate::response::harmonic_balance::{Damping, HarmonicTransform};
    use crate::response::mistuning::{ModalRows, StructuralModes};

    const OMEGA: f64 = 1.1;
    const HARMONICS: [usize; 3] = [1, 2, 3];

    /// Two modes, two pairs with normal motion that slip at [`displacement`].
    fn system() -> HarmonicSystem {
        let rows = |count, factor: f64| ModalRows {
            real: Matrix::from_fn(count, 2, |i, j| (factor * (1 + i + 3 * j) as f64).sin()),
            imaginary: None,
        };
        let structure = Arc::new(Structure::new(
            StructuralModes {
                eigenvalues: vec![1.0, 3.5],
                tuned_eigenvalues: vec![1.0, 3.5],
                rotation: None,
                added_damping_per_s: Vec::new(),
                contact: rows(4, 1.0),
                observed: rows(3, 2.0),
                sectors: 1,
            },
            Damping::ModalRatio(0.02),
        ));
        let stuck = Arc::new(structure.contact_stiffness(&[0.7, 0.9]));
        let blocks = HARMONICS.map(|harmonic| HarmonicBlock {
            harmonic: harmonic as u32,
            structure: Arc::clone(&structure),
            stuck: Arc::clone(&stuck),
        });
        let pair = PairParameters {
            normal_load_n: 2.0,
            normal_stiffness_n_per_m: 0.7,
            tangential_stiffness_n_per_m: 0.9,
            friction_coefficient: 0.3,
        };
        let interface = ContactInterface {
            law: ContactLaw::Simplified3d,
            geometry: ContactGeometry {
                weights: vec![0.5; 2],
                load_weights: vec![0.5; 2],
                rows: vec![[Some(0), Some(1), None], [Some(2), Some(3), None]],
                ring_motion: vec![[[0.0; 2]; 2]; 2],
                ring_free: [false; 2],
            },
            pairs: vec![pair; 2],
        };
        let force = vec![Complex64::new(1.0, 0.0), Complex64::new(0.3, 0.2)];
        let transform = HarmonicTransform::new(&HARMONICS, 64).expect("enough samples");
        HarmonicSystem::new(blocks.to_vec(), force, interface, Arc::new(transform))
    }

    fn displacement() -> Vec<f64> {
        (0..12)
            .map(|i| 2.0 * (0.7 + 1.3 * f64::from(i)).sin() / (1.0 + f64::from(i / 4)))
            .collect()
    }

    /// The whole Jacobian, column-major, and the buffers with the derivatives of the pairs.
    fn jacobian(system: &HarmonicSystem) -> (Vec<f64>, SystemWorkspace) {
        let mut workspace = system.workspace();
        let mut residual = vec![0.0; 12];
        let (_, shares) =
            system.residual(OMEGA, &displacement(), &mut residual, true, &mut workspace);
        assert!(
            shares.slipping > 0.9 && shares.separated == 0.0,
            "{shares:?}"
        );
        let mut jacobian = vec![0.0; 144];
        system.jacobian(OMEGA, &mut workspace, &mut jacobian);
        (jacobian, workspace)
    }

    /// `matrix x - right`, largest entry.
    fn missed(matrix: &[f64], x: &[f64], right: &[f64]) -> f64 {
        (0..12)
            .map(|i| (0..12).map(|j| matrix[12 * j + i] * x[j]).sum::<f64>() - right[i])
            .fold(0.0, |worst: f64, d| worst.max(d.abs()))
    }

    #[test]
    fn the_triangle_leaves_out_what_higher_harmonics_do_to_lower_ones_and_nothing_else() {
        let system = system();
        let (mut expected, mut workspace) = jacobian(&system);
        for column in 0..12 {
            expected[12 * column..][..4 * (column / 4)].fill(0.0);
        }
        let right = displacement();
        let mut x = right.clone();
        let mut kept = KeptJacobian::new();
        assert!(kept.factor_triangle(&system, OMEGA, &mut workspace));
        kept.solve(&mut x);
        assert!(missed(&expected, &x, &right) < 1e-12);
    }

    #[test]
    fn by_harmonic_the_first_is_whole_and_the_others_are_what_is_linear_in_complex_unknowns() {
        let system = system();
        let (whole, _) = jacobian(&system);
        let mut expected = vec![0.0; 144];
        for (column, entries) in whole.chunks_exact(12).enumerate() {
            let block = 4 * (column / 4)..4 * (column / 4) + 4;
            expected[12 * column..][block.clone()].copy_from_slice(&entries[block]);
        }
        // Of [A, B; C, D] the part [a, -b; b, a] with a = (A + D) / 2, b = (C - B) / 2.
        for first in [4, 8] {
            for i in 0..2 {
                for j in 0..2 {
                    let at = |row: usize, column: usize| {
                        12 * (first + 2 * column + j) + first + 2 * row + i
                    };
                    let a = 0.5 * (whole[at(0, 0)] + whole[at(1, 1)]);
                    let b = 0.5 * (whole[at(1, 0)] - whole[at(0, 1)]);
                    (expected[at(0, 0)], expected[at(1, 1)]) = (a, a);
                    (expected[at(1, 0)], expected[at(0, 1)]) = (b, -b);
                }
            }
        }
        let mut workspace = system.workspace();
        workspace.couple_first(system.leading_coefficients());
        let mut residual = vec![0.0; 12];
        system.residual(OMEGA, &displacement(), &mut residual, true, &mut workspace);
        let right = displacement();
        let mut x = right.clone();
        let mut kept = KeptJacobian::new();
        assert!(kept.factor_by_harmonic(&system, OMEGA, &mut workspace));
        kept.solve(&mut x);
        assert!(missed(&expected, &x, &right) < 1e-12);
        // It is not the whole.
        assert!(missed(&whole, &x, &right) > 1e-3);
        kept.forget();
        assert!(!kept.is_factored());
    }
}
