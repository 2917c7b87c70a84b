//! A comparison of scenarios as text of at most 80 columns.

use std::fmt;

use super::text_table::TextTable;
use super::words::{
    LengthUnit, excitation, four_digits, load_per_sector, load_with_unit, load_words, paragraph,
    trimmed,
};
use super::{
    BaselineChoice, BestLoads, ComparedScenario, ComparisonReport, QuantityComparison,
    ScenarioComparison,
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
        writeln!(f, "{}", paragraph(&self.baselines()))?;
        for found in &self.quantities {
            self.quantity(f, found)?;
        }
        for scenario in &self.unmatched {
            let line = format!(
                "no counterpart in {}: {}; --baseline compares it",
                letter(0),
                self.name(scenario)
            );
            writeln!(f, "\n{}", paragraph(&line))?;
        }
        writeln!(f, "\n{}", paragraph(&self.notes()))
    }
}

/// Unit of the values of a table; a ratio has none.
type Unit = Option<LengthUnit>;

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
        let warning = "WARNING: different builds of the program solved these folders; a difference can be \
                       one of the builds";
        writeln!(f, "{}", paragraph(warning))
    }

    /// Which scenarios the others are compared with, and why.
    fn baselines(&self) -> String {
        let percent = trimmed(self.percent);
        match self.baseline_choice {
            BaselineChoice::Lowest => format!(
                "baseline: the load with the lowest P{percent} of the peak amplitude; --baseline I takes \
                 scenario I"
            ),
            BaselineChoice::LowestOfLargest => {
                let one = self.folders.first().is_some_and(|own| own.patterns == 1);
                let which = if one {
                    "lowest"
                } else {
                    "lowest of the largest"
                };
                format!(
                    "baseline: the load with the {which} peak amplitude, since patterns are too few for P{percent}; \
                     --baseline I takes scenario I"
                )
            }
            BaselineChoice::Named => "baseline: the scenario of --baseline".to_owned(),
            BaselineChoice::SameKeys => {
                "baseline: the same load in A; --baseline I takes scenario I of A".to_owned()
            }
        }
    }

    fn notes(&self) -> String {
        let comparisons = self.quantities.iter().flat_map(|found| &found.comparisons);
        let bound = comparisons
            .filter(|found| found.adjusted_p_value_is_bound)
            .find_map(|found| found.percentile.p_value_floor);
        let bound = bound.map_or_else(String::new, |floor| {
            format!(
                " p <=: no resample has the other sign, and {} of them cannot show a p below {floor:.4}, \
                 which Holm's method multiplies by the number of rows: p is this or less.",
                self.resamples
            )
        });
        format!(
            "Loads are normal loads per sector. 95 % intervals in brackets, from {} resamples of the \
             patterns (seed {}). p: two-sided, by Holm's method for all rows of a quantity together.{bound} \
             better: share of patterns with a smaller value than under the baseline. worst: largest ratio \
             of one pattern. as sharp as: two independent samples of this size. Failed rows stand where \
             they do most harm; - = none or not estimable.",
            self.resamples, self.seed
        )
    }

    fn quantity(&self, f: &mut fmt::Formatter<'_>, found: &QuantityComparison) -> fmt::Result {
        let percent = trimmed(self.percent);
        let unit = match found.quantity {
            Quantity::PeakAmplitudeM => Some(length_unit(found)),
            Quantity::AmplificationFactor => None,
        };
        let of_percentile = { found.comparisons.iter() }.any(|own| own.needed_patterns().is_none());
        let what = if of_percentile || found.comparisons.is_empty() {
            format!("P{percent} of the ")
        } else {
            String::new()
        };
        match unit {
            Some(unit) => writeln!(f, "\n{what}peak amplitude, {}", unit.name())?,
            None => writeln!(f, "\n{what}amplification factor")?,
        }
        for together in found.comparisons.chunk_by(told_together) {
            self.together(f, together, unit)?;
        }
        for best in &found.best {
            writeln!(f, "{}", paragraph(&self.best(best, &percent, unit)))?;
        }
        Ok(())
    }

    /// Comparisons with one heading: of the same groups, folders and patterns.
    fn together(
        &self,
        f: &mut fmt::Formatter<'_>,
        found: &[ScenarioComparison],
        unit: Unit,
    ) -> fmt::Result {
        let first = &found[0];
        // Where every candidate has a baseline of its own, that is the same load in the other folder.
        let one_baseline = found.iter().all(|own| own.baseline == first.baseline)
            && self.baseline_choice != BaselineChoice::SameKeys;
        let heading = self.heading(first, one_baseline, unit);
        if let Some(needed) = first.needed_patterns() {
            let why = self.why_largest(first, needed);
            writeln!(f, "\n{}", paragraph(&format!("{heading}. {why}")))?;
            return write!(f, "{}", of_largest(found, one_baseline, unit));
        }
        writeln!(f, "\n{}", paragraph(&heading))?;
        let percent = trimmed(self.percent);
        let value = format!("P{percent}");
        let [of_baseline, of_candidate] = [&first.baseline, &first.candidate]
            .map(|own| format!("P{percent} {}", letter(own.folder)));
        let mut values = TextTable::new(&if one_baseline {
            ["load N", &value, "difference", "ratio", "p"]
        } else {
            ["load N", &of_baseline, &of_candidate, "difference", "p"]
        });
        let mut header = vec!["load N", "ratio", "better", "worst", "as sharp as"];
        if one_baseline {
            header.remove(1);
        }
        let mut pairs = TextTable::new(&header);
        for own in found {
            let load = load_words(own.candidate.contact, own.candidate.normal_load_n);
            let percentile = &own.percentile;
            let candidate = point(&percentile.candidate, unit);
            let difference = interval(percentile.difference.as_ref(), unit);
            let ratio = interval(percentile.ratio.as_ref(), None);
            let p = probability(own);
            let mut of_pairs = vec![load.clone()];
            values.row(if one_baseline {
                vec![load, candidate, difference, ratio, p]
            } else {
                of_pairs.push(ratio);
                let baseline = point(&percentile.baseline, unit);
                vec![load, baseline, candidate, difference, p]
            });
            of_pairs.extend(facts_about_pairs(own));
            pairs.row(of_pairs);
        }
        write!(f, "{values}")?;
        if !one_baseline || first.pairs.is_some() {
            write!(f, "\n{pairs}")?;
        }
        Ok(())
    }

    fn heading(&self, first: &ScenarioComparison, one_baseline: bool, unit: Unit) -> String {
        let patterns = match (first.pairing, first.patterns) {
            ("independent", [x, y]) => format!("{x} and {y} independent patterns"),
            ("same_blades", [x, _]) => format!("{x} sets of blades"),
            ("same_unit_draws", [x, _]) => format!("{x} unit draws"),
            (_, [x, _]) => format!("{x} common patterns"),
        };
        let candidates = format!(
            "{}{}",
            self.folder(&first.candidate),
            group(&first.candidate)
        );
        if !one_baseline {
            return format!(
                "{candidates}, against the same load in {}; {patterns}",
                letter(first.baseline.folder)
            );
        }
        let baseline = &first.baseline;
        format!(
            "{candidates}, against {}{}{}: {}; {patterns}",
            self.folder(baseline),
            load_per_sector(baseline.contact, baseline.normal_load_n),
            if group(baseline) == group(&first.candidate) {
                String::new()
            } else {
                format!(" ({})", group(baseline))
            },
            match first.needed_patterns() {
                Some(_) => shown_or_dash(first.largest[0], unit),
                None => point(&first.percentile.baseline, unit),
            },
        )
    }

    /// Why the percentile of so few patterns is not compared, and what is in its place.
    fn why_largest(&self, first: &ScenarioComparison, needed: u64) -> String {
        let percent = trimmed(self.percent);
        let in_its_place = match first.patterns {
            [1, 1] => "the one pattern is compared",
            _ => "the largest of the patterns is compared, which is no statistic",
        };
        format!("P{percent} has no value, it needs {needed} patterns: {in_its_place}")
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
        let possible = best.loads.iter().filter(|load| load.could_be_best);
        let among = if possible.count() > 1 { "among " } else { "" };
        format!(
            "lowest P{percent} ({heading}): at {}; with 95 % confidence the best of the loads is \
             {among}{}, its P{percent} in [{} {}]",
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

/// Whether two comparisons can stand in one table.
fn told_together(a: &ScenarioComparison, b: &ScenarioComparison) -> bool {
    let alike =
        |a: &ComparedScenario, b: &ComparedScenario| a.folder == b.folder && group(a) == group(b);
    alike(&a.baseline, &b.baseline)
        && alike(&a.candidate, &b.candidate)
        && (a.pairing, a.patterns) == (b.pairing, b.patterns)
}

/// Comparisons by the largest value of the patterns.
fn of_largest(found: &[ScenarioComparison], one_baseline: bool, unit: Unit) -> TextTable {
    let of = |scenario: &ComparedScenario| format!("largest {}", letter(scenario.folder));
    let [of_baseline, of_candidate] = [of(&found[0].baseline), of(&found[0].candidate)];
    let mut header = vec!["load N", &of_baseline, &of_candidate, "ratio", "better"];
    if one_baseline {
        header = vec!["load N", "largest", "ratio", "better"];
    }
    let mut table = TextTable::new(&header);
    for own in found {
        let [baseline, candidate] = own.largest;
        let ratio = { baseline.zip(candidate) }.map(|(baseline, candidate)| candidate / baseline);
        let mut row = vec![load_words(
            own.candidate.contact,
            own.candidate.normal_load_n,
        )];
        if !one_baseline {
            row.push(shown_or_dash(baseline, unit));
        }
        row.push(shown_or_dash(candidate, unit));
        row.push(shown_or_dash(ratio, None));
        let [better, ..] = facts_about_pairs(own);
        row.push(better);
        table.row(row);
    }
    table
}

fn facts_about_pairs(found: &ScenarioComparison) -> [String; 3] {
    let pairs = found.pairs.as_ref();
    let better = pairs.and_then(|pairs| pairs.improved_share);
    let worst = pairs.and_then(|pairs| pairs.worst);
    let size = pairs.and_then(|pairs| pairs.effective_sample_size);
    [
        better.map_or_else(dash, |share| format!("{:.1} %", 100.0 * share)),
        worst.map_or_else(dash, |worst| {
            let ratio = four_digits(worst.ratio);
            format!("{ratio} times, pattern {}", worst.pattern)
        }),
        size.map_or_else(dash, |size| format!("2 x {size:.0}")),
    ]
}

/// The adjusted probability, marked where it is an upper bound.
fn probability(found: &ScenarioComparison) -> String {
    let mark = if found.adjusted_p_value_is_bound {
        "<= "
    } else {
        ""
    };
    found
        .adjusted_p_value
        .map_or_else(dash, |p| format!("{mark}{p:.4}"))
}

fn load_of(scenario: &ComparedScenario) -> String {
    load_with_unit(scenario.contact, scenario.normal_load_n)
}

fn group(scenario: &ComparedScenario) -> String {
    let deviation = scenario.standard_deviation;
    format!(
        "{}{}",
        excitation(scenario.load_case, scenario.engine_order),
        deviation.map_or_else(String::new, |s| format!(
            ", standard deviation {} %",
            trimmed(100.0 * s)
        ))
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

fn length_unit(found: &QuantityComparison) -> LengthUnit {
    let values = found.comparisons.iter().flat_map(|comparison| {
        let percentile = &comparison.percentile;
        match comparison.needed_patterns() {
            Some(_) => comparison.largest,
            None => [percentile.baseline.value, percentile.candidate.value],
        }
    });
    LengthUnit::of(values.flatten())
}

fn point(found: &Percentile, unit: Unit) -> String {
    shown_or_dash(found.value, unit)
}

fn shown_or_dash(value: Option<f64>, unit: Unit) -> String {
    value.map_or_else(dash, |value| shown(value, unit))
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
    unit.map_or_else(|| four_digits(value), |unit| unit.number(value))
}

fn dash() -> String {
    "-".to_owned()
}
