//! What accuracy costs, as a table.

use std::fmt;

use serde::Serialize;

use super::text_table::TextTable;
use crate::population::monte_carlo::LoadCaseName;
use crate::population::statistics::{ErrorBound, LoadCaseErrors};
use crate::population::table::TradeoffRecord;

/// A measured trade-off between accuracy and cost.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TradeoffReport {
    /// Name of the study.
    pub name: String,
    /// Its digest.
    pub study_digest: String,
    /// Version of the program.
    pub version: String,
    /// Seed of the study.
    pub seed: u64,
    /// Ids of the patterns of the sample.
    pub patterns: Vec<u32>,
    /// Scenarios of the sample.
    pub scenarios: Vec<usize>,
    /// Normal load of each, N.
    pub normal_loads_n: Vec<f64>,
    /// Load case of each; absent in a study without load cases.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub load_cases: Vec<LoadCaseName>,
    /// What all errors refer to.
    pub reference: TradeoffReference,
    /// The cheapest setting for each accepted error.
    pub choices: Vec<TradeoffChoice>,
    /// Estimated floating-point operations of everything measured here.
    pub operations: f64,
    /// The settings.
    pub settings: Vec<TradeoffRecord>,
}

/// What the errors refer to.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TradeoffReference {
    /// `joint`: all knobs at their best at once; `by_knobs`: one at a time, ratios multiplied.
    pub kind: &'static str,
    /// Rows of the sample.
    pub rows: u64,
    /// Rows of the sample that the reference has no value for; they judge nothing.
    pub without_value: u64,
    /// Tolerance of its harmonics.
    pub harmonic_tolerance: f64,
    /// Where both kinds are there: largest relative difference of the amplitude between them.
    pub product_error: Option<f64>,
    /// Fixed-interface modes, the same at every setting.
    pub craig_bampton_modes: usize,
    /// Relative change of the tuned peak by more fixed-interface modes.
    pub craig_bampton_error: Option<f64>,
    /// The reference itself against the full-contact model, where asked for.
    pub full_contact: Vec<FullContactCheck>,
}

/// One row of the reference on the full-contact model.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FullContactCheck {
    /// Scenario.
    pub scenario: usize,
    /// Load case of the scenario; absent in a study without load cases.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub load_case: Option<LoadCaseName>,
    /// Pattern.
    pub pattern: u32,
    /// Harmonic set of the full-contact model.
    pub harmonics: String,
    /// How its solution ended.
    pub status: &'static str,
    /// Relative error of the reference's amplitude.
    pub amplitude_error: Option<f64>,
    /// Relative error of the frequency of the reference's peak.
    pub frequency_error: Option<f64>,
    /// Relative error of the reference's amplification factor.
    pub amplification_factor_error: Option<f64>,
}

/// The cheapest setting for an accepted error.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TradeoffChoice {
    /// Accepted upper bound of the 95th percentile of the amplitude error.
    pub accepted_error: f64,
    /// The setting; none where no setting has it.
    pub setting: Option<u32>,
    /// Errors of the setting under each load case of the sample; absent in a study without load
    /// cases.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub load_cases: Vec<LoadCaseErrors>,
}

impl fmt::Display for TradeoffReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let reference = &self.reference;
        writeln!(
            f,
            "study {}: {} patterns x {} scenarios ({}); reference {}, harmonics within {}, \
             {} of {} rows without reference",
            self.name,
            self.patterns.len(),
            self.scenarios.len(),
            self.loads(),
            reference.kind,
            percent(reference.harmonic_tolerance),
            reference.without_value,
            reference.rows
        )?;
        if let Some(error) = reference.craig_bampton_error.filter(|&error| error > 0.0) {
            writeln!(
                f,
                "{} fixed-interface modes at every setting; more change the tuned peak by {}",
                reference.craig_bampton_modes,
                percent(error)
            )?;
        }
        if let Some(error) = reference.product_error {
            let error = percent(error);
            writeln!(
                f,
                "ratios of single knobs multiplied are within {error} of it"
            )?;
        }
        for check in &reference.full_contact {
            writeln!(
                f,
                "full-contact model, scenario {}{} pattern {} harmonics {}: {}; amplitude {}, \
                 frequency {}, amplification factor {}",
                check.scenario,
                check
                    .load_case
                    .map_or_else(String::new, |load_case| format!(" ({load_case})")),
                check.pattern,
                check.harmonics,
                check.status,
                signed(check.amplitude_error),
                signed(check.frequency_error),
                signed(check.amplification_factor_error)
            )?;
        }
        let cheapest = self.settings.iter().map(|own| own.operations);
        let cheapest = cheapest.fold(f64::INFINITY, f64::min);
        let mut front: Vec<&TradeoffRecord> = self.settings.iter().collect();
        front.retain(|own| own.on_front || own.chosen.contains(&true));
        front.sort_by(|a, b| a.operations.total_cmp(&b.operations));
        writeln!(
            f,
            "\nerror of the peak amplitude against cost, the best of each:\n"
        )?;
        self.table(f, &front, cheapest)?;
        let mut knobs: Vec<&TradeoffRecord> = self.settings.iter().collect();
        knobs.retain(|own| own.knob.is_some());
        writeln!(
            f,
            "\nsingle knobs, the others as in the base; own = change by this knob alone:\n"
        )?;
        self.knob_table(f, &knobs)?;
        writeln!(
            f,
            "\nP95 <=: upper bound of the 95th percentile over all rows, 95 % confidence; cost: estimated \
             floating-point operations of a row; CPU: this machine, now."
        )?;
        for choice in &self.choices {
            let accepted = percent(choice.accepted_error);
            match choice.setting {
                Some(setting) => writeln!(f, "cheapest within {accepted}: setting {setting}")?,
                None => writeln!(f, "no setting is within {accepted}")?,
            }
            for own in &choice.load_cases {
                let error = |of: fn(&ErrorBound) -> f64| shown(own.amplitude.as_ref().map(of));
                writeln!(
                    f,
                    "  of its rows under load case {}: median {}, worst {}",
                    own.load_case,
                    error(|errors| errors.median),
                    error(|errors| errors.worst),
                )?;
            }
        }
        Ok(())
    }
}

impl TradeoffReport {
    /// Loads of the sample, under each load case if there are any.
    fn loads(&self) -> String {
        let listed = |loads: &[f64]| {
            let loads: Vec<String> = loads.iter().map(f64::to_string).collect();
            format!("loads {} N per sector", loads.join(", "))
        };
        let cases = self.load_cases.chunk_by(|a, b| a == b);
        let mut first = 0;
        let of_cases: Vec<String> = cases
            .map(|case| {
                let own = first..first + case.len();
                first = own.end;
                format!(
                    "load case {}: {}",
                    case[0],
                    listed(&self.normal_loads_n[own])
                )
            })
            .collect();
        if of_cases.is_empty() {
            listed(&self.normal_loads_n)
        } else {
            of_cases.join("; ")
        }
    }

    fn table(
        &self,
        f: &mut fmt::Formatter<'_>,
        settings: &[&TradeoffRecord],
        cheapest: f64,
    ) -> fmt::Result {
        let mut table = TextTable::new(&[
            "setting",
            "basis",
            "harmonics",
            "samples",
            "residual",
            "peak",
            "law",
            "median",
            "P95",
            "P95 <=",
            "worst",
            "worst <=",
            "factor P95",
            "Gflop",
            "cost",
            "CPU ms",
            "chosen",
        ]);
        for own in settings {
            let error = |of: fn(&ErrorBound) -> f64| shown(own.amplitude.as_ref().map(of));
            let factor = own.amplification_factor.map(|errors| errors.p95);
            let chosen: Vec<String> = self
                .choices
                .iter()
                .filter(|choice| choice.setting == Some(own.setting))
                .map(|choice| percent(choice.accepted_error))
                .collect();
            table.row(vec![
                own.setting.to_string(),
                own.basis.clone(),
                own.harmonics.clone(),
                own.samples_per_period.to_string(),
                format!("{:e}", own.residual_tolerance),
                format!("{:e}", own.peak_tolerance),
                own.contact_law.to_owned(),
                error(|errors| errors.median),
                error(|errors| errors.p95),
                error(|errors| errors.p95_upper),
                error(|errors| errors.worst),
                shown(own.amplitude_worst_upper),
                shown(factor),
                format!("{:.3}", 1e-9 * own.operations),
                format!("{:.1}", own.operations / cheapest),
                format!("{:.0}", 1e3 * own.cpu_s),
                chosen.join(", "),
            ]);
        }
        write!(f, "{table}")
    }

    fn knob_table(&self, f: &mut fmt::Formatter<'_>, settings: &[&TradeoffRecord]) -> fmt::Result {
        let base = self.settings.iter().find(|own| own.role == "base");
        let base = base.map_or(f64::NAN, |base| base.operations);
        let mut table = TextTable::new(&[
            "setting",
            "knob",
            "level",
            "own median",
            "own P95",
            "own worst",
            "P95",
            "failed",
            "cost of base",
            "solves",
            "Newton",
            "LU",
            "CPU ms",
        ]);
        for own in settings {
            let single = |of: fn(&ErrorBound) -> f64| shown(own.knob_amplitude.as_ref().map(of));
            table.row(vec![
                own.setting.to_string(),
                own.knob.unwrap_or_default().to_owned(),
                level(own),
                single(|errors| errors.median),
                single(|errors| errors.p95),
                single(|errors| errors.worst),
                shown(own.amplitude.map(|errors| errors.p95)),
                own.amplitude.map_or(0, |errors| errors.failed).to_string(),
                format!("{:.2}", own.operations / base),
                format!("{:.1}", own.work.nonlinear_solves),
                format!("{:.0}", own.work.newton_iterations),
                format!("{:.1}", own.work.factorisations),
                format!("{:.0}", 1e3 * own.cpu_s),
            ]);
        }
        write!(f, "{table}")
    }
}

/// The level of the knob that a setting moves.
fn level(own: &TradeoffRecord) -> String {
    match own.knob {
        Some("basis") => own.basis.clone(),
        Some("harmonics") => own.harmonics.clone(),
        Some("samples_per_period") => own.samples_per_period.to_string(),
        Some("residual_tolerance") => format!("{:e}", own.residual_tolerance),
        Some("peak_tolerance") => format!("{:e}", own.peak_tolerance),
        Some("contact_law") => own.contact_law.to_owned(),
        Some("projection") => own.projection.to_owned(),
        _ => String::new(),
    }
}

fn percent(share: f64) -> String {
    let digits = format!("{:.3}", 100.0 * share);
    let digits = digits.trim_end_matches('0').trim_end_matches('.');
    format!("{digits} %")
}

fn shown(share: Option<f64>) -> String {
    match share {
        None => "-".to_owned(),
        Some(share) if share.is_finite() => format!("{:.3} %", 100.0 * share),
        Some(_) => "inf".to_owned(),
    }
}

fn signed(share: Option<f64>) -> String {
    share.map_or_else(
        || "-".to_owned(),
        |share| format!("{:+.3} %", 100.0 * share),
    )
}
