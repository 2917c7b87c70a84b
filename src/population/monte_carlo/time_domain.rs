//! The point of a row, its pattern at the frequency of its peak, by time integration as well.

use super::{LoadCaseSolvers, ResponseRow, Scenario};
use crate::response::forced_response::ContactCondition;
use crate::response::friction::PairParameters;
use crate::response::harmonic_balance::Status;
use crate::response::mistuning::Pattern;
use crate::verification::time_integration::{
    PointCase, PointComparison, TimeOptions, compare_point,
};

/// The point of `row`, which `solvers` gave, by harmonic balance and by time integration, on the reduced model and with the
/// harmonics that the row was solved with, both with the same viscous damping.
///
/// # Errors
/// The status of a row without peak frequency, of a pattern that cannot be applied, or of the
/// harmonic balance; `invalid_pattern` where there is no contact law to march.
pub fn compare_in_time(
    solvers: &LoadCaseSolvers,
    pattern: &Pattern,
    scenario: &Scenario,
    row: &ResponseRow,
    options: &TimeOptions,
) -> Result<PointComparison, Status> {
    let solver = solvers.under(scenario).solver_of(scenario, row);
    let frequency_hz = row.peak_frequency_hz.ok_or(row.status)?;
    let change = solver
        .on_basis
        .stiffness_change(pattern)
        .ok_or(Status::InvalidPattern)?;
    let settings = solver.settings();
    let (Some((law, sector)), ContactCondition::Full { normal_load_n }) =
        (settings.contact, scenario.contact)
    else {
        return Err(Status::InvalidPattern);
    };
    let case = PointCase {
        basis: solver.basis(),
        stiffness_change: Some(&change),
        damping: settings.damping,
        engine_order: scenario.engine_order,
        amplitude_n: settings.amplitude_n,
        law,
        sector: PairParameters {
            normal_load_n,
            ..sector
        },
        factors: &pattern.contact,
        harmonics: solver.points(scenario).harmonics(),
        solver: &settings.solver,
        frequency_hz,
    };
    compare_point(&case, options)
}
