//! The answers that a report opens with: which normal load, how sure, and how much of it is numerical error.

use super::words::{Quantities, load_with_unit, percent_words, share_words};
use super::{
    BestLoads, GroupReport, LoadChoice, PercentileError, ScenarioSummary, StatedErrors, StudyReport,
};

/// A question of an engineer with its answer from the numbers of a report.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Answer {
    /// The question.
    pub question: String,
    /// The answer in a sentence.
    pub verdict: String,
    /// What it rests on, a sentence each.
    pub reasons: Vec<String>,
}

/// The answers for one group: for P99 and P95 which load to choose, and how much is numerical error.
#[must_use]
pub fn answers(report: &StudyReport, group: &GroupReport) -> Vec<Answer> {
    let writer = Writer {
        report,
        group,
        units: Quantities::of(&report.summary),
    };
    let asked = || group.choices.iter().filter(|choice| choice.percent > 90.0);
    let mut answers: Vec<Answer> = asked().map(|choice| writer.load(choice)).collect();
    answers.extend(asked().find_map(|choice| writer.error(choice)));
    answers
}

struct Writer<'a> {
    report: &'a StudyReport,
    group: &'a GroupReport,
    units: Quantities,
}

impl Writer<'_> {
    fn scenario(&self, index: usize) -> &ScenarioSummary {
        &self.report.summary.scenarios[index]
    }

    fn load_of(&self, index: usize) -> String {
        let scenario = self.scenario(index);
        load_with_unit(scenario.contact, scenario.normal_load_n)
    }

    fn error_of(&self, scenario: usize, percent: f64) -> Option<(&StatedErrors, &PercentileError)> {
        let errors = self
            .group
            .errors
            .iter()
            .find(|errors| errors.scenario == scenario)?;
        let of_percent = errors
            .percentiles
            .iter()
            .find(|error| error.percentile.percent.total_cmp(&percent).is_eq())?;
        Some((&errors.rows, of_percent))
    }

    /// Which load to choose for a percentile, and how sure that is.
    fn load(&self, choice: &LoadChoice) -> Answer {
        let percent = percent_words(choice.percent);
        let question = format!(
            "Which normal load should I choose for the {percent}th percentile (P{percent}) of the peak amplitude, and how \
             sure is that?"
        );
        let found = choice
            .lowest
            .and_then(|lowest| Some((lowest, self.error_of(lowest, choice.percent)?.1)));
        let Some((lowest, found)) = found else {
            return Answer {
                question,
                verdict: format!("Not known: these rows give no P{percent}."),
                reasons: self.why_none(choice),
            };
        };
        let value = found.percentile.value.unwrap_or(f64::NAN);
        let verdict = format!(
            "{}: P{percent} = {}{}.",
            self.load_of(lowest),
            self.units.amplitude(value),
            self.bounds(found.percentile.lower, found.percentile.upper)
        );
        let mut reasons = Vec::new();
        match &choice.best {
            Some(best) => reasons.extend(self.could_be_best(best, lowest, &percent)),
            None => reasons.push("It is the only load of this study.".to_owned()),
        }
        if choice.best.is_some() && !choice.enclosed {
            reasons.push(
                "No lower and higher normal load than this one were both studied, so the optimum may lie beyond: add \
                 loads to sweep.normal_load_n and run again."
                    .to_owned(),
            );
        }
        Answer {
            question,
            verdict,
            reasons,
        }
    }

    fn why_none(&self, choice: &LoadChoice) -> Vec<String> {
        let patterns = self.report.summary.patterns;
        let mut reasons = vec![if patterns < choice.needed_patterns {
            format!(
                "A 95 % interval needs {} patterns, the study has {patterns}: raise study.patterns and run again, only \
                 the new ones are solved.",
                choice.needed_patterns
            )
        } else {
            "Too many rows failed: see the accounting below.".to_owned()
        }];
        // The next lower percentile that there is may serve meanwhile.
        let lower = self.group.choices.iter();
        let mut lower = lower.filter(|other| other.percent < choice.percent);
        if let Some((percent, lowest)) =
            lower.find_map(|other| Some((other.percent, other.lowest?)))
        {
            reasons.push(format!(
                "The lowest P{} is that of {}.",
                percent_words(percent),
                self.load_of(lowest)
            ));
        }
        reasons
    }

    /// Which other loads could be the best, and how low the percentile of the best can be.
    fn could_be_best(&self, best: &BestLoads, lowest: usize, percent: &str) -> Vec<String> {
        let others: Vec<String> = best
            .loads
            .iter()
            .filter(|load| load.could_be_best && load.scenario.scenario != lowest)
            .map(|load| self.load_of(load.scenario.scenario))
            .collect();
        let count = best.loads.len();
        let mut reasons = vec![if others.is_empty() {
            format!(
                "With 95 % confidence no other of the {count} loads studied has a lower P{percent}; all were compared on \
                 the same patterns."
            )
        } else {
            format!(
                "{} could have a lower P{percent} as well: with 95 % confidence the best of the {count} loads studied is \
                 among these. All were compared on the same patterns.",
                listed(&others)
            )
        }];
        if let Some((lower, upper)) = best.lower.zip(best.upper) {
            reasons.push(format!(
                "At the truly best of these loads the P{percent} lies between {} and {} (95 %, the choice allowed for).",
                self.units.number(lower),
                self.units.amplitude(upper)
            ));
        }
        reasons
    }

    /// How much of the percentile at the chosen load is numerical error; none without a percentile.
    fn error(&self, choice: &LoadChoice) -> Option<Answer> {
        let lowest = choice.lowest?;
        let (rows, found) = self.error_of(lowest, choice.percent)?;
        let value = found.percentile.value?;
        let percent = percent_words(choice.percent);
        let statistical = found.statistical_width();
        let numerical = found.numerical_width();
        let around = |low: Option<f64>, high: Option<f64>| {
            let side = |end: f64| {
                let share = end / value - 1.0;
                let sign = if share < 0.0 { "−" } else { "+" };
                format!("{sign}{}", share_words(share.abs()))
            };
            low.zip(high)
                .map(|(low, high)| format!("{} to {}", side(low), side(high)))
        };
        let verdict = match around(found.lowest, found.highest) {
            Some(range) => format!(
                "At most {range} of the P{percent} at {}.",
                self.load_of(lowest)
            ),
            None => format!(
                "Not bounded: {} of {} rows at {} state no bound.",
                rows.without_bound,
                rows.rows,
                self.load_of(lowest)
            ),
        };
        let mut reasons = Vec::new();
        if let Some(range) = around(found.percentile.lower, found.percentile.upper) {
            let beside = match statistical.zip(numerical) {
                Some((statistical, numerical)) if numerical > statistical => {
                    ": less than the numerical bounds, so finer solutions (reduction.error, solver.harmonics) before more \
                     patterns"
                }
                Some(_) => {
                    ": more than the numerical bounds, so more patterns before finer solutions"
                }
                None => "",
            };
            reasons.push(format!("The statistical interval spans {range}{beside}."));
        }
        reasons.push(format!(
            "The bound takes every row as wrong by all that it states, and all in the same direction. {}",
            stated(rows)
        ));
        if let Some(corrected) = found.corrected {
            reasons.push(format!(
                "With every row corrected by its own sampling and harmonic error the P{percent} would be {}.",
                self.units.amplitude(corrected)
            ));
        }
        reasons.extend(self.basis());
        Some(Answer {
            question: "How much of that number is numerical error?".to_owned(),
            verdict,
            reasons,
        })
    }

    fn basis(&self) -> Option<String> {
        let basis = &self.report.summary.basis;
        let error = basis.tuned_peak_error?;
        Some(format!(
            "Of what rows state, {} is that of the reduced basis ({}), measured on the tuned peak against the full \
             contact model.",
            share_words(error),
            basis.name
        ))
    }

    fn bounds(&self, lower: Option<f64>, upper: Option<f64>) -> String {
        let one = |bound: Option<f64>| {
            bound.map_or("unbounded".to_owned(), |bound| self.units.number(bound))
        };
        format!(" [{}, {}]", one(lower), one(upper))
    }
}

/// What the rows of the chosen load state.
fn stated(rows: &StatedErrors) -> String {
    let mut parts = Vec::new();
    let sources = [
        ("all sources", &rows.stated),
        ("sampling", &rows.sampling),
        ("harmonics left out", &rows.harmonics),
    ];
    for (name, spread) in sources {
        if let Some(spread) = spread {
            parts.push(format!(
                "{name} {} (largest {})",
                share_words(spread.median),
                share_words(spread.largest)
            ));
        }
    }
    if parts.is_empty() {
        "These rows state no errors.".to_owned()
    } else {
        format!("Median of the rows: {}.", parts.join(", "))
    }
}

/// Names with commas, and an `and` before the last.
fn listed(names: &[String]) -> String {
    match names {
        [] => String::new(),
        [only] => only.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}
