//! Harmonic balance of a whole wheel on the motions at the contact. Each step solves the wheel with springs that follow
//! the contact forces of the step before; what is left of them is a load. Steps are combined (Anderson 1965; Walker and
//! Ni 2011), and the springs are taken anew where the steps no longer get shorter.

use std::f64::consts::TAU;

use faer::linalg::solvers::SolveLstsq;
use faer::{Mat, c64};

use super::contact::{Law, Period};
use super::sector::{DIRECTIONS, Sector};
use super::wheel::{FactoredWheel, PairStiffness};

/// What a wheel is excited and held by.
#[derive(Clone)]
pub struct Case {
    pub loss_factor: f64,
    pub engine_order: u32,
    /// Relative deviation of each blade's stiffness.
    pub deviations: Vec<f64>,
    /// Contact per sector.
    pub contact: Contact,
}

/// What holds the ring, with the parameters of a sector.
#[derive(Clone, Copy)]
pub enum Contact {
    Friction(Law),
    /// Springs that never open or slip: normal and tangential, N/m.
    Springs(f64, f64),
}

/// Length of a step relative to the motion at which a point is solved.
pub const TOLERANCE: f64 = 1e-6;
const MOST_STEPS: usize = 200;
const MEMORY: usize = 20;
/// Steps after which the springs are taken anew in any case.
const STEPS_PER_SPRINGS: usize = 25;

/// A solved frequency.
#[derive(Clone)]
pub struct Point {
    pub frequency_hz: f64,
    /// Amplitude of the first harmonic of each blade, m.
    pub amplitudes_m: Vec<f64>,
    /// Motion at the contact, harmonic by harmonic.
    pub motion: Vec<Vec<c64>>,
    pub steps: usize,
    pub opening_pairs: usize,
    pub slipping_pairs: usize,
}

impl Point {
    pub fn amplitude_m(&self) -> f64 {
        self.amplitudes_m.iter().copied().fold(0.0, f64::max)
    }
}

/// Solves a frequency with `harmonics` from `start`, the motion of each; none where no solution was reached.
pub fn solve(
    sector: &Sector,
    case: &Case,
    harmonics: &[u32],
    period: &Period,
    frequency_hz: f64,
    start: Option<&[Vec<c64>]>,
) -> Option<Point> {
    let pairs = sector.pairs.len() * sector.sectors;
    let omega = TAU * frequency_hz;
    let springs_of = |normal: f64, tangential: f64| -> Vec<PairStiffness> {
        let of = |place: usize| {
            let weight = sector.pairs[place % sector.pairs.len()].weight;
            let mut springs = [[c64::new(0.0, 0.0); DIRECTIONS]; DIRECTIONS];
            for (direction, row) in springs.iter_mut().enumerate() {
                let stiffness = if direction == 0 { normal } else { tangential };
                row[direction] = c64::new(weight * stiffness, 0.0);
            }
            springs
        };
        (0..pairs).map(of).collect()
    };
    let factored = |harmonic: u32, springs: &[PairStiffness]| {
        let omega = f64::from(harmonic) * omega;
        FactoredWheel::new(sector, omega, case.loss_factor, &case.deviations, springs)
    };
    let rows = sector.contact_rows() * sector.sectors;
    let amplitudes = |observed: &[c64]| -> Vec<f64> {
        let of = |blade: &[c64]| blade.iter().map(|u| u.norm_sqr()).sum::<f64>().sqrt();
        observed.chunks(sector.observed.len()).map(of).collect()
    };
    let nothing = vec![c64::new(0.0, 0.0); rows];
    let law = match case.contact {
        Contact::Friction(law) => law,
        Contact::Springs(normal, tangential) => {
            let wheel = factored(1, &springs_of(normal, tangential));
            let motion = wheel.solve(&nothing, Some(case.engine_order));
            return Some(Point {
                frequency_hz,
                amplitudes_m: amplitudes(&motion.observed),
                motion: vec![motion.contact],
                steps: 0,
                opening_pairs: 0,
                slipping_pairs: 0,
            });
        }
    };
    let laws: Vec<Law> = (0..pairs)
        .map(|place| {
            let weight = sector.pairs[place % sector.pairs.len()].weight;
            Law {
                normal_load_n: weight * law.normal_load_n,
                normal_stiffness_n_per_m: weight * law.normal_stiffness_n_per_m,
                tangential_stiffness_n_per_m: weight * law.tangential_stiffness_n_per_m,
                ..law
            }
        })
        .collect();
    let mut motion: Vec<Vec<c64>> = match start {
        Some(start) => start.to_vec(),
        None => {
            let (normal, tangential) = (
                law.normal_stiffness_n_per_m,
                law.tangential_stiffness_n_per_m,
            );
            let stuck = factored(1, &springs_of(normal, tangential));
            let stuck = stuck.solve(&nothing, Some(case.engine_order)).contact;
            let of = |&k: &u32| {
                if k == 1 {
                    stuck.clone()
                } else {
                    nothing.clone()
                }
            };
            harmonics.iter().map(of).collect()
        }
    };
    let mut wheels: Vec<FactoredWheel<'_>> = Vec::new();
    let mut springs: Vec<Vec<PairStiffness>> = Vec::new();
    let mut history: Vec<(Vec<f64>, Vec<f64>)> = Vec::new();
    let mut lengths: Vec<f64> = Vec::new();
    for step in 0..MOST_STEPS {
        let of_pair = |place: usize| -> Vec<[c64; DIRECTIONS]> {
            let own = |u: &Vec<c64>| std::array::from_fn(|row| u[DIRECTIONS * place + row]);
            motion.iter().map(own).collect()
        };
        let answers: Vec<_> = (0..pairs)
            .map(|place| period.answer(laws[place], harmonics, &of_pair(place)))
            .collect();
        let since = lengths.len();
        let stalls = since >= 6 && lengths[since - 1] > 0.5 * lengths[since - 5];
        if wheels.is_empty()
            || (step == 3 && start.is_none())
            || stalls
            || since >= STEPS_PER_SPRINGS
        {
            springs = (0..harmonics.len())
                .map(|k| answers.iter().map(|own| own.tangent[k]).collect())
                .collect();
            wheels = harmonics
                .iter()
                .zip(&springs)
                .map(|(&k, springs)| factored(k, springs))
                .collect();
            history.clear();
            lengths.clear();
        }
        let mut observed = Vec::new();
        let mut next = Vec::with_capacity(harmonics.len());
        for (k, wheel) in wheels.iter().enumerate() {
            let mut load = vec![c64::new(0.0, 0.0); rows];
            for (place, answer) in answers.iter().enumerate() {
                for row in 0..DIRECTIONS {
                    let at = DIRECTIONS * place + row;
                    load[at] = -answer.force[k][row];
                    for column in 0..DIRECTIONS {
                        let spring = springs[k][place][row][column];
                        load[at] += spring * motion[k][DIRECTIONS * place + column];
                    }
                }
            }
            let order = (harmonics[k] == 1).then_some(case.engine_order);
            let mut moved = wheel.solve(&load, order);
            if harmonics[k] == 0 {
                moved.contact.iter_mut().for_each(|u| u.im = 0.0);
            }
            if harmonics[k] == 1 {
                observed = moved.observed;
            }
            next.push(moved.contact);
        }
        let (from, to) = (flat(&motion), flat(&next));
        let change: Vec<f64> = to.iter().zip(&from).map(|(to, from)| to - from).collect();
        let length = norm(&change) / norm(&to);
        if !length.is_finite() {
            return None;
        }
        if length < TOLERANCE {
            return Some(Point {
                frequency_hz,
                amplitudes_m: amplitudes(&observed),
                motion: next,
                steps: step + 1,
                opening_pairs: answers.iter().filter(|own| own.opens).count(),
                slipping_pairs: answers.iter().filter(|own| own.slips).count(),
            });
        }
        lengths.push(length);
        history.push((from, change));
        if history.len() > MEMORY {
            history.remove(0);
        }
        motion = unflat(&combined(&history), harmonics.len());
    }
    None
}

/// Where the steps so far, combined so that their changes cancel as far as they can, lead to.
fn combined(history: &[(Vec<f64>, Vec<f64>)]) -> Vec<f64> {
    let (last, change) = history.last().expect("a step");
    let mut next: Vec<f64> = last.iter().zip(change).map(|(u, r)| u + r).collect();
    let before = &history[..history.len() - 1];
    if before.is_empty() {
        return next;
    }
    let differences = Mat::from_fn(change.len(), before.len(), |i, j| {
        change[i] - before[j].1[i]
    });
    let right = Mat::from_fn(change.len(), 1, |i, _| change[i]);
    let weights = differences.col_piv_qr().solve_lstsq(&right);
    for (j, (u, r)) in before.iter().enumerate() {
        let weight = weights[(j, 0)];
        for (i, next) in next.iter_mut().enumerate() {
            *next -= weight * (last[i] + change[i] - u[i] - r[i]);
        }
    }
    next
}

fn flat(motion: &[Vec<c64>]) -> Vec<f64> {
    motion.iter().flatten().flat_map(|u| [u.re, u.im]).collect()
}

fn unflat(flat: &[f64], harmonics: usize) -> Vec<Vec<c64>> {
    let pairs = flat.chunks(flat.len() / harmonics);
    let complex = |own: &[f64]| own.chunks(2).map(|u| c64::new(u[0], u[1])).collect();
    pairs.map(complex).collect()
}

fn norm(vector: &[f64]) -> f64 {
    vector.iter().map(|part| part * part).sum::<f64>().sqrt()
}
