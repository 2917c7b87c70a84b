//! Transitions between stick, slip and separation where Yang, Chu & Menq (1998) put them.
//!
//! With u the tangential, v the normal displacement and n the direction of the force (+1 or -1 for
//! one tangent), the force reaches the limit, or stays at it, where `kt n.u' - mu kn v' > 0`. In
//! one direction these are the criteria of the paper: `kt u' - mu kn v' > 0` for slip forwards, `kt
//! u' + mu kn v' < 0` backwards.

use std::f64::consts::TAU;

use blisk::response::friction::{ContactHistory, ContactLaw, PairDisplacement, PairParameters};

use super::random::Random;

const SAMPLES: usize = 1 << 13;

/// A signal of harmonics 1 to 3 with its derivative by the angle.
fn signal(random: &mut Random, size: f64) -> [Vec<f64>; 2] {
    let coefficients = random.vector(6, size);
    let sum = |j: usize, derivative: bool| -> f64 {
        (0..3)
            .map(|i| {
                let k = (i + 1) as f64;
                let (s, c) = (k * TAU * j as f64 / SAMPLES as f64).sin_cos();
                let (a, b) = (coefficients[2 * i], coefficients[2 * i + 1]);
                if derivative {
                    k * (b * c - a * s)
                } else {
                    a * c + b * s
                }
            })
            .sum()
    };
    [false, true].map(|derivative| (0..SAMPLES).map(|j| sum(j, derivative)).collect())
}

#[derive(Clone, Copy, PartialEq)]
enum State {
    Stick,
    Slip,
    Open,
}

/// Transitions seen, and how many of them met their criterion without the allowance for a sample.
#[derive(Default, Debug)]
struct Count {
    stick_to_slip: usize,
    slip_to_stick: usize,
    opening: usize,
    closing_to_slip: usize,
    closing_to_stick: usize,
    strict: usize,
}

impl Count {
    fn all(&self) -> usize {
        self.stick_to_slip
            + self.slip_to_stick
            + self.opening
            + self.closing_to_slip
            + self.closing_to_stick
    }
}

fn check(law: ContactLaw, flatness: f64, seed: u64) -> Count {
    let mut random = Random(seed);
    let mut count = Count::default();
    let (kt, mu) = (2.0, 0.5);
    for _ in 0..60 {
        let kn = random.uniform(0.5, 6.0);
        let parameters = PairParameters {
            normal_load_n: random.uniform(1.0, 6.0),
            normal_stiffness_n_per_m: kn,
            tangential_stiffness_n_per_m: kt,
            friction_coefficient: mu,
        };
        let [first, second] = [1.0, flatness].map(|size| signal(&mut random, size));
        let [v, v_rate] = signal(&mut random, 1.0);
        let mut history = ContactHistory::new(SAMPLES);
        let displacement = PairDisplacement {
            normal: &v,
            tangential: [&first[0], &second[0]],
        };
        history.respond(law, &parameters, displacement);
        let [y1, y2] = history.tangential_correction_n();
        let load = history.normal_load_n();
        let force = |j: usize| [kt * first[0][j] + y1[j], kt * second[0][j] + y2[j]];
        let state = |j: usize| {
            let before = (j + SAMPLES - 1) % SAMPLES;
            if load[j] <= 0.0 {
                State::Open
            } else if (y1[j] - y1[before]).hypot(y2[j] - y2[before]) < 1e-11 {
                // Slip over a sample is many orders larger, the closure of a period not.
                State::Stick
            } else {
                State::Slip
            }
        };
        let speed = |j: usize| first[1][j].hypot(second[1][j]);
        // Rate at which the force would leave the circle in the direction of the force at `at`.
        let leaving = |at: usize, j: usize| {
            let t = force(at);
            let size = t[0].hypot(t[1]);
            kt * (t[0] * first[1][j] + t[1] * second[1][j]) / size - mu * kn * v_rate[j]
        };
        for j in 0..SAMPLES {
            let before = (j + SAMPLES - 1) % SAMPLES;
            // Rates change by this much over a sample, that of the direction included.
            let turning = if flatness > 0.0 && load[j].min(load[before]) > 0.0 {
                (kt * speed(j)).powi(2) / (mu * load[j].min(load[before]))
            } else {
                0.0
            };
            let allowance = TAU / SAMPLES as f64 * (20.0 * (kt + mu * kn) + 2.0 * turning);
            let mut expect = |rate: f64, seen: fn(&mut Count) -> &mut usize| {
                assert!(
                    rate > -allowance,
                    "{rate} at sample {j}, allowed {allowance}"
                );
                count.strict += usize::from(rate > 0.0);
                *seen(&mut count) += 1;
            };
            // Contact begins between two samples: the first one sees a full step of the displacement
            // but part of a step of the load, so the second one tells slip from stick.
            let earlier = (j + SAMPLES - 2) % SAMPLES;
            let states = if state(before) == State::Open && state(j) != State::Open {
                continue;
            } else if state(earlier) == State::Open && state(before) != State::Open {
                (State::Open, state(j))
            } else {
                (state(before), state(j))
            };
            match states {
                (State::Stick, State::Slip) => expect(leaving(j, j), |c| &mut c.stick_to_slip),
                (State::Slip, State::Stick) => {
                    assert!(leaving(before, before) > -allowance);
                    expect(-leaving(before, j), |c| &mut c.slip_to_stick);
                }
                (State::Stick | State::Slip, State::Open) => {
                    assert!(force(j)[0].hypot(force(j)[1]) < 1e-12);
                    expect(-v_rate[j], |c| &mut c.opening);
                }
                (State::Open, State::Slip) => {
                    assert!(v_rate[j] > -allowance);
                    expect(kt * speed(j) - mu * kn * v_rate[j], |c| {
                        &mut c.closing_to_slip
                    });
                }
                (State::Open, State::Stick) => {
                    assert!(v_rate[j] > -allowance);
                    expect(mu * kn * v_rate[j] - kt * speed(j), |c| {
                        &mut c.closing_to_stick
                    });
                }
                (State::Slip, State::Slip) => assert!(leaving(j, j) > -allowance),
                (State::Stick, State::Stick) | (State::Open, State::Open) => {}
            }
        }
    }
    println!("{law:?}, second tangent {flatness}: {count:?}");
    count
}

#[test]
fn transitions_along_one_tangent_are_those_of_yang_chu_and_menq() {
    for law in [ContactLaw::Simplified3d, ContactLaw::Coulomb3d] {
        let count = check(law, 0.0, 41);
        assert!(count.stick_to_slip > 50 && count.slip_to_stick > 50);
        assert!(count.opening > 20 && count.closing_to_slip > 10 && count.closing_to_stick > 5);
        assert!(10 * count.strict > 9 * count.all());
    }
}

#[test]
fn transitions_in_the_plane_are_those_along_the_force() {
    let count = check(ContactLaw::Coulomb3d, 1.0, 42);
    assert!(count.stick_to_slip > 50 && count.slip_to_stick > 50);
    assert!(count.opening > 20 && count.closing_to_slip > 10 && count.closing_to_stick > 2);
    assert!(10 * count.strict > 8 * count.all());
}
