//! What accuracy costs: a sample of the study's rows at reference settings and over a ladder of others.

use std::path::Path;

use super::replay::harmonics_of;
use crate::campaign::pipeline::pool_of;
use crate::campaign::store::ResultsFolder;
use crate::identity;
use crate::model::sector::SectorModel;
use crate::population::monte_carlo::Scenario;
use crate::population::statistics::{ErrorBound, percentile};
use crate::population::table::{
    TRADEOFF_TARGETS, TableHeader, TradeoffRecord, TradeoffRow, write_side_table, write_tradeoff,
    write_tradeoff_rows, write_tradeoff_times,
};
use crate::report::{FullContactCheck, TradeoffChoice, TradeoffReference, TradeoffReport};
use crate::response::mistuning::PatternSource;
use crate::settings::ladder::{
    Compared, LadderBench, LadderEnds, LadderPlan, LadderReference, LadderSample, LadderSearch,
    LadderValues, Measured, error_bound, errors_of_load_cases, projection_name, sample_of_patterns,
};
use crate::settings::{FullModel, FullRow, FullSettings, Knob, LadderSetting, Progress, Stage};
use crate::study::{PipelineError, Study, StudyDigest, load_sector_model, pattern_source};

/// Tolerance of the harmonics of the reference.
const REFERENCE_TOLERANCE: f64 = 1e-3;
/// Errors for which combinations are proposed and measured: the front between them.
const PROPOSED: [f64; 9] = [0.1, 0.05, 0.03, 0.02, 0.01, 0.005, 0.003, 0.002, 0.001];
/// Combinations measured at most for each.
const ATTEMPTS: usize = 3;
/// Share of an error that the next combination is predicted to have, after one that missed it.
const CAUTION: f64 = 0.7;

/// What to trade.
#[derive(Debug, Clone, Copy)]
pub struct TradeoffRequest<'a> {
    /// The study.
    pub study: &'a Study,
    /// The results folder.
    pub results: &'a Path,
    /// Patterns of the sample, at most those of the study.
    pub patterns: usize,
    /// Whether the reference itself is checked by the full-contact model, on one pattern.
    pub full: bool,
    /// Number of threads.
    pub threads: usize,
}

/// Measures what accuracy costs, and writes `tradeoff.parquet`, `tradeoff_rows.parquet` and
/// `tradeoff_times.parquet`.
///
/// # Errors
/// The study has no friction, the model cannot be reduced, or a table not be written.
pub fn tradeoff(
    request: TradeoffRequest<'_>,
    progress: &dyn Progress,
) -> Result<TradeoffReport, PipelineError> {
    let study = request.study;
    if !study.has_friction() {
        return Err(PipelineError::NoTradeoff {
            reason: "the study has linear limits alone, which are exact; accepted: a study with a number \
                     in sweep.normal_load_n"
                .to_owned(),
        });
    }
    let digest = StudyDigest::of(study)?;
    let folder = ResultsFolder::open(request.results)?;
    folder.find(study, &digest, None)?;
    progress.stage(Stage::LoadModel);
    let sector = load_sector_model(study)?;
    let patterns = pattern_source(study, &sector)?;
    let pool = pool_of(request.threads)?;
    let ids = sample_of_patterns(study, &patterns, request.patterns);
    let threads = request.threads;
    let measure = || Trade::measure((study, &sector), &patterns, ids, threads, progress);
    let trade = pool.install(measure)?;
    let checks = if request.full {
        pool.install(|| trade.checked_by_full_contact(&sector, &patterns))?
    } else {
        Vec::new()
    };
    progress.stage(Stage::Tables);
    let header = TableHeader {
        study_digest: digest.hex(),
        compression: study.output.compression,
        load_cases: TableHeader::load_cases_of(&study.scenarios()),
    };
    let records = trade.records();
    let report = trade.report(study, &digest, records, checks);
    let more = [
        ("blisk.reference", trade.reference.kind.name().to_owned()),
        ("blisk.sample_patterns", format!("{:?}", report.patterns)),
    ];
    let settings = &report.settings;
    write_side_table(folder.path(), "tradeoff.parquet", |path| {
        write_tradeoff(path, settings, &header, &more)
    })?;
    write_side_table(folder.path(), "tradeoff_rows.parquet", |path| {
        write_tradeoff_rows(path, &trade.rows(), &header)
    })?;
    write_side_table(folder.path(), "tradeoff_times.parquet", |path| {
        write_tradeoff_times(path, settings, &header)
    })?;
    Ok(report)
}

/// All that was measured.
struct Trade {
    sample: LadderSample,
    /// The study on the scenarios of the sample.
    study: Study,
    reference: LadderReference,
    fixed_interface: crate::settings::FixedInterface,
    /// The base, single knobs, then combinations.
    settings: Vec<Measured>,
}

/// The wheel of harmonics other than 1 in `tradeoff.parquet`.
const HIGHER_HARMONICS: &str = "mistuned";

impl Trade {
    fn measure(
        (study, sector): (&Study, &SectorModel),
        patterns: &PatternSource,
        ids: Vec<u32>,
        threads: usize,
        progress: &dyn Progress,
    ) -> Result<Self, PipelineError> {
        progress.stage(Stage::Reduce);
        let patterns_of_sample = ids.len();
        let mut bench = LadderBench::new(study, sector, ids, progress)?;
        let ends = LadderEnds::choose(&mut bench, REFERENCE_TOLERANCE)?;
        progress.stage(Stage::Rows);
        let space = bench.space(ends.best.basis);
        let levels = space.one_at_a_time(&ends.base, REFERENCE_TOLERANCE);
        let plan = LadderPlan {
            ends: &ends,
            levels: &levels,
            combinations: PROPOSED.len(),
            threads,
        };
        plan.announce(&mut bench, patterns, progress)?;
        let rows = (bench.sample().scenarios.len() * patterns_of_sample) as u64;
        progress.begin_rows((levels.len() + PROPOSED.len()) as u64 * rows, 0);
        let reference = LadderReference::solve(&mut bench, &ends, patterns)?;
        let mut search = LadderSearch::new(&mut bench, patterns, &reference);
        search.measure_levels(levels)?;
        let combinations = combinations(&mut search, reference.most_operations())?;
        let mut settings: Vec<Measured> = Vec::new();
        let levels = search.levels().iter();
        // The best levels of single knobs are parts of the reference.
        let of_reference = |level: &&Measured| {
            let parts = reference.parts.iter();
            parts.clone().all(|part| part.setting != level.setting)
        };
        settings.extend(levels.filter(of_reference).cloned());
        settings.extend(combinations);
        Ok(Self {
            sample: bench.sample().clone(),
            study: bench.study().clone(),
            fixed_interface: bench.fixed_interface().clone(),
            reference,
            settings,
        })
    }

    /// Everything measured: the parts of the reference first.
    fn all(&self) -> Vec<(&'static str, &Measured)> {
        let parts = self.reference.parts.iter().map(|part| ("reference", part));
        let base = &self.reference.base.setting;
        let role = |measured: &Measured| match measured.knob {
            Some(_) => "knob",
            None if measured.setting == *base => "base",
            None => "combination",
        };
        parts
            .chain(
                self.settings
                    .iter()
                    .map(|measured| (role(measured), measured)),
            )
            .collect()
    }

    fn records(&self) -> Vec<TradeoffRecord> {
        let all = self.all();
        let mut records: Vec<TradeoffRecord> = all
            .iter()
            .enumerate()
            .map(|(place, (role, measured))| self.record(place, role, measured))
            .collect();
        let cost = |record: &TradeoffRecord| {
            let upper = record
                .amplitude
                .map_or(f64::INFINITY, |errors| errors.p95_upper);
            (record.operations, upper)
        };
        let costs: Vec<(f64, f64)> = records.iter().map(cost).collect();
        for (place, record) in records.iter_mut().enumerate() {
            let (record_cost, error) = costs[place];
            // Of two alike the first.
            let better = |(at, &(cost, upper)): (usize, &(f64, f64))| {
                cost <= record_cost
                    && upper <= error
                    && (cost < record_cost || upper < error || at < place)
            };
            record.on_front = error.is_finite() && !costs.iter().enumerate().any(better);
        }
        for (target, accepted) in TRADEOFF_TARGETS.into_iter().enumerate() {
            let within = (0..costs.len()).filter(|&place| costs[place].1 <= accepted);
            let cheapest = within.min_by(|&a, &b| costs[a].0.total_cmp(&costs[b].0));
            if let Some(cheapest) = cheapest {
                records[cheapest].chosen[target] = true;
            }
        }
        records
    }

    fn record(&self, place: usize, role: &'static str, measured: &Measured) -> TradeoffRecord {
        let values = measured.values();
        let bound = |quantity| error_bound(&values, &self.reference.values, quantity);
        let amplitude = bound(Compared::Amplitude);
        let setting = &measured.setting;
        TradeoffRecord {
            setting: place as u32,
            role,
            knob: measured.knob.map(Knob::name),
            basis: basis_name(setting),
            harmonics: setting.harmonics.to_string(),
            higher_harmonics: HIGHER_HARMONICS,
            samples_per_period: setting.samples_per_period as u32,
            residual_tolerance: setting.residual_tolerance,
            peak_tolerance: setting.peak_tolerance,
            contact_law: setting.law.name(),
            projection: projection_name(setting.projection),
            amplitude,
            amplitude_worst_upper: amplitude.map(|bound| bound.worst_upper(setting.peak_tolerance)),
            frequency: bound(Compared::Frequency),
            amplification_factor: bound(Compared::AmplificationFactor),
            knob_amplitude: self.knob_error(measured),
            amplitude_p95_error: self.percentile_error(&values, 95),
            amplitude_p99_error: self.percentile_error(&values, 99),
            work: measured.work(),
            unknowns: measured.unknowns() as u32,
            operations: measured.operations(),
            on_front: false,
            chosen: [false; 3],
            cpu_s: measured.cpu_s(),
        }
    }

    /// Errors of a level of a knob against the best level of that knob on the base.
    fn knob_error(&self, measured: &Measured) -> Option<ErrorBound> {
        let best = match measured.knob? {
            Knob::Basis => Knob::Basis,
            Knob::Harmonics => Knob::Harmonics,
            Knob::SamplesPerPeriod | Knob::ResidualTolerance | Knob::PeakTolerance => {
                Knob::SamplesPerPeriod
            }
            // The base has the law and the projection of the study, and the better harmonics.
            Knob::ContactLaw | Knob::Projection => {
                let base = self.reference.base.values();
                return error_bound(&measured.values(), &base, Compared::Amplitude);
            }
        };
        let mut parts = self.reference.parts.iter();
        let best = parts.find(|part| part.knob == Some(best));
        let best = best.unwrap_or(&self.reference.base).values();
        error_bound(&measured.values(), &best, Compared::Amplitude)
    }

    /// Largest relative error of a percentile of the amplitude over the scenarios.
    fn percentile_error(&self, values: &[LadderValues], percent: u32) -> Option<f64> {
        let scenarios = self.sample.scenarios.len();
        let at = |values: &[LadderValues], scenario: usize| {
            let rows = values.iter().skip(scenario).step_by(scenarios);
            let mut good: Vec<f64> = rows.clone().filter_map(|row| row.amplitude_m).collect();
            good.sort_by(f64::total_cmp);
            let failed = (rows.count() - good.len()) as u64;
            percentile(&good, failed, percent).value
        };
        (0..scenarios)
            .map(|scenario| {
                Some(at(values, scenario)? / at(&self.reference.values, scenario)? - 1.0)
            })
            .try_fold(0.0, |largest: f64, error| Some(largest.max(error?.abs())))
    }

    fn rows(&self) -> Vec<TradeoffRow> {
        let values = |values: &LadderValues| {
            [
                values.amplitude_m,
                values.frequency_hz,
                values.amplification_factor,
            ]
        };
        let of_setting = |(place, (_, measured)): (usize, (&'static str, &Measured))| {
            let rows = measured.rows.iter().zip(&self.reference.values);
            rows.map(|(row, reference)| TradeoffRow {
                setting: place as u32,
                scenario: self.sample.scenarios[row.scenario],
                pattern: row.pattern,
                status: row.status.name(),
                harmonics: row.harmonics.clone(),
                values: values(&row.values),
                reference: values(reference),
                work: row.work,
                operations: row.operations,
            })
            .collect::<Vec<_>>()
        };
        self.all()
            .into_iter()
            .enumerate()
            .flat_map(of_setting)
            .collect()
    }

    fn report(
        &self,
        study: &Study,
        digest: &StudyDigest,
        records: Vec<TradeoffRecord>,
        checks: Vec<FullContactCheck>,
    ) -> TradeoffReport {
        let reference = &self.reference;
        let all = self.all();
        let choices = TRADEOFF_TARGETS.into_iter().enumerate();
        let choices = choices.map(|(target, accepted)| {
            let chosen = records.iter().position(|record| record.chosen[target]);
            let measured = chosen.map(|place| all[place].1);
            TradeoffChoice {
                accepted_error: accepted,
                setting: chosen.map(|place| records[place].setting),
                load_cases: measured.map_or_else(Vec::new, |measured| {
                    errors_of_load_cases(&measured.rows, &reference.values, &self.sample)
                }),
            }
        });
        let choices = choices.collect();
        TradeoffReport {
            name: study.name.clone(),
            study_digest: digest.hex(),
            version: identity::VERSION.to_owned(),
            seed: study.seed,
            patterns: self.sample.patterns.clone(),
            scenarios: self
                .sample
                .scenarios
                .iter()
                .map(|scenario| scenario.index)
                .collect(),
            normal_loads_n: self
                .sample
                .scenarios
                .iter()
                .filter_map(|scenario| scenario.contact.normal_load_n())
                .collect(),
            load_cases: TableHeader::load_cases_of(&self.sample.scenarios),
            reference: TradeoffReference {
                kind: reference.kind.name(),
                rows: reference.values.len() as u64,
                without_value: reference
                    .values
                    .iter()
                    .filter(|values| values.amplitude_m.is_none())
                    .count() as u64,
                harmonic_tolerance: REFERENCE_TOLERANCE,
                product_error: reference.product_error,
                craig_bampton_modes: self.fixed_interface.modes,
                craig_bampton_error: self.fixed_interface.error,
                full_contact: checks,
            },
            choices,
            operations: all
                .iter()
                .flat_map(|(_, measured)| &measured.rows)
                .map(|row| row.operations)
                .sum(),
            settings: records,
        }
    }

    /// The rows of the first pattern on the full-contact model, with the harmonics of the reference.
    fn checked_by_full_contact(
        &self,
        sector: &SectorModel,
        patterns: &PatternSource,
    ) -> Result<Vec<FullContactCheck>, PipelineError> {
        let full = FullModel::build(&self.study, sector, &FullSettings::default())?;
        let parts = &self.reference.parts;
        let finest = parts.iter().find(|part| part.knob == Some(Knob::Harmonics));
        let finest = finest.unwrap_or(&self.reference.base);
        let check = |(place, scenario): (usize, &Scenario)| {
            let row = &finest.rows[place];
            let set = harmonics_of(&row.harmonics).unwrap_or_else(|| vec![1]);
            let settings = full.settings(&set)?;
            let wheel = FullRow {
                scenario,
                pattern: None,
                settings: &settings,
                tuned_hz: None,
                expected_hz: None,
            };
            let tuned = full.peak(wheel);
            let pattern = patterns.pattern(row.pattern, scenario.standard_deviation);
            let found = full.peak(FullRow {
                pattern: pattern.as_ref(),
                tuned_hz: tuned.frequency_hz,
                expected_hz: row.values.frequency_hz,
                ..wheel
            });
            let reference = &self.reference.values[place];
            let change = |reduced: Option<f64>, full: Option<f64>| Some(reduced? / full? - 1.0);
            let factor = change(found.amplitude_m, tuned.amplitude_m).map(|change| change + 1.0);
            Ok(FullContactCheck {
                scenario: scenario.index,
                load_case: scenario.load_case,
                pattern: row.pattern,
                harmonics: row.harmonics.clone(),
                status: found.status.name(),
                amplitude_error: change(reference.amplitude_m, found.amplitude_m),
                frequency_error: change(reference.frequency_hz, found.frequency_hz),
                amplification_factor_error: change(reference.amplification_factor, factor),
            })
        };
        self.sample
            .scenarios
            .iter()
            .enumerate()
            .map(check)
            .collect()
    }
}

/// Combinations between the levels, measured: for each of [`PROPOSED`] the cheapest that promises it and
/// takes no more than `most_operations` a row.
fn combinations(
    search: &mut LadderSearch<'_, '_>,
    most_operations: f64,
) -> Result<Vec<Measured>, PipelineError> {
    let mut proposals = search.proposals();
    proposals.retain(|proposal| proposal.operations <= most_operations);
    let mut measured: Vec<Measured> = Vec::new();
    for target in PROPOSED {
        let mut promised = target;
        for _ in 0..ATTEMPTS {
            let within = |proposal: &&crate::settings::ladder::Proposal| {
                proposal.predicted[0].p95_upper <= promised
            };
            let Some(proposal) = proposals.iter().find(within) else {
                break;
            };
            let known = measured.iter().chain(search.levels());
            let known = known
                .into_iter()
                .find(|known| known.setting == proposal.setting);
            let error = if let Some(known) = known {
                search.error_of(known)
            } else {
                let found = search.measure(&proposal.setting)?;
                let error = search.error_of(&found);
                measured.push(found);
                error
            };
            if error.is_some_and(|error| error.p95_upper <= target) {
                break;
            }
            promised *= CAUTION;
        }
    }
    Ok(measured)
}

/// Name of a basis; a model that is not reduced has none to choose.
pub(super) fn basis_name(setting: &LadderSetting) -> String {
    setting.level(Knob::Basis)
}
