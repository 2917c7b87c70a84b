//! Contact forces of one pair over a period: a normal spring that opens, and along either tangent a spring with a
//! slider whose limit follows the normal force. Two periods are marched from rest; the second one is periodic.

use std::f64::consts::TAU;

use faer::c64;

use super::sector::DIRECTIONS;
use super::wheel::PairStiffness;

/// Parameters of a pair.
#[derive(Clone, Copy)]
pub struct Law {
    pub normal_load_n: f64,
    pub normal_stiffness_n_per_m: f64,
    pub tangential_stiffness_n_per_m: f64,
    pub friction_coefficient: f64,
}

/// Cosines and sines of the samples of a period.
pub struct Period {
    turns: Vec<c64>,
}

/// What a pair answers with.
pub struct Answer {
    /// Force per harmonic and direction, N.
    pub force: Vec<[c64; DIRECTIONS]>,
    /// What the force follows the motion with, harmonic by harmonic, no other harmonic counted.
    pub tangent: Vec<PairStiffness>,
    /// Whether the pair opens, and whether it slips.
    pub opens: bool,
    pub slips: bool,
}

impl Period {
    pub fn new(samples: usize) -> Self {
        let turn = |j: usize| c64::cis(TAU * j as f64 / samples as f64);
        Self {
            turns: (0..samples).map(turn).collect(),
        }
    }

    fn samples(&self) -> usize {
        self.turns.len()
    }

    fn turn(&self, harmonic: u32, sample: usize) -> c64 {
        self.turns[harmonic as usize * sample % self.samples()]
    }

    /// Samples of one direction; harmonic 0 counts for the normal motion alone.
    fn wave(&self, harmonics: &[u32], motion: &[[c64; DIRECTIONS]], direction: usize) -> Vec<f64> {
        let sample = |j: usize| {
            let parts = harmonics.iter().zip(motion);
            let of = |(&k, motion): (&u32, &[c64; DIRECTIONS])| match k {
                0 if direction > 0 => 0.0,
                0 => motion[0].re,
                _ => (motion[direction] * self.turn(k, j)).re,
            };
            parts.map(of).sum()
        };
        (0..self.samples()).map(sample).collect()
    }

    /// Coefficients of samples.
    fn harmonics(&self, harmonics: &[u32], samples: &[f64]) -> Vec<c64> {
        let coefficient = |&k: &u32| {
            let share = if k == 0 { 1.0 } else { 2.0 } / samples.len() as f64;
            let sum = |(j, value): (usize, &f64)| self.turn(k, j).conj() * *value;
            samples.iter().enumerate().map(sum).sum::<c64>() * share
        };
        harmonics.iter().map(coefficient).collect()
    }

    /// The answer to `motion`, harmonic by harmonic: closing and sliding, m.
    pub fn answer(&self, law: Law, harmonics: &[u32], motion: &[[c64; DIRECTIONS]]) -> Answer {
        let samples = self.samples();
        let closing = self.wave(harmonics, motion, 0);
        let pressed: Vec<f64> = closing
            .iter()
            .map(|g| f64::max(0.0, law.normal_load_n + law.normal_stiffness_n_per_m * g))
            .collect();
        let change: Vec<f64> = pressed.iter().map(|n| n - law.normal_load_n).collect();
        let is_closed: Vec<f64> = pressed.iter().map(|&n| f64::from(n > 0.0)).collect();
        let contact = is_closed.iter().sum::<f64>() / samples as f64;
        let nothing = c64::new(0.0, 0.0);
        let mut answer = Answer {
            force: self
                .harmonics(harmonics, &change)
                .into_iter()
                .map(|force| [force, nothing, nothing])
                .collect(),
            tangent: vec![[[nothing; DIRECTIONS]; DIRECTIONS]; harmonics.len()],
            opens: contact < 1.0,
            slips: false,
        };
        for tangent in &mut answer.tangent {
            tangent[0][0] = c64::new(law.normal_stiffness_n_per_m * contact, 0.0);
        }
        for direction in 1..DIRECTIONS {
            let sliding = self.wave(harmonics, motion, direction);
            self.slider(law, harmonics, [&pressed, &sliding], direction, &mut answer);
            // The mean is answered by the spring.
            for (place, &k) in harmonics.iter().enumerate() {
                if k == 0 {
                    let spring = law.tangential_stiffness_n_per_m;
                    answer.force[place][direction] = motion[place][direction] * spring;
                    answer.tangent[place][direction] = [nothing; DIRECTIONS];
                    answer.tangent[place][direction][direction] = c64::new(spring, 0.0);
                }
            }
        }
        answer
    }

    /// A spring with a slider along one tangent.
    fn slider(
        &self,
        law: Law,
        harmonics: &[u32],
        [pressed, sliding]: [&[f64]; 2],
        direction: usize,
        answer: &mut Answer,
    ) {
        let samples = self.samples();
        let (kt, mu) = (law.tangential_stiffness_n_per_m, law.friction_coefficient);
        // The spring's foot stands at -offset / kt; where it was dragged last, and to which side.
        let mut offset = 0.0;
        let mut dragged: Option<(usize, f64)> = None;
        let mut force = vec![0.0; samples];
        let mut origins = vec![None; samples];
        for period in 0..2 {
            for j in 0..samples {
                let limit = mu * pressed[j];
                let wanted = kt * sliding[j] + offset;
                if wanted.abs() > limit {
                    let side = wanted.signum();
                    offset = side * limit - kt * sliding[j];
                    dragged = Some((j, side));
                    answer.slips |= period == 1;
                }
                if period == 1 {
                    force[j] = kt * sliding[j] + offset;
                    origins[j] = dragged;
                }
            }
        }
        for (place, coefficient) in self.harmonics(harmonics, &force).into_iter().enumerate() {
            answer.force[place][direction] = coefficient;
        }
        for (place, &k) in harmonics.iter().enumerate() {
            let (mut own, mut of_normal) = (c64::new(0.0, 0.0), c64::new(0.0, 0.0));
            for (j, origin) in origins.iter().enumerate() {
                // A pair that sticks for good has its slider where the first period left it.
                let Some((at, side)) = origin.filter(|_| answer.slips) else {
                    own += kt;
                    continue;
                };
                let lag = self.turn(k, (j + samples - at) % samples).conj();
                own += (c64::new(1.0, 0.0) - lag) * kt;
                if pressed[at] > 0.0 {
                    of_normal += lag * (side * mu * law.normal_stiffness_n_per_m);
                }
            }
            let share = 1.0 / samples as f64;
            answer.tangent[place][direction][direction] = own * share;
            answer.tangent[place][direction][0] = of_normal * share;
        }
    }
}
