//! The contact of a wheel as harmonic balance sees it: law, rows and parameters of its pairs.

use crate::model::cyclic::ContactGeometry;
use crate::response::friction::{ContactLaw, PairParameters};

/// Contact law and pair parameters.
#[derive(Debug, Clone)]
pub struct ContactInterface {
    /// Law of every pair.
    pub law: ContactLaw,
    /// Rows and weights of the pairs of one sector.
    pub geometry: ContactGeometry,
    /// Parameters of each pair of one sector, or of the whole wheel where sectors differ.
    pub pairs: Vec<PairParameters>,
}

impl ContactInterface {
    /// Number of pairs of a sector.
    #[must_use]
    pub fn per_sector(&self) -> usize {
        self.geometry.rows.len()
    }

    /// Contact rows of the wheel along n, t1 and t2 of a pair, which is counted sector after sector.
    pub(super) fn rows_of(&self, pair: usize) -> [Option<usize>; 3] {
        let (sector, place) = (pair / self.per_sector(), pair % self.per_sector());
        let base = sector * self.geometry.row_count();
        self.geometry.rows[place].map(|row| row.map(|row| base + row))
    }

    /// Parameters of a pair of the wheel.
    #[must_use]
    pub fn pair(&self, pair: usize) -> &PairParameters {
        &self.pairs[pair % self.pairs.len()]
    }

    /// Springs of the contact rows where every pair sticks, N/m, the tangential ones multiplied by
    /// `factor`: of a sector, or of the whole wheel where sectors differ.
    pub(in crate::response::harmonic_balance) fn stuck_springs(&self, factor: f64) -> Vec<f64> {
        let per_sector = self.per_sector().max(1);
        let sector_rows = self.geometry.row_count();
        let mut springs = vec![0.0; self.pairs.len() / per_sector * sector_rows];
        for (index, pair) in self.pairs.iter().enumerate() {
            let rows = &self.geometry.rows[index % per_sector];
            let first = index / per_sector * sector_rows;
            let tangential = factor * pair.tangential_stiffness_n_per_m;
            let pair_springs = self.law.springs(pair.normal_stiffness_n_per_m, tangential);
            for (row, spring) in rows.iter().zip(pair_springs) {
                if let Some(row) = *row {
                    springs[first + row] = spring;
                }
            }
        }
        springs
    }
}
