//! Mistuned lumped wheels against the whole wheel marched in time: its own matrices, its own friction, no harmonics.

use std::f64::consts::TAU;

use blisk::model::reduction::BasisChoice;
use blisk::model::sector::{LumpedOptions, lumped};
use blisk::population::monte_carlo::{ResponseRow, Scenario};
use blisk::response::forced_response::{ContactCondition, SolverOptions};
use blisk::response::friction::{ContactLaw, PairParameters};
use blisk::response::harmonic_balance::{Damping, Status};

use super::chains::{KT, ground, ring, shroud, underplatform};
use crate::extremes::wheels::{under, uneven};
use crate::wheels::{Wheel, full, pattern, relative};

const SECTORS: usize = 6;
const ORDER: u32 = 2;
const FRICTION_COEFFICIENT: f64 = 0.3;
/// Damping proportional to the tuned stiffness, s.
const STIFFNESS_S: f64 = 6e-6;
const FORCE_N: f64 = 10.0;
/// Steps of a period, and periods until the motion repeats itself to 1e-6 or so.
const STEPS: usize = 4000;
const PERIODS: usize = 250;

/// A kind of damper and three loads from slip of most contacts to micro-slip, N.
type Kind = (&'static str, fn(usize) -> LumpedOptions, [f64; 3]);
const KINDS: [Kind; 4] = [
    ("shroud", shroud, [5.0, 30.0, 100.0]),
    ("ground", ground, [5.0, 30.0, 60.0]),
    ("underplatform", underplatform, [5.0, 30.0, 100.0]),
    ("ring", ring, [5.0, 30.0, 100.0]),
];

/// The whole wheel in its physical coordinates: sector after sector, masses in the order of the options.
struct WholeWheel {
    mass_kg: Vec<f64>,
    /// Springs `(end, other end, N/m, N s/m)`.
    springs: Vec<(usize, Option<usize>, f64, f64)>,
    /// Contacts `(end, other end, share)`.
    contacts: Vec<(usize, Option<usize>, f64)>,
    forced: Vec<usize>,
}

impl WholeWheel {
    fn new(options: &LumpedOptions, deviations: &[f64]) -> Self {
        let (sectors, count) = (options.sectors, options.mass.len());
        let place = |sector: usize, name: &str| -> Option<usize> {
            let (step, name) = name
                .strip_prefix("next.")
                .map_or((0, name), |name| (1, name));
            let mass = options.mass.iter().position(|mass| mass.name == name)?;
            Some((sector + step) % sectors * count + mass)
        };
        let ends = |sector: usize, between: &[String; 2]| {
            let [a, b] = [place(sector, &between[0]), place(sector, &between[1])];
            a.map_or_else(|| (b.unwrap(), None), |a| (a, b))
        };
        let (mut springs, mut contacts) = (Vec::new(), Vec::new());
        let weights: f64 = options.contact.iter().map(|contact| contact.weight).sum();
        for (sector, deviation) in deviations.iter().enumerate() {
            for spring in &options.spring {
                let (a, b) = ends(sector, &spring.between);
                let tuned = spring.stiffness_n_per_m;
                let factor = if spring.mistuned {
                    1.0 + deviation
                } else {
                    1.0
                };
                springs.push((a, b, tuned * factor, STIFFNESS_S * tuned));
            }
            for contact in &options.contact {
                // The ground is either end; friction does not mind the sign.
                let (a, b) = ends(sector, &contact.between);
                contacts.push((a, b, contact.weight / weights));
            }
        }
        let masses = options.mass.iter().map(|mass| mass.mass_kg);
        let force = options.force.as_deref().unwrap();
        Self {
            mass_kg: masses.cycle().take(sectors * count).collect(),
            springs,
            contacts,
            forced: (0..sectors).map(|n| place(n, force).unwrap()).collect(),
        }
    }

    /// Amplitude of harmonic 1 of every blade, m, after many periods from rest, by central differences.
    fn amplitudes(&self, load_n: f64, frequency_hz: f64) -> Vec<f64> {
        let dt = 1.0 / (frequency_hz * STEPS as f64);
        let n = self.mass_kg.len();
        let (mut x, mut v) = (vec![0.0; n], vec![0.0; n]);
        let mut friction = vec![0.0; self.contacts.len()];
        let mut before = vec![0.0; self.contacts.len()];
        let blades = self.forced.len();
        let mut sums = vec![[0.0; 2]; blades];
        for step in 0..STEPS * PERIODS {
            let phase = TAU * step as f64 / STEPS as f64;
            let mut force = vec![0.0; n];
            for (blade, &at) in self.forced.iter().enumerate() {
                let turn = TAU * f64::from(ORDER) * blade as f64 / blades as f64;
                force[at] += FORCE_N * (phase + turn).cos();
            }
            let mut pull = |a: usize, b: Option<usize>, newton: f64| {
                force[a] -= newton;
                if let Some(b) = b {
                    force[b] += newton;
                }
            };
            for &(a, b, stiffness, damping) in &self.springs {
                let apart = |of: &[f64]| of[a] - b.map_or(0.0, |b| of[b]);
                pull(a, b, stiffness * apart(&x) + damping * apart(&v));
            }
            for (place, &(a, b, share)) in self.contacts.iter().enumerate() {
                let apart = x[a] - b.map_or(0.0, |b| x[b]);
                let limit = FRICTION_COEFFICIENT * load_n * share;
                let elastic = friction[place] + KT * share * (apart - before[place]);
                friction[place] = elastic.clamp(-limit, limit);
                before[place] = apart;
                pull(a, b, friction[place]);
            }
            if step >= STEPS * (PERIODS - 1) {
                for (sum, &at) in sums.iter_mut().zip(&self.forced) {
                    sum[0] += x[at] * phase.cos();
                    sum[1] += x[at] * phase.sin();
                }
            }
            for i in 0..n {
                v[i] += dt * force[i] / self.mass_kg[i];
                x[i] += dt * v[i];
            }
        }
        let amplitude = |sum: &[f64; 2]| 2.0 / STEPS as f64 * sum[0].hypot(sum[1]);
        sums.iter().map(amplitude).collect()
    }
}

fn wheel(options: &LumpedOptions) -> Wheel {
    let contact = PairParameters {
        normal_load_n: 0.0,
        normal_stiffness_n_per_m: 0.0,
        tangential_stiffness_n_per_m: KT,
        friction_coefficient: FRICTION_COEFFICIENT,
    };
    let damping = Damping::Rayleigh {
        mass_per_s: 0.0,
        stiffness_s: STIFFNESS_S,
    };
    let law = ContactLaw::MacroSlip1d;
    let sector = lumped::build(options).unwrap();
    let mut wheel = Wheel::of(&sector, law, contact, damping, BasisChoice::CraigBampton);
    wheel.amplitude_n = FORCE_N;
    wheel
}

/// Rows of one pattern under several conditions of the contact.
fn rows(
    options: &LumpedOptions,
    order: u32,
    deviations: &[f64],
    conditions: &[ContactCondition],
) -> Vec<ResponseRow> {
    let odd: Vec<u32> = (0..8).map(|k| 2 * k + 1).collect();
    let settings = SolverOptions {
        samples_per_period: 768,
        peak_tolerance: 1e-6,
        residual_tolerance: 1e-9,
        ..SolverOptions::default()
    };
    let solver = wheel(options).solver(&odd, settings);
    let scenarios: Vec<Scenario> = conditions.iter().map(|&own| under(order, own)).collect();
    let tuned: Vec<_> = scenarios.iter().map(|own| solver.tuned(own)).collect();
    let wanted: Vec<_> = scenarios.iter().zip(&tuned).collect();
    let rows = solver.rows(&pattern(deviations), &wanted);
    assert!(rows.iter().all(|row| row.status == Status::Ok));
    rows
}

#[test]
fn every_kind_of_contact_is_what_the_whole_wheel_does_in_time() {
    let deviations = uneven(SECTORS, 0.03);
    for (name, options, loads) in KINDS {
        let options = options(SECTORS);
        let marched = WholeWheel::new(&options, &deviations);
        for (load, row) in loads
            .iter()
            .zip(rows(&options, ORDER, &deviations, &loads.map(full)))
        {
            let amplitudes = marched.amplitudes(*load, row.peak_frequency_hz.unwrap());
            let blade = row.peak_blade.unwrap() as usize;
            let found = row.peak_amplitude_m.unwrap();
            let error = found / amplitudes[blade] - 1.0;
            println!(
                "{name} {load} N: {found:.4e} m, slipping {:.2}, against time {error:.1e}",
                row.slipping_fraction.unwrap()
            );
            assert!(error.abs() < 1e-3, "{name}, {load} N: {error:e}");
            let highest = amplitudes.iter().copied().fold(0.0, f64::max);
            assert!(
                relative(highest, amplitudes[blade]) < 1e-3,
                "{name}, {load} N"
            );
        }
    }
}

/// No load is the sliding limit, much load and friction without a coefficient are the limits that they mean.
#[test]
fn limits_of_every_kind_are_the_linear_ones() {
    let deviations = uneven(SECTORS, 0.03);
    let conditions = [
        full(1e-9),
        ContactCondition::Slide,
        full(1e9),
        ContactCondition::Stuck,
    ];
    for (name, options, _) in KINDS {
        let found = rows(&options(SECTORS), ORDER, &deviations, &conditions);
        let amplitude: Vec<f64> = found
            .iter()
            .map(|row| row.peak_amplitude_m.unwrap())
            .collect();
        assert!(
            relative(amplitude[0], amplitude[1]) < 1e-6,
            "{name}: {amplitude:?}"
        );
        assert!(
            relative(amplitude[2], amplitude[3]) < 1e-6,
            "{name}: {amplitude:?}"
        );
        // Both are no trivial limit: the contact matters.
        assert!(
            relative(amplitude[1], amplitude[3]) > 0.01,
            "{name}: {amplitude:?}"
        );
    }
}

/// Blades numbered from another one on, and the mirrored wheel under the mirrored wave, answer alike.
#[test]
fn numbering_and_direction_are_conventions() {
    let deviations = uneven(SECTORS, 0.03);
    let shifted: Vec<f64> = (0..SECTORS)
        .map(|n| deviations[(n + 2) % SECTORS])
        .collect();
    // Blade n of the mirrored wheel is blade -n; its contact with the next blade is that with the one before.
    let mirrored: Vec<f64> = (0..SECTORS)
        .map(|n| deviations[(SECTORS - n) % SECTORS])
        .collect();
    for (name, options, loads) in KINDS {
        let options = options(SECTORS);
        let condition = [full(loads[1])];
        let row = |order: u32, deviations: &[f64]| {
            let row = rows(&options, order, deviations, &condition).remove(0);
            (
                row.peak_amplitude_m.unwrap(),
                row.peak_blade.unwrap() as usize,
            )
        };
        let (amplitude, blade) = row(ORDER, &deviations);
        let (other, other_blade) = row(ORDER, &shifted);
        assert!(
            relative(other, amplitude) < 1e-5,
            "{name}: {other} {amplitude}"
        );
        assert_eq!((other_blade + 2) % SECTORS, blade, "{name}");
        let (other, other_blade) = row(SECTORS as u32 - ORDER, &mirrored);
        assert!(
            relative(other, amplitude) < 1e-5,
            "{name}: {other} {amplitude}"
        );
        assert_eq!((SECTORS - other_blade) % SECTORS, blade, "{name}");
        // The wave in the other direction on the same wheel is another response.
        let (other, _) = row(SECTORS as u32 - ORDER, &deviations);
        assert!(
            relative(other, amplitude) > 1e-4,
            "{name}: {other} {amplitude}"
        );
    }
}
