//! Contact forces of a wheel over a period: at every pair a normal spring that opens, and along either tangent a spring
//! with a slider whose limit follows the normal force. Two periods are marched from rest; the second one is periodic.
//!
//! Motions and forces are columns of real coefficients, a column a contact row: the mean, then real and imaginary part
//! of each harmonic of `Re(U e^{ik theta})`.

use std::f64::consts::TAU;

use faer::{Mat, c64};

use super::sector::DIRECTIONS;

/// Parameters of the contact of a sector, which its pairs share by their weights.
#[derive(Clone, Copy)]
pub struct Law {
    pub normal_load_n: f64,
    pub normal_stiffness_n_per_m: f64,
    pub tangential_stiffness_n_per_m: f64,
    pub friction_coefficient: f64,
}

/// Harmonics and samples of a period.
pub struct Period {
    pub harmonics: Vec<u32>,
    /// Samples by coefficients.
    waves: Mat<f64>,
}

/// Where the slider of a tangent was dragged last before a sample, and to which side.
type Origin = Option<(usize, f64)>;

/// What the pairs do over a period: enough to follow a small change of the motion.
pub struct State {
    samples: usize,
    /// Of each pair and sample: whether it is closed.
    is_closed: Vec<Vec<bool>>,
    /// Of each contact row and sample; empty for a normal, and for a tangent that does not slip.
    origins: Vec<Vec<Origin>>,
}

impl State {
    pub fn opening_pairs(&self) -> usize {
        let opens = |closed: &&Vec<bool>| closed.contains(&false);
        self.is_closed.iter().filter(opens).count()
    }

    pub fn slipping_pairs(&self) -> usize {
        let slips = |rows: &&[Vec<Origin>]| rows.iter().any(|row| !row.is_empty());
        self.origins.chunks(DIRECTIONS).filter(slips).count()
    }

    /// What the forces of a pair follow its motion with in one harmonic, every other harmonic left out: force along a
    /// row by motion along a column, N/m.
    pub fn stiffness(
        &self,
        law: &Law,
        pair: usize,
        harmonic: u32,
    ) -> [[c64; DIRECTIONS]; DIRECTIONS] {
        let nothing = c64::new(0.0, 0.0);
        let mut found = [[nothing; DIRECTIONS]; DIRECTIONS];
        let samples = self.samples;
        let share = 1.0 / samples as f64;
        let closed = self.is_closed[pair].iter().filter(|own| **own).count() as f64;
        found[0][0] = c64::new(law.normal_stiffness_n_per_m * closed * share, 0.0);
        for (direction, row) in found.iter_mut().enumerate().skip(1) {
            let spring = law.tangential_stiffness_n_per_m;
            let origins = &self.origins[DIRECTIONS * pair + direction];
            row[direction] = c64::new(spring, 0.0);
            if harmonic == 0 {
                continue;
            }
            for (j, origin) in origins.iter().enumerate() {
                let Some((at, side)) = *origin else { continue };
                let steps = harmonic as usize * ((j + samples - at) % samples) % samples;
                let lag = c64::cis(-TAU * steps as f64 * share) * share;
                row[direction] -= lag * spring;
                if self.is_closed[pair][at] {
                    let follows = side * law.friction_coefficient * law.normal_stiffness_n_per_m;
                    row[0] += lag * follows;
                }
            }
        }
        found
    }
}

impl Period {
    /// With 0 among the harmonics, if at all, in front.
    pub fn new(harmonics: &[u32], samples: usize) -> Self {
        let coefficients: Vec<(u32, bool)> = harmonics
            .iter()
            .flat_map(|&k| [(k, false), (k, true)])
            .filter(|&coefficient| coefficient != (0, true))
            .collect();
        let waves = Mat::from_fn(samples, coefficients.len(), |j, at| {
            let (k, is_imaginary) = coefficients[at];
            let angle = TAU * (k as usize * j % samples) as f64 / samples as f64;
            if is_imaginary {
                -angle.sin()
            } else {
                angle.cos()
            }
        });
        Self {
            harmonics: harmonics.to_vec(),
            waves,
        }
    }

    pub fn samples(&self) -> usize {
        self.waves.nrows()
    }

    pub fn coefficients(&self) -> usize {
        self.waves.ncols()
    }

    /// The first coefficient of the harmonic at `place`.
    pub fn first(&self, place: usize) -> usize {
        let has_mean = self.harmonics[0] == 0;
        2 * place - usize::from(has_mean && place > 0)
    }

    /// Samples of every contact row; the mean counts for normal motions alone.
    fn samples_of(&self, motion: &Mat<f64>) -> Mat<f64> {
        let mut counted = motion.clone();
        if self.harmonics[0] == 0 {
            for row in (0..motion.ncols()).filter(|row| row % DIRECTIONS > 0) {
                counted[(0, row)] = 0.0;
            }
        }
        &self.waves * counted
    }

    /// Coefficients of samples; the mean of a tangent is that of its spring.
    fn coefficients_of(&self, samples: &Mat<f64>, motion: &Mat<f64>, law: &[Law]) -> Mat<f64> {
        let mut found = self.waves.transpose() * samples;
        for row in 0..found.ncols() {
            for at in 0..found.nrows() {
                let is_mean = self.harmonics[0] == 0 && at == 0;
                let share = if is_mean { 1.0 } else { 2.0 } / self.samples() as f64;
                found[(at, row)] *= share;
                if is_mean && row % DIRECTIONS > 0 {
                    let spring = law[row / DIRECTIONS].tangential_stiffness_n_per_m;
                    found[(at, row)] = spring * motion[(at, row)];
                }
            }
        }
        found
    }

    /// Contact forces of `motion` under the `law` of each pair, and what the pairs do.
    pub fn forces(&self, law: &[Law], motion: &Mat<f64>) -> (Mat<f64>, State) {
        let samples = self.samples();
        let waves = self.samples_of(motion);
        let mut forces = Mat::zeros(samples, motion.ncols());
        let mut state = State {
            samples,
            is_closed: Vec::with_capacity(law.len()),
            origins: vec![Vec::new(); motion.ncols()],
        };
        for (pair, law) in law.iter().enumerate() {
            let normal = DIRECTIONS * pair;
            let pressed: Vec<f64> = (0..samples)
                .map(|j| law.normal_load_n + law.normal_stiffness_n_per_m * waves[(j, normal)])
                .map(|force| force.max(0.0))
                .collect();
            for (j, force) in pressed.iter().enumerate() {
                forces[(j, normal)] = force - law.normal_load_n;
            }
            state
                .is_closed
                .push(pressed.iter().map(|&force| force > 0.0).collect());
            for tangent in normal + 1..normal + DIRECTIONS {
                let spring = law.tangential_stiffness_n_per_m;
                // The force is that of the spring and an offset, which slip changes.
                let mut offset = 0.0;
                let mut dragged: Origin = None;
                let mut origins = vec![None; samples];
                let mut slips = false;
                for period in 0..2 {
                    for j in 0..samples {
                        let limit = law.friction_coefficient * pressed[j];
                        let wanted = spring * waves[(j, tangent)] + offset;
                        if wanted.abs() > limit {
                            offset += wanted.signum() * limit - wanted;
                            dragged = Some((j, wanted.signum()));
                            slips |= period == 1;
                        }
                        forces[(j, tangent)] = spring * waves[(j, tangent)] + offset;
                        origins[j] = dragged;
                    }
                }
                if slips {
                    state.origins[tangent] = origins;
                }
            }
        }
        (self.coefficients_of(&forces, motion, law), state)
    }

    /// Change of the forces with a small `change` of the motion, where the pairs do what `state` says.
    pub fn change(&self, law: &[Law], state: &State, change: &Mat<f64>) -> Mat<f64> {
        let waves = self.samples_of(change);
        let mut forces = Mat::zeros(self.samples(), change.ncols());
        for (pair, law) in law.iter().enumerate() {
            let normal = DIRECTIONS * pair;
            let pressed = |j: usize| {
                let follows = f64::from(state.is_closed[pair][j]);
                follows * law.normal_stiffness_n_per_m * waves[(j, normal)]
            };
            for j in 0..self.samples() {
                forces[(j, normal)] = pressed(j);
            }
            for tangent in normal + 1..normal + DIRECTIONS {
                let spring = law.tangential_stiffness_n_per_m;
                let origins = &state.origins[tangent];
                for j in 0..self.samples() {
                    let origin = origins.get(j).copied().flatten();
                    let held = origin.map_or(0.0, |(at, side)| {
                        side * law.friction_coefficient * pressed(at)
                            - spring * waves[(at, tangent)]
                    });
                    forces[(j, tangent)] = spring * waves[(j, tangent)] + held;
                }
            }
        }
        self.coefficients_of(&forces, change, law)
    }
}
