//! What a study will cost and what its percentiles will be worth, from a pilot: its first few patterns.
//!
//! The pilot is kept in memory and nothing is written but two small files in the folder for temporary
//! files, to measure the bytes of a row; they are removed again.

use std::path::{Path, PathBuf};
use std::time::Instant;

use rayon::prelude::*;

use crate::campaign::pipeline::{Facts, TableWork, pool_of};
use crate::campaign::store::{continued, finished_rows};
use crate::platform::{peak_memory_bytes, thread_processor_time_s};
use crate::population::monte_carlo::{ResponseRow, StoredRows, block_size, plan_blocks};
use crate::population::statistics::{
    Accounting, CONFIDENCE, PERCENTILES, Quantity, StopOptions, expected_relative_width,
    expected_sum, percentile_at, smallest_sample,
};
use crate::population::table::{ResponseWriter, RowSchema, RowStore, TableError, write_patterns};
use crate::report::{
    PlannedDisk, PlannedLook, PlannedPercentile, PlannedRest, PlannedStop, PlannedTime, StudyPlan,
};
use crate::response::mistuning::PatternSource;
use crate::settings::{EngineSource, Progress, RowWork, Stage};
use crate::study::{PipelineError, Study, StudyDigest, load_sector_model, pattern_source};

/// Bytes by which the largest memory of a run grows with a row. From 100,000 to a million rows 61 to 109 were measured
/// (`cargo test --release --test reproducibility -- --ignored --nocapture overhead`); rounded up, since a plan that says
/// too little ends a job. The 24 bytes of a look of `[stop]` are in it.
const BYTES_OF_ROW: u64 = 128;

/// What to plan.
#[derive(Debug, Clone, Copy)]
pub struct PlanRequest<'a> {
    /// The study.
    pub study: &'a Study,
    /// Results folder whose rows are not solved again; it need not be there, and nothing is written to it.
    pub results: &'a Path,
    /// Patterns of the pilot, at most.
    pub pilot: usize,
    /// Number of threads.
    pub threads: usize,
}

/// A pilot that has been solved.
struct Pilot {
    ids: Vec<u32>,
    /// Rows, ordered by pattern, then scenario.
    rows: Vec<ResponseRow>,
    /// Time of each pattern on the clock, s.
    wall_s: Vec<f64>,
    /// Time of each pattern on a processor, s; that on the clock where the system does not say.
    cpu_s: Vec<f64>,
}

/// Solves the pilot and plans the study from it.
///
/// # Errors
/// The model is refused, or the temporary files cannot be written.
pub fn plan(
    request: PlanRequest<'_>,
    source: &dyn EngineSource,
    progress: &dyn Progress,
) -> Result<StudyPlan, PipelineError> {
    let study = request.study;
    let began = Instant::now();
    let digest = StudyDigest::of(study)?;
    progress.stage(Stage::LoadModel);
    let model = load_sector_model(study)?;
    let patterns = pattern_source(study, &model)?;
    let pool = pool_of(request.threads)?;
    progress.stage(Stage::Reduce);
    let engine = pool.install(|| source.build_watched(study, &model, None, progress))?;
    progress.stage(Stage::Tuned);
    let facts = pool.install(|| Facts::solve(engine.as_ref(), study, &digest, progress));
    let set_up_s = began.elapsed().as_secs_f64();
    let all = patterns.ids();
    let ids = all[..all.len().min(request.pilot)].to_vec();
    let tables = TableWork::new(study, &digest, &patterns, (None, ids), facts);
    let scenarios = &tables.schema().scenarios;
    progress.stage(Stage::Rows);
    progress.rows_at_a_time((request.threads * scenarios.len()) as u64);
    progress.begin_rows(tables.planned(), 0);
    let work = RowWork {
        engine: engine.as_ref(),
        patterns: &patterns,
        scenarios,
        tuned: tables.tuned(),
        progress,
    };
    let wanted: Vec<usize> = (0..scenarios.len()).collect();
    let solve = |&id: &u32| {
        let (began, cpu) = (Instant::now(), thread_processor_time_s());
        let rows = work.of_pattern(id, &wanted);
        let wall = began.elapsed().as_secs_f64();
        let cpu = cpu
            .zip(thread_processor_time_s())
            .map(|(before, after)| after - before);
        (rows, (wall, cpu.unwrap_or(wall)))
    };
    let solved: Vec<(Vec<ResponseRow>, (f64, f64))> = pool.install(|| {
        let ids = tables.ids().par_iter().with_max_len(1);
        ids.map(solve).collect()
    });
    let (rows, seconds): (Vec<_>, Vec<_>) = solved.into_iter().unzip();
    let (wall_s, cpu_s) = seconds.into_iter().unzip();
    let pilot = Pilot {
        ids: tables.ids().to_vec(),
        rows: rows.into_iter().flatten().collect(),
        wall_s,
        cpu_s,
    };
    let disk = pilot.disk(study, &patterns, tables.schema())?;
    let mut plan = pilot.plan(&request, scenarios.len(), set_up_s, disk);
    let stored = stored_rows(&request, &digest, tables.schema());
    plan.stored = stored.and_then(|stored| pilot.beside_stored(&request, &stored, &all, set_up_s));
    Ok(plan)
}

/// The rows that a run would take over; none without results that it goes on from.
fn stored_rows(
    request: &PlanRequest<'_>,
    digest: &StudyDigest,
    schema: &RowSchema,
) -> Option<StoredRows> {
    let manifest = continued(request.results, request.study, digest)?;
    let finished = finished_rows(request.results, &manifest);
    let store = RowStore::open(request.results, schema.clone(), finished);
    store.and_then(|store| store.stored()).ok()
}

impl Pilot {
    fn plan(
        &self,
        request: &PlanRequest<'_>,
        scenarios: usize,
        set_up_s: f64,
        disk: PlannedDisk,
    ) -> StudyPlan {
        let study = request.study;
        let patterns = u64::from(study.patterns);
        let rows = patterns * scenarios as u64;
        let stop = study.stop.map(|stop| self.stop(&stop, patterns, scenarios));
        let expected = stop.as_ref().and_then(|stop| stop.expected_patterns);
        let cpu_s: f64 = self.cpu_s.iter().sum();
        let time = |patterns: u64| self.time(patterns, request.threads, set_up_s);
        StudyPlan {
            name: study.name.clone(),
            patterns,
            scenarios: scenarios as u64,
            rows,
            threads: request.threads,
            pilot_patterns: self.ids.len() as u64,
            pilot_rows: self
                .rows
                .iter()
                .map(|row| row.status)
                .collect::<Accounting>(),
            set_up_s,
            cpu_s_per_pattern: cpu_s / self.ids.len() as f64,
            processor_share: (cpu_s / self.wall_s.iter().sum::<f64>()).min(1.0),
            time: time(patterns),
            expected_time: expected.map(time),
            stored: None,
            memory_bytes: peak_memory_bytes().map(|peak| peak + BYTES_OF_ROW * rows),
            disk,
            percentiles: self.percentiles(patterns, scenarios),
            stop,
        }
    }

    /// Time of `patterns` patterns on `threads` threads.
    fn time(&self, patterns: u64, threads: usize, set_up_s: f64) -> PlannedTime {
        let on_clock = expected_sum(&self.wall_s, patterns);
        let side_by_side = threads.min(patterns as usize).max(1) as f64;
        let wall = |on_clock: f64| set_up_s + on_clock / side_by_side;
        PlannedTime {
            patterns,
            cpu_s: expected_sum(&self.cpu_s, patterns),
            wall_s: wall(on_clock.value),
            wall_lower_s: wall(on_clock.lower),
            wall_upper_s: on_clock.upper.map(wall),
        }
    }

    /// What is stored of the patterns `all`, and the time of the other rows; none where no row is stored. Rows of different
    /// loads differ in time, which their nonlinear solves tell; linear rows take next to none.
    fn beside_stored(
        &self,
        request: &PlanRequest<'_>,
        stored: &StoredRows,
        all: &[u32],
        set_up_s: f64,
    ) -> Option<PlannedRest> {
        let rows = stored.count(all);
        let scenarios = self.rows.len() / self.ids.len().max(1);
        let mut work = vec![0_u64; scenarios];
        for row in &self.rows {
            work[row.scenario] += row.nonlinear_solves;
        }
        let of_pattern: u64 = work.iter().sum();
        // The number of patterns that take as long as the missing rows.
        let blocks = plan_blocks(all, stored, scenarios, all.len().max(1));
        let missing: f64 = { blocks.iter() }
            .map(|block| {
                let own = block.scenarios.iter().map(|&scenario| work[scenario]);
                let share = if of_pattern == 0 {
                    block.scenarios.len() as f64 / scenarios as f64
                } else {
                    own.sum::<u64>() as f64 / of_pattern as f64
                };
                share * block.patterns.len() as f64
            })
            .sum();
        let patterns = (missing.ceil() as u64).max(u64::from(!blocks.is_empty()));
        let time = (patterns > 0).then(|| self.time(patterns, request.threads, set_up_s));
        (rows > 0).then(|| PlannedRest {
            folder: request.results.to_owned(),
            rows,
            time,
        })
    }

    /// Good values (ascending) of a scenario, and the number of failed rows.
    fn sample(&self, scenario: usize, quantity: Quantity) -> (Vec<f64>, u64) {
        let rows = self.rows.iter().filter(|row| row.scenario == scenario);
        let values: Vec<Option<f64>> = rows.map(|row| quantity.of(row)).collect();
        let mut good: Vec<f64> = values.iter().flatten().copied().collect();
        good.sort_unstable_by(f64::total_cmp);
        let failed = (values.len() - good.len()) as u64;
        (good, failed)
    }

    /// Expected width of the interval of a percentile among `n` patterns at `confidence`, of the
    /// widest scenario; none where a scenario does not say.
    fn width(
        &self,
        (quantity, percent): (Quantity, f64),
        (n, confidence): (u64, f64),
        scenarios: usize,
    ) -> Option<f64> {
        let pilot = self.ids.len() as u64;
        let widths: Option<Vec<f64>> = (0..scenarios)
            .map(|scenario| {
                let (sorted, failed) = self.sample(scenario, quantity);
                let found = percentile_at(&sorted, failed, percent, CONFIDENCE);
                expected_relative_width(&found, pilot, n, confidence)
            })
            .collect();
        widths.map(|widths| widths.into_iter().fold(0.0, f64::max))
    }

    fn percentiles(&self, patterns: u64, scenarios: usize) -> Vec<PlannedPercentile> {
        let planned = |percent: u32| {
            let needed = smallest_sample(f64::from(percent) / 100.0, CONFIDENCE);
            let width = |quantity| {
                let percent = (quantity, f64::from(percent));
                self.width(percent, (patterns, CONFIDENCE), scenarios)
            };
            PlannedPercentile {
                percent,
                needed_patterns: needed,
                estimable: patterns >= needed,
                peak_amplitude_m_relative_width: width(Quantity::PeakAmplitudeM),
                amplification_factor_relative_width: width(Quantity::AmplificationFactor),
            }
        };
        PERCENTILES.into_iter().map(planned).collect()
    }

    fn stop(&self, stop: &StopOptions, patterns: u64, scenarios: usize) -> PlannedStop {
        let rule = stop.rule(patterns);
        let confidence = rule.confidence();
        let of_rule = (stop.quantity, stop.percentile);
        let looks: Vec<PlannedLook> = rule
            .looks()
            .into_iter()
            .map(|patterns| PlannedLook {
                patterns,
                relative_width: self.width(of_rule, (patterns, confidence), scenarios),
            })
            .collect();
        let reaches = |look: &&PlannedLook| {
            look.relative_width
                .is_some_and(|width| width <= stop.relative_width)
        };
        let first = looks.iter().find(reaches).map(|look| look.patterns);
        let is_known = looks
            .last()
            .is_some_and(|last| last.relative_width.is_some());
        PlannedStop {
            wanted: *stop,
            confidence,
            expected_patterns: first.or(is_known.then_some(patterns)),
            reached: is_known.then_some(first.is_some()),
            looks,
        }
    }

    /// Bytes of the tables, from the growth of small ones with their rows.
    fn disk(
        &self,
        study: &Study,
        patterns: &PatternSource,
        schema: &RowSchema,
    ) -> Result<PlannedDisk, PipelineError> {
        let folder = Scratch::new()?;
        let scenarios = schema.scenarios.len();
        let half = self.ids.len() / 2;
        let bytes_of = |ids: &[u32]| -> Result<[f64; 2], TableError> {
            let path = folder.0.join("rows.parquet");
            let RowSchema {
                scenarios: keys,
                row_digests,
                header,
            } = schema;
            let mut writer = ResponseWriter::create(&path, keys, header, row_digests)?;
            writer.write(self.rows[..ids.len() * scenarios].iter().cloned())?;
            writer.finish()?;
            let drawn = folder.0.join("patterns.parquet");
            write_patterns(&drawn, (patterns, ids), &study.standard_deviations, header)?;
            Ok([bytes(&path)?, bytes(&drawn)?])
        };
        let (some, all) = (bytes_of(&self.ids[..half])?, bytes_of(&self.ids)?);
        let grown = (self.ids.len() - half).max(1) as f64;
        // Bytes of a pattern, and of a file without any.
        let growth = |place: usize| {
            let slope = ((all[place] - some[place]) / grown).max(0.0);
            (slope, (all[place] - slope * self.ids.len() as f64).max(0.0))
        };
        let ((of_rows, rows_file), (of_pattern, pattern_file)) = (growth(0), growth(1));
        let count = f64::from(study.patterns);
        let blocks = (count / block_size(study.patterns as usize) as f64).ceil();
        let table = rows_file + of_rows * count;
        let parts = rows_file * blocks + of_rows * count;
        let drawn = if TableWork::writes_patterns_of(study, study.patterns as usize) {
            pattern_file + of_pattern * count
        } else {
            0.0
        };
        Ok(PlannedDisk {
            bytes_per_row: of_rows / scenarios.max(1) as f64,
            results_bytes: (table + drawn) as u64,
            // Parts stay until the tables stand.
            peak_bytes: (table + drawn + parts) as u64,
        })
    }
}

fn bytes(path: &Path) -> Result<f64, TableError> {
    let found = std::fs::metadata(path).map_err(|source| TableError::Io {
        action: "read",
        path: path.to_owned(),
        source,
    })?;
    Ok(found.len() as f64)
}

/// A folder that goes with this.
struct Scratch(PathBuf);

impl Scratch {
    fn new() -> Result<Self, TableError> {
        let path = std::env::temp_dir().join(format!("blisk-plan-{}", std::process::id()));
        std::fs::create_dir_all(&path).map_err(|source| TableError::Io {
            action: "create the folder",
            path: path.clone(),
            source,
        })?;
        Ok(Self(path))
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        // Two small files among the temporary ones, at worst.
        let _ = std::fs::remove_dir_all(&self.0);
    }
}
