//! Derivatives of the contact forces of a pair whose tangents do not couple.
//!
//! With `W`, `V` sums over the clips (sample `r_e`, sign `s_e`) of a slider and `Psi_e` the sum of `psi` over the samples
//! that clip e rules,
//!
//! ```text
//! W_{cc'} = sum_e Psi_{e,c} phi_c'(r_e),    V_{cc'} = sum_e s_e Psi_{e,c} phi_c'(r_e)
//! d(tangential)/d(tangential) = -kt W,      d(tangential)/d(normal) = mu kn V
//! d(normal)/d(normal)_{cc'}   = -kn sum_{j: N_j = 0} psi_c(tau_j) phi_c'(tau_j)
//! ```
//!
//! Of harmonics by themselves the sums are those over the ends of runs of clips, of which there are few. Under `coulomb_3d` the
//! sums over clips become those of `coupled_derivative`.

use std::ops::Range;

use super::PairJacobian;
use crate::linalg::dot;
use crate::response::friction::PairParameters;
use crate::response::harmonic_balance::HarmonicTransform;

/// Coefficients by which the derivatives of coefficient `c` are wanted: all `coupled` ones, or those of its
/// harmonic.
pub(super) fn wanted(transform: &HarmonicTransform, coupled: usize, c: usize) -> Range<usize> {
    if c < coupled {
        0..coupled.min(transform.n_coefficients())
    } else {
        transform.own(c)
    }
}

/// The tangential mean has no correction.
pub(super) fn clear_mean_row(block: &mut [f64], n_coefficients: usize) {
    block[..n_coefficients].fill(0.0);
}

/// The tangential mean is no input of the law.
pub(super) fn clear_mean_column(block: &mut [f64], n_coefficients: usize) {
    let column = block.iter_mut().step_by(n_coefficients);
    column.for_each(|entry| *entry = 0.0);
}

/// Derivatives of the laws that leave the tangents uncoupled.
pub(super) struct ClipSlopes<'a> {
    pub(super) transform: &'a HarmonicTransform,
    /// See [`super::PairHarmonics::couple_first`].
    pub(super) coupled: usize,
    pub(super) variable_load: bool,
    pub(super) parameters: &'a PairParameters,
}

impl ClipSlopes<'_> {
    /// The derivative of the limit by the normal displacement, N/m; a constant load has none.
    pub(super) fn limit(&self) -> f64 {
        if self.variable_load {
            self.parameters.friction_coefficient * self.parameters.normal_stiffness_n_per_m
        } else {
            0.0
        }
    }

    /// Derivatives by the normal displacement, of a pair with this normal load, N, over the samples.
    pub(super) fn normal(
        &self,
        sums: &mut ClipSums,
        normal_load: &[f64],
        jacobian: &mut PairJacobian,
    ) {
        sums.gather_separated(self.transform, normal_load);
        let wanted = |c| wanted(self.transform, self.coupled, c);
        let stiffness = self.parameters.normal_stiffness_n_per_m;
        sums.fill_normal(-stiffness, wanted, &mut jacobian.normal_normal);
    }

    /// Of a slider that slips, by its clips (samples, signs).
    pub(super) fn tangential(
        &self,
        sums: &mut ClipSums,
        tangent: usize,
        (samples, signs): (&[usize], &[f64]),
        jacobian: &mut PairJacobian,
    ) {
        let by_tangential = &mut jacobian.tangential_tangential[tangent];
        let by_normal = &mut jacobian.tangential_normal[tangent];
        let factors = [-self.parameters.tangential_stiffness_n_per_m, self.limit()];
        if self.coupled == 0 {
            self.add_runs((samples, signs), factors, [by_tangential, by_normal]);
        } else {
            sums.gather_clips(self.transform, samples, signs);
            let wanted = |c| wanted(self.transform, self.coupled, c);
            sums.fill_tangential(factors, wanted, by_tangential, by_normal);
        }
        if self.transform.has_mean() {
            let n_coefficients = self.transform.n_coefficients();
            clear_mean_row(by_tangential, n_coefficients);
            clear_mean_row(by_normal, n_coefficients);
            clear_mean_column(by_tangential, n_coefficients);
        }
    }

    /// The tangential blocks of every harmonic by itself, into cleared ones. Along a run, clips of one sign at neighbouring samples,
    /// every clip but the last rules its own sample alone: their sums are those of products up to the ends of the run.
    fn add_runs(
        &self,
        (samples, signs): (&[usize], &[f64]),
        [by_displacement, by_limit]: [f64; 2],
        [by_tangential, by_normal]: [&mut [f64]; 2],
    ) {
        let transform = self.transform;
        let n = transform.n_coefficients();
        let mut first = 0;
        for last in 0..samples.len() {
            let next = samples.get(last + 1);
            let goes_on = next == Some(&(samples[last] + 1))
                && signs[last + 1].total_cmp(&signs[last]).is_eq();
            if goes_on {
                continue;
            }
            let sample = samples[last];
            let before = transform.own_products_to(samples[first]);
            let up_to = transform.own_products_to(sample);
            for c in 0..n {
                let cumulative = transform.cumulative_projection(c);
                let ruled = next.map_or_else(
                    || cumulative[transform.n_samples()] + cumulative[samples[0]],
                    |&next| cumulative[next],
                ) - cumulative[sample];
                for (place, other) in transform.own(c).enumerate() {
                    let run = up_to[c][place] - before[c][place];
                    let sum = run + ruled * transform.basis(other)[sample];
                    by_tangential[c * n + other] += by_displacement * sum;
                    by_normal[c * n + other] += by_limit * signs[last] * sum;
                }
            }
            first = last + 1;
        }
    }
}

/// Factors of the sums over events (clips, or separated samples), coefficient after coefficient
/// with a stride of `n_samples`.
#[derive(Debug, Clone)]
pub(super) struct ClipSums {
    n_coefficients: usize,
    n_samples: usize,
    n_events: usize,
    /// `Psi_{e,c}`.
    held: Vec<f64>,
    /// `s_e Psi_{e,c}`.
    held_signed: Vec<f64>,
    /// `phi_c(r_e)`.
    moved: Vec<f64>,
}

impl ClipSums {
    pub(super) fn new(n_coefficients: usize, n_samples: usize) -> Self {
        let zero = || vec![0.0; n_coefficients * n_samples];
        Self {
            n_coefficients,
            n_samples,
            n_events: 0,
            held: zero(),
            held_signed: zero(),
            moved: zero(),
        }
    }

    /// Factors of the clips of a slipping slider.
    fn gather_clips(&mut self, transform: &HarmonicTransform, samples: &[usize], signs: &[f64]) {
        self.n_events = samples.len();
        let (Some(&first), Some(&last)) = (samples.first(), samples.last()) else {
            return;
        };
        for c in 0..self.n_coefficients {
            let rows = c * self.n_samples..c * self.n_samples + samples.len();
            let (basis, cumulative) = (transform.basis(c), transform.cumulative_projection(c));
            let held = &mut self.held[rows.clone()];
            for (held, pair) in held.iter_mut().zip(samples.windows(2)) {
                *held = cumulative[pair[1]] - cumulative[pair[0]];
            }
            held[samples.len() - 1] =
                (cumulative[self.n_samples] - cumulative[last]) + cumulative[first];
            let held_signed = self.held_signed[rows.clone()].iter_mut();
            held_signed
                .zip(held)
                .zip(signs)
                .for_each(|((signed, held), sign)| *signed = sign * *held);
            let moved = self.moved[rows].iter_mut();
            moved.zip(samples).for_each(|(moved, &r)| *moved = basis[r]);
        }
    }

    /// Factors of the samples without normal load.
    fn gather_separated(&mut self, transform: &HarmonicTransform, normal_load: &[f64]) {
        for c in 0..self.n_coefficients {
            let scale = transform.projection_scale(c);
            let mut n_events = 0;
            for (&load, &phi) in normal_load.iter().zip(transform.basis(c)) {
                self.held[c * self.n_samples + n_events] = scale * phi;
                self.moved[c * self.n_samples + n_events] = phi;
                n_events += usize::from(load == 0.0);
            }
            self.n_events = n_events;
        }
    }

    /// `block_{cc'} = factor sum_e held_{e,c} moved_{e,c'}`.
    fn fill_normal(&self, factor: f64, wanted: impl Fn(usize) -> Range<usize>, block: &mut [f64]) {
        for (c, row) in block.chunks_exact_mut(self.n_coefficients).enumerate() {
            for other in wanted(c) {
                row[other] =
                    factor * dot(self.events(&self.held, c), self.events(&self.moved, other));
            }
        }
    }

    /// `by_tangential = tangential_factor W`, `by_normal = normal_factor V`.
    fn fill_tangential(
        &self,
        [tangential_factor, normal_factor]: [f64; 2],
        wanted: impl Fn(usize) -> Range<usize>,
        by_tangential: &mut [f64],
        by_normal: &mut [f64],
    ) {
        let n = self.n_coefficients;
        for c in 0..n {
            let held = [
                self.events(&self.held, c),
                self.events(&self.held_signed, c),
            ];
            // Two columns at a time; an odd last one is paired with itself.
            let others = wanted(c);
            for first in others.clone().step_by(2) {
                let second = (first + 1).min(others.end - 1);
                let moved = [
                    self.events(&self.moved, first),
                    self.events(&self.moved, second),
                ];
                let [w, v] = dots(held, moved);
                for (other, w, v) in [(first, w[0], v[0]), (second, w[1], v[1])] {
                    by_tangential[c * n + other] = tangential_factor * w;
                    by_normal[c * n + other] = normal_factor * v;
                }
            }
        }
    }

    /// The events of coefficient `c`.
    fn events<'a>(&self, factors: &'a [f64], c: usize) -> &'a [f64] {
        &factors[c * self.n_samples..][..self.n_events]
    }
}

/// `a_i . b_j`: each vector is read once for two products.
fn dots(a: [&[f64]; 2], b: [&[f64]; 2]) -> [[f64; 2]; 2] {
    const LANES: usize = 4;
    let length = a[0].len();
    let [a0, a1] = a.map(|values| values[..length].as_chunks::<LANES>());
    let [b0, b1] = b.map(|values| values[..length].as_chunks::<LANES>());
    let mut sums = [[[0.0; LANES]; 2]; 2];
    for (((a0, a1), b0), b1) in a0.0.iter().zip(a1.0).zip(b0.0).zip(b1.0) {
        for lane in 0..LANES {
            sums[0][0][lane] += a0[lane] * b0[lane];
            sums[0][1][lane] += a0[lane] * b1[lane];
            sums[1][0][lane] += a1[lane] * b0[lane];
            sums[1][1][lane] += a1[lane] * b1[lane];
        }
    }
    let rest = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let total = |lanes: [f64; LANES]| lanes.into_iter().sum::<f64>();
    [
        [
            total(sums[0][0]) + rest(a0.1, b0.1),
            total(sums[0][1]) + rest(a0.1, b1.1),
        ],
        [
            total(sums[1][0]) + rest(a1.1, b0.1),
            total(sums[1][1]) + rest(a1.1, b1.1),
        ],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_by_runs_are_the_sums_over_all_clips() {
        let parameters = PairParameters {
            friction_coefficient: 0.3,
            tangential_stiffness_n_per_m: 2.0,
            normal_stiffness_n_per_m: 5.0,
            normal_load_n: 1.0,
        };
        let transform = HarmonicTransform::new(&[0, 1, 2, 5], 32).expect("a set");
        let n = transform.n_coefficients();
        // Runs of either sign side by side, with gaps, over the end of the period, a clip at both bounds, and one clip alone.
        let cases: [(&[usize], &[f64]); 3] = [
            (
                &[0, 1, 2, 7, 8, 9, 10, 15, 16, 30, 31],
                &[1.0, 1.0, 1.0, -1.0, -1.0, 1.0, 1.0, 0.0, -1.0, 1.0, 1.0],
            ),
            (&[5, 6, 7, 20], &[-1.0, -1.0, -1.0, 1.0]),
            (&[12], &[1.0]),
        ];
        for (samples, signs) in cases {
            let [by_runs, by_clips] = [0, 99].map(|coupled| {
                let slopes = ClipSlopes {
                    transform: &transform,
                    coupled,
                    variable_load: true,
                    parameters: &parameters,
                };
                let mut jacobian = PairJacobian::new(n);
                let mut sums = ClipSums::new(n, transform.n_samples());
                slopes.tangential(&mut sums, 1, (samples, signs), &mut jacobian);
                jacobian
            });
            for c in 0..n {
                for other in transform.own(c) {
                    for block in [1, 2] {
                        let of = |jacobian: &PairJacobian| {
                            let blocks = [
                                &jacobian.tangential_tangential[1],
                                &jacobian.tangential_normal[1],
                            ];
                            blocks[block - 1][c * n + other]
                        };
                        let difference = of(&by_runs) - of(&by_clips);
                        assert!(difference.abs() < 1e-14, "{c} {other} {difference}");
                    }
                }
            }
        }
    }
}
