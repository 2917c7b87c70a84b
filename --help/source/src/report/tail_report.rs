//! Tail fits beside the percentiles of the sample, as text.

use std::fmt;

use serde::Serialize;

use super::StudySummary;
use super::text_table::TextTable;
use super::words::{LengthUnit, excitation, four_digits, load_per_sector};
use crate::population::statistics::{
    Estimate, FitStatus, Percentile, Quantity, TailFit, TailLaw, TailPercentile,
};
use crate::population::table::TailFitRecord;

/// A summary with tail fits, where they were asked for.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StatisticsReport {
    /// The summary.
    #[serde(flatten)]
    pub summary: StudySummary,
    /// Tail fits.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tails: Option<Vec<TailFitRecord>>,
}

impl fmt::Display for StatisticsReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.summary)?;
        for record in self.tails.iter().flatten() {
            let unit = (record.quantity == Quantity::PeakAmplitudeM)
                .then(|| LengthUnit::of_summary(&self.summary));
            write!(f, "\n{}", heading(record, unit))?;
            let mut table = TextTable::new(&["", "P95", "P99", "P99.9", "P99.99", "fit"]);
            let empirical = |p: &TailPercentile| shown(sample(&p.empirical).as_ref(), unit);
            let mut row = vec!["sample".to_owned()];
            row.extend(record.fits[0].percentiles.iter().map(empirical));
            table.row(row);
            for fit in &record.fits {
                table.row(law_row(fit, unit));
            }
            write!(f, "{table}")?;
        }
        if self.tails.is_some() {
            writeln!(
                f,
                "\nFitted laws are models, a second opinion beside the sample; p: goodness of fit \
                 (Anderson-Darling, parametric bootstrap);\n* outside of the bounds of the sample, \
                 + beyond 1 - 1/n, where no value of the sample reaches."
            )?;
        }
        Ok(())
    }
}

fn heading(record: &TailFitRecord, unit: Option<LengthUnit>) -> String {
    let scenario = &record.scenario;
    let deviation = scenario.standard_deviation;
    format!(
        "tail of the {} at {}, {}{}\n",
        match unit {
            Some(unit) => format!("peak amplitude in {}", unit.name()),
            None => "amplification factor".to_owned(),
        },
        load_per_sector(scenario.contact.name(), scenario.contact.normal_load_n()),
        excitation(scenario.load_case, scenario.engine_order),
        deviation.map_or_else(String::new, |s| format!(
            ", standard deviation {} %",
            100.0 * s
        )),
    )
}

fn sample(found: &Percentile) -> Option<Estimate> {
    found.value.map(|value| Estimate {
        value,
        lower: found.lower,
        upper: found.upper,
    })
}

fn law_row(fit: &TailFit, unit: Option<LengthUnit>) -> Vec<String> {
    let name = match fit.law {
        TailLaw::WeibullBoundedAbove => "Weibull, bounded above",
        TailLaw::GeneralisedExtremeValue => "generalised extreme value",
    };
    let mut row = vec![name.to_owned()];
    row.extend(fit.percentiles.iter().map(|p| {
        let marks = [(p.outside_interval, "*"), (p.extrapolates, "+")];
        let marks = marks.iter().filter(|mark| mark.0 && p.model.is_some());
        let marks: String = marks.map(|mark| mark.1).collect();
        format!("{}{marks}", shown(p.model.as_ref(), unit))
    }));
    row.push(verdict(fit));
    row
}

fn verdict(fit: &TailFit) -> String {
    if fit.status != FitStatus::Converged {
        return fit.status.name().to_owned();
    }
    let mut words = match fit.p_value {
        Some(p) => format!("p = {p:.3}"),
        None => "no p".to_owned(),
    };
    if fit.rejected {
        words.push_str(", rejected");
    }
    if fit.few_values {
        words.push_str(", fewer than 50 values");
    }
    if fit.failures_left_out > 0 {
        words.push_str(", failed rows left out");
    }
    words
}

/// Four significant digits, in the unit of the table.
fn shown(estimate: Option<&Estimate>, unit: Option<LengthUnit>) -> String {
    let digits = |value: f64| unit.map_or_else(|| four_digits(value), |unit| unit.number(value));
    let bound = |bound: Option<f64>| bound.map_or_else(|| "-".to_owned(), digits);
    estimate.map_or_else(
        || "-".to_owned(),
        |found| {
            let (lower, upper) = (bound(found.lower), bound(found.upper));
            format!("{} [{lower} {upper}]", digits(found.value))
        },
    )
}
