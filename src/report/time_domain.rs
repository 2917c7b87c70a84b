//! A delivered row by harmonic balance and by time integration: both amplitudes and the verdict.

use std::fmt;

use serde::Serialize;

use super::text_table::TextTable;
use super::words::{LengthUnit, basis_words, excitation, load_per_sector};
use crate::population::monte_carlo::{LoadCaseName, ResponseRow, Scenario};
use crate::response::harmonic_balance::Status;
use crate::verification::time_integration::{PeriodicMotion, PointComparison, Stability};

/// Difference of a blade's amplitude that is accepted besides the stated error of the row, relative
/// to the largest amplitude.
const ACCEPTED: f64 = 5e-3;

/// One march of the step study.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct StepReport {
    /// Steps per period.
    pub steps_per_period: usize,
    /// Periods marched.
    pub periods: usize,
    /// How the march ended.
    pub status: Status,
    /// Largest amplitude of a blade over its last period, m.
    pub amplitude_m: f64,
}

/// One point of a study on both paths.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TimeDomainReport {
    /// Name of the study.
    pub name: String,
    /// Digest of the study.
    pub study_digest: String,
    /// Scenario index.
    pub scenario: usize,
    /// Pattern id.
    pub pattern: u32,
    /// Load case; absent: the study has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub load_case: Option<LoadCaseName>,
    /// Engine order.
    pub engine_order: u32,
    /// Normal load, N per sector.
    pub normal_load_n: Option<f64>,
    /// Harmonic set of the row.
    pub harmonics: String,
    /// Basis of the reduced model that the row was solved on.
    pub basis: String,
    /// Frequency, Hz: that of the delivered peak.
    pub frequency_hz: Option<f64>,
    /// Delivered peak amplitude, m, with the damping of the study.
    pub delivered_amplitude_m: Option<f64>,
    /// `ok`: a periodic motion, the same with half the step. `work_budget`: not periodic within the
    /// budget. `step_too_small`: periodic, but the amplitude still changes with the step. Otherwise
    /// why either path broke off.
    pub status: Status,
    /// Largest amplitude of a blade by harmonic balance, m, with viscous damping.
    pub harmonic_balance_amplitude_m: Option<f64>,
    /// Largest amplitude of a blade by time integration, m, with viscous damping, over the last
    /// period marched.
    pub time_domain_amplitude_m: Option<f64>,
    /// Amplitude of harmonic 1 of the largest blade by time integration, m, averaged with its phase
    /// over the last periods.
    pub mean_fundamental_amplitude_m: Option<f64>,
    /// Second over first, less one.
    pub amplitude_difference: Option<f64>,
    /// Largest difference of the amplitude of any blade, over the largest amplitude.
    pub largest_blade_difference: Option<f64>,
    /// Stated error of the row.
    pub stated_error: Option<f64>,
    /// Accepted difference of any blade: 0.5 % and the stated error of the row.
    pub accepted_difference: f64,
    /// Whether the motion repeats itself.
    pub periodic: bool,
    /// Whether the wheel stays on the motion of harmonic balance; none where nothing was marched.
    pub stability: Option<Stability>,
    /// Largest modulus of a Floquet multiplier, where the march is not periodic and the multipliers
    /// were looked for.
    pub largest_floquet_multiplier: Option<f64>,
    /// Periods marched, all step sizes.
    pub periods: usize,
    /// Change of the blades' displacements over the last period, relative to the largest.
    pub blade_change_per_period: Option<f64>,
    /// Change of the contact forces over the last period, relative to the largest.
    pub force_change_per_period: Option<f64>,
    /// Change of the blades' fundamental amplitudes over the last periods (50), relative to the
    /// largest.
    pub drift: Option<f64>,
    /// Largest shift of a contact pair along its tangents over the last period, m.
    pub creep_per_period_m: Option<f64>,
    /// The step study, coarsest first.
    pub steps: Vec<StepReport>,
    /// Whether the motion is periodic and no blade differs by more than accepted.
    pub verified: bool,
}

impl TimeDomainReport {
    /// The report on `row`; a point without harmonic-balance solution has its status alone.
    #[must_use]
    pub fn new(
        name: &str,
        study_digest: &str,
        scenario: &Scenario,
        row: &ResponseRow,
        found: &Result<PointComparison, Status>,
    ) -> Self {
        let compared = found.as_ref().ok();
        let status = found
            .as_ref()
            .map_or_else(|status| *status, |found| found.status);
        // A march that broke off within its first period has no amplitudes.
        let marched = compared.filter(|found| !found.time_m.is_empty());
        let settled = marched.map(|found| &found.settled);
        let accepted_difference = ACCEPTED + row.stated_error.unwrap_or(0.0);
        let largest_blade_difference = marched.map(PointComparison::blade_difference);
        let finite = |value: f64| Some(value).filter(|value| value.is_finite());
        let steps: Vec<StepReport> = compared
            .iter()
            .flat_map(|found| &found.steps)
            .map(|step| StepReport {
                steps_per_period: step.steps_per_period,
                periods: step.periods,
                status: step.status,
                amplitude_m: step.largest_m,
            })
            .collect();
        Self {
            name: name.to_owned(),
            study_digest: study_digest.to_owned(),
            scenario: scenario.index,
            pattern: row.pattern,
            load_case: scenario.load_case,
            engine_order: scenario.engine_order,
            normal_load_n: scenario.contact.normal_load_n(),
            harmonics: row.harmonics.clone(),
            basis: row.basis.clone(),
            frequency_hz: row.peak_frequency_hz,
            delivered_amplitude_m: row.peak_amplitude_m,
            status,
            harmonic_balance_amplitude_m: compared.map(|found| largest(&found.harmonic_balance_m)),
            time_domain_amplitude_m: marched.map(|found| largest(&found.time_m)),
            mean_fundamental_amplitude_m: settled
                .map(|settled| largest(&settled.mean_fundamental_m)),
            amplitude_difference: marched.map(PointComparison::largest_difference),
            largest_blade_difference,
            stated_error: row.stated_error,
            accepted_difference,
            periodic: settled.is_some_and(|settled| settled.status == Status::Ok),
            stability: compared.map(PointComparison::stability),
            largest_floquet_multiplier: compared
                .and_then(|found| found.motion.as_ref())
                .and_then(PeriodicMotion::largest_multiplier),
            periods: steps.iter().map(|step| step.periods).sum(),
            blade_change_per_period: settled.and_then(|settled| finite(settled.blade_change)),
            force_change_per_period: settled.and_then(|settled| finite(settled.force_change)),
            drift: settled.and_then(|settled| finite(settled.drift)),
            creep_per_period_m: settled.and_then(|settled| finite(settled.creep_m)),
            steps,
            verified: status == Status::Ok
                && largest_blade_difference.is_some_and(|share| share <= accepted_difference),
        }
    }
}

fn largest(amplitudes_m: &[f64]) -> f64 {
    amplitudes_m.iter().copied().fold(0.0, f64::max)
}

impl fmt::Display for TimeDomainReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let unit = LengthUnit::of(self.delivered_amplitude_m);
        let length =
            |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |value| unit.precise(value));
        let short = |value: Option<f64>, unit: &str| {
            value.map_or_else(|| "-".to_owned(), |value| format!("{value:.1e}{unit}"))
        };
        let percent = |share: Option<f64>| {
            share.map_or_else(|| "-".to_owned(), |share| format!("{:.4} %", 100.0 * share))
        };
        writeln!(
            f,
            "study {}: scenario {}, pattern {}, {}, {}, {} Hz, harmonics {}, {}",
            self.name,
            self.scenario,
            self.pattern,
            excitation(self.load_case, self.engine_order),
            load_per_sector("-", self.normal_load_n),
            self.frequency_hz
                .map_or_else(|| "-".to_owned(), |hz| format!("{hz:.4}")),
            self.harmonics,
            basis_words(&self.basis)
        )?;
        let mut table = TextTable::new(&["largest blade", "amplitude"]);
        for (path, amplitude_m) in [
            ("delivered", self.delivered_amplitude_m),
            (
                "harmonic balance, viscous",
                self.harmonic_balance_amplitude_m,
            ),
            ("time integration, viscous", self.time_domain_amplitude_m),
            ("its mean at harmonic 1", self.mean_fundamental_amplitude_m),
        ] {
            table.row(vec![path.to_owned(), length(amplitude_m)]);
        }
        write!(f, "\n{table}\n")?;
        let mut table = TextTable::new(&["steps per period", "periods", "status", "amplitude"]);
        for step in &self.steps {
            table.row(vec![
                step.steps_per_period.to_string(),
                step.periods.to_string(),
                step.status.name().to_owned(),
                length(Some(step.amplitude_m)),
            ]);
        }
        writeln!(f, "{table}")?;
        writeln!(
            f,
            "difference of the largest amplitude {}, of any blade {}; accepted {}",
            percent(self.amplitude_difference),
            percent(self.largest_blade_difference),
            percent(Some(self.accepted_difference))
        )?;
        writeln!(
            f,
            "change over the last period: blades {}, contact forces {}, ring {}; drift {}",
            short(self.blade_change_per_period, ""),
            short(self.force_change_per_period, ""),
            short(
                self.creep_per_period_m.map(|own| own / unit.metres()),
                &format!(" {}", unit.name())
            ),
            short(self.drift, "")
        )?;
        let multiplier = self
            .largest_floquet_multiplier
            .map_or_else(String::new, |size| {
                format!(", largest Floquet multiplier {size:.4}")
            });
        writeln!(
            f,
            "{}{multiplier} ({}): {}",
            match self.stability {
                Some(Stability::Stable) => "stable",
                Some(Stability::Unstable) => "UNSTABLE",
                Some(Stability::NotSettled) => "NOT settled",
                None => "not marched",
            },
            self.status.name(),
            if self.verified {
                "verified"
            } else {
                "NOT verified"
            }
        )
    }
}
