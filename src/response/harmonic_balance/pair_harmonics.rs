//! One contact pair in harmonic space: coefficients of its displacement to those of its force, with
//! derivatives.
//!
//! Alternating frequency/time: synthesise the histories, apply the law, project. Forces are
//! *corrections* to the linear stuck force, see [`ContactHistory`]; with `W`, `V` sums over the
//! clips (sample `r_e`, sign `s_e`) of a slider and `Psi_e` the sum of `psi` over the samples that
//! clip e rules,
//!
//! ```text
//! W_{cc'} = sum_e Psi_{e,c} phi_c'(r_e),    V_{cc'} = sum_e s_e Psi_{e,c} phi_c'(r_e)
//! d(tangential)/d(tangential) = -kt W,      d(tangential)/d(normal) = mu kn V
//! d(normal)/d(normal)_{cc'}   = -kn sum_{j: N_j = 0} psi_c(tau_j) phi_c'(tau_j)
//! ```
//!
//! The mean of the tangential displacement is no input of the law and its correction is zero (its
//! force is the linear `kt u_0`), so coefficient 0 of a set with harmonic 0 gives zero rows
//! and columns in the tangential directions. Under `coulomb_3d` the sums over clips become those of
//! `coupled_derivative`.

use std::ops::Range;
use std::sync::Arc;

use super::coupled_derivative::{CoupledDerivative, Slopes};
use super::{HarmonicTransform, PairJacobian, TransformScratch};
use crate::linalg::dot;
use crate::response::friction::{
    ContactHistory, ContactLaw, PairDisplacement, PairParameters, PairState,
};

/// Evaluates pairs of one law and one harmonic set; owns the buffers, so each thread has its own.
#[derive(Debug, Clone)]
pub struct PairHarmonics {
    law: ContactLaw,
    transform: Arc<HarmonicTransform>,
    scratch: TransformScratch,
    /// Coefficients without tangential means (`3 * n_coefficients`).
    oscillation: Vec<f64>,
    /// Histories along n, t1, t2 (`3 * n_samples`).
    displacement: Vec<f64>,
    history: ContactHistory,
    /// Growth of the tangential displacement per period, m.
    drift_m: [f64; 2],
    /// Coefficients, the first ones, whose derivatives by each other are wanted; of the others only those by
    /// their own harmonic.
    coupled_first: usize,
    sums: ClipSums,
    coupled: CoupledDerivative,
}

impl PairHarmonics {
    /// Buffers for `law` on the harmonics and samples of `transform`.
    #[must_use]
    pub fn new(law: ContactLaw, transform: Arc<HarmonicTransform>) -> Self {
        let (n_samples, n_coefficients) = (transform.n_samples(), transform.n_coefficients());
        Self {
            law,
            scratch: transform.scratch(),
            oscillation: vec![0.0; 3 * n_coefficients],
            displacement: vec![0.0; 3 * n_samples],
            history: ContactHistory::new(n_samples),
            drift_m: [0.0; 2],
            coupled_first: usize::MAX,
            sums: ClipSums::new(n_coefficients, n_samples),
            coupled: CoupledDerivative::new(n_coefficients),
            transform,
        }
    }

    /// The transform: harmonics, samples, order of the coefficients.
    #[must_use]
    pub fn transform(&self) -> &HarmonicTransform {
        &self.transform
    }

    /// Histories of the pair last evaluated.
    #[must_use]
    pub fn history(&self) -> &ContactHistory {
        &self.history
    }

    /// Sets by how much the tangential displacement of the pairs evaluated next grows per period
    /// besides its harmonics, m; zero at first.
    pub fn set_drift(&mut self, drift_m: [f64; 2]) {
        self.drift_m = drift_m;
    }

    /// From now on derivatives of one harmonic by another are left out (not under `coulomb_3d`), they remain
    /// zero; but for those of the first `coefficients` by each other.
    pub(super) fn couple_first(&mut self, coefficients: usize) {
        self.coupled_first = coefficients;
    }

    /// The coefficients last given to [`Self::couple_first`].
    pub(super) fn coupled_first(&self) -> usize {
        self.coupled_first
    }

    /// Corrections of one pair, and where wanted their derivative.
    ///
    /// `coefficients`, m, and `correction`, N (`3 * n_coefficients` each): those of n, then t1,
    /// then t2, each in the order of [`HarmonicTransform`]. `jacobian` is overwritten. A pair that
    /// neither slips nor separates has zero correction and zero Jacobian, exactly.
    pub fn evaluate(
        &mut self,
        parameters: &PairParameters,
        coefficients: &[f64],
        correction: &mut [f64],
        jacobian: Option<&mut PairJacobian>,
    ) -> PairState {
        let n_coefficients = self.transform.n_coefficients();
        self.oscillation.copy_from_slice(coefficients);
        if self.transform.has_mean() {
            self.oscillation[n_coefficients] = 0.0;
            self.oscillation[2 * n_coefficients] = 0.0;
        }
        correction.fill(0.0);
        let drifts = self.drift_m.iter().any(|drift| drift.abs() > 0.0);
        let state = if !drifts && parameters.surely_sticks(self.law, self.excursions()) {
            self.history.rest(parameters)
        } else {
            self.respond(parameters)
        };
        if state.slipping || state.separated {
            self.project(correction);
        }
        if let Some(jacobian) = jacobian {
            jacobian.clear();
            if state.slipping || state.separated {
                self.differentiate(parameters, jacobian);
            }
        }
        state
    }

    /// Upper bounds on the displacement along n, t1, t2, m: the sum of the amplitudes of the
    /// harmonics.
    fn excursions(&self) -> [f64; 3] {
        let n_coefficients = self.transform.n_coefficients();
        let first = usize::from(self.transform.has_mean());
        std::array::from_fn(|direction| {
            let (mean, oscillation) =
                self.oscillation[direction * n_coefficients..][..n_coefficients].split_at(first);
            let amplitude = |pair: &[f64]| (pair[0] * pair[0] + pair[1] * pair[1]).sqrt();
            mean.iter().map(|mean| mean.abs()).sum::<f64>()
                + oscillation.chunks_exact(2).map(amplitude).sum::<f64>()
        })
    }

    /// Displacement histories and the response of the law to them.
    fn respond(&mut self, parameters: &PairParameters) -> PairState {
        let n_samples = self.transform.n_samples();
        self.transform
            .synthesize(&self.oscillation, &mut self.displacement, &mut self.scratch);
        let (normal, tangential) = self.displacement.split_at(n_samples);
        let (first, second) = tangential.split_at(n_samples);
        let displacement = PairDisplacement {
            normal,
            tangential: [first, second],
        };
        self.history
            .respond_drifting(self.law, parameters, displacement, self.drift_m)
    }

    /// Coefficients of the corrections that are not zero.
    fn project(&mut self, correction: &mut [f64]) {
        let n_coefficients = self.transform.n_coefficients();
        let (normal, tangential) = correction.split_at_mut(n_coefficients);
        if self.history.state().separated {
            self.transform.project(
                self.history.normal_correction_n(),
                normal,
                &mut self.scratch,
            );
        }
        if self.law == ContactLaw::Coulomb3d {
            let slider = self.history.coupled_slider();
            if slider.is_slipping() {
                self.transform
                    .project(slider.offsets_n(), tangential, &mut self.scratch);
                if self.transform.has_mean() {
                    (tangential[0], tangential[n_coefficients]) = (0.0, 0.0);
                }
            }
            return;
        }
        let sliders = self.history.sliders().iter();
        for (slider, correction) in sliders.zip(tangential.chunks_exact_mut(n_coefficients)) {
            if slider.is_slipping() {
                self.transform
                    .project(slider.offset_n(), correction, &mut self.scratch);
                if self.transform.has_mean() {
                    correction[0] = 0.0;
                }
            }
        }
    }

    /// Blocks of the Jacobian that are not zero, into cleared blocks.
    fn differentiate(&mut self, parameters: &PairParameters, jacobian: &mut PairJacobian) {
        let variable_load = self.law.has_variable_load();
        if self.law != ContactLaw::Coulomb3d {
            self.history.locate_clips();
        }
        let Self {
            history,
            transform,
            sums,
            ..
        } = self;
        let slopes = ClipSlopes {
            transform,
            coupled: self.coupled_first,
            variable_load,
            parameters,
        };
        if variable_load && history.state().separated {
            slopes.normal(sums, history.normal_load_n(), jacobian);
        }
        if self.law == ContactLaw::Coulomb3d {
            let slopes = Slopes {
                tangential_n_per_m: parameters.tangential_stiffness_n_per_m,
                limit_n_per_m: slopes.limit(),
            };
            self.differentiate_coupled(slopes, jacobian);
            return;
        }
        for (tangent, slider) in history.sliders().iter().enumerate() {
            if slider.is_slipping() {
                let clips = (slider.clip_samples(), slider.clip_signs());
                slopes.tangential(sums, tangent, clips, jacobian);
            }
        }
    }

    /// The same from what is known of a pair under `simplified_3d`: its normal load where it separates, and the clips
    /// (samples, signs) of its sliders that slip.
    pub(super) fn differentiate_clips(
        &mut self,
        parameters: &PairParameters,
        normal_load: Option<&[f64]>,
        clips: [Option<(&[usize], &[f64])>; 2],
        jacobian: &mut PairJacobian,
    ) {
        let slopes = ClipSlopes {
            transform: &self.transform,
            coupled: self.coupled_first,
            variable_load: true,
            parameters,
        };
        if let Some(load) = normal_load {
            slopes.normal(&mut self.sums, load, jacobian);
        }
        for (tangent, clips) in clips.into_iter().enumerate() {
            if let Some(clips) = clips {
                slopes.tangential(&mut self.sums, tangent, clips, jacobian);
            }
        }
    }

    /// Tangential blocks under `coulomb_3d`.
    fn differentiate_coupled(&mut self, slopes: Slopes, jacobian: &mut PairJacobian) {
        let slider = self.history.coupled_slider();
        if !slider.is_slipping() {
            return;
        }
        let load = self.history.normal_load_n();
        self.coupled.gather(&self.transform, slider, slopes, load);
        let n = self.transform.n_coefficients();
        let has_mean = self.transform.has_mean();
        let cross = jacobian
            .tangential_cross
            .get_or_insert_with(|| [vec![0.0; n * n], vec![0.0; n * n]]);
        let by_normal = jacobian.tangential_normal.iter_mut();
        let blocks = by_normal
            .zip(&mut jacobian.tangential_tangential)
            .zip(cross);
        for (tangent, ((by_normal, by_own), by_other)) in blocks.enumerate() {
            let blocks = [
                (0, by_normal),
                (1 + tangent, by_own),
                (2 - tangent, by_other),
            ];
            for (direction, block) in blocks {
                self.coupled.fill(tangent, direction, block);
                if has_mean {
                    clear_mean_row(block, n);
                    if direction > 0 {
                        clear_mean_column(block, n);
                    }
                }
            }
        }
    }
}

/// Coefficients by which the derivatives of coefficient `c` are wanted: all `coupled` ones, or those of its
/// harmonic.
pub(super) fn wanted(transform: &HarmonicTransform, coupled: usize, c: usize) -> Range<usize> {
    let mean = usize::from(transform.has_mean());
    if c < coupled {
        0..coupled.min(transform.n_coefficients())
    } else if c < mean {
        0..mean
    } else {
        let first = c - (c - mean) % 2;
        first..first + 2
    }
}

/// The tangential mean has no correction.
fn clear_mean_row(block: &mut [f64], n_coefficients: usize) {
    block[..n_coefficients].fill(0.0);
}

/// The tangential mean is no input of the law.
fn clear_mean_column(block: &mut [f64], n_coefficients: usize) {
    let column = block.iter_mut().step_by(n_coefficients);
    column.for_each(|entry| *entry = 0.0);
}

/// Derivatives of the laws that leave the tangents uncoupled.
struct ClipSlopes<'a> {
    transform: &'a HarmonicTransform,
    /// See [`PairHarmonics::couple_first`].
    coupled: usize,
    variable_load: bool,
    parameters: &'a PairParameters,
}

impl ClipSlopes<'_> {
    /// The derivative of the limit by the normal displacement, N/m; a constant load has none.
    fn limit(&self) -> f64 {
        if self.variable_load {
            self.parameters.friction_coefficient * self.parameters.normal_stiffness_n_per_m
        } else {
            0.0
        }
    }

    fn normal(&self, sums: &mut ClipSums, normal_load: &[f64], jacobian: &mut PairJacobian) {
        sums.gather_separated(self.transform, normal_load);
        let wanted = |c| wanted(self.transform, self.coupled, c);
        let stiffness = self.parameters.normal_stiffness_n_per_m;
        sums.fill_normal(-stiffness, wanted, &mut jacobian.normal_normal);
    }

    fn tangential(
        &self,
        sums: &mut ClipSums,
        tangent: usize,
        (samples, signs): (&[usize], &[f64]),
        jacobian: &mut PairJacobian,
    ) {
        let by_tangential = &mut jacobian.tangential_tangential[tangent];
        let by_normal = &mut jacobian.tangential_normal[tangent];
        sums.gather_clips(self.transform, samples, signs);
        let wanted = |c| wanted(self.transform, self.coupled, c);
        let factors = [-self.parameters.tangential_stiffness_n_per_m, self.limit()];
        sums.fill_tangential(factors, wanted, by_tangential, by_normal);
        if self.transform.has_mean() {
            let n_coefficients = self.transform.n_coefficients();
            clear_mean_row(by_tangential, n_coefficients);
            clear_mean_row(by_normal, n_coefficients);
            clear_mean_column(by_tangential, n_coefficients);
        }
    }
}

/// Factors of the sums over events (clips, or separated samples), coefficient after coefficient
/// with a stride of `n_samples`.
#[derive(Debug, Clone)]
struct ClipSums {
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
    fn new(n_coefficients: usize, n_samples: usize) -> Self {
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
