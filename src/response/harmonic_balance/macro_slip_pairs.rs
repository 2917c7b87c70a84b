//! The pairs of a wheel under `macro_slip_1d` side by side, a vector lane each.
//!
//! One element per pair and a constant limit: the displacements of all pairs are one matrix product, and the chains
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

#![expect(
    clippy::inline_always,
    reason = "only what is inlined is compiled for vectors"
)]

use std::sync::Arc;

use super::clip_slopes::wanted;
use super::lanes::{LANES, clip, lanes_at, larger, smaller};
use super::{ContactShares, HarmonicSystem, HarmonicTransform, PairJacobian, SystemWorkspace};
use crate::linalg::{Loops, add_times, vectorized};
use crate::response::friction::{ContactLaw, PairParameters};

/// Buffers for the pairs of one wheel. Matrices are column-major, a row per lane.
#[derive(Debug)]
pub(super) struct MacroSlipPairs {
    transform: Arc<HarmonicTransform>,
    /// Samples looked at: those of a period, or of half of it where the other half is the same with the other sign.
    samples: usize,
    /// Sign of what comes after them.
    then: f64,
    /// `phi_c(tau_j)` of the samples, a column per sample, and a column per coefficient.
    basis: Vec<f64>,
    basis_rows: Vec<f64>,
    /// Pairs that may slip, each in its lane; lanes beyond are idle.
    pairs: Vec<usize>,
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
    /// Buffers for `pairs` pairs.
    pub(super) fn new(pairs: usize, transform: &Arc<HarmonicTransform>) -> Self {
        let lanes = pairs.next_multiple_of(LANES);
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
            pairs: Vec::with_capacity(pairs),
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
        self.pairs.len().next_multiple_of(LANES)
    }

    /// Histories of `kt x` and of the offsets from the coefficients of `kt x`.
    fn respond(&mut self) {
        let lanes = self.lanes();
        let (count, samples) = (self.transform.n_coefficients(), self.samples);
        let elastic = &mut self.elastic[..lanes * samples];
        elastic.fill(0.0);
        let coefficients = &self.coefficients[..lanes * count];
        add_times(elastic, coefficients, &self.basis, (lanes, samples, count));
        vectorized(March {
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
        for lane in 0..self.pairs.len() {
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

/// The chains of clips of all lanes: a period, from which on they are periodic, and the samples looked at.
struct March<'a> {
    lanes: usize,
    /// Times that the samples make up a period.
    periods: usize,
    then: f64,
    limit: &'a [f64],
    elastic: &'a [f64],
    offset: &'a mut [f64],
    least: &'a mut [f64],
    most: &'a mut [f64],
}

impl Loops for March<'_> {
    type Output = ();

    /// Several blocks at a time: a clip waits for the one before it.
    #[inline(always)]
    fn call(mut self) {
        let mut first = 0;
        while first < self.lanes {
            first += match (self.lanes - first) / LANES {
                1 => self.blocks::<1>(first),
                2 => self.blocks::<2>(first),
                _ => self.blocks::<3>(first),
            };
        }
    }
}

impl March<'_> {
    /// The blocks from lane `first` on; returns their lanes.
    #[inline(always)]
    fn blocks<const BLOCKS: usize>(&mut self, first: usize) -> usize {
        let place = |block: usize| first + block * LANES;
        let limit: [_; BLOCKS] = std::array::from_fn(|block| lanes_at(self.limit, place(block)));
        let mut least = [[f64::INFINITY; LANES]; BLOCKS];
        let mut most = [[f64::NEG_INFINITY; LANES]; BLOCKS];
        let mut y = [[0.0; LANES]; BLOCKS];
        for period in 0..self.periods {
            for elastic in self.elastic.chunks_exact(self.lanes) {
                for block in 0..BLOCKS {
                    let elastic = lanes_at(elastic, place(block));
                    for lane in 0..LANES {
                        if period == 0 {
                            least[block][lane] = smaller(elastic[lane], least[block][lane]);
                            most[block][lane] = larger(elastic[lane], most[block][lane]);
                        }
                        y[block][lane] = clip(y[block][lane], limit[block][lane], elastic[lane]);
                    }
                }
            }
            y = y.map(|y| y.map(|y| self.then * y));
        }
        for (elastic, offset) in self
            .elastic
            .chunks_exact(self.lanes)
            .zip(self.offset.chunks_exact_mut(self.lanes))
        {
            for block in 0..BLOCKS {
                let elastic = lanes_at(elastic, place(block));
                for lane in 0..LANES {
                    y[block][lane] = clip(y[block][lane], limit[block][lane], elastic[lane]);
                }
                offset[place(block)..place(block) + LANES].copy_from_slice(&y[block]);
            }
        }
        for block in 0..BLOCKS {
            for lane in 0..LANES {
                let (low, high) = (least[block][lane], most[block][lane]);
                let half = self.then < 0.0;
                self.least[place(block) + lane] = if half { smaller(low, -high) } else { low };
                self.most[place(block) + lane] = if half { larger(high, -low) } else { high };
            }
        }
        BLOCKS * LANES
    }
}

impl HarmonicSystem {
    /// Whether the pairs can be evaluated side by side.
    pub(super) fn marches_together(&self) -> bool {
        let drifts = self.ring_drift_m().iter().any(|drift| drift.abs() > 0.0);
        self.interface.law == ContactLaw::MacroSlip1d && !drifts
    }

    /// [`Self::contact_correction`] of all pairs at once.
    pub(super) fn correction_together(
        &self,
        derivative: bool,
        workspace: &mut SystemWorkspace,
    ) -> ContactShares {
        let pairs = workspace.active.len();
        let together = workspace
            .together
            .get_or_insert_with(|| MacroSlipPairs::new(pairs, &self.transform));
        let row_of = |pair: usize| self.row_along_t1(pair);
        let rows = workspace.displacement.len() / self.transform.n_coefficients().max(1);
        together.pairs.clear();
        let mut separated = 0_usize;
        for pair in 0..pairs {
            let parameters = self.interface.pair(pair);
            let open = parameters.normal_load_n <= 0.0;
            separated += usize::from(open);
            workspace.active[pair] = open;
            let motion = workspace.displacement.chunks_exact(rows.max(1));
            let motion = row_of(pair).map(|row| motion.map(move |column| column[row]));
            let excursion = motion.map_or(0.0, |motion| self.transform.excursion(motion));
            if !parameters.surely_sticks(ContactLaw::MacroSlip1d, [0.0, excursion, 0.0]) {
                together.pairs.push(pair);
            }
            if derivative {
                workspace.jacobians[pair].clear();
            }
        }
        let lanes = together.lanes();
        let stiffness = |parameters: &PairParameters| parameters.tangential_stiffness_n_per_m;
        together.limit[..lanes].fill(0.0);
        together.coefficients[..lanes * self.transform.n_coefficients()].fill(0.0);
        for (lane, &pair) in together.pairs.iter().enumerate() {
            let parameters = self.interface.pair(pair);
            together.limit[lane] = parameters.friction_coefficient * parameters.normal_load_n;
            let Some(row) = row_of(pair) else { continue };
            let kt = stiffness(parameters);
            for c in usize::from(self.transform.has_mean())..self.transform.n_coefficients() {
                together.coefficients[c * lanes + lane] =
                    kt * workspace.displacement[c * rows + row];
            }
        }
        if lanes > 0 {
            together.respond();
            together.project();
        }
        let mut slipping = 0_usize;
        for (lane, &pair) in together.pairs.iter().enumerate() {
            if !together.slips(lane) {
                continue;
            }
            slipping += 1;
            workspace.active[pair] = true;
            let Some(row) = row_of(pair) else { continue };
            for c in 0..self.transform.n_coefficients() {
                workspace.correction[c * rows + row] = together.coefficients[c * lanes + lane];
            }
            if derivative {
                let PairJacobian {
                    tangential_tangential: [block, _],
                    ..
                } = &mut workspace.jacobians[pair];
                let kt = stiffness(self.interface.pair(pair));
                together.differentiate(lane, kt, workspace.pairs.coupled_first(), block);
            }
        }
        workspace.separated = separated > 0;
        let share = |count: usize| count as f64 / pairs as f64;
        ContactShares {
            slipping: share(slipping),
            separated: share(separated),
            unclosed: 0.0,
        }
    }

    /// Contact row along t1 of a pair of the wheel.
    fn row_along_t1(&self, pair: usize) -> Option<usize> {
        let geometry = &self.interface.geometry;
        let (sector, own) = (pair / geometry.rows.len(), pair % geometry.rows.len());
        geometry.rows[own][1].map(|row| sector * geometry.row_count() + row)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::response::harmonic_balance::PairHarmonics;
    use crate::response::harmonic_balance::condensed::tests::{OMEGA, state, system};

    /// Blocks by themselves, in twos, in threes, and what is left of them.
    #[test]
    fn any_number_of_lanes_is_marched_like_one_slider_after_another() {
        const SAMPLES: usize = 30;
        for (lanes, then) in (0..6).flat_map(|blocks| [(8 * blocks, 1.0), (8 * blocks, -1.0)]) {
            let number = |i: usize| (0.9 * i as f64 + (i * i) as f64 * 0.37).sin();
            let elastic: Vec<f64> = (0..lanes * SAMPLES).map(number).collect();
            let limit: Vec<f64> = (0..lanes).map(|i| 0.1 + number(i).abs()).collect();
            let mut offset = vec![0.0; lanes * SAMPLES];
            let [mut least, mut most] = [vec![0.0; lanes], vec![0.0; lanes]];
            vectorized(March {
                lanes,
                periods: if then < 0.0 { 2 } else { 1 },
                then,
                limit: &limit,
                elastic: &elastic,
                offset: &mut offset,
                least: &mut least,
                most: &mut most,
            });
            for lane in 0..lanes {
                let own: Vec<f64> = (0..SAMPLES).map(|j| elastic[j * lanes + lane]).collect();
                let before = own.iter().map(|x| then * x);
                let period: Vec<f64> = own.iter().copied().chain(before).collect();
                let whole = if then < 0.0 { &period[..] } else { &own[..] };
                let mut y = 0.0_f64;
                for x in whole {
                    y = y.max(-limit[lane] - x).min(limit[lane] - x);
                }
                let expected = own.iter().map(|x| {
                    y = y.max(-limit[lane] - x).min(limit[lane] - x);
                    y
                });
                let found = (0..SAMPLES).map(|j| offset[j * lanes + lane]);
                assert!(expected.eq(found), "{lanes} lanes, {lane}");
                let largest = whole.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                let smallest = whole.iter().copied().fold(f64::INFINITY, f64::min);
                assert!(largest.total_cmp(&most[lane]).is_eq());
                assert!(smallest.total_cmp(&least[lane]).is_eq());
            }
        }
    }

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
        for ((harmonics, samples), coupled) in sets.into_iter().zip([0, 99, 2, 99, 0]) {
            let system = system(ContactLaw::MacroSlip1d, harmonics, samples);
            let mut workspace = system.workspace();
            workspace.pairs.couple_first(coupled);
            let x = state(&system);
            let mut residual = vec![0.0; x.len()];
            let (_, shares) = system.residual(OMEGA, &x, &mut residual, true, &mut workspace);
            let mut one =
                PairHarmonics::new(ContactLaw::MacroSlip1d, Arc::clone(&system.transform));
            one.couple_first(coupled);
            let count = system.transform.n_coefficients();
            let mut slipping = 0;
            for pair in 0..workspace.active.len() {
                system.gather_pair(pair, &mut workspace);
                let mut correction = vec![0.0; 3 * count];
                let mut jacobian = PairJacobian::new(count);
                let state = one.evaluate(
                    system.interface.pair(pair),
                    &workspace.pair_input,
                    &mut correction,
                    Some(&mut jacobian),
                );
                slipping += usize::from(state.slipping);
                assert_eq!(workspace.active[pair], state.slipping || state.separated);
                let row = system.row_along_t1(pair).expect("a row");
                let rows = workspace.correction.len() / count;
                for (c, expected) in correction[count..2 * count].iter().enumerate() {
                    let found = workspace.correction[c * rows + row];
                    assert!((found - expected).abs() < 1e-14, "{harmonics:?} {pair} {c}");
                }
                let found = &workspace.jacobians[pair].tangential_tangential[0];
                let expected = &jacobian.tangential_tangential[0];
                for (found, expected) in found.iter().zip(expected) {
                    assert!((found - expected).abs() < 1e-13, "{harmonics:?} {pair}");
                }
            }
            assert!((2..4).contains(&slipping), "{harmonics:?}: {slipping}");
            assert!((shares.slipping - slipping as f64 / 4.0).abs() < 1e-15);
            assert!((shares.separated - 0.25).abs() < 1e-15);
        }
    }
}
