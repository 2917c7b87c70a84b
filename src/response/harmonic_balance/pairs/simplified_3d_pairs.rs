//! The pairs of a wheel under `simplified_3d` side by side, a vector lane each.
//!
//! As in [`super::macro_slip_pairs`], with a normal load that varies and two elements per pair: histories of all
//! directions of a block of pairs by [`QuarterWaves`], the chains of clips of
//! [`crate::response::friction::PeriodicSlider`] marched together, and the way back. From wherever it starts, a slider that
//! slips is in its periodic state after one period.

#![expect(
    clippy::inline_always,
    reason = "only what is inlined is compiled for vectors"
)]

use std::sync::Arc;

use super::lanes::{LANES, clip, larger, smaller};
use super::quarter_waves::{QuarterWaves, WIDTH};
use super::wheel_pairs::WheelPairs;
use super::{ContactShares, PairJacobian};
use crate::linalg::{Loops, vectorized};
use crate::response::friction::ContactLaw;
use crate::response::harmonic_balance::HarmonicTransform;

/// Rows of the matrices of a block: the lanes of n, then those of t1, then t2.
const HEIGHT: usize = WIDTH * LANES;

/// Buffers for the pairs of one wheel. Matrices are column-major with [`HEIGHT`] rows, block after block.
#[derive(Debug)]
pub(in crate::response::harmonic_balance) struct Simplified3dPairs {
    transform: Arc<HarmonicTransform>,
    waves: QuarterWaves,
    /// Pairs that may slip or separate, each in its lane; lanes beyond are idle.
    pairs: Vec<usize>,
    /// Sum of the amplitudes of the harmonics of every contact row, m.
    excursions: Vec<f64>,
    /// Contact row of every row of the matrices, and its spring, N/m; one of 0 N/m where there is none.
    rows: Vec<(usize, f64)>,
    /// Rows of the matrices of a block that have a correction, each with its contact row: of n, and of t1 and t2.
    corrected: [Vec<(usize, usize)>; 2],
    /// `N0`, N, and `mu` of each lane.
    normal_load: Vec<f64>,
    friction: Vec<f64>,
    /// Coefficients of `kn g`, `kt x1`, `kt x2`, N, then of the corrections.
    coefficients: Vec<f64>,
    /// Samples of the same, of the block that is marched.
    histories: Vec<f64>,
    /// Whether the lane separates, slips along t1, along t2.
    states: Vec<[bool; 3]>,
    /// Where a direction is at a bound, as the histories of all blocks: see [`Bound`].
    bounds: Vec<f64>,
    clips: Clips,
}

/// Bounds at which a sample may be.
struct Bound;

impl Bound {
    /// Of a slider: neither; else the sign of the one, 0.5 where both are one. Of a normal load: not 0.
    const NEITHER: f64 = 0.0;
    const UPPER: f64 = 1.0;
    const LOWER: f64 = -1.0;
    const BOTH: f64 = 0.5;
    /// A normal load of 0.
    const OPEN: f64 = 1.0;
}

/// What the derivatives of one pair need.
#[derive(Debug, Default)]
struct Clips {
    normal_load: Vec<f64>,
    samples: [Vec<usize>; 2],
    signs: [Vec<f64>; 2],
}

impl Simplified3dPairs {
    pub(in crate::response::harmonic_balance) fn new(
        pairs: usize,
        transform: &Arc<HarmonicTransform>,
    ) -> Self {
        let lanes = pairs.next_multiple_of(LANES);
        Self {
            waves: QuarterWaves::new(transform),
            pairs: Vec::with_capacity(pairs),
            excursions: Vec::new(),
            rows: Vec::with_capacity(3 * lanes),
            corrected: Default::default(),
            normal_load: vec![0.0; lanes],
            friction: vec![0.0; lanes],
            coefficients: vec![0.0; 3 * lanes * transform.n_coefficients()],
            histories: vec![0.0; HEIGHT * transform.n_samples()],
            states: vec![[false; 3]; lanes],
            bounds: Vec::new(),
            clips: Clips::default(),
            transform: Arc::clone(transform),
        }
    }

    /// Lanes in use, whole blocks.
    fn lanes(&self) -> usize {
        self.pairs.len().next_multiple_of(LANES)
    }

    /// The corrections of all pairs, with their derivatives where these are wanted.
    pub(in crate::response::harmonic_balance) fn correct(
        &mut self,
        derivative: bool,
        wheel: &mut WheelPairs<'_>,
    ) -> ContactShares {
        self.choose(wheel);
        wheel.active.fill(false);
        if derivative {
            wheel.jacobians.iter_mut().for_each(PairJacobian::clear);
        }
        if !self.pairs.is_empty() {
            self.load(wheel.displacement, wheel.rows);
            self.respond(derivative);
            self.unload(wheel.correction, wheel.rows);
        }
        let (mut slipping, mut separated) = (0_usize, 0_usize);
        for (lane, &pair) in self.pairs.iter().enumerate() {
            let state = self.states[lane];
            separated += usize::from(state[0]);
            slipping += usize::from(state[1] || state[2]);
            wheel.active[pair] = state.contains(&true);
            if derivative && wheel.active[pair] {
                let clips = &mut self.clips;
                let samples = self.transform.n_samples();
                clips.gather(&self.bounds, samples, lane, state);
                let sliders = [0, 1].map(|tangent| {
                    let clips = (&*clips.samples[tangent], &*clips.signs[tangent]);
                    state[1 + tangent].then_some(clips)
                });
                wheel.one.differentiate_clips(
                    wheel.interface.pair(pair),
                    state[0].then_some(&clips.normal_load),
                    sliders,
                    &mut wheel.jacobians[pair],
                );
            }
        }
        let share = |number: usize| number as f64 / wheel.active.len() as f64;
        ContactShares {
            slipping: share(slipping),
            separated: share(separated),
            unclosed: 0.0,
        }
    }

    /// Gives every pair that may slip or separate a lane, with its load, its friction, and its contact rows and springs.
    fn choose(&mut self, wheel: &WheelPairs<'_>) {
        let mean = usize::from(self.transform.has_mean());
        self.pairs.clear();
        self.excursions.clear();
        self.excursions.resize(wheel.rows, 0.0);
        vectorized(Excursions {
            oscillation: &wheel.displacement[mean * wheel.rows..],
            sums: &mut self.excursions,
        });
        for pair in 0..wheel.active.len() {
            let places = wheel.interface.rows_of(pair);
            let mut excursions = places.map(|row| row.map_or(0.0, |row| self.excursions[row]));
            if let (Some(row), 1) = (places[0], mean) {
                excursions[0] += wheel.displacement[row].abs();
            }
            let parameters = wheel.interface.pair(pair);
            if !parameters.surely_sticks(ContactLaw::Simplified3d, excursions) {
                self.pairs.push(pair);
            }
        }
        let lanes = self.lanes();
        // An idle lane rests under no load: it has no correction.
        self.normal_load[..lanes].fill(0.0);
        self.friction[..lanes].fill(0.0);
        self.rows.clear();
        self.rows.resize(3 * lanes, (0, 0.0));
        for (lane, &pair) in self.pairs.iter().enumerate() {
            let parameters = wheel.interface.pair(pair);
            self.normal_load[lane] = parameters.normal_load_n;
            self.friction[lane] = parameters.friction_coefficient;
            for (direction, row) in wheel.interface.rows_of(pair).into_iter().enumerate() {
                let spring = if direction == 0 {
                    parameters.normal_stiffness_n_per_m
                } else {
                    parameters.tangential_stiffness_n_per_m
                };
                let at = lane / LANES * HEIGHT + direction * LANES + lane % LANES;
                self.rows[at] = row.map_or((0, 0.0), |row| (row, spring));
            }
        }
    }

    /// The corrections in the place of the displacements; with the bounds where the `derivative` is wanted.
    fn respond(&mut self, derivative: bool) {
        let blocks = self.lanes() / LANES;
        let per_block = HEIGHT * self.transform.n_samples();
        let bounds = if derivative { blocks * per_block } else { 0 };
        self.bounds.resize(bounds, 0.0);
        let mut bounds = self.bounds.chunks_exact_mut(per_block);
        let of_block = HEIGHT * self.transform.n_coefficients();
        let coefficients = self.coefficients.chunks_exact_mut(of_block);
        for (block, coefficients) in coefficients.take(blocks).enumerate() {
            self.waves.synthesize(coefficients, &mut self.histories);
            let lanes = block * LANES..(block + 1) * LANES;
            vectorized(March {
                histories: &mut self.histories,
                normal_load: &self.normal_load[lanes.clone()],
                friction: &self.friction[lanes.clone()],
                states: &mut self.states[lanes],
                bounds: bounds.next().unwrap_or_default(),
            });
            self.waves.project(&self.histories, coefficients);
        }
    }

    /// Takes the springs of `kn g`, `kt x1` and `kt x2` over displacements, a column of contact rows per coefficient. Tangents have no
    /// mean, which is the first of the coefficients where there is one.
    fn load(&mut self, displacement: &[f64], contact_rows: usize) {
        let (coefficients, mean) = (self.transform.n_coefficients(), self.transform.has_mean());
        let blocks = self.coefficients.chunks_exact_mut(HEIGHT * coefficients);
        for (rows, block) in self.rows.chunks_exact(HEIGHT).zip(blocks) {
            let from = displacement.chunks_exact(contact_rows.max(1));
            for (column, motions) in block.chunks_exact_mut(HEIGHT).zip(from) {
                for (force, &(row, spring)) in column.iter_mut().zip(rows) {
                    *force = spring * motions[row];
                }
            }
            if mean {
                block[LANES..HEIGHT].fill(0.0);
            }
        }
    }

    /// The corrections of what slips or separates, a column of contact rows per coefficient; what sticks has none.
    fn unload(&mut self, correction: &mut [f64], contact_rows: usize) {
        let (coefficients, mean) = (self.transform.n_coefficients(), self.transform.has_mean());
        let blocks = self.coefficients.chunks_exact(HEIGHT * coefficients);
        for (block, (rows, from)) in self.rows.chunks_exact(HEIGHT).zip(blocks).enumerate() {
            let [normal, tangents] = &mut self.corrected;
            normal.clear();
            tangents.clear();
            for (at, &(row, spring)) in rows.iter().enumerate() {
                let (direction, lane) = (at / LANES, block * LANES + at % LANES);
                if spring > 0.0 && self.states[lane][direction] {
                    let list = if direction == 0 {
                        &mut *normal
                    } else {
                        &mut *tangents
                    };
                    list.push((at, row));
                }
            }
            let to = correction.chunks_exact_mut(contact_rows.max(1));
            for (c, (column, corrections)) in from.chunks_exact(HEIGHT).zip(to).enumerate() {
                let of_tangents = if mean && c == 0 { &[][..] } else { &**tangents };
                for &(at, row) in normal.iter().chain(of_tangents) {
                    corrections[row] = column[at];
                }
            }
        }
    }
}

impl Clips {
    /// Gathers the clips of the pair in lane `lane`; `state` is whether it separates, and whether each of its sliders slips.
    fn gather(&mut self, bounds: &[f64], samples: usize, lane: usize, state: [bool; 3]) {
        let bounds = &bounds[lane / LANES * HEIGHT * samples..][..HEIGHT * samples];
        let of = |direction: usize| {
            let direction_bounds = bounds[direction * LANES + lane % LANES..].iter();
            direction_bounds.step_by(HEIGHT)
        };
        self.normal_load.clear();
        if state[0] {
            let load = |open: &f64| if *open == Bound::OPEN { 0.0 } else { 1.0 };
            self.normal_load.extend(of(0).map(load));
        }
        for tangent in 0..2 {
            let (samples, signs) = (&mut self.samples[tangent], &mut self.signs[tangent]);
            samples.clear();
            signs.clear();
            if state[1 + tangent] {
                for (j, &bound) in of(1 + tangent).enumerate() {
                    if bound != Bound::NEITHER {
                        samples.push(j);
                        signs.push(if bound == Bound::BOTH { 0.0 } else { bound });
                    }
                }
            }
        }
    }
}

/// Sums of the amplitudes of the harmonics, a column of real parts and one of imaginary parts each.
struct Excursions<'a> {
    oscillation: &'a [f64],
    sums: &'a mut [f64],
}

impl Loops for Excursions<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let rows = self.sums.len();
        for columns in self.oscillation.chunks_exact(2 * rows.max(1)) {
            let (re, im) = columns.split_at(rows);
            for i in 0..rows {
                self.sums[i] += (re[i] * re[i] + im[i] * im[i]).sqrt();
            }
        }
    }
}

/// Through one period to the periodic state, and through another one that is kept; of one block.
struct March<'a> {
    histories: &'a mut [f64],
    normal_load: &'a [f64],
    friction: &'a [f64],
    states: &'a mut [[bool; 3]],
    /// As long as the histories, or empty.
    bounds: &'a mut [f64],
}

impl Loops for March<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let load: [f64; LANES] = std::array::from_fn(|i| self.normal_load[i]);
        let friction: [f64; LANES] = std::array::from_fn(|i| self.friction[i]);
        let mut lowest = [f64::INFINITY; LANES];
        let mut bounds = [[[f64::NEG_INFINITY; LANES], [f64::INFINITY; LANES]]; 2];
        let mut y = [[0.0; LANES]; 2];
        let histories = self.histories.as_chunks_mut::<LANES>().0;
        for column in histories.chunks_exact(3) {
            let bilateral = sum(&load, &column[0]);
            let limit = std::array::from_fn(|i| friction[i] * larger(bilateral[i], 0.0));
            for i in 0..LANES {
                lowest[i] = smaller(bilateral[i], lowest[i]);
            }
            for direction in 0..2 {
                let elastic = &column[1 + direction];
                let [highest_lower, lowest_upper] = &mut bounds[direction];
                for i in 0..LANES {
                    let (lower, upper) = (-limit[i] - elastic[i], limit[i] - elastic[i]);
                    highest_lower[i] = larger(lower, highest_lower[i]);
                    lowest_upper[i] = smaller(upper, lowest_upper[i]);
                }
                march(&mut y[direction], &limit, elastic);
            }
        }
        let mut slips = [[0.0; LANES]; 2];
        for (i, state) in self.states.iter_mut().enumerate() {
            state[0] = lowest[i] <= 0.0;
            for direction in 0..2 {
                let [highest_lower, lowest_upper] = &bounds[direction];
                state[1 + direction] = highest_lower[i] > lowest_upper[i];
                slips[direction][i] = f64::from(u8::from(state[1 + direction]));
            }
        }
        let mut bounds = self.bounds.as_chunks_mut::<LANES>().0.chunks_exact_mut(3);
        for column in histories.chunks_exact_mut(3) {
            let bilateral = sum(&load, &column[0]);
            let limit = std::array::from_fn(|i| friction[i] * larger(bilateral[i], 0.0));
            column[0] = bilateral.map(|bilateral| larger(0.0 - bilateral, 0.0));
            let mut bounds = bounds.next();
            if let Some(bounds) = &mut bounds {
                bounds[0] = bilateral.map(|load| if load > 0.0 { 0.0 } else { Bound::OPEN });
            }
            for direction in 0..2 {
                let elastic = &mut column[1 + direction];
                march(&mut y[direction], &limit, elastic);
                if let Some(bounds) = &mut bounds {
                    bounds[1 + direction] = attained(&y[direction], &limit, elastic);
                }
                // A slider that sticks has a constant offset, whose harmonics are zero.
                for i in 0..LANES {
                    elastic[i] = slips[direction][i] * y[direction][i];
                }
            }
        }
    }
}

#[inline(always)]
fn sum(a: &[f64; LANES], b: &[f64; LANES]) -> [f64; LANES] {
    std::array::from_fn(|i| a[i] + b[i])
}

/// The offsets one sample later.
#[inline(always)]
fn march(y: &mut [f64; LANES], limit: &[f64; LANES], elastic: &[f64; LANES]) {
    for i in 0..LANES {
        y[i] = clip(y[i], limit[i], elastic[i]);
    }
}

/// The bounds at which the offsets are: they are attained, never passed, so these are equalities.
#[inline(always)]
fn attained(y: &[f64; LANES], limit: &[f64; LANES], elastic: &[f64; LANES]) -> [f64; LANES] {
    std::array::from_fn(|i| {
        let lower = y[i] <= -limit[i] - elastic[i];
        let upper = y[i] >= limit[i] - elastic[i];
        match (lower, upper) {
            (true, true) => Bound::BOTH,
            (true, false) => Bound::LOWER,
            (false, true) => Bound::UPPER,
            (false, false) => Bound::NEITHER,
        }
    })
}

#[cfg(test)]
mod tests {
    use super::super::{PairHarmonics, PairJacobian};
    use super::*;
    use crate::response::harmonic_balance::equation::system_for_tests::{OMEGA, state, system};

    /// With the mean and without, odd numbers of samples, derivatives between harmonics and without.
    #[test]
    fn pairs_side_by_side_are_the_pairs_one_by_one() {
        let sets: [(&[usize], usize); 5] = [
            (&[1], 64),
            (&[1, 3], 128),
            (&[1, 3, 5], 33),
            (&[1, 2], 64),
            // By sums, not by an FFT, which leaves rounding in the normal motion of a pair that has none.
            (&[0, 1, 2, 3], 60),
        ];
        let law = ContactLaw::Simplified3d;
        for ((harmonics, samples), coupled) in sets.into_iter().zip([0, 99, 2, 99, 0]) {
            let system = system(law, harmonics, samples);
            let mut workspace = system.workspace();
            workspace.contact.pairs.couple_first(coupled);
            // Small motions, too: then pairs stick.
            for scale in [1.0, 0.4, 0.02] {
                let x: Vec<f64> = state(&system).iter().map(|x| scale * x).collect();
                let mut residual = vec![0.0; x.len()];
                let (_, shares) = system.residual(OMEGA, &x, &mut residual, true, &mut workspace);
                let mut one = PairHarmonics::new(law, Arc::clone(&system.contact.transform));
                one.couple_first(coupled);
                let count = system.contact.transform.n_coefficients();
                let (mut slipping, mut separated) = (0, 0);
                let pairs = workspace.contact.active.len();
                for pair in 0..pairs {
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
                    separated += usize::from(state.separated);
                    assert_eq!(
                        workspace.contact.active[pair],
                        state.slipping || state.separated
                    );
                    let per_sector = system.contact.interface.per_sector();
                    let base = pair / per_sector * system.contact.interface.geometry.row_count();
                    let places = system.contact.interface.geometry.rows[pair % per_sector];
                    for (direction, place) in places.iter().enumerate() {
                        let Some(row) = place else { continue };
                        let expected = &correction[direction * count..][..count];
                        for (c, expected) in expected.iter().enumerate() {
                            let found =
                                workspace.contact.correction[c * system.contact.rows + base + row];
                            assert!((found - expected).abs() < 1e-13, "{harmonics:?} {pair} {c}");
                        }
                    }
                    let found = &workspace.contact.jacobians[pair];
                    let blocks = |of: &PairJacobian| {
                        let tangential = of.tangential_tangential.clone();
                        let normal = of.tangential_normal.clone();
                        [
                            tangential.concat(),
                            normal.concat(),
                            of.normal_normal.clone(),
                        ]
                        .concat()
                    };
                    for (found, expected) in blocks(found).iter().zip(blocks(&jacobian)) {
                        assert!((found - expected).abs() < 1e-12, "{harmonics:?} {pair}");
                    }
                }
                let share = |number: usize| number as f64 / pairs as f64;
                assert!((shares.slipping - share(slipping)).abs() < 1e-15);
                assert!((shares.separated - share(separated)).abs() < 1e-15);
                match scale {
                    1.0 => assert!(slipping > 1 && separated > 0, "{slipping} {separated}"),
                    0.02 => assert!(slipping < pairs, "{slipping}"),
                    _ => {}
                }
            }
        }
    }
}
