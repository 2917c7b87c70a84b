//! Real fields over the sectors of a wheel and their waves 0..=N/2.
//!
//! ```text
//! x_n = (1/sqrt N) (sum_h w_h Re(X_h e^{i h n alpha})),    X_h = (1/sqrt N) sum_n x_n e^{-i h n alpha}
//! ```
//!
//! with the weight 1 for h = 0 and N/2 and 2 for all others, each of which stands for its conjugate wave as well.

use crate::linalg::{Matrix, set_times};
use crate::model::cyclic::phase;

/// Transform of real fields. Sector after sector, or wave after wave with the real parts of all channels before the
/// imaginary ones.
#[derive(Debug)]
pub(super) struct SectorWaves {
    sectors: usize,
    /// `2 waves x N`, and `N x 2 waves`.
    synthesis: Matrix<f64>,
    analysis: Matrix<f64>,
}

impl SectorWaves {
    pub(super) fn new(sectors: usize) -> Self {
        let waves = sectors / 2 + 1;
        let scale = 1.0 / (sectors as f64).sqrt();
        let part = |row: usize, n: usize| {
            let turn = phase(row / 2, n, sectors) * scale;
            if row.is_multiple_of(2) {
                turn.re
            } else {
                -turn.im
            }
        };
        let weight = |row: usize| {
            if Self::real(row / 2, sectors) {
                1.0
            } else {
                2.0
            }
        };
        Self {
            sectors,
            synthesis: Matrix::from_fn(2 * waves, sectors, |row, n| weight(row) * part(row, n)),
            analysis: Matrix::from_fn(sectors, 2 * waves, |n, row| part(row, n)),
        }
    }

    fn real(h: usize, sectors: usize) -> bool {
        h == 0 || 2 * h == sectors
    }

    pub(super) fn sectors(&self) -> usize {
        self.sectors
    }

    pub(super) fn to_sectors(&self, waves: &[f64], channels: usize, field: &mut [f64]) {
        let size = (channels, self.sectors, self.synthesis.rows());
        set_times(field, waves, self.synthesis.as_slice(), size);
    }

    pub(super) fn to_waves(&self, field: &[f64], channels: usize, waves: &mut [f64]) {
        let size = (channels, self.analysis.columns(), self.sectors);
        set_times(waves, field, self.analysis.as_slice(), size);
    }

    /// Of a circulant matrix, given by its waves as `[Re, -Im; Im, Re]`, the block of a sector by itself.
    pub(super) fn sector_block(
        &self,
        waves: &[Matrix<f64>],
        (rows, columns): (usize, usize),
    ) -> Matrix<f64> {
        let mut block = Matrix::zeros(rows, columns);
        for (h, wave) in waves.iter().enumerate() {
            let weight = if Self::real(h, self.sectors) {
                1.0
            } else {
                2.0
            };
            for j in 0..columns {
                for i in 0..rows {
                    block[(i, j)] += weight / self.sectors as f64 * wave[(i, j)];
                }
            }
        }
        block
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_field_comes_back_from_its_waves_and_the_waves_of_one_sector_are_its_turns() {
        for sectors in [1, 2, 5, 8] {
            let transform = SectorWaves::new(sectors);
            let channels = 3;
            let field: Vec<f64> = (0..channels * sectors)
                .map(|i| (1.7 * i as f64 + 0.3).sin())
                .collect();
            let mut waves = vec![0.0; channels * 2 * (sectors / 2 + 1)];
            transform.to_waves(&field, channels, &mut waves);
            let mut back = vec![0.0; field.len()];
            transform.to_sectors(&waves, channels, &mut back);
            for (a, b) in field.iter().zip(&back) {
                assert!((a - b).abs() < 1e-14, "{sectors}");
            }
            for h in 0..=sectors / 2 {
                let turned = (0..sectors).map(|n| {
                    phase(h, n, sectors).conj() * field[n * channels] / (sectors as f64).sqrt()
                });
                let wave = turned.fold(crate::linalg::Complex64::default(), |a, b| a + b);
                assert!((wave.re - waves[2 * h * channels]).abs() < 1e-14);
                assert!((wave.im - waves[(2 * h + 1) * channels]).abs() < 1e-14);
            }
        }
    }
}
