//! One contact pair in harmonic space: coefficients of its displacement to those of its force, with
//! derivatives.
//!
//! Alternating frequency/time: synthesise the histories, apply the law, project. Forces are
//! *corrections* to the linear stuck force, see [`ContactHistory`]. Derivatives are those of `clip_slopes`.
//!
//! The mean of the tangential displacement is no input of the law and its correction is zero (its
//! force is the linear `kt u_0`), so coefficient 0 of a set with harmonic 0 gives zero rows
//! and columns in the tangential directions.

use std::sync::Arc;

use super::PairJacobian;
use super::clip_slopes::{ClipSlopes, ClipSums, clear_mean_column, clear_mean_row};
use super::coupled_derivative::{CoupledDerivative, Slopes};
use crate::response::friction::{
    ContactHistory, ContactLaw, PairDisplacement, PairParameters, PairState,
};
use crate::response::harmonic_balance::{HarmonicTransform, TransformScratch};

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
    /// Number of leading coefficients whose derivatives by each other are needed; the remaining ones need only
    /// those by their own harmonic.
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
    pub(in crate::response::harmonic_balance) fn couple_first(&mut self, coefficients: usize) {
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
        if self.law.couples_tangents() {
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
        if !self.law.couples_tangents() {
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
        if self.law.couples_tangents() {
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

    /// Blocks of the Jacobian of a pair under `simplified_3d` that are not zero, into cleared blocks, from what is
    /// known of it: its normal load where it separates, and the clips (samples, signs) of its sliders that slip.
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
