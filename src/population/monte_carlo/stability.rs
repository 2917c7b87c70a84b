//! Whether the wheel of a row stays on the motion at its peak.

use std::f64::consts::TAU;

use super::{LoadCaseSolvers, ResponseRow, RowSolver, Scenario, TunedReference};
use crate::response::forced_response::{
    ContactCondition, EngineRow, PointSettings, SolverOptions, receptance_contact_motion,
};
use crate::response::friction::{ContactLaw, Ring};
use crate::response::mistuning::Pattern;
use crate::response::receptance::EngineWheel;
use crate::response::stability::{ContactMotion, StabilityOptions, multipliers};

/// Highest harmonic of the motion that is looked at: when pairs slip and open decides, and few harmonics say that badly.
const HIGHEST: u32 = 31;
/// Samples per period of its solution.
const SAMPLES: usize = 512;
/// Steps per period.
const STEPS: usize = 1024;

/// Whether small disturbances of the motion of `row`, which `solvers` gave, at its peak die out; none for a linear limit and a
/// creeping ring, and where that is not settled.
#[must_use]
pub fn is_row_stable(
    solvers: &LoadCaseSolvers,
    pattern: &Pattern,
    scenario: &Scenario,
    row: &ResponseRow,
) -> Option<bool> {
    let solver = solvers.under(scenario).solver_of(scenario, row);
    stays(solver, Some(pattern), scenario, row.peak_frequency_hz?)
}

/// [`is_row_stable`] of the tuned wheel.
#[must_use]
pub fn is_tuned_stable(
    solvers: &LoadCaseSolvers,
    scenario: &Scenario,
    tuned: &TunedReference,
) -> Option<bool> {
    let solver = solvers.under(scenario).rows();
    stays(solver, None, scenario, tuned.frequency_hz?)
}

fn stays(
    solver: &RowSolver,
    pattern: Option<&Pattern>,
    scenario: &Scenario,
    hz: f64,
) -> Option<bool> {
    let ContactCondition::Full { normal_load_n } = scenario.contact else {
        return None;
    };
    let settings = solver.settings();
    let (law, sector) = settings.contact?;
    if settings.ring != Ring::Locked {
        return None;
    }
    let rows = solver.on_receptances.as_ref()?;
    let (engine, force) = (rows.receptances(), rows.force(scenario.engine_order)?);
    let wheel = EngineWheel::new(pattern, engine.sectors());
    let row = EngineRow {
        engine,
        wheel: &wheel,
        force,
        condition: scenario.contact,
    };
    let points = &solver.on_basis.points;
    let points = points.of(pattern, scenario.engine_order, scenario.contact);
    let finer = finer(&settings.solver, &points, law)?;
    let harmonics = receptance_contact_motion(&row, &points, &finer, hz).ok()??;
    let omega = TAU * hz;
    let found = multipliers(
        &engine.free_wheel(&wheel, omega)?,
        &points.interface(law, sector, normal_load_n),
        &ContactMotion { harmonics },
        omega,
        &StabilityOptions {
            steps_per_period: STEPS,
            ..StabilityOptions::default()
        },
    );
    found?.stable
}

/// The settings of a point with all harmonics up to a high one that the law excites.
fn finer(
    options: &SolverOptions,
    points: &PointSettings,
    law: ContactLaw,
) -> Option<PointSettings> {
    let odd = !law.has_variable_load() && points.harmonics().iter().all(|k| k % 2 == 1);
    let harmonics: Vec<u32> = (0..=HIGHEST).filter(|k| !odd || k % 2 == 1).collect();
    let options = SolverOptions {
        samples_per_period: SAMPLES.max(options.samples_per_period),
        ..options.clone()
    };
    points.with_harmonics(&harmonics, &options).ok()
}
