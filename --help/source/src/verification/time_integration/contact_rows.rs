//! The pairs of the whole wheel on its contact rows.

use crate::response::friction::{ContactLaw, PairMemory, PairParameters, march};
use crate::response::harmonic_balance::ContactInterface;

/// One pair of the wheel.
struct Pair {
    parameters: PairParameters,
    /// Rows of its normal, first and second tangential motion.
    rows: [Option<usize>; 3],
}

/// All pairs, sector after sector.
pub(super) struct ContactRows {
    law: ContactLaw,
    pairs: Vec<Pair>,
    springs: Vec<f64>,
}

impl ContactRows {
    /// `n_rows` contact rows of as many sectors as they make.
    pub(super) fn new(interface: &ContactInterface, n_rows: usize) -> Self {
        let sector_rows = interface.geometry.row_count().max(1);
        let mut springs = vec![0.0; n_rows];
        let mut pairs = Vec::new();
        for (sector, first) in (0..n_rows).step_by(sector_rows).enumerate() {
            for (place, places) in interface.geometry.rows.iter().enumerate() {
                let parameters = interface.pair(sector * interface.per_sector() + place);
                let rows = places.map(|place| place.map(|row| first + row));
                let kt = parameters.tangential_stiffness_n_per_m;
                let kn = parameters.normal_stiffness_n_per_m;
                let stiffness = interface.law.springs(kn, kt);
                for (row, stiffness) in rows.iter().zip(stiffness) {
                    if let Some(row) = *row {
                        springs[row] = stiffness;
                    }
                }
                pairs.push(Pair {
                    parameters: *parameters,
                    rows,
                });
            }
        }
        Self {
            law: interface.law,
            pairs,
            springs,
        }
    }

    /// Springs k of the law at every row, N/m.
    pub(super) fn springs(&self) -> &[f64] {
        &self.springs
    }

    /// Every pair at rest, without displacement and friction.
    pub(super) fn at_rest(&self) -> Vec<PairMemory> {
        let pairs = self.pairs.iter();
        pairs
            .map(|pair| PairMemory::at_rest(&pair.parameters))
            .collect()
    }

    /// Parameters of every pair.
    pub(super) fn parameters(&self) -> impl Iterator<Item = &PairParameters> {
        self.pairs.iter().map(|pair| &pair.parameters)
    }

    /// Tangential rows of every pair.
    pub(super) fn tangential_rows(&self) -> impl Iterator<Item = usize> + '_ {
        self.pairs
            .iter()
            .flat_map(|pair| [pair.rows[1], pair.rows[2]])
            .flatten()
    }

    /// Relative displacement n, t1, t2 of one pair.
    pub(super) fn gather(&self, pair: usize, displacement: &[f64]) -> [f64; 3] {
        let rows = self.pairs[pair].rows;
        rows.map(|row| row.map_or(0.0, |row| displacement[row]))
    }

    /// The memory after a straight step of every row to `displacement`, and the forces there.
    pub(super) fn march(
        &self,
        before: &[PairMemory],
        displacement: &[f64],
        after: &mut [PairMemory],
        force: &mut [f64],
    ) {
        for (index, pair) in self.pairs.iter().enumerate() {
            let at = self.gather(index, displacement);
            after[index] = march(self.law, &pair.parameters, &before[index], at);
            let after = &after[index];
            let forces = after.force_n(self.law, &pair.parameters);
            for (row, value) in pair.rows.iter().zip(forces) {
                if let Some(row) = *row {
                    force[row] = value;
                }
            }
        }
    }
}
