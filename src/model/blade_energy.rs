//! The strain energy of the blade over the real and imaginary motions of the nodal diameters.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use crate::linalg::Matrix;

/// `G = W^T K_blade W` over `W = [Re B_0, Im B_0, Re B_1, Im B_1, ...]` of the blade, real symmetric, `2 sum n_modes` square: every
/// block `B_h^H K_blade B_h'` follows from it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum BladeEnergy {
    /// G itself; empty where it is not known.
    Gram(Matrix<f64>),
    /// W and `K_blade W`, `n_blade x 2 sum n_modes`, in the place of a larger G.
    Factors {
        /// W.
        motions: Matrix<f64>,
        /// `K_blade W`, N per unit of the motions.
        forces: Matrix<f64>,
    },
}

impl BladeEnergy {
    /// Of a model made for the tuned wheel alone.
    #[must_use]
    pub fn unknown() -> Self {
        Self::Gram(Matrix::zeros(0, 0))
    }

    /// Number of motions; 0 where the energy is not known.
    #[must_use]
    pub fn size(&self) -> usize {
        match self {
            Self::Gram(gram) => gram.rows(),
            Self::Factors { motions, .. } => motions.columns(),
        }
    }

    /// G.
    #[must_use]
    pub fn gram(&self) -> Cow<'_, Matrix<f64>> {
        match self {
            Self::Gram(gram) => Cow::Borrowed(gram),
            Self::Factors { motions, forces } => {
                let mut gram = motions.adjoint_times(forces);
                for i in 0..gram.rows() {
                    for j in 0..i {
                        let mean = 0.5 * (gram[(i, j)] + gram[(j, i)]);
                        gram[(i, j)] = mean;
                        gram[(j, i)] = mean;
                    }
                }
                Cow::Owned(gram)
            }
        }
    }

    /// Diagonal of G.
    #[must_use]
    pub fn diagonal(&self) -> Vec<f64> {
        let entry = |at: usize| match self {
            Self::Gram(gram) => gram[(at, at)],
            Self::Factors { motions, forces } => {
                let products = motions.column(at).iter().zip(forces.column(at));
                products.map(|(u, f)| u * f).sum()
            }
        };
        (0..self.size()).map(entry).collect()
    }

    /// Column of G.
    #[must_use]
    pub fn column(&self, at: usize) -> Vec<f64> {
        match self {
            Self::Gram(gram) => gram.column(at).to_vec(),
            Self::Factors { motions, forces } => {
                let of_force = motions.adjoint_times(&forces.column_range(at, at + 1));
                let of_motion = forces.adjoint_times(&motions.column_range(at, at + 1));
                let both = of_force.as_slice().iter().zip(of_motion.as_slice());
                both.map(|(a, b)| 0.5 * (a + b)).collect()
            }
        }
    }

    /// Bytes of its matrices.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        let entries = match self {
            Self::Gram(gram) => gram.as_slice().len(),
            Self::Factors { motions, forces } => motions.as_slice().len() + forces.as_slice().len(),
        };
        8 * entries
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_give_the_columns_and_the_diagonal_of_their_product() {
        let motions = Matrix::from_fn(3, 5, |i, j| (0.3 + 1.7 * i as f64 + 0.9 * j as f64).sin());
        let stiffness = [[4.0, -1.0, 0.5], [-1.0, 3.0, -2.0], [0.5, -2.0, 5.0]];
        let forces = Matrix::from_fn(3, 5, |i, j| {
            (0..3).map(|k| stiffness[i][k] * motions[(k, j)]).sum()
        });
        let energy = BladeEnergy::Factors { motions, forces };
        let BladeEnergy::Factors { motions, .. } = &energy else {
            unreachable!()
        };
        let of = |i: usize, j: usize| -> f64 {
            let places = (0..9).map(|at| (at / 3, at % 3));
            places
                .map(|(a, b)| motions[(a, i)] * stiffness[a][b] * motions[(b, j)])
                .sum()
        };
        for j in 0..5 {
            assert!((energy.diagonal()[j] - of(j, j)).abs() < 1e-14);
            for i in 0..5 {
                assert!((energy.column(j)[i] - of(i, j)).abs() < 1e-14);
                assert!((energy.gram()[(i, j)] - of(i, j)).abs() < 1e-14);
            }
        }
        assert_eq!((energy.size(), energy.memory_bytes()), (5, 240));
    }
}
