//! One pair of contact nodes: its parameters, its displacement history and what the chosen law
//! makes of it.

use serde::Serialize;

use super::{CoupledSlider, PeriodicSlider, TangentialFriction};
use crate::model::cyclic::ContactGeometry;
use crate::response::mistuning::{ContactFactors, PairFactors};

/// Parameters of one pair: the per-sector values of the study times the weight of the pair.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PairParameters {
    /// Static normal load N0 of the pair, N, >= 0.
    pub normal_load_n: f64,
    /// Normal stiffness kn of the pair, N/m.
    pub normal_stiffness_n_per_m: f64,
    /// Tangential stiffness kt of the pair, N/m, in either tangential direction.
    pub tangential_stiffness_n_per_m: f64,
    /// Coefficient of friction mu.
    pub friction_coefficient: f64,
}

impl PairParameters {
    /// The parameters of a pair that has `weight` of the sector's contact; mu is no share.
    #[must_use]
    pub fn share(self, weight: f64) -> Self {
        Self {
            normal_load_n: weight * self.normal_load_n,
            normal_stiffness_n_per_m: weight * self.normal_stiffness_n_per_m,
            tangential_stiffness_n_per_m: weight * self.tangential_stiffness_n_per_m,
            friction_coefficient: self.friction_coefficient,
        }
    }

    /// The pairs of a sector under this normal load, each with its share of stiffness and load.
    pub fn pairs(self, geometry: &ContactGeometry) -> impl Iterator<Item = Self> + Clone {
        let shares = geometry.weights.iter().zip(&geometry.load_weights);
        shares.map(move |(&weight, &load_weight)| Self {
            normal_load_n: load_weight * self.normal_load_n,
            ..self.share(weight)
        })
    }

    /// The pairs of a sector under the normal load `normal_load_n`, N per sector; the pairs of the
    /// whole wheel where `factors` vary them.
    #[must_use]
    pub fn pairs_under(
        self,
        normal_load_n: f64,
        geometry: &ContactGeometry,
        factors: &ContactFactors,
    ) -> Vec<Self> {
        let sector = Self {
            normal_load_n,
            ..self
        };
        let nominal = sector.pairs(geometry);
        if factors.is_nominal() {
            return nominal.collect();
        }
        let varied = factors.pairs().iter().zip(nominal.cycle());
        varied.map(|(factors, pair)| pair.varied(factors)).collect()
    }

    /// This pair with each parameter multiplied by its factor.
    #[must_use]
    pub fn varied(self, factors: &PairFactors) -> Self {
        Self {
            normal_load_n: factors.normal_load * self.normal_load_n,
            normal_stiffness_n_per_m: factors.normal_stiffness * self.normal_stiffness_n_per_m,
            tangential_stiffness_n_per_m: factors.tangential_stiffness
                * self.tangential_stiffness_n_per_m,
            friction_coefficient: factors.friction_coefficient * self.friction_coefficient,
        }
    }
}

/// Relative displacement `u_blisk - u_ring` of a pair over one period, m; each history has
/// `n_samples` samples.
#[derive(Debug, Clone, Copy)]
pub struct PairDisplacement<'a> {
    /// Closing `g_j` (positive = pressed together), its mean included where harmonic 0 is solved
    /// for.
    pub normal: &'a [f64],
    /// `x_j` along t1 and t2, without their means.
    pub tangential: [&'a [f64]; 2],
}

/// Contact state of a pair over the period.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PairState {
    /// Slips in any direction at any sample.
    pub slipping: bool,
    /// The normal load is zero at any sample.
    pub separated: bool,
    /// The periodic state was not found: the forces are those of the last period marched, and no
    /// solution may rest on them.
    pub unclosed: bool,
}

/// Response of a pair: corrections to the *linear, stuck* contact force, and what their derivatives
/// need.
///
/// The stuck force is `(kn g, kt x1, kt x2)` (for `macro_slip_1d`: `(kn g, kt x1, 0)`). Corrections
/// are formed directly, never as a difference of two forces: a pair that sticks has a correction of
/// exactly zero at any normal load.
#[derive(Debug, Clone)]
pub struct ContactHistory {
    /// `N_j`, N.
    pub(super) normal_load: Vec<f64>,
    /// `(N_j - N0) - kn g_j`, N: zero unless separated.
    pub(super) normal_correction: Vec<f64>,
    /// Sliders of the laws that leave the tangents uncoupled.
    pub(super) sliders: [PeriodicSlider; 2],
    /// Slider of `coulomb_3d`.
    pub(super) coupled: CoupledSlider,
    /// Growth of the tangential displacement per period, m.
    pub(super) drift_m: [f64; 2],
    /// Friction of the law of the response last computed.
    pub(super) friction: TangentialFriction,
    pub(super) state: PairState,
}

impl ContactHistory {
    /// Buffers for histories of `n_samples` samples.
    #[must_use]
    pub fn new(n_samples: usize) -> Self {
        Self {
            normal_load: vec![0.0; n_samples],
            normal_correction: vec![0.0; n_samples],
            sliders: [
                PeriodicSlider::new(n_samples),
                PeriodicSlider::new(n_samples),
            ],
            coupled: CoupledSlider::new(n_samples),
            drift_m: [0.0; 2],
            friction: TangentialFriction::Jenkins { tangents: 2 },
            state: PairState::default(),
        }
    }

    /// State of a pair known to stick with zero offset throughout, without looking at its history.
    pub fn rest(&mut self, parameters: &PairParameters) -> PairState {
        self.normal_load.fill(parameters.normal_load_n);
        self.normal_correction.fill(0.0);
        self.sliders.iter_mut().for_each(PeriodicSlider::rest);
        self.coupled.rest();
        self.state = PairState::default();
        self.state
    }

    /// Fills the normal load `max(0, N0 + kn g)` and the normal correction for the closing `g`;
    /// returns whether the load is zero at any sample.
    ///
    /// The correction `(N - N0) - kn g = max(0, -(N0 + kn g))` is no difference of large numbers.
    pub(super) fn press(&mut self, parameters: &PairParameters, closing: &[f64]) -> bool {
        let (n0, kn) = (
            parameters.normal_load_n,
            parameters.normal_stiffness_n_per_m,
        );
        let mut separated = false;
        let outputs = self.normal_load.iter_mut().zip(&mut self.normal_correction);
        for ((load, correction), &g) in outputs.zip(closing) {
            let bilateral = n0 + kn * g;
            separated |= bilateral <= 0.0;
            *load = if bilateral > 0.0 { bilateral } else { 0.0 };
            *correction = if bilateral > 0.0 {
                0.0
            } else {
                0.0 - bilateral
            };
        }
        separated
    }

    /// Finds what the derivatives of the tangential corrections need.
    pub fn locate_clips(&mut self) {
        self.sliders
            .iter_mut()
            .for_each(PeriodicSlider::locate_clips);
    }

    /// State of the response last computed.
    #[must_use]
    pub fn state(&self) -> PairState {
        self.state
    }

    /// Normal load `N_j`, N (`n_samples`); the static load where the law has no other.
    #[must_use]
    pub fn normal_load_n(&self) -> &[f64] {
        &self.normal_load
    }

    /// Normal correction `(N_j - N0) - kn g_j`, N (`n_samples`); its derivative is `-kn` where `N_j
    /// = 0`, else 0.
    #[must_use]
    pub fn normal_correction_n(&self) -> &[f64] {
        &self.normal_correction
    }

    /// Slider of `coulomb_3d`.
    #[must_use]
    pub fn coupled_slider(&self) -> &CoupledSlider {
        &self.coupled
    }

    /// Sliders along t1 and t2 of the laws that leave the tangents uncoupled.
    #[must_use]
    pub fn sliders(&self) -> &[PeriodicSlider; 2] {
        &self.sliders
    }
}
