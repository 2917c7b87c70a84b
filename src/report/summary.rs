//! Every number of the summary of a study, and the warnings that go with them.

use serde::Serialize;

use super::{NumericalError, RotationFacts, RowTolerance, Warning};
use crate::population::monte_carlo::{LoadCaseName, TUNED_RECEPTANCES};
use crate::population::statistics::{
    Accounting, PERCENTILES, Percentile, PointStatus, SampleStatistics, ScenarioStability,
    StopOutcome,
};
use crate::population::table::ScenarioRecord;
use crate::response::forced_response::Harmonics;
use crate::response::harmonic_balance::Status;

/// What a summary says about the study itself.
#[derive(Debug, Clone, PartialEq)]
pub struct SummaryContext {
    /// Name of the study.
    pub name: String,
    /// Its digest.
    pub study_digest: String,
    /// Seed of the patterns.
    pub seed: u64,
    /// Number of patterns.
    pub patterns: u64,
    /// What the stopping rule came to, if there is one.
    pub stop: Option<StopOutcome>,
    /// Harmonics as the study has them.
    pub harmonics: Harmonics,
    /// What rows are marked by.
    pub tolerance: RowTolerance,
    /// Reduction basis in use.
    pub basis: BasisSummary,
    /// Numerical error by which the settings were chosen, if they were.
    pub numerical_error: Option<NumericalError>,
    /// Normal loads by rotation, if there are any.
    pub rotation: Option<RotationFacts>,
    /// Stress per amplitude, Pa/m, if the study says it.
    pub stress_pa_per_m: Option<f64>,
    /// Version of the program that made the results.
    pub version: String,
}

/// The reduction basis of a study and its measured error.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct BasisSummary {
    /// The basis, in words.
    pub name: String,
    /// Measured relative error of the tuned peak; none where nothing is left out or no peak was found.
    pub tuned_peak_error: Option<f64>,
    /// Highest fixed-interface frequency over what it should be; 1 is enough.
    pub craig_bampton_reach: Option<f64>,
    /// Largest relative change of a tuned peak by more modes than the study asks for; none where the program chooses.
    pub craig_bampton_error: Option<f64>,
    /// Error that the study asks for.
    pub wanted_error: f64,
    /// What peaks may be off by the basis for it.
    pub wanted_peak_error: f64,
    /// Whether rows are solved on something else than the basis that the study names, because that is replaced.
    pub is_replaced: bool,
}

impl BasisSummary {
    /// What of the reduction is less accurate than it should be.
    #[must_use]
    pub fn warnings(&self) -> Vec<Warning> {
        let peak = self
            .tuned_peak_error
            .filter(|&error| error > self.wanted_peak_error)
            .map(|error| Warning::BasisError {
                basis: self.name.clone(),
                error,
                wanted: self.wanted_peak_error,
            });
        let modes = self
            .craig_bampton_reach
            .filter(|&reach| reach < 1.0)
            .map(|reach| Warning::CraigBamptonModes { reach });
        let wanted = self.wanted_error;
        let truncation = { self.craig_bampton_error }
            .filter(|&error| error > wanted)
            .map(|error| Warning::CraigBamptonError { error, wanted });
        let replaced = self.is_replaced.then(|| Warning::ReplacedBasis {
            taken: self.name.clone(),
        });
        replaced
            .into_iter()
            .chain(peak)
            .chain(modes)
            .chain(truncation)
            .collect()
    }
}

/// One scenario of a summary.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ScenarioSummary {
    /// Index.
    pub scenario: usize,
    /// Load case; absent: the study has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub load_case: Option<LoadCaseName>,
    /// Engine order.
    pub engine_order: u32,
    /// Standard deviation, if the study has one.
    pub standard_deviation: Option<f64>,
    /// `full`, `stuck`, `slide` or `free`.
    pub contact: &'static str,
    /// Normal load per sector, N.
    pub normal_load_n: Option<f64>,
    /// Speed that the normal load is that of, revolutions per minute; absent: it is written in newtons.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed_rpm: Option<f64>,
    /// How the tuned solution ended.
    pub tuned_status: &'static str,
    /// Tuned peak amplitude, m.
    pub tuned_amplitude_m: Option<f64>,
    /// Tuned peak frequency, Hz.
    pub tuned_frequency_hz: Option<f64>,
    /// Rows by status.
    pub rows: Accounting,
    /// Peak amplitude, m.
    pub peak_amplitude_m: SampleStatistics,
    /// Amplification factor.
    pub amplification_factor: SampleStatistics,
    /// Mean share of slipping pairs at the peak.
    pub mean_slipping_fraction: Option<f64>,
    /// Share of rows in which a pair separates.
    pub separated_rows: Option<f64>,
    /// What is known of the stability of its motions; absent: none was looked at.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stability: Option<ScenarioStability>,
}

impl ScenarioSummary {
    /// Speed at which the engine order meets the tuned peak, revolutions per minute: the crossing of the
    /// Campbell diagram; none for engine order 0.
    #[must_use]
    pub fn crossing_rpm(&self) -> Option<f64> {
        let order = f64::from(self.engine_order);
        self.tuned_frequency_hz
            .filter(|_| order > 0.0)
            .map(|hz| 60.0 * hz / order)
    }

    /// Whether both differ in nothing but the contact condition.
    pub(super) fn same_group(&self, other: &Self) -> bool {
        self.load_case == other.load_case
            && self.engine_order == other.engine_order
            && self.standard_deviation == other.standard_deviation
    }
}

/// The contact condition with the lowest amplitude among those studied.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BestLoad {
    /// Load case; absent: the study has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub load_case: Option<LoadCaseName>,
    /// Engine order.
    pub engine_order: u32,
    /// Standard deviation, if the study has one.
    pub standard_deviation: Option<f64>,
    /// `tuned_amplitude_m`, `peak_amplitude_m` of a single wheel, or `peak_amplitude_m_p95`.
    pub quantity: &'static str,
    /// Scenario with the lowest value.
    pub scenario: usize,
    /// `full`, `stuck`, `slide` or `free`.
    pub contact: &'static str,
    /// Its normal load per sector, N.
    pub normal_load_n: Option<f64>,
    /// The lowest value, m.
    pub amplitude_m: f64,
    /// Whether a lower and a higher normal load were studied.
    pub interior: bool,
}

/// Summary of a study.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StudySummary {
    /// Name of the study.
    pub name: String,
    /// Its digest.
    pub study_digest: String,
    /// Version of the program that made the results.
    pub version: String,
    /// Seed of the patterns.
    pub seed: u64,
    /// Number of patterns.
    pub patterns: u64,
    /// What the stopping rule came to; null: all patterns were to be solved.
    pub stop: Option<StopOutcome>,
    /// Reduction basis in use.
    pub basis: BasisSummary,
    /// Numerical error by which the settings were chosen; null: the study says the settings.
    pub numerical_error: Option<NumericalError>,
    /// What rows are marked by.
    pub tolerance: RowTolerance,
    /// Normal loads by rotation; absent: all are written in newtons.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rotation: Option<RotationFacts>,
    /// Stress per amplitude, Pa/m; absent: the study does not say it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stress_pa_per_m: Option<f64>,
    /// Rows by status over all scenarios.
    pub rows: Accounting,
    /// The scenarios, in order.
    pub scenarios: Vec<ScenarioSummary>,
    /// Best contact conditions.
    pub best: Vec<BestLoad>,
    /// Warnings.
    pub warnings: Vec<Warning>,
}

impl StudySummary {
    /// The summary of the scenarios of a study.
    #[must_use]
    pub fn new(context: &SummaryContext, records: &[ScenarioRecord]) -> Self {
        let rotation = context.rotation.as_ref();
        let scenarios: Vec<ScenarioSummary> = records
            .iter()
            .map(|record| scenario_summary(record, rotation))
            .collect();
        let mut rows = Accounting::default();
        for scenario in &scenarios {
            rows.merge(&scenario.rows);
        }
        Self {
            name: context.name.clone(),
            study_digest: context.study_digest.clone(),
            version: context.version.clone(),
            seed: context.seed,
            patterns: context.patterns,
            stop: context.stop.clone(),
            basis: context.basis.clone(),
            numerical_error: context.numerical_error,
            tolerance: context.tolerance,
            rotation: context.rotation.clone(),
            stress_pa_per_m: context.stress_pa_per_m,
            rows,
            best: best_loads(&scenarios),
            warnings: warnings(context, records, &rows),
            scenarios,
        }
    }

    /// Whether all patterns were spent without an interval as narrow as wanted.
    #[must_use]
    pub fn misses_its_target(&self) -> bool {
        self.stop.as_ref().is_some_and(|stop| !stop.met)
    }

    /// Whether it is of one wheel of `mistuning.file`, of which there is no percentile.
    pub(super) fn is_of_one_wheel(&self) -> bool {
        let mut own = self.scenarios.iter();
        self.patterns == 1 && own.all(|own| own.standard_deviation.is_none())
    }

    /// Whether failures leave a percentile or a tuned reference without value.
    #[must_use]
    pub fn failures_cost_a_statistic(&self) -> bool {
        self.warnings.iter().any(Warning::costs_a_statistic)
    }
}

fn scenario_summary(record: &ScenarioRecord, rotation: Option<&RotationFacts>) -> ScenarioSummary {
    let ScenarioRecord {
        scenario,
        tuned,
        statistics,
        stability,
    } = record;
    ScenarioSummary {
        scenario: scenario.index,
        load_case: scenario.load_case,
        engine_order: scenario.engine_order,
        standard_deviation: scenario.standard_deviation,
        contact: scenario.contact.name(),
        normal_load_n: scenario.contact.normal_load_n(),
        speed_rpm: rotation
            .zip(scenario.contact.normal_load_n())
            .and_then(|(rotation, load_n)| rotation.speed_of(load_n)),
        tuned_status: tuned.status.name(),
        tuned_amplitude_m: tuned.amplitude_m,
        tuned_frequency_hz: tuned.frequency_hz,
        rows: statistics.accounting,
        peak_amplitude_m: statistics.peak_amplitude_m.clone(),
        amplification_factor: statistics.amplification_factor.clone(),
        mean_slipping_fraction: statistics.mean_slipping_fraction,
        separated_rows: statistics.separated_rows,
        stability: *stability,
    }
}

/// For each excitation and standard deviation, the lowest tuned amplitude, the lowest peak of a single wheel, and the lowest P95.
fn best_loads(scenarios: &[ScenarioSummary]) -> Vec<BestLoad> {
    let mut best = Vec::new();
    let groups = scenarios.chunk_by(ScenarioSummary::same_group);
    for group in groups.filter(|group| group.len() > 1) {
        let tuned = |scenario: &ScenarioSummary| scenario.tuned_amplitude_m;
        let single = |scenario: &ScenarioSummary| {
            let mean = scenario.peak_amplitude_m.mean;
            mean.filter(|_| scenario.rows.planned() == 1)
        };
        let p95 = |scenario: &ScenarioSummary| scenario.peak_amplitude_m.percentile(95)?.value;
        best.extend(lowest(group, "tuned_amplitude_m", tuned));
        best.extend(lowest(group, "peak_amplitude_m", single));
        best.extend(lowest(group, "peak_amplitude_m_p95", p95));
    }
    best
}

fn lowest(
    group: &[ScenarioSummary],
    quantity: &'static str,
    value: impl Fn(&ScenarioSummary) -> Option<f64>,
) -> Option<BestLoad> {
    let (scenario, amplitude_m) = group
        .iter()
        .filter_map(|scenario| Some((scenario, value(scenario)?)))
        .min_by(|a, b| a.1.total_cmp(&b.1))?;
    let loads = || group.iter().filter_map(|scenario| scenario.normal_load_n);
    Some(BestLoad {
        load_case: scenario.load_case,
        engine_order: scenario.engine_order,
        standard_deviation: scenario.standard_deviation,
        quantity,
        scenario: scenario.scenario,
        contact: scenario.contact,
        normal_load_n: scenario.normal_load_n,
        amplitude_m,
        interior: scenario
            .normal_load_n
            .is_some_and(|best| loads().any(|load| load < best) && loads().any(|load| load > best)),
    })
}

fn warnings(
    context: &SummaryContext,
    records: &[ScenarioRecord],
    rows: &Accounting,
) -> Vec<Warning> {
    let mut warnings = Vec::new();
    warnings.extend(separation(&context.harmonics, records));
    let concerned = || { records.iter() }.filter(|record| record.statistics.beyond_tolerance > 0);
    let scenarios: Vec<usize> = concerned().map(|record| record.scenario.index).collect();
    if !scenarios.is_empty() {
        let statistics = || records.iter().map(|record| &record.statistics);
        let stated = statistics().filter_map(|of| of.largest_stated_error);
        let of_concerned = concerned().map(|record| record.statistics.accounting.planned());
        warnings.push(Warning::BeyondTolerance {
            rows: statistics().map(|of| of.beyond_tolerance).sum(),
            by_sampling: statistics().map(|of| of.beyond_by_sampling).sum(),
            automatic: context.harmonics == Harmonics::Auto,
            on_basis: context.basis.name != TUNED_RECEPTANCES,
            planned: of_concerned.sum(),
            scenarios,
            tolerance: context.tolerance,
            largest_stated_error: stated.fold(0.0, f64::max),
        });
    }
    warnings.extend(unstable(records));
    warnings.extend(context.basis.warnings());
    if let Some(error) = context.numerical_error {
        let percent = context
            .stop
            .as_ref()
            .map_or(95.0, |stop| stop.wanted.percentile);
        let amplitudes = records
            .iter()
            .map(|record| &record.statistics.peak_amplitude_m);
        let found: Vec<Percentile> = amplitudes
            .filter_map(|sample| {
                sample
                    .percentiles
                    .iter()
                    .find(|found| found.percent.total_cmp(&percent).is_eq())
            })
            .copied()
            .collect();
        let findings = error.findings(&found).into_iter();
        warnings.extend(findings.map(Warning::NumericalError));
    }
    if rows.failed() > 0 {
        warnings.push(Warning::Failures {
            failed: rows.failed(),
            planned: rows.planned(),
        });
    }
    let without_tuned = { records.iter() }.filter(|record| record.tuned.status != Status::Ok);
    let tuned_failures: Vec<usize> = without_tuned.map(|own| own.scenario.index).collect();
    if !tuned_failures.is_empty() {
        warnings.push(Warning::TunedFailures {
            scenarios: tuned_failures,
        });
    }
    warnings.extend(unestimated(context.patterns, records));
    warnings
}

/// Motions that are known to be unstable.
fn unstable(records: &[ScenarioRecord]) -> Option<Warning> {
    let found = || records.iter().filter_map(|record| record.stability);
    let rows: u64 = found().map(|own| own.unstable).sum();
    let tuned = records.iter().filter(|record| {
        let found = record.stability;
        found.is_some_and(|own| own.tuned == Some(false))
    });
    let tuned: Vec<usize> = tuned.map(|record| record.scenario.index).collect();
    (rows > 0 || !tuned.is_empty()).then(|| Warning::Unstable {
        looked_at: found().map(|own| own.rows).sum(),
        rows,
        tuned,
    })
}

/// Separation needs harmonic 0 and even harmonics; an automatic set has them where the tuned wheel
/// separates.
fn separation(harmonics: &Harmonics, records: &[ScenarioRecord]) -> Option<Warning> {
    let has_even = |set: &[u32]| set.contains(&0) && set.iter().any(|k| *k > 0 && k % 2 == 0);
    let lacks_even = |record: &&ScenarioRecord| match harmonics {
        Harmonics::Auto => {
            let names = record.tuned.harmonics.split('-');
            let set: Vec<u32> = names.filter_map(|k| k.parse().ok()).collect();
            !has_even(&set)
        }
        Harmonics::Set(set) => !has_even(set),
    };
    let separated = |record: &ScenarioRecord| -> f64 {
        let tuned = record.tuned.separated_fraction.unwrap_or(0.0);
        let rows = record.statistics.largest_separated_fraction;
        rows.unwrap_or(0.0).max(tuned)
    };
    let concerned: Vec<&ScenarioRecord> = records
        .iter()
        .filter(lacks_even)
        .filter(|record| separated(record) > 0.0)
        .collect();
    (!concerned.is_empty()).then(|| Warning::SeparationWithFewHarmonics {
        scenarios: concerned
            .iter()
            .map(|record| record.scenario.index)
            .collect(),
        largest_fraction: concerned
            .iter()
            .map(|record| separated(record))
            .fold(0.0, f64::max),
    })
}

/// One warning per percentile and reason.
fn unestimated(patterns: u64, records: &[ScenarioRecord]) -> Vec<Warning> {
    let mut warnings = Vec::new();
    // Only wheels of a file have no standard deviation.
    let of_file = |record: &ScenarioRecord| record.scenario.standard_deviation.is_none();
    let wheels_in_file = records.iter().any(of_file).then_some(patterns);
    // Nobody asks one wheel for a percentile: its peak is the answer.
    if wheels_in_file == Some(1) {
        return warnings;
    }
    for percent in PERCENTILES {
        let of = |record: &ScenarioRecord| -> Vec<Percentile> {
            [
                &record.statistics.amplification_factor,
                &record.statistics.peak_amplitude_m,
            ]
            .into_iter()
            .filter_map(|sample| sample.percentile(percent).copied())
            .collect()
        };
        let needed = records
            .iter()
            .flat_map(of)
            .find_map(|found| match found.status {
                PointStatus::TooFewPatterns { needed } => Some(needed),
                _ => None,
            });
        if let Some(needed) = needed {
            warnings.push(Warning::TooFewPatterns {
                percent,
                needed,
                wheels_in_file,
            });
        }
        let scenarios: Vec<usize> = records
            .iter()
            .filter(|record| {
                of(record)
                    .iter()
                    .any(|found| found.status == PointStatus::TooManyFailures)
            })
            .map(|record| record.scenario.index)
            .collect();
        if !scenarios.is_empty() {
            warnings.push(Warning::TooManyFailures { percent, scenarios });
        }
    }
    warnings
}
