//! The summary of a study as text for a terminal and for `summary.txt`.

use std::fmt;

use super::text_table::TextTable;
use super::words::{
    LengthUnit, basis_words, excitation, excitation_and_deviation, load_per_sector, load_words,
    scenarios_in_words, trimmed,
};
use super::{BestLoad, NumericalError, ScenarioSummary, StudySummary};
use crate::population::statistics::{
    PointStatus, SampleStatistics, ScenarioLook, ScenarioStability, StopOutcome,
};

impl fmt::Display for StudySummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "study {}: {} patterns, {} scenarios, seed {}; {} rows ok, {} failed",
            self.name,
            self.patterns,
            self.scenarios.len(),
            self.seed,
            self.rows.ok(),
            self.rows.failed()
        )?;
        if let Some(error) = self.basis.tuned_peak_error {
            writeln!(
                f,
                "{}, tuned peak within {:.2} % of the full contact model at the same harmonics",
                basis_words(&self.basis.name),
                100.0 * error
            )?;
        }
        if let Some(error) = &self.numerical_error {
            writeln!(f, "{}", numerical_line(error))?;
        }
        if let Some(stop) = &self.stop {
            let named = |own: usize| scenarios_in_words(self, &[own]);
            writeln!(f, "{}", stop_line(stop, &named))?;
        }
        if let Some(rotation) = &self.rotation {
            writeln!(f, "{rotation}")?;
        }
        if let Some(scale) = self.stress_pa_per_m {
            writeln!(f, "{}", stress_line(scale, &self.scenarios))?;
        }
        if let Some(line) = stability_line(&self.scenarios) {
            writeln!(f, "{line}")?;
        }
        let unit = LengthUnit::of_summary(self);
        let groups = self.scenarios.chunk_by(ScenarioSummary::same_group);
        for group in groups {
            writeln!(f, "\n{}", heading(&group[0]))?;
            write!(f, "{}", amplitudes(group, unit, self.is_of_one_wheel()))?;
            if !self.is_of_one_wheel() {
                write!(f, "\n{}", factors(group))?;
            }
        }
        if !self.best.is_empty() {
            writeln!(f)?;
        }
        for best in &self.best {
            writeln!(f, "{}", best_line(best, unit))?;
        }
        if !self.warnings.is_empty() {
            writeln!(f)?;
        }
        for warning in &self.warnings {
            let named = |own: &[usize]| scenarios_in_words(self, own);
            writeln!(f, "warning: {}", warning.in_words(&named))?;
        }
        if self.is_of_one_wheel() {
            return writeln!(
                f,
                "\npeak is that of the one wheel of mistuning.file, amplification its ratio to the tuned peak of the same \
                 normal load; of one wheel there is no percentile. - = no result, or no such thing: the linear solutions \
                 slide, stuck and free have no slip.\n\
                 A load N is the normal load per sector."
            );
        }
        writeln!(
            f,
            "\nP50, P95, P99 are order statistics over the patterns with 95 % bounds in brackets \
             (distribution-free); failed rows count as very small in the lower bound and as very large \
             in the upper one. - = not estimable, or no such thing: the linear solutions slide, stuck and \
             free have no slip.\n\
             A load N is the normal load per sector. Amplification factor: peak over the tuned peak of \
             the same normal load."
        )
    }
}

impl StudySummary {
    /// What each row with friction is held to, in a paragraph; empty where there is none, or nothing is known.
    #[must_use]
    pub fn held_to(&self) -> String {
        let accepted = self.numerical_error.map(|error| error.accepted);
        let words = self.tolerance.in_words(accepted);
        let mut scenarios = self.scenarios.iter();
        if words.is_empty() || !scenarios.any(|own| own.normal_load_n.is_some()) {
            return String::new();
        }
        format!("Accuracy: {words}.\n\n")
    }
}

fn numerical_line(error: &NumericalError) -> String {
    let bound = error.p95_upper.map_or("no bound".to_owned(), |bound| {
        format!("95 % of the amplitudes within {:.2} %", 100.0 * bound)
    });
    let worst = error.worst_upper.map_or(String::new(), |worst| {
        format!(", the worst within {:.2} %", 100.0 * worst)
    });
    let accepted = 100.0 * error.accepted;
    format!(
        "settings chosen by an accepted numerical error of {accepted} %: {bound}{worst}, measured on a sample"
    )
}

/// What is known of the stability of motions, in a line; none where none was looked at.
fn stability_line(scenarios: &[ScenarioSummary]) -> Option<String> {
    let found: Vec<_> = scenarios.iter().filter_map(|own| own.stability).collect();
    if found.is_empty() {
        return None;
    }
    let sum = |of: &dyn Fn(&ScenarioStability) -> u64| found.iter().map(of).sum::<u64>();
    let tuned = |stable: Option<bool>| sum(&|own| u64::from(own.tuned == stable));
    let rows = sum(&|own| own.rows);
    let (stable, unstable) = (sum(&|own| own.stable), sum(&|own| own.unstable));
    Some(format!(
        "stability: of {rows} rows {stable} stable, {unstable} unstable, {} not settled; of {} tuned wheels {} stable, {} \
         unstable, {} not settled",
        rows - stable - unstable,
        found.len(),
        tuned(Some(true)),
        tuned(Some(false)),
        tuned(None)
    ))
}

/// What the stopping rule came to, in a line.
fn stop_line(stop: &StopOutcome, named: &dyn Fn(usize) -> String) -> String {
    let made = stop.made.len();
    let last = stop.made.last();
    let widest = last.iter().flat_map(|look| &look.scenarios).max_by(|a, b| {
        let width = |scenario: &ScenarioLook| scenario.relative_width.unwrap_or(f64::INFINITY);
        width(a).total_cmp(&width(b))
    });
    let width = widest.map_or_else(String::new, |widest| {
        let width = widest
            .relative_width
            .map_or("no interval".to_owned(), |width| {
                format!("{:.2} %", 100.0 * width)
            });
        format!("; widest {width} (at {})", named(widest.scenario))
    });
    format!(
        "stop: P{} of {} within {} % {} at look {made} of {}, {} of at most {} patterns{width}; bounds at \
         {:.1} %, so that all looks hold with 95 %",
        trimmed(stop.wanted.percentile),
        stop.wanted.quantity.name(),
        trimmed(100.0 * stop.wanted.relative_width),
        if stop.met { "reached" } else { "NOT reached" },
        stop.looks.len(),
        last.map_or(0, |look| look.patterns),
        stop.most_patterns,
        100.0 * stop.confidence,
    )
}

/// The scale, and the largest tuned and P99 amplitudes as stress.
fn stress_line(pa_per_m: f64, scenarios: &[ScenarioSummary]) -> String {
    let largest = |of: &dyn Fn(&ScenarioSummary) -> Option<f64>| {
        let found = scenarios.iter().filter_map(of).max_by(f64::total_cmp);
        found.map_or("-".to_owned(), |amplitude_m| {
            format!("{:.4} MPa", 1e-6 * pa_per_m * amplitude_m)
        })
    };
    let p99 = |scenario: &ScenarioSummary| scenario.peak_amplitude_m.percentile(99)?.value;
    format!(
        "stress {pa_per_m:e} Pa per m of amplitude: largest tuned {}, largest P99 {}",
        largest(&|scenario| scenario.tuned_amplitude_m),
        largest(&p99)
    )
}

fn heading(scenario: &ScenarioSummary) -> String {
    excitation_and_deviation(
        scenario.load_case,
        scenario.engine_order,
        scenario.standard_deviation,
    )
}

fn amplitudes(group: &[ScenarioSummary], unit: LengthUnit, is_of_one_wheel: bool) -> TextTable {
    let column = |name: &str| format!("{name} {}", unit.name());
    let mut header = vec!["load N".to_owned(), column("tuned"), "at Hz".to_owned()];
    if is_of_one_wheel {
        header.extend([column("peak"), "amplification".to_owned()]);
    } else {
        header.extend(["P50", "P95", "P99"].map(column));
    }
    header.extend(["ok", "failed", "slip", "separated"].map(str::to_owned));
    let header: Vec<&str> = header.iter().map(String::as_str).collect();
    let mut table = TextTable::new(&header);
    for scenario in group {
        let metres = |value: f64| unit.number(value);
        let mut row = vec![
            load_words(scenario.contact, scenario.normal_load_n),
            scenario
                .tuned_amplitude_m
                .map_or_else(|| scenario.tuned_status.to_owned(), metres),
            scenario
                .tuned_frequency_hz
                .map_or("-".to_owned(), |hz| format!("{hz:.2}")),
        ];
        if is_of_one_wheel {
            let shown =
                |own: Option<f64>, show: &dyn Fn(f64) -> String| own.map_or("-".to_owned(), show);
            let factor = |own: f64| format!("{own:.3}");
            row.push(shown(scenario.peak_amplitude_m.mean, &metres));
            row.push(shown(scenario.amplification_factor.mean, &factor));
        } else {
            row.extend(percentiles(&scenario.peak_amplitude_m, metres));
        }
        row.push(scenario.rows.ok().to_string());
        row.push(scenario.rows.failed().to_string());
        // Pairs of a linear limit stick or slide by definition: no share of them is a result.
        let friction = scenario.normal_load_n.is_some();
        row.push(share(scenario.mean_slipping_fraction.filter(|_| friction)));
        row.push(share(scenario.separated_rows.filter(|_| friction)));
        table.row(row);
    }
    table
}

fn factors(group: &[ScenarioSummary]) -> TextTable {
    let mut table = TextTable::new(&[
        "load N",
        "amplification P50",
        "amplification P95",
        "amplification P99",
    ]);
    for scenario in group {
        let mut row = vec![load_words(scenario.contact, scenario.normal_load_n)];
        row.extend(percentiles(&scenario.amplification_factor, |value| {
            format!("{value:.3}")
        }));
        table.row(row);
    }
    table
}

fn percentiles(sample: &SampleStatistics, show: impl Fn(f64) -> String) -> Vec<String> {
    [50, 95, 99]
        .into_iter()
        .map(|percent| {
            let bound = |bound: Option<f64>| bound.map_or("-".to_owned(), &show);
            match sample.percentile(percent) {
                Some(found) if !matches!(found.status, PointStatus::TooFewPatterns { .. }) => {
                    let (lower, upper) = (bound(found.lower), bound(found.upper));
                    format!("{} [{lower} {upper}]", bound(found.value))
                }
                _ => "-".to_owned(),
            }
        })
        .collect()
}

fn best_line(best: &BestLoad, unit: LengthUnit) -> String {
    let what = match best.quantity {
        "tuned_amplitude_m" => "tuned amplitude",
        "peak_amplitude_m" => "peak of the wheel",
        _ => "P95 amplitude",
    };
    let deviation = best
        .standard_deviation
        .map_or_else(String::new, |deviation| {
            format!(", standard deviation {} %", trimmed(100.0 * deviation))
        });
    let place = if best.interior {
        ""
    } else {
        "; not enclosed by a lower and a higher load"
    };
    format!(
        "lowest {what} ({}{deviation}): {} at {}{place}",
        excitation(best.load_case, best.engine_order),
        unit.length(best.amplitude_m),
        load_per_sector(best.contact, best.normal_load_n),
    )
}

fn share(fraction: Option<f64>) -> String {
    fraction.map_or("-".to_owned(), |fraction| {
        format!("{:.1} %", 100.0 * fraction)
    })
}
