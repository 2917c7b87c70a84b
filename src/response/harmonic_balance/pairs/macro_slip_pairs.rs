//! The pairs of a wheel under a constant normal load side by side, a vector lane for every element.
//!
//! Elements by themselves and a constant limit: the displacements of all are one matrix product, and the chains
//! of clips (see [`crate::response::friction::PeriodicSlider`]) are marched together. From wherever it starts, a
//! slider that slips is in its periodic state after one period. With `r(j)` the sample at which the offset of sample j
//! was last clipped,
//!
//! ```text
//! dG_c / dX_c' = -kt sum_j psi_c(tau_j) phi_c'(tau_r(j))
//! ```
//!
//! While it slips `r(j) = j`, while it sticks `r(j)` stays: sums over either are differences of two table entries.
//! Under odd harmonics everything changes sign after half a period, so that half of it will do.

use std::sync::Arc;

use super::ContactShares;
use super::clip_slopes::wanted;
use super::lanes::LANES;
use super::slider_march::SliderMarch;
use super::wheel_pairs::WheelPairs;
use crate::linalg::{add_times, vectorized};
use crate::response::friction::{ContactLaw, PairParameters};
use crate::response::harmonic_balance::HarmonicTransform;

/// An element of a pair.
#[derive(Debug, Clone, Copy)]
struct Slider {
    pair: usize,
    /// 0 along t1, 1 along t2.
    tangent: usize,
    /// Contact row of the wheel.
    row: usize,
}

/// Buffers for the pairs of one wheel. Matrices are column-major, a row per lane.
#[derive(Debug)]
pub(in crate::response::harmonic_balance) struct MacroSlipPairs {
    transform: Arc<HarmonicTransform>,
    /// Samples looked at: those of a period, or of half of it where the other half is the same with the other sign.
    samples: usize,
    /// Sign of what comes after them.
    then: f64,
    /// `phi_c(tau_j)` of the samples, a column per sample, and a column per coefficient.
    basis: Vec<f64>,
    basis_rows: Vec<f64>,
    /// Elements that may slip, pair after pair, each in its lane; lanes beyond are idle.
    sliders: Vec<Slider>,
    /// `mu N0` of each lane, N.
    limit: Vec<f64>,
    /// Coefficients of `kt x`, N, then of the correction.
    coefficients: Vec<f64>,
    /// Samples of `kt x` and of the offset of the slider, N.
    elastic: Vec<f64>,
    offset: Vec<f64>,
    /// Smallest and largest `kt x` over the samples, N.
    least: Vec<f64>,
    most: Vec<f64>,
}

impl MacroSlipPairs {
    /// Buffers for as many `sliders`.
    pub(in crate::response::harmonic_balance) fn new(
        sliders: usize,
        transform: &Arc<HarmonicTransform>,
    ) -> Self {
        let lanes = sliders.next_multiple_of(LANES);
        let (coefficients, period) = (transform.n_coefficients(), transform.n_samples());
        let half = transform.has_half_waves();
        let samples = if half { period / 2 } else { period };
        let basis = (0..samples)
            .flat_map(|j| (0..coefficients).map(move |c| transform.basis(c)[j]))
            .collect();
        let basis_rows = (0..coefficients)
            .flat_map(|c| transform.basis(c)[..samples].iter().copied())
            .collect();
        Self {
            samples,
            then: if half { -1.0 } else { 1.0 },
            basis,
            basis_rows,
            sliders: Vec::with_capacity(sliders),
            limit: vec![0.0; lanes],
            coefficients: vec![0.0; lanes * coefficients],
            elastic: vec![0.0; lanes * samples],
            offset: vec![0.0; lanes * samples],
            least: vec![0.0; lanes],
            most: vec![0.0; lanes],
            transform: Arc::clone(transform),
        }
    }

    /// Lanes in use, whole blocks.
    fn lanes(&self) -> usize {
        self.sliders.len().next_multiple_of(LANES)
    }

    /// The corrections of all pairs, with their derivatives where these are wanted.
    pub(in crate::response::harmonic_balance) fn correct(
        &mut self,
        derivative: bool,
        wheel: &mut WheelPairs<'_>,
    ) -> ContactShares {
        let (pairs, rows) = (wheel.active.len(), wheel.rows);
        let (tangents, count) = (
            wheel.interface.law.tangents(),
            self.transform.n_coefficients(),
        );
        self.sliders.clear();
        let mut separated = 0_usize;
        for pair in 0..pairs {
            let parameters = wheel.interface.pair(pair);
            let open = parameters.normal_load_n <= 0.0;
            separated += usize::from(open);
            wheel.active[pair] = open;
            let [_, along @ ..] = wheel.interface.rows_of(pair);
            for (tangent, row) in along.into_iter().enumerate().take(tangents) {
                let Some(row) = row else { continue };
                let motion = wheel.displacement.chunks_exact(rows.max(1));
                let excursion = self.transform.excursion(motion.map(|column| column[row]));
                // By itself, whatever the law.
                if !parameters.surely_sticks(ContactLaw::MacroSlip1d, [0.0, excursion, 0.0]) {
                    self.sliders.push(Slider { pair, tangent, row });
                }
            }
            if derivative {
                wheel.jacobians[pair].clear();
            }
        }
        let lanes = self.lanes();
        let stiffness = |parameters: &PairParameters| parameters.tangential_stiffness_n_per_m;
        self.limit[..lanes].fill(0.0);
        self.coefficients[..lanes * count].fill(0.0);
        for (lane, &Slider { pair, row, .. }) in self.sliders.iter().enumerate() {
            let parameters = wheel.interface.pair(pair);
            self.limit[lane] = parameters.friction_coefficient * parameters.normal_load_n;
            let kt = stiffness(parameters);
            for c in usize::from(self.transform.has_mean())..count {
                self.coefficients[c * lanes + lane] = kt * wheel.displacement[c * rows + row];
            }
        }
        if lanes > 0 {
            self.respond();
            self.project();
        }
        let (mut slipping, mut last) = (0_usize, None);
        for (lane, &Slider { pair, tangent, row }) in self.sliders.iter().enumerate() {
            if !self.slips(lane) {
                continue;
            }
            slipping += usize::from(last != Some(pair));
            last = Some(pair);
            wheel.active[pair] = true;
            for c in 0..count {
                wheel.correction[c * rows + row] = self.coefficients[c * lanes + lane];
            }
            if derivative {
                let block = &mut wheel.jacobians[pair].tangential_tangential[tangent];
                let kt = stiffness(wheel.interface.pair(pair));
                self.differentiate(lane, kt, wheel.one.coupled_first(), block);
            }
        }
        let share = |count: usize| count as f64 / pairs as f64;
        ContactShares {
            slipping: share(slipping),
            separated: share(separated),
            unclosed: 0.0,
        }
    }

    /// Histories of `kt x` and of the offsets from the coefficients of `kt x`.
    fn respond(&mut self) {
        let lanes = self.lanes();
        let (count, samples) = (self.transform.n_coefficients(), self.samples);
        let elastic = &mut self.elastic[..lanes * samples];
        elastic.fill(0.0);
        let coefficients = &self.coefficients[..lanes * count];
        add_times(elastic, coefficients, &self.basis, (lanes, samples, count));
        vectorized(SliderMarch {
            lanes,
            periods: self.transform.n_samples() / samples,
            then: self.then,
            limit: &self.limit,
            elastic,
            offset: &mut self.offset[..lanes * samples],
            least: &mut self.least,
            most: &mut self.most,
        });
        // A slider that sticks has a constant offset, whose harmonics are zero.
        for lane in 0..self.sliders.len() {
            if self.slips(lane) {
                continue;
            }
            let column = self.offset[lane..lanes * samples].iter_mut();
            let column = column.step_by(lanes);
            column.for_each(|offset| *offset = 0.0);
        }
    }

    /// Whether the highest of the lower bounds lies above the lowest of the upper ones.
    fn slips(&self, lane: usize) -> bool {
        let limit = self.limit[lane];
        -limit - self.least[lane] > limit - self.most[lane]
    }

    /// Coefficients of the offsets.
    fn project(&mut self) {
        let lanes = self.lanes();
        let (count, samples) = (self.transform.n_coefficients(), self.samples);
        let coefficients = &mut self.coefficients[..lanes * count];
        coefficients.fill(0.0);
        let offset = &self.offset[..lanes * samples];
        let size = (lanes, count, samples);
        add_times(coefficients, offset, &self.basis_rows, size);
        let repeated = (self.transform.n_samples() / samples) as f64;
        for (c, column) in coefficients.chunks_exact_mut(lanes.max(1)).enumerate() {
            let scale = repeated * self.transform.projection_scale(c);
            for entry in column {
                *entry *= scale;
            }
        }
        if self.transform.has_mean() {
            coefficients[..lanes].fill(0.0);
        }
    }

    /// Derivative of the correction of a slider that slips; `coupled` as in
    /// [`super::PairHarmonics::couple_first`].
    fn differentiate(&self, lane: usize, stiffness: f64, coupled: usize, block: &mut [f64]) {
        let transform = &*self.transform;
        let (lanes, samples) = (self.lanes(), self.samples);
        let limit = self.limit[lane];
        let clipped = |j: usize| {
            let (y, elastic) = (
                self.offset[j * lanes + lane],
                self.elastic[j * lanes + lane],
            );
            // The bounds are attained, never passed, so these are equalities.
            y <= -limit - elastic || y >= limit - elastic
        };
        let Some(first) = (0..samples).find(|&j| clipped(j)) else {
            return;
        };
        let mut start = first;
        while start < samples {
            let end = (start..samples).find(|&j| !clipped(j)).unwrap_or(samples);
            let next = (end..samples).find(|&j| clipped(j)).unwrap_or(samples);
            self.add_stretches(coupled, [start, end, next], block);
            if next == samples {
                // The last clip rules on across the end.
                let held = |cumulative: &[f64]| self.then * cumulative[first];
                self.add_held(coupled, end - 1, held, block);
            }
            start = next;
        }
        let count = transform.n_coefficients();
        let factor = -stiffness * (transform.n_samples() / samples) as f64;
        for entry in block.iter_mut() {
            *entry *= factor;
        }
        if transform.has_mean() {
            block[..count].fill(0.0);
            block
                .iter_mut()
                .step_by(count)
                .for_each(|entry| *entry = 0.0);
        }
    }

    /// Adds the sums over samples that slip, from `start` up to `end`, and stick, from there up to `next`.
    fn add_stretches(&self, coupled: usize, [start, end, next]: [usize; 3], block: &mut [f64]) {
        let transform = &*self.transform;
        let count = transform.n_coefficients();
        let (before, after) = (transform.products_to(start), transform.products_to(end));
        for (c, row) in block.chunks_exact_mut(count).enumerate() {
            for other in wanted(transform, coupled, c) {
                row[other] += after[c * count + other] - before[c * count + other];
            }
        }
        if next > end {
            let held = |cumulative: &[f64]| cumulative[next] - cumulative[end];
            self.add_held(coupled, end - 1, held, block);
        }
    }

    /// Adds the sum over samples that stick since `clip`; `held` takes it from the cumulated projection.
    fn add_held(
        &self,
        coupled: usize,
        clip: usize,
        held: impl Fn(&[f64]) -> f64,
        block: &mut [f64],
    ) {
        let transform = &*self.transform;
        let count = transform.n_coefficients();
        for (c, row) in block.chunks_exact_mut(count).enumerate() {
            let held = held(transform.cumulative_projection(c));
            for other in wanted(transform, coupled, c) {
                row[other] += held * self.basis[clip * count + other];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{PairHarmonics, PairJacobian};
    use super::*;
    use crate::response::harmonic_balance::equation::system_for_tests::{OMEGA, state, system};

    /// Half waves and not, with an odd number of samples, with derivatives between harmonics and without.
    #[test]
    fn pairs_side_by_side_are_the_pairs_one_by_one() {
        let sets: [(&[usize], usize); 5] = [
            (&[1], 64),
            (&[1, 3], 128),
            (&[1, 3, 5], 33),
            (&[1, 2], 64),
            (&[0, 1, 3], 60),
        ];
        let settings = sets.into_iter().zip([0, 99, 2, 99, 0]);
        let laws = [ContactLaw::MacroSlip1d, ContactLaw::MacroSlip2d];
        for (((harmonics, samples), coupled), law) in
            settings.flat_map(|setting| laws.map(|law| (setting, law)))
        {
            let system = system(law, harmonics, samples);
            let mut workspace = system.workspace();
            workspace.contact.pairs.couple_first(coupled);
            let x = state(&system);
            let mut residual = vec![0.0; x.len()];
            let (_, shares) = system.residual(OMEGA, &x, &mut residual, true, &mut workspace);
            let mut one = PairHarmonics::new(law, Arc::clone(&system.contact.transform));
            one.couple_first(coupled);
            let count = system.contact.transform.n_coefficients();
            let mut slipping = 0;
            for pair in 0..workspace.contact.active.len() {
                system.contact.gather_pair(pair, &mut workspace.contact);
                let mut correction = vec![0.0; 3 * count];
                let mut jacobian = PairJacobian::new(count);
                let state = one.evaluate(
                    system.contact.interface.pair(pair),
                    &workspace.contact.pair_input,
                    &mut correction,
                    Some(&mut jacobian),
                );
                slipping += usize::from(state.slipping);
                assert_eq!(
                    workspace.contact.active[pair],
                    state.slipping || state.separated
                );
                let rows = workspace.contact.correction.len() / count;
                for tangent in 0..2 {
                    let row = system.contact.interface.rows_of(pair)[1 + tangent].expect("a row");
                    let expected = correction[(1 + tangent) * count..].iter().take(count);
                    for (c, expected) in expected.enumerate() {
                        let found = workspace.contact.correction[c * rows + row];
                        assert!((found - expected).abs() < 1e-14, "{harmonics:?} {pair} {c}");
                    }
                    let found = &workspace.contact.jacobians[pair].tangential_tangential[tangent];
                    let expected = &jacobian.tangential_tangential[tangent];
                    for (found, expected) in found.iter().zip(expected) {
                        assert!((found - expected).abs() < 1e-13, "{harmonics:?} {pair}");
                    }
                }
            }
            assert!((2..4).contains(&slipping), "{harmonics:?}: {slipping}");
            assert!((shares.slipping - slipping as f64 / 4.0).abs() < 1e-15);
            assert!((shares.separated - 0.25).abs() < 1e-15);
        }
    }
}
