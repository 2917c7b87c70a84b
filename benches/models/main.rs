//! What a Newton step is made of and what a peak costs, for several models, sizes of basis and harmonic sets.
//!
//! `cargo bench --bench models` prints two Markdown tables: the smallest of a few repetitions on one thread, pattern 0 under
//! the middle load of its study, all harmonics of the mistuned wheel.

#![allow(clippy::print_stdout)] // The tables are the result of this program.

#[path = "../common/mod.rs"]
mod common;

use std::f64::consts::TAU;
use std::hint::black_box;
use std::time::Duration;

use blisk::linalg::LuWorkspace;
use blisk::model::reduction::Basis;
use blisk::population::monte_carlo::Scenario;
use blisk::response::forced_response::{ContactCondition, Harmonics, Peak};
use blisk::response::harmonic_balance::HarmonicTransform;
use blisk::study::Study;

use common::case::{Case, Model, study};
use common::machine::{Floor, smallest};

const HARMONICS: [&[u32]; 3] = [&[1], &[1, 3], &[0, 1, 2, 3]];
/// Steps are timed so often, and peaks, which take seconds with the largest sets.
const REPETITIONS: [usize; 2] = [10, 2];

fn models() -> [(&'static str, Study); 4] {
    let wheel24 = |modes| {
        let mut wheel24 = study("validation/wheel24");
        wheel24.reduction.basis = Basis::StickSlide;
        wheel24.reduction.stick_modes = Some(modes);
        wheel24.reduction.slide_modes = Some(modes);
        wheel24.solver.samples_per_period = 128;
        wheel24.solver.peak_tolerance = 1e-3;
        wheel24
    };
    [
        ("lumped24", study("lumped24")),
        ("quickstart", study("quickstart")),
        ("wheel24, 2+2", wheel24(2)),
        ("wheel24, 6+6", wheel24(6)),
    ]
}

/// One line of both tables.
struct Measured {
    name: &'static str,
    harmonics: Vec<u32>,
    unknowns: usize,
    contact_rows: usize,
    parts: Parts,
    floor: Floor,
    peak: Peak,
    peak_time: Duration,
    /// A row with its error columns, and a stuck one.
    row: Duration,
    linear_row: Duration,
}

/// What a Newton step with the whole Jacobian is made of.
struct Parts {
    /// A residual where every pair surely sticks, so that none is evaluated.
    structure: Duration,
    /// What the contact adds to it: transforms and law.
    contact: Duration,
    /// All contact rows to samples and back, by themselves: the largest share of that which transforms can have.
    transforms: Duration,
    /// What the derivatives of all pairs add.
    derivatives: Duration,
    assembly: Duration,
    factors: Duration,
    solve: Duration,
}

impl Parts {
    fn of(case: &Case, peak: &Peak, load: f64) -> Self {
        let point = peak.point.as_ref().expect("a peak");
        let excited = case.excited(&case.patterns[0], case.harmonics());
        let system = case.system(&excited, load);
        let (omega, n) = (TAU * point.frequency_hz, system.unknowns());
        let mut workspace = system.workspace();
        let mut residual = vec![0.0; n];
        let rest = vec![0.0; n];
        let mut of_residual = |x: &[f64], derivative| {
            let once = || {
                system.residual(
                    omega,
                    black_box(x),
                    &mut residual,
                    derivative,
                    &mut workspace,
                )
            };
            smallest(REPETITIONS[0], once).0
        };
        let structure = of_residual(&rest, false);
        let plain = of_residual(&point.solution, false);
        let with_derivatives = of_residual(&point.solution, true);
        let mut lu = LuWorkspace::<f64>::new(n);
        let mut jacobian = vec![0.0; n * n];
        let (assembly, ()) = smallest(REPETITIONS[0], || {
            system.jacobian(omega, &mut workspace, &mut jacobian);
        });
        let (factors, _) = smallest(REPETITIONS[0], || {
            lu.matrix_mut().copy_from_slice(&jacobian);
            lu.factor()
        });
        let (solve, ()) = smallest(REPETITIONS[0], || lu.solve(&mut residual));
        Self {
            structure,
            contact: plain.saturating_sub(structure),
            transforms: transforms(case),
            derivatives: with_derivatives.saturating_sub(plain),
            assembly,
            factors,
            solve,
        }
    }

    fn residual(&self) -> Duration {
        self.structure + self.contact
    }

    fn jacobian(&self) -> Duration {
        self.derivatives + self.assembly + self.factors
    }

    fn step(&self) -> Duration {
        self.residual() + self.jacobian() + self.solve
    }
}

/// All contact rows to samples and their forces back.
fn transforms(case: &Case) -> Duration {
    let set: Vec<usize> = case.harmonics().iter().map(|&k| k as usize).collect();
    let samples = case.study.solver.samples_per_period;
    let transform = HarmonicTransform::new(&set, samples).expect("enough samples");
    let rows = case.solver.basis().contact().rows();
    let mut coefficients = vec![1.0; rows * transform.n_coefficients()];
    let mut histories = vec![0.0; rows * samples];
    let mut scratch = transform.scratch();
    let both = || {
        transform.synthesize(&coefficients, &mut histories, &mut scratch);
        transform.project(&histories, &mut coefficients, &mut scratch);
    };
    smallest(REPETITIONS[0], both).0
}

fn measured(name: &'static str, model: &Model, mut study: Study, harmonics: &[u32]) -> Measured {
    study.solver.harmonics = Harmonics::Set(harmonics.to_vec());
    let case = Case::with_model(name, model, study, 1);
    let pattern = &case.patterns[0];
    let loads = case.loads();
    let normal_load_n = loads[loads.len() / 2];
    let condition = ContactCondition::Full { normal_load_n };
    let (peak_time, peak) = smallest(REPETITIONS[1], || {
        let excited = case.excited(pattern, case.harmonics());
        case.peak(pattern, &excited, condition)
    });
    let row = |contact: ContactCondition| {
        let scenario = Scenario {
            contact,
            ..case.study.scenarios()[0]
        };
        let tuned = case.solver.tuned(&scenario);
        smallest(REPETITIONS[1], || {
            black_box(case.solver.rows(pattern, &[(&scenario, &tuned)]));
        })
        .0
    };
    let contact_rows = case.solver.basis().contact().rows();
    let parts = Parts::of(&case, &peak, normal_load_n);
    let unknowns = peak.point.as_ref().expect("a peak").solution.len();
    Measured {
        name,
        harmonics: harmonics.to_vec(),
        unknowns,
        contact_rows,
        floor: Floor::measured(unknowns, contact_rows, REPETITIONS[0]),
        parts,
        peak,
        peak_time,
        row: row(condition),
        linear_row: row(ContactCondition::Stuck),
    }
}

fn ms(time: Duration) -> f64 {
    1e3 * time.as_secs_f64()
}

impl Measured {
    fn label(&self) -> String {
        let set: Vec<String> = self.harmonics.iter().map(ToString::to_string).collect();
        format!("{} | {}", self.name, set.join(", "))
    }

    fn print_step(&self) {
        let (parts, floor) = (&self.parts, &self.floor);
        let times = [
            parts.structure,
            parts.contact,
            parts.transforms,
            parts.derivatives,
            parts.assembly,
            parts.factors,
            parts.solve,
            parts.step(),
            floor.step(),
        ];
        let times: Vec<String> = times
            .iter()
            .map(|&time| format!("{:.3}", ms(time)))
            .collect();
        println!(
            "| {} | {} | {} | {} | {:.2} | {:.0}, {:.0} |",
            self.label(),
            self.unknowns,
            self.contact_rows,
            times.join(" | "),
            parts.step().div_duration_f64(floor.step()),
            1e-9 * floor.rates[0],
            1e-9 * floor.rates[1],
        );
    }

    /// Beside the peak: its counts at the prices of the first table, of which the floor is what dense algebra takes for the
    /// factorisations alone.
    fn print_peak(&self) {
        let work = &self.peak.work;
        let steps = (self.parts.residual() + self.parts.solve)
            .mul_f64(work.newton_iterations as f64)
            + self.parts.jacobian().mul_f64(work.factorisations as f64);
        let floor = self.floor.step().mul_f64(work.factorisations as f64);
        println!(
            "| {} | {} | {:.1} | {} | {} | {} | {:.1} | {:.1} | {:.2} | {:.1} | {:.2} | {:.1} |",
            self.label(),
            self.peak.status.name(),
            ms(self.peak_time),
            work.nonlinear_solves,
            work.newton_iterations,
            work.factorisations,
            ms(steps),
            ms(floor),
            self.peak_time.div_duration_f64(floor),
            ms(self.row),
            ms(self.linear_row),
            self.row.div_duration_f64(self.linear_row),
        );
    }
}

fn main() {
    let mut all = Vec::new();
    println!("| model | reduced model, s |\n| --- | ---: |");
    for (name, study) in models() {
        let (time, model) = smallest(1, || Model::new(&study));
        println!("| {name} | {:.2} |", time.as_secs_f64());
        all.extend(HARMONICS.map(|set| measured(name, &model, study.clone(), set)));
    }
    println!(
        "\nms:\n\n| model | harmonics | unknowns | contact rows | structure | contact | its transforms at most | derivatives | assembly | LU | solve \
         | step | floor | step / floor | LU, product, GFLOP/s |\n| --- | --- |{}",
        " ---: |".repeat(13)
    );
    all.iter().for_each(Measured::print_step);
    println!(
        "\n| model | harmonics | status | peak, ms | solves | iterations | factorisations | as whole steps, ms | floor, ms | peak / floor \
         | row, ms | linear row, ms | row / linear |\n| --- | --- | --- |{}",
        " ---: |".repeat(10)
    );
    all.iter().for_each(Measured::print_peak);
}
