//! Derivative of the offset of a [`CoupledSlider`] in harmonic space.
//!
//! With the slips e (sample `r_e`, directions `n`, `m`, share `lost`) and the coefficients `G` of
//! the normal and `X` of the tangential displacement, every slip leaves the derivative
//!
//! ```text
//! Y_e = m (1 - lost) m^T Y_{e-1} - kt (n n^T + lost m m^T) dX phi(r_e) + n mu kn dG phi(r_e)
//! ```
//!
//! (the last term where `N > 0` only). It is propagated from zero together with the derivative by
//! the offset at the period's start, `M_e`; periodicity then asks for `Y_0 = (I - M)^-1 Y_last`, and
//! the projection of the history constant by stretches is
//!
//! ```text
//! sum_e Psi_e (Y_e + M_e Y_0)
//! ```

use crate::response::friction::{CoupledSlider, Slip};
use crate::response::harmonic_balance::HarmonicTransform;

/// Slopes of the law: spring and limit.
#[derive(Debug, Clone, Copy)]
pub(super) struct Slopes {
    /// kt, N/m.
    pub tangential_n_per_m: f64,
    /// Derivative of the limit by the closing, `mu kn`, N/m.
    pub limit_n_per_m: f64,
}

/// Buffers for one harmonic set.
#[derive(Debug, Clone)]
pub(super) struct CoupledDerivative {
    n_coefficients: usize,
    /// `m^T` times the derivative before the slip, then the factor of `m` after it (`width`).
    across: Vec<f64>,
    /// Factor of `n` (`width`).
    along: Vec<f64>,
    /// Derivative after the slip, along t1, then t2 (`2 * width`).
    offset: Vec<f64>,
    /// `sum_e Psi_{e,c} Y_e`, row `(c, tangent)` after row (`n_coefficients * 2 * width`).
    sums: Vec<f64>,
}

impl CoupledDerivative {
    pub(super) fn new(n_coefficients: usize) -> Self {
        let width = width(n_coefficients);
        Self {
            n_coefficients,
            across: vec![0.0; width],
            along: vec![0.0; width],
            offset: vec![0.0; 2 * width],
            sums: vec![0.0; n_coefficients * 2 * width],
        }
    }

    /// Sums over the slips of `slider`, which slips, under the normal load `normal_load`
    /// (`n_samples`).
    pub(super) fn gather(
        &mut self,
        transform: &HarmonicTransform,
        slider: &CoupledSlider,
        slopes: Slopes,
        normal_load: &[f64],
    ) {
        let n = self.n_coefficients;
        let width = width(n);
        self.offset.fill(0.0);
        self.sums.fill(0.0);
        // The derivative by the offset at the start.
        self.offset[3 * n] = 1.0;
        self.offset[width + 3 * n + 1] = 1.0;
        let slips = slider.slips();
        for (e, slip) in slips.iter().enumerate() {
            self.pass(transform, slip, slopes, normal_load[slip.sample] > 0.0);
            for (c, rows) in self.sums.chunks_exact_mut(2 * width).enumerate() {
                let cumulative = transform.cumulative_projection(c);
                let from = cumulative[slip.sample];
                let held = match slips.get(e + 1) {
                    Some(next) => cumulative[next.sample] - from,
                    None => (cumulative[cumulative.len() - 1] - from) + cumulative[slips[0].sample],
                };
                let terms = rows.iter_mut().zip(&self.offset);
                terms.for_each(|(sum, offset)| *sum += held * offset);
            }
        }
        self.close(slider);
    }

    /// Derivative after a slip from that before it.
    fn pass(
        &mut self,
        transform: &HarmonicTransform,
        slip: &Slip,
        slopes: Slopes,
        is_pressed: bool,
    ) {
        let n_coefficients = self.n_coefficients;
        let (n, m, kept) = (slip.direction, slip.across(), 1.0 - slip.lost);
        let (first, second) = self.offset.split_at_mut(width(n_coefficients));
        for ((across, y1), y2) in self.across.iter_mut().zip(&*first).zip(&*second) {
            *across = kept * (m[0] * y1 + m[1] * y2);
        }
        let kt = slopes.tangential_n_per_m;
        let limit = if is_pressed {
            slopes.limit_n_per_m
        } else {
            0.0
        };
        for c in 0..n_coefficients {
            let phi = transform.basis(c)[slip.sample];
            self.along[c] = limit * phi;
            for tangent in 0..2 {
                let column = (1 + tangent) * n_coefficients + c;
                self.along[column] = -kt * n[tangent] * phi;
                self.across[column] -= slip.lost * kt * m[tangent] * phi;
            }
        }
        let factors = self.across.iter().zip(&self.along);
        for ((y1, y2), (across, along)) in first.iter_mut().zip(second).zip(factors) {
            *y1 = m[0] * across + n[0] * along;
            *y2 = m[1] * across + n[1] * along;
        }
    }

    /// Adds the part of the periodic start to the sums.
    fn close(&mut self, slider: &CoupledSlider) {
        let n = self.n_coefficients;
        let width = width(n);
        for column in 0..3 * n {
            let last = [self.offset[column], self.offset[width + column]];
            // Without a common contraction there is no start to be determined, and a constant
            // offset has no harmonics.
            let Some(start) = slider.close(last) else {
                continue;
            };
            for row in self.sums.chunks_exact_mut(width) {
                row[column] += row[3 * n] * start[0] + row[3 * n + 1] * start[1];
            }
        }
    }

    /// Derivative of the coefficients of the offset along `tangent` by those of the displacement
    /// in `direction` (0 the normal, 1 and 2 the tangents), row after row.
    pub(super) fn fill(&self, tangent: usize, direction: usize, block: &mut [f64]) {
        let n = self.n_coefficients;
        let rows = self.sums.chunks_exact(width(n)).skip(tangent).step_by(2);
        for (target, row) in block.chunks_exact_mut(n).zip(rows) {
            target.copy_from_slice(&row[direction * n..][..n]);
        }
    }
}

/// Columns: the coefficients of the three directions, then the offset at the period's start.
fn width(n_coefficients: usize) -> usize {
    3 * n_coefficients + 2
}
