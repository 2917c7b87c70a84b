//! The answers that a report opens with: which normal load, how sure, and how much of it is numerical error.

use super::numerical_error::Remedy;
use super::stated_errors::{common_words, largest_stated, measured, stated};
use super::study_report::{at_the_end_by, within};
use super::words::{
    LengthUnit, four_digits, listed, loads_and_limits, percent_words, share_words,
    short_load_with_unit, signed_share,
};
use super::{
    BestLoads, GroupReport, LoadChoice, MeasuredPeak, ScenarioSummary, StudyReport, Warning,
};
use crate::population::statistics::{CONFIDENCE, Percentile};

/// What no numerical error is about.
const NOT_IN_ERROR: &str = "Not in these numbers: errors of the model that was given, as of its mesh, contact stiffness, \
                            friction coefficient or damping.";

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

/// The answers for one group: the peak of each measured wheel, where they are few, and its numerical error; for P99 and P95 which load to choose, and
/// how much is numerical error. Percentiles that are known come first, of the others the one that needs the fewest patterns.
#[must_use]
pub fn answers(report: &StudyReport, group: &GroupReport) -> Vec<Answer> {
    let writer = Writer {
        report,
        group,
        units: LengthUnit::of_summary(&report.summary),
    };
    let asked = || {
        group
            .choices
            .iter()
            .filter(|choice| choice.is_of_a_design())
    };
    let (known, unknown): (Vec<&LoadChoice>, Vec<&LoadChoice>) =
        asked().partition(|choice| choice.lowest.is_some());
    let loads = known.into_iter().chain(unknown.into_iter().rev());
    let mut answers: Vec<Answer> = writer.measured_wheels().into_iter().collect();
    if report.summary.is_of_one_wheel() {
        answers.extend(writer.error_of_wheels());
        return answers;
    }
    answers.extend(loads.map(|choice| writer.load(choice)));
    let error = asked().find_map(|choice| writer.error(choice));
    answers.extend(error.or_else(|| writer.error_of_wheels()));
    answers
}

struct Writer<'a> {
    report: &'a StudyReport,
    group: &'a GroupReport,
    units: LengthUnit,
}

impl Writer<'_> {
    fn scenario(&self, index: usize) -> &ScenarioSummary {
        &self.report.summary.scenarios[index]
    }

    fn load_of(&self, index: usize) -> String {
        self.with_speed(index, "")
    }

    /// The load of scenario `index` in words, per sector: where a load is named for the first time.
    fn load_per_sector_of(&self, index: usize) -> String {
        let of_newtons = self.scenario(index).normal_load_n.is_some();
        self.with_speed(index, if of_newtons { " per sector" } else { "" })
    }

    fn with_speed(&self, index: usize, per: &str) -> String {
        let scenario = self.scenario(index);
        let load = short_load_with_unit(scenario.contact, scenario.normal_load_n);
        match scenario.speed_rpm {
            Some(speed) => format!("{load}{per} ({speed} rpm)"),
            None => format!("{load}{per}"),
        }
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
            .and_then(|lowest| Some((lowest, self.group.error_of(lowest, choice.percent)?.1)));
        let Some((lowest, found)) = found else {
            return Answer {
                question,
                verdict: self.unknown(choice),
                reasons: self.why_none(choice),
            };
        };
        let value = found.percentile.value.unwrap_or(f64::NAN);
        let amplitude = format!("{}{}", self.units.length(value), self.as_stress(value));
        let open = self.group.left_by_error(choice, lowest);
        let verdict = if open.is_empty() {
            let load = self.load_per_sector_of(lowest);
            format!("{load}: P{percent} = {amplitude}.")
        } else {
            let others: Vec<String> = { open.into_iter() }
                .map(|scenario| {
                    let error = self.group.error_of(scenario, choice.percent);
                    let value = error.and_then(|error| error.1.percentile.value);
                    let value = value.map_or(String::new(), |value| {
                        format!("{} at ", self.units.length(value))
                    });
                    format!("{value}{}", self.load_of(scenario))
                })
                .collect();
            format!(
                "Numerical error leaves it open: P{percent} = {amplitude} at {}, {}.",
                self.load_per_sector_of(lowest),
                listed(&others)
            )
        };
        let mut reasons = vec![self.how_sure(lowest, &found.percentile)];
        match &choice.best {
            Some(best) => reasons.extend(self.could_be_best(best, lowest, choice)),
            None => reasons.push("It is the only load of this study.".to_owned()),
        }
        if choice.best.is_some() {
            reasons.extend(self.by_numerical_error(lowest, choice.percent));
        }
        if let Some(end) = at_the_end_by(self.report, self.group, (choice, lowest)) {
            reasons.push(format!("{}.", end.in_words));
        }
        Answer {
            question,
            verdict,
            reasons,
        }
    }

    /// An amplitude as stress, where the study has a scale.
    fn as_stress(&self, amplitude_m: f64) -> String {
        let scale = self.report.summary.stress_pa_per_m;
        scale.map_or_else(String::new, |pa_per_m| {
            format!(" ({} MPa)", four_digits(1e-6 * pa_per_m * amplitude_m))
        })
    }

    /// The interval of a percentile, and what the percentile means.
    fn how_sure(&self, scenario: usize, found: &Percentile) -> String {
        let percent = percent_words(found.percent);
        let confidence = percent_words(100.0 * self.confidence());
        let range = match (found.lower, found.upper) {
            (Some(lower), Some(upper)) => format!(
                "lies between {} and {}",
                self.units.number(lower),
                self.units.length(upper)
            ),
            (Some(lower), None) => format!("is above {}", self.units.length(lower)),
            (None, Some(upper)) => format!("is below {}", self.units.length(upper)),
            (None, None) => "has no bounds".to_owned(),
        };
        format!(
            "{percent} % of such wheels have a lower peak. From {} random patterns: with {confidence} % confidence the \
             P{percent} at {} {range}; numerical error is not in this interval.",
            self.report.summary.patterns,
            self.load_of(scenario),
        )
    }

    /// Confidence of the intervals.
    fn confidence(&self) -> f64 {
        let stop = self.report.summary.stop.as_ref();
        stop.map_or(CONFIDENCE, |stop| stop.confidence)
    }

    /// What a percentile without value lacks.
    fn unknown(&self, choice: &LoadChoice) -> String {
        let needed = choice.needed_patterns;
        if self.report.summary.patterns >= needed {
            "Not known: too many rows failed.".to_owned()
        } else if self.group.standard_deviation.is_none() {
            format!("Not known: needs {needed} wheels.")
        } else {
            format!("Not known yet: needs {needed} patterns.")
        }
    }

    fn why_none(&self, choice: &LoadChoice) -> Vec<String> {
        let patterns = self.report.summary.patterns;
        let few = patterns < choice.needed_patterns;
        let of_file = self.group.standard_deviation.is_none();
        let mut reasons = vec![if few && of_file {
            format!(
                "A 95 % interval needs {} wheels, mistuning.file holds {patterns}: read the peak of each wheel, or put \
                 more wheels into the file.",
                choice.needed_patterns
            )
        } else if few {
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
                "The lowest P{}, as computed, is that of {}.",
                percent_words(percent),
                self.load_of(lowest)
            ));
        }
        reasons
    }

    /// The peak of each wheel of a file, a sentence for each load; none where they are many or drawn.
    fn measured_wheels(&self) -> Option<Answer> {
        let of_load = |peaks: &[MeasuredPeak]| {
            let named: Vec<String> = peaks
                .iter()
                .map(|own| {
                    let peak = own.peak_amplitude_m;
                    let peak = peak.map_or("failed".to_owned(), |peak| self.units.length(peak));
                    format!("wheel {} {peak}{}", own.pattern, factor_and_blade(own))
                })
                .collect();
            format!(
                "Peaks at {}: {}.",
                self.load_of(peaks[0].scenario),
                named.join(", ")
            )
        };
        let loads = self
            .group
            .measured
            .chunk_by(|a, b| a.scenario == b.scenario);
        let verdict = self.group.smallest_worst_peak().map_or_else(
            || "Not known: under every load a wheel lacks a peak.".to_owned(),
            |(worst, highest)| {
                if self.report.summary.is_of_one_wheel() {
                    let load = self.load_of(worst.scenario);
                    return format!("{} at {load}, its lowest.", self.units.length(highest));
                }
                let open = self.group.loads_left_open();
                let ranges = std::iter::once((worst.scenario, highest)).chain(open.iter().copied());
                let ranges: Vec<String> = ranges.map(|own| self.range_of_wheels(own)).collect();
                let which = if open.is_empty() {
                    "where the worst is lowest"
                } else {
                    "which load is better is open"
                };
                format!("{}: {which}.", ranges.join(", "))
            },
        );
        (!self.group.measured.is_empty()).then(|| Answer {
            question: "How large is the peak amplitude of each wheel of mistuning.file?".to_owned(),
            verdict,
            reasons: loads.map(of_load).collect(),
        })
    }

    /// From the lowest to the highest peak of the measured wheels under a scenario.
    fn range_of_wheels(&self, (scenario, highest): (usize, f64)) -> String {
        let here = { self.group.measured.iter() }.filter(|own| own.scenario == scenario);
        let lowest = { here.filter_map(|own| own.peak_amplitude_m) }.fold(highest, f64::min);
        let (lowest, highest) = (self.units.number(lowest), self.units.length(highest));
        format!("{lowest} to {highest} at {}", self.load_of(scenario))
    }

    /// Which other loads could be the best, and how low the percentile of the best can be.
    fn could_be_best(&self, best: &BestLoads, lowest: usize, choice: &LoadChoice) -> Vec<String> {
        let percent = percent_words(choice.percent);
        let others: Vec<String> = best
            .loads
            .iter()
            .filter(|load| load.could_be_best && load.scenario.scenario != lowest)
            .map(|load| {
                let of_sample = load.percentile.value.map(|value| self.units.length(value));
                let of_sample = of_sample.map_or(String::new(), |value| format!(" ({value})"));
                format!("{}{of_sample}", self.load_of(load.scenario.scenario))
            })
            .collect();
        let compared_loads =
            { best.loads.iter() }.map(|load| self.scenario(load.scenario.scenario));
        let count = loads_and_limits(compared_loads);
        let compared = "all were compared on the same patterns";
        let with = if self.group.hidden_by_error(choice, lowest).is_empty() {
            "With"
        } else {
            "By statistics alone, with"
        };
        let mut reasons = vec![if others.is_empty() {
            format!(
                "{with} 95 % confidence none of the {count} studied has a lower P{percent}; {compared}."
            )
        } else {
            format!(
                "The P{percent} at {} is not significantly higher: with 95 % confidence the best of the {count} \
                 studied is among these; {compared}.",
                listed(&others)
            )
        }];
        match best.lower.zip(best.upper) {
            Some((lower, upper)) => reasons.push(format!(
                "Whichever of these loads is truly the best, its P{percent} lies between {} and {} (95 %; that the same patterns \
                 chose the load is allowed for, numerical error is not).",
                self.units.number(lower),
                self.units.length(upper)
            )),
            None if self.report.summary.patterns < choice.patterns_of_best => reasons.push(format!(
                "Bounds on the P{percent} of whichever of these loads is truly the best need {} patterns.",
                choice.patterns_of_best
            )),
            None => {}
        }
        reasons
    }

    /// Which other loads could have a lower percentile if rows are wrong by what they state; none where
    /// the rows of the chosen load state no bound.
    fn by_numerical_error(&self, lowest: usize, percent: f64) -> Option<String> {
        let rivals = self.group.numerical_rivals(lowest, percent)?;
        let named = |scenarios: Vec<usize>| -> Vec<String> {
            { scenarios.into_iter() }
                .map(|own| self.load_of(own))
                .collect()
        };
        let (could, unknown) = (named(rivals.could_be_lower), named(rivals.unknown));
        let words = percent_words(percent);
        let not_compared = if unknown.is_empty() {
            String::new()
        } else {
            format!(
                " Not compared: {}, where failed rows leave no P{words}.",
                listed(&unknown)
            )
        };
        let by_error = if could.is_empty() {
            format!(
                "Even if every solution is off by its full error bound, {} keeps the lowest P{words}.",
                self.load_of(lowest)
            )
        } else {
            format!(
                "If every solution is off by its full error bound, P{words} may be lower at {}: more accurate solutions decide.",
                listed(&could)
            )
        };
        Some(by_error + &not_compared)
    }

    /// How much of the percentile at the chosen load is numerical error; none without a percentile.
    fn error(&self, choice: &LoadChoice) -> Option<Answer> {
        let lowest = choice.lowest?;
        let (errors, found) = self.group.error_of(lowest, choice.percent)?;
        let rows = &errors.rows;
        let value = found.percentile.value?;
        let percent = percent_words(choice.percent);
        let statistical = found.statistical_width();
        let numerical = found.numerical_width();
        let around = |low: Option<f64>, high: Option<f64>| {
            let side = |end: f64| signed_share(end / value - 1.0);
            low.zip(high).map(|(low, high)| (side(low), side(high)))
        };
        let verdict = match around(found.lowest, found.highest) {
            Some((low, high)) => format!(
                "Between {low} and {high} of the P{percent} at {}, if every solution is off by its full error bound.",
                self.load_of(lowest)
            ),
            None => format!(
                "Not bounded at {}: {}.",
                self.load_of(lowest),
                rows.why_no_bound()
            ),
        };
        let mut reasons = Vec::new();
        if let Some((lowest, highest)) = found.lowest.zip(found.highest) {
            reasons.push(format!(
                "Were these wheels solved without error, their P{percent} would lie between {} and {}.",
                self.units.number(lowest),
                self.units.length(highest)
            ));
        }
        if let Some((low, high)) = around(found.percentile.lower, found.percentile.upper) {
            let findings = self.report.summary.warnings.iter();
            let findings = findings.filter_map(Warning::numerical_finding);
            let remedy = { statistical.zip(numerical) }
                .map(|(statistical, numerical)| Remedy::of(statistical, numerical, findings));
            let wider = numerical > statistical;
            let beside = remedy.map_or("", |remedy| remedy.beside_bounds(wider));
            reasons.push(format!(
                "The statistical interval spans {low} to {high}{beside}."
            ));
        }
        reasons.push(format!(
            "The bound takes all solutions as off in the same direction. {}",
            stated(rows)
        ));
        if let Some(corrected) = found.corrected {
            reasons.push(format!(
                "With every row corrected by its own sampling and harmonic error the P{percent} would be {}.",
                self.units.length(corrected)
            ));
        }
        reasons.extend(common_words(&self.report.summary.basis, &errors.common));
        reasons.extend(self.report.summary.numerical_error.map(measured));
        reasons.push(NOT_IN_ERROR.to_owned());
        Some(Answer {
            question: "How much of that number is numerical error?".to_owned(),
            verdict,
            reasons,
        })
    }

    /// How much of the peaks of a few measured wheels is numerical error under the load of the smallest worst one; none
    /// where there is none.
    fn error_of_wheels(&self) -> Option<Answer> {
        let (worst, peak) = self.group.smallest_worst_peak()?;
        let mut errors = self.group.errors.iter();
        let errors = errors.find(|own| own.scenario == worst.scenario)?;
        let one = self.report.summary.is_of_one_wheel();
        let (question, peaks, which) = if one {
            (
                "How much of that peak is numerical error?",
                "the peak",
                "it",
            )
        } else {
            (
                "How much of these peaks is numerical error?",
                "each peak",
                "the worst",
            )
        };
        let load = self.load_of(worst.scenario);
        let bound = self.group.largest_stated_error(worst.scenario);
        let bound = bound.filter(|_| errors.rows.without_bound == 0);
        let ends = bound.and_then(|error| {
            let (low, high) = within(peak, error);
            Some((low, high?))
        });
        let verdict = match ends {
            Some((low, high)) => format!(
                "At most {} of {peaks} at {load}: {which} lies between {} and {}.",
                share_words(high / peak - 1.0),
                self.units.number(low),
                self.units.length(high)
            ),
            None => format!("Not bounded at {load}: {}.", errors.rows.why_no_bound()),
        };
        let mut reasons: Vec<String> = largest_stated(&errors.rows).into_iter().collect();
        reasons.extend(common_words(&self.report.summary.basis, &errors.common));
        reasons.extend(self.report.summary.numerical_error.map(measured));
        reasons.push(NOT_IN_ERROR.to_owned());
        Some(Answer {
            question: question.to_owned(),
            verdict,
            reasons,
        })
    }
}

/// Amplification factor and blade of a peak, in brackets.
fn factor_and_blade(own: &MeasuredPeak) -> String {
    let factor = { own.amplification_factor }.map(|factor| format!("amplification {factor:.3}"));
    let blade = own.peak_blade.map(|blade| format!("blade {blade}"));
    let parts: Vec<String> = factor.into_iter().chain(blade).collect();
    if parts.is_empty() {
        return String::new();
    }
    format!(" ({})", parts.join(", "))
}
