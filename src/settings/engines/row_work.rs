//! Rows of an engine, whatever happens while they are solved, and the tuned references beside them.

use std::panic::{AssertUnwindSafe, catch_unwind};

use super::Engine;
use crate::population::monte_carlo::{ResponseRow, Scenario, TunedReference};
use crate::report::{excitation, short_load_with_unit};
use crate::response::harmonic_balance::Status;
use crate::response::mistuning::{Pattern, PatternSource};
use crate::settings::progress::Progress;

/// All that the solution of rows needs.
pub(crate) struct RowWork<'a> {
    pub(crate) engine: &'a dyn Engine,
    pub(crate) patterns: &'a PatternSource,
    pub(crate) scenarios: &'a [Scenario],
    /// One for each scenario.
    pub(crate) tuned: &'a [TunedReference],
    pub(crate) progress: &'a dyn Progress,
}

impl RowWork<'_> {
    /// Rows of one pattern under the scenarios `wanted`, in their order; the engine sees the
    /// scenarios of each standard deviation together.
    pub(crate) fn of_pattern(&self, id: u32, wanted: &[usize]) -> Vec<ResponseRow> {
        let mut standard_deviations: Vec<Option<f64>> = Vec::new();
        for &index in wanted {
            let standard_deviation = self.scenarios[index].standard_deviation;
            if !standard_deviations.contains(&standard_deviation) {
                standard_deviations.push(standard_deviation);
            }
        }
        let mut rows = Vec::with_capacity(wanted.len());
        for standard_deviation in standard_deviations {
            let group: Vec<(&Scenario, &TunedReference)> = wanted
                .iter()
                .map(|&index| (&self.scenarios[index], &self.tuned[index]))
                .filter(|(scenario, _)| scenario.standard_deviation == standard_deviation)
                .collect();
            let pattern = self.patterns.pattern(id, standard_deviation);
            let pattern = pattern.expect("every id of a run is one of its patterns");
            rows.extend(rows_of(self.engine, &pattern, &group));
        }
        rows.sort_by_key(|row| row.scenario);
        for row in &rows {
            self.progress.row(row.status);
        }
        rows
    }
}

/// Rows of one pattern under scenarios of the same standard deviation. A panic costs the rows of that pattern, not the run.
pub(crate) fn rows_of(
    engine: &dyn Engine,
    pattern: &Pattern,
    scenarios: &[(&Scenario, &TunedReference)],
) -> Vec<ResponseRow> {
    let solve = AssertUnwindSafe(|| engine.rows(pattern, scenarios));
    catch_unwind(solve).unwrap_or_else(|_| {
        scenarios
            .iter()
            .map(|(scenario, _)| ResponseRow {
                contact_factors: pattern.contact.means(),
                ..ResponseRow::without_result(scenario.index, pattern.id, Status::Panicked)
            })
            .collect()
    })
}

/// Tuned reference of each scenario. The tuned wheel, which knows no standard deviation, is solved once per engine order and
/// contact condition; `progress` is told which one.
pub(crate) fn tuned_references(
    engine: &dyn Engine,
    scenarios: &[Scenario],
    progress: &dyn Progress,
) -> Vec<TunedReference> {
    let first_alike = |scenario: &Scenario| {
        let alike =
            |other: &Scenario| other.same_excitation(scenario) && other.contact == scenario.contact;
        scenarios.iter().position(alike)
    };
    let own: Vec<&Scenario> = { scenarios.iter().enumerate() }
        .filter(|(place, scenario)| first_alike(scenario) == Some(*place))
        .map(|(_, scenario)| scenario)
        .collect();
    let mut solved = 0;
    let mut tuned: Vec<TunedReference> = Vec::new();
    for (place, scenario) in scenarios.iter().enumerate() {
        let same = first_alike(scenario).filter(|&first| first < place);
        if same.is_none() {
            solved += 1;
            progress.step(&tuned_step(scenario, solved, &own));
        }
        tuned.push(match same {
            Some(same) => TunedReference {
                scenario: scenario.index,
                ..tuned[same].clone()
            },
            None => engine.tuned(scenario),
        });
    }
    tuned
}

/// The tuned wheel of `scenario`, the `number`th of `all` that are solved: by load, and by engine order and load case where they differ.
fn tuned_step(scenario: &Scenario, number: usize, all: &[&Scenario]) -> String {
    let contact = scenario.contact;
    let load = short_load_with_unit(contact.name(), contact.normal_load_n());
    let count = all.len();
    if all.iter().all(|other| other.same_excitation(scenario)) {
        return format!("tuned wheel: load {number} of {count} ({load})");
    }
    let excitation = excitation(scenario.load_case, scenario.engine_order);
    format!("tuned wheel: load {number} of {count} ({excitation}, {load})")
}
