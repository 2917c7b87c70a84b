//! Loads of results folders that are solved already on the patterns of a search, and what their rows took.

use std::path::Path;

use crate::campaign::store::{GROWING, ResultColumns};
use crate::identity;
use crate::population::table::{Manifest, RunRecord, RunState};
use crate::response::forced_response::ContactCondition;
use crate::study::{PipelineError, Study, StudyDigest};

/// A load that is solved under every load case and engine order of a study.
pub(super) struct SolvedLoad {
    /// The load per sector, N.
    pub(super) normal_load_n: f64,
    /// Its scenarios in the order of the study; patterns and manifest of their folder.
    pub(super) columns: ResultColumns,
}

/// What a results folder has for a search.
pub(super) enum Holding {
    /// Nothing: there are no results.
    Nothing,
    /// Results that are not of these patterns or not of this study, and why.
    Other(String),
    /// Loads, ascending.
    Loads(Vec<SolvedLoad>),
}

/// The study of a search at one load.
pub(super) fn study_at(study: &Study, normal_load_n: f64) -> Study {
    let mut loaded = study.clone();
    loaded.contacts = vec![ContactCondition::Full { normal_load_n }];
    // Loads are compared over the same patterns, so that none may stop before the others.
    loaded.stop = None;
    loaded
}

/// The loads of the folder `results` that are rows of `study` on all of its patterns.
///
/// # Errors
/// A file of the folder is damaged.
pub(super) fn solved_loads(study: &Study, results: &Path) -> Result<Holding, PipelineError> {
    let Some(manifest) = Manifest::read(results)? else {
        return Ok(Holding::Nothing);
    };
    let other = |reason: &str| Ok(Holding::Other(reason.to_owned()));
    if manifest.state != RunState::Finished {
        return other("it is not finished");
    }
    if manifest.build != identity::BUILD {
        return other("another build of the program made it");
    }
    let mut differences = StudyDigest::of(study)?.differences(&manifest.number_keys);
    differences.retain(|(key, ..)| !GROWING.contains(&key.as_str()));
    if let Some((key, theirs, ours)) = differences.first() {
        return other(&format!("{key} is {theirs} there and {ours} here"));
    }
    if manifest.patterns != u64::from(study.patterns) {
        let (there, here) = (manifest.patterns, study.patterns);
        return other(&format!("it has {there} patterns, the study {here}"));
    }
    let columns = ResultColumns::read(results)?;
    let mut loads: Vec<f64> = columns
        .scenarios
        .iter()
        .filter_map(|scenario| scenario.scenario.contact.normal_load_n())
        .collect();
    loads.sort_by(f64::total_cmp);
    loads.dedup();
    let solved = |normal_load_n: f64| {
        let wanted = study_at(study, normal_load_n).scenarios();
        let found = wanted.iter().map(|scenario| {
            let mut all = columns.scenarios.iter();
            let same = |candidate: &&crate::campaign::store::ScenarioColumns| {
                candidate.scenario.same_group(scenario)
                    && candidate.scenario.contact == scenario.contact
            };
            all.find(same).cloned()
        });
        Some(SolvedLoad {
            normal_load_n,
            columns: ResultColumns {
                scenarios: found.collect::<Option<Vec<_>>>()?,
                folder: columns.folder.clone(),
                manifest: columns.manifest.clone(),
                patterns: columns.patterns.clone(),
            },
        })
    };
    Ok(Holding::Loads(
        loads.into_iter().filter_map(solved).collect(),
    ))
}

/// Processor time of a row under friction, by the runs of the folder `results`, s: all threads count
/// as busy, and rows of the linear limits as free. None where no run solved a row.
pub(super) fn cpu_s_per_row(results: &Path, columns: &ResultColumns) -> Option<f64> {
    let runs = RunRecord::all(results);
    let busy_s: f64 = runs
        .iter()
        .filter(|run| run.rows_solved > 0)
        .map(|run| run.wall_time_s * run.threads as f64)
        .sum();
    let rows: u64 = runs.iter().map(|run| run.rows_solved).sum();
    let entries = &columns.manifest.scenarios;
    let friction = entries
        .iter()
        .filter(|entry| entry.keys().contact.normal_load_n().is_some());
    let share = friction.count() as f64 / entries.len().max(1) as f64;
    (rows > 0).then(|| busy_s / (rows as f64 * share))
}
