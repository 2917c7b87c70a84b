//! From stored rows to finished tables and their manifest.

use std::collections::BTreeMap;
use std::path::Path;

use serde_json::{Value, json};

use super::stability::{Stabilities, StabilityWork};
use crate::campaign::store::{RESPONSES, context_of, records_of};
use crate::identity;
use crate::population::monte_carlo::{Scenario, TunedReference};
use crate::population::statistics::{
    Accounting, CONFIDENCE, ScenarioAccumulator, ScenarioStability, StopOutcome,
};
use crate::population::table::{
    EffectRows, Manifest, RowSchema, RowStore, RunState, SCHEMA_VERSION, ScenarioEntry,
    ScenarioExtras, ScenarioRecord, Shard, Staging, StatusCounts, TableError, TableHeader,
    write_atomically, write_distribution, write_main_effects, write_patterns, write_percentiles,
    write_scenarios,
};
use crate::report::StudySummary;
use crate::response::mistuning::{GENERATOR, PatternSource};
use crate::settings::{Engine, Progress, tuned_references};
use crate::study::{PipelineError, Study, StudyDigest};

/// Patterns up to which `patterns.parquet` is written without being asked for.
const PATTERNS_WRITTEN: usize = 10_000;

/// What a solved model says about a study beside its rows.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::campaign) struct Facts {
    /// Tuned reference of each scenario.
    pub(in crate::campaign) tuned: Vec<TunedReference>,
    /// What the rows of each scenario are made from.
    pub(in crate::campaign) row_digests: Vec<String>,
    /// Settings chosen where the study says `auto`.
    pub(in crate::campaign) chosen: Value,
    /// Facts about the reduction.
    pub(in crate::campaign) reduction: Value,
}

impl Facts {
    /// Asks the engine; `progress` is told which tuned wheel is solved.
    pub(in crate::campaign) fn solve(
        engine: &dyn Engine,
        study: &Study,
        digest: &StudyDigest,
        progress: &dyn Progress,
    ) -> Self {
        let scenarios = study.scenarios();
        Self {
            tuned: tuned_references(engine, &scenarios, progress),
            row_digests: scenarios
                .iter()
                .map(|scenario| digest.of_rows(scenario, &engine.rows_made_from(scenario)))
                .collect(),
            chosen: engine.chosen_settings(),
            reduction: with_rotation(engine.reduction_facts(), study),
        }
    }

    /// Takes them from the manifest of a finished run; none if it lacks a scenario of `study`.
    pub(super) fn stored(manifest: &Manifest, study: &Study) -> Option<Self> {
        let scenarios = study.scenarios();
        let entries: Option<Vec<&ScenarioEntry>> = scenarios
            .iter()
            .map(|scenario| {
                manifest.scenarios.iter().find(|entry| {
                    Scenario {
                        index: scenario.index,
                        ..entry.keys()
                    } == *scenario
                })
            })
            .collect();
        let entries = entries?;
        Some(Self {
            tuned: scenarios
                .iter()
                .zip(&entries)
                .map(|(scenario, entry)| TunedReference {
                    scenario: scenario.index,
                    ..entry.tuned()
                })
                .collect(),
            row_digests: entries
                .iter()
                .map(|entry| entry.row_digest.clone())
                .collect(),
            chosen: manifest.chosen.clone(),
            reduction: manifest.reduction.clone(),
        })
    }
}

/// Facts about the reduced model with those of the loads by rotation, if there are any.
fn with_rotation(mut facts: Value, study: &Study) -> Value {
    if let Some(rotation) = &study.rotation {
        facts["rotation"] = json!(rotation.facts());
    }
    facts
}

/// All that the tables need beside the rows.
pub(in crate::campaign) struct TableWork<'a> {
    study: &'a Study,
    digest: &'a StudyDigest,
    patterns: &'a PatternSource,
    shard: Option<Shard>,
    ids: Vec<u32>,
    schema: RowSchema,
    facts: Facts,
}

impl<'a> TableWork<'a> {
    /// The tables of the patterns `ids`, or of the shard that these are.
    pub(in crate::campaign) fn new(
        study: &'a Study,
        digest: &'a StudyDigest,
        patterns: &'a PatternSource,
        (shard, ids): (Option<Shard>, Vec<u32>),
        facts: Facts,
    ) -> Self {
        Self {
            ids,
            schema: RowSchema {
                scenarios: study.scenarios(),
                row_digests: facts.row_digests.clone(),
                header: TableHeader {
                    study_digest: digest.hex(),
                    compression: study.output.compression,
                    load_cases: TableHeader::load_cases_of(&study.scenarios()),
                },
            },
            study,
            digest,
            patterns,
            shard,
            facts,
        }
    }

    /// Ids of the patterns, ascending.
    pub(in crate::campaign) fn ids(&self) -> &[u32] {
        &self.ids
    }

    /// Number of rows.
    pub(in crate::campaign) fn planned(&self) -> u64 {
        self.ids.len() as u64 * self.schema.scenarios.len() as u64
    }

    pub(in crate::campaign) fn schema(&self) -> &RowSchema {
        &self.schema
    }

    pub(in crate::campaign) fn tuned(&self) -> &[TunedReference] {
        &self.facts.tuned
    }

    /// Manifest of a run that is not finished.
    pub(super) fn unfinished(&self) -> Manifest {
        let none = vec![Accounting::default(); self.schema.scenarios.len()];
        self.manifest(RunState::Running, (&none, &vec![None; none.len()]), None)
    }

    /// Joins the rows of `store` to the tables of the folder `results`, which appear all together;
    /// `stop` says why there are no more of them. `engine` looks at the stability of motions, where that [`is asked
    /// for`](Self::wants_engine).
    pub(in crate::campaign) fn publish(
        &self,
        store: &RowStore,
        results: &Path,
        stop: Option<StopOutcome>,
        engine: Option<&dyn Engine>,
    ) -> Result<(Manifest, StudySummary), PipelineError> {
        let mut staging = Staging::begin(results)?;
        let mut accumulators = vec![ScenarioAccumulator::default(); self.schema.scenarios.len()];
        let varies = self.shard.is_none() && !self.study.contact_variations.is_empty();
        let mut effects = vec![EffectRows::default(); self.schema.scenarios.len()];
        let stability = self.stability(store, engine)?;
        store.assemble(&staging.table(RESPONSES), &self.ids, |row| {
            accumulators[row.scenario].add(row);
            if varies {
                effects[row.scenario].add(row);
            }
            stability.of_row(row)
        })?;
        let confidence = stop.as_ref().map_or(CONFIDENCE, |stop| stop.confidence);
        let tuned = &self.facts.tuned;
        let scenarios = &self.schema.scenarios;
        let found: Vec<_> = (0..scenarios.len())
            .map(|scenario| stability.of_scenario(scenario))
            .collect();
        let records = records_of(scenarios, (tuned, &found), accumulators, confidence);
        let counts: Vec<Accounting> = records
            .iter()
            .map(|record| record.statistics.accounting)
            .collect();
        let manifest = self.manifest(RunState::Finished, (&counts, &found), stop);
        let summary = StudySummary::new(&context_of(&manifest), &records);
        if self.shard.is_none() {
            self.of_population(&mut staging, &records, &summary)?;
        }
        if varies {
            let variations = self.study.contact_variations.iter();
            let inputs: Vec<_> = variations.map(|variation| variation.quantity).collect();
            write_main_effects(
                &staging.table("main_effects.parquet"),
                &self.schema.scenarios,
                &effects,
                &inputs,
                &self.schema.header,
            )?;
        }
        Ok((staging.publish(manifest)?, summary))
    }

    /// Whether the tables of a study, or of a shard of it, need its engine.
    pub(in crate::campaign) fn wants_engine(study: &Study, shard: Option<Shard>) -> bool {
        study.output.stability > 0 && shard.is_none()
    }

    fn stability(
        &self,
        store: &RowStore,
        engine: Option<&dyn Engine>,
    ) -> Result<Stabilities, TableError> {
        let solver = engine.and_then(Engine::solvers);
        let Some(solver) = solver.filter(|_| Self::wants_engine(self.study, self.shard)) else {
            return Ok(Stabilities::default());
        };
        let work = StabilityWork {
            study: self.study,
            patterns: self.patterns,
            ids: &self.ids,
            scenarios: &self.schema.scenarios,
            tuned: &self.facts.tuned,
        };
        work.find(store, solver)
    }

    /// The tables that need all patterns.
    fn of_population(
        &self,
        staging: &mut Staging,
        records: &[ScenarioRecord],
        summary: &StudySummary,
    ) -> Result<(), TableError> {
        let header = &self.schema.header;
        let extras = ScenarioExtras {
            speeds_rpm: self.speeds_rpm(),
            stress_pa_per_m: self.study.output.stress_pa_per_m,
        };
        let table = staging.table("scenarios.parquet");
        write_scenarios(&table, records, &extras, header)?;
        write_percentiles(&staging.table("percentiles.parquet"), records, header)?;
        write_distribution(&staging.table("distribution.parquet"), records, header)?;
        if Self::writes_patterns_of(self.study, self.ids.len()) {
            write_patterns(
                &staging.table("patterns.parquet"),
                (self.patterns, &self.ids),
                &self.study.standard_deviations,
                header,
            )?;
        }
        write_atomically(
            &staging.table("summary.txt"),
            summary.to_string().as_bytes(),
        )
    }

    /// Speed of each scenario whose load is by rotation.
    fn speeds_rpm(&self) -> Vec<Option<f64>> {
        let rotation = self.study.rotation.as_ref();
        let scenarios = self.schema.scenarios.iter();
        scenarios
            .map(|scenario| rotation?.speed_rpm(scenario.contact))
            .collect()
    }

    /// Whether `patterns.parquet` is part of the results of `study` with that many patterns.
    pub(in crate::campaign) fn writes_patterns_of(study: &Study, patterns: usize) -> bool {
        let few = patterns <= PATTERNS_WRITTEN;
        study.output.patterns.unwrap_or(few)
    }

    fn manifest(
        &self,
        state: RunState,
        (counts, stability): (&[Accounting], &[Option<ScenarioStability>]),
        stop: Option<StopOutcome>,
    ) -> Manifest {
        let mut total = Accounting::default();
        for count in counts {
            total.merge(count);
        }
        let scenarios = self
            .schema
            .scenarios
            .iter()
            .zip(&self.facts.tuned)
            .zip(&self.facts.row_digests)
            .zip(counts.iter().zip(stability))
            .map(
                |(((scenario, tuned), row_digest), (count, stability))| ScenarioEntry {
                    stability: *stability,
                    ..ScenarioEntry::new(scenario, tuned, row_digest, count)
                },
            )
            .collect();
        Manifest {
            schema: SCHEMA_VERSION,
            version: identity::VERSION.to_owned(),
            build: identity::BUILD.to_owned(),
            state,
            name: self.study.name.clone(),
            study_digest: self.schema.header.study_digest.clone(),
            seed: self.study.seed,
            generator: GENERATOR.to_owned(),
            patterns: match self.shard {
                Some(_) => u64::from(self.study.patterns),
                None => self.ids.len() as u64,
            },
            stop,
            shard: self.shard,
            number_keys: self.digest.number_keys.clone(),
            inputs: self.digest.inputs.clone(),
            study: self.study.resolved(),
            chosen: self.facts.chosen.clone(),
            reduction: self.facts.reduction.clone(),
            counts: StatusCounts::from(&total),
            tables: BTreeMap::new(),
            scenarios,
        }
    }
}
