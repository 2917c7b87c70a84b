//! A comparison of scenarios as text.

use std::fmt;

use super::summary_text::{four_digits, load, trimmed};
use super::text_table::TextTable;
use super::{
    BestLoads, ComparedScenario, ComparisonReport, QuantityComparison, ScenarioComparison,
};
use crate::identity;
use crate::population::statistics::{IntervalEstimate, Percentile, Quantity};

impl fmt::Display for ComparisonReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (place, folder) in self.folders.iter().enumerate() {
            writeln!(
                f,
                "{}: study {}, {} patterns, {}",
                letter(place),
                folder.name,
                folder.patterns,
                folder.folder.display()
            )?;
        }
        self.builds(f)?;
        for found in &self.quantities {
            self.quantity(f, found)?;
        }
        for scenario in &self.unmatched {
            writeln!(
                f,
                "\nno counterpart in {}: {}; --baseline compares it",
                letter(0),
                self.name(scenario)
            )?;
        }
        writeln!(
            f,
            "\n95 % intervals in brackets from {} resamples of the patterns (seed {}); p: Holm's, for all \
             rows of a table together;\nbetter: share of patterns with a smaller value; failed rows \
             stand where they do most harm, - = none or not estimable.",
            self.resamples, self.seed
        )
    }
}

/// Metres per unit, or 1 for a ratio, and the unit.
type Unit = (f64, &'static str);

impl ComparisonReport {
    /// The build of the program that solved the folders.
    fn builds(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.builds_differ() {
            let build = self.folders.first().map_or("", |folder| &folder.build);
            return writeln!(f, "build {}", identity::named(build));
        }
        for (place, folder) in self.folders.iter().enumerate() {
            let build = identity::named(&folder.build);
            writeln!(f, "{}: build {build}", letter(place))?;
        }
        writeln!(
            f,
            "WARNING: different builds of the program solved these folders; a difference can be one of the builds"
        )
    }

    fn quantity(&self, f: &mut fmt::Formatter<'_>, found: &QuantityComparison) -> fmt::Result {
        let (name, unit) = match found.quantity {
            Quantity::PeakAmplitudeM => ("peak amplitude", length_unit(found)),
            Quantity::AmplificationFactor => ("amplification factor", (1.0, "")),
        };
        let percent = trimmed(self.percent);
        let heading = format!("P{percent} of the {name} {}", unit.1);
        writeln!(f, "\n{}", heading.trim_end())?;
        let [of_baseline, of_candidate] =
            ["baseline", "candidate"].map(|side| format!("{side} P{percent}"));
        let mut table = TextTable::new(&[
            "baseline",
            "candidate",
            "patterns",
            &of_baseline,
            &of_candidate,
            "difference",
            "ratio",
            "p",
            "better",
            "worst",
            "as sharp as",
        ]);
        for comparison in &found.comparisons {
            table.row(self.row(comparison, unit));
        }
        write!(f, "{table}")?;
        for best in &found.best {
            writeln!(f, "{}", self.best(best, &percent, unit))?;
        }
        Ok(())
    }

    fn row(&self, found: &ScenarioComparison, unit: Unit) -> Vec<String> {
        let percentile = &found.percentile;
        let pairs = found.pairs.as_ref();
        let patterns = match (found.pairing, found.patterns) {
            ("independent", [x, y]) => format!("{x} and {y}, independent"),
            ("same_blades", [x, _]) => format!("{x} sets of blades"),
            ("same_unit_draws", [x, _]) => format!("{x} unit draws"),
            (_, [x, _]) => format!("{x} common"),
        };
        vec![
            self.name(&found.baseline),
            self.name(&found.candidate),
            patterns,
            point(&percentile.baseline, unit),
            point(&percentile.candidate, unit),
            interval(percentile.difference.as_ref(), unit),
            interval(percentile.ratio.as_ref(), (1.0, "")),
            found
                .adjusted_p_value
                .map_or_else(dash, |p| format!("{p:.4}")),
            pairs
                .and_then(|pairs| pairs.improved_share)
                .map_or_else(dash, |share| format!("{:.1} %", 100.0 * share)),
            pairs
                .and_then(|pairs| pairs.worst)
                .map_or_else(dash, |worst| {
                    format!(
                        "{} times, pattern {}",
                        four_digits(worst.ratio),
                        worst.pattern
                    )
                }),
            pairs
                .and_then(|pairs| pairs.effective_sample_size)
                .map_or_else(dash, |size| format!("2 x {size:.0}")),
        ]
    }

    /// Which load is the lowest, and which could be.
    fn best(&self, best: &BestLoads, percent: &str, unit: Unit) -> String {
        let of = |possible: &dyn Fn(usize, bool) -> bool| -> String {
            let loads = best.loads.iter();
            let names: Vec<String> = loads
                .filter(|load| possible(load.scenario.scenario, load.could_be_best))
                .map(|load| load_of(&load.scenario))
                .collect();
            names.join(", ")
        };
        let heading = best.loads.first().map_or_else(String::new, |first| {
            format!("{}{}", self.folder(&first.scenario), group(&first.scenario))
        });
        let bound = |bound: Option<f64>| bound.map_or_else(dash, |value| shown(value, unit));
        format!(
            "lowest P{percent} ({heading}): at load {}; with 95 % confidence the best of the loads is \
             among {}, its P{percent} in [{} {}]",
            of(&|scenario, _| Some(scenario) == best.lowest),
            of(&|_, possible| possible),
            bound(best.lower),
            bound(best.upper),
        )
    }

    fn name(&self, scenario: &ComparedScenario) -> String {
        format!(
            "{}{} ({})",
            self.folder(scenario),
            load_of(scenario),
            group(scenario)
        )
    }

    /// Letter of the folder, where there are several.
    fn folder(&self, scenario: &ComparedScenario) -> String {
        if self.folders.len() > 1 {
            format!("{} ", letter(scenario.folder))
        } else {
            String::new()
        }
    }
}

fn load_of(scenario: &ComparedScenario) -> String {
    let unit = if scenario.normal_load_n.is_some() {
        " N"
    } else {
        ""
    };
    format!("{}{unit}", load(scenario.contact, scenario.normal_load_n))
}

fn group(scenario: &ComparedScenario) -> String {
    let deviation = scenario.standard_deviation;
    let case = scenario.load_case;
    format!(
        "{}EO {}{}",
        case.map_or_else(String::new, |name| format!("{name}, ")),
        scenario.engine_order,
        deviation.map_or_else(String::new, |s| format!(", {} %", trimmed(100.0 * s)))
    )
}

/// A, B, ..., Z, then by number.
fn letter(place: usize) -> String {
    u8::try_from(place)
        .ok()
        .filter(|place| *place < 26)
        .map_or_else(
            || format!("folder {place}"),
            |place| char::from(b'A' + place).to_string(),
        )
}

/// The largest unit in which no percentile is below 1.
fn length_unit(found: &QuantityComparison) -> Unit {
    let values = found.comparisons.iter().flat_map(|comparison| {
        [
            comparison.percentile.baseline.value,
            comparison.percentile.candidate.value,
        ]
    });
    let smallest = values.flatten().fold(f64::INFINITY, f64::min);
    let units = [(1.0, "m"), (1e-3, "mm"), (1e-6, "um"), (1e-9, "nm")];
    let fits = |unit: &Unit| smallest.is_finite() && smallest >= unit.0;
    units.into_iter().find(fits).unwrap_or((1.0, "m"))
}

fn point(found: &Percentile, unit: Unit) -> String {
    found.value.map_or_else(dash, |value| shown(value, unit))
}

fn interval(found: Option<&IntervalEstimate>, unit: Unit) -> String {
    let bound = |bound: Option<f64>| bound.map_or_else(dash, |value| shown(value, unit));
    found.map_or_else(dash, |found| {
        format!(
            "{} [{} {}]",
            bound(found.value),
            bound(found.lower),
            bound(found.upper)
        )
    })
}

fn shown(value: f64, unit: Unit) -> String {
    four_digits(value / unit.0)
}

fn dash() -> String {
    "-".to_owned()
}
