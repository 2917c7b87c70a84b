//! How many patterns a run solves: all of them, or as few as the `[stop]` of the study asks for.
//!
//! A look is made when every row of its patterns is stored, and from these rows alone, so that it does
//! not matter who solved them, in which order, or what else is stored. Patterns that a finished folder
//! holds are never given up: a study whose rule changed ends at the first look, from there on, at
//! which the rule is met.

use crate::population::statistics::{StopOptions, StopOutcome};
use crate::population::table::{RowStore, Shard};
use crate::study::{PipelineError, Study};

/// Where the run of a study may end.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Goal {
    stop: Option<StopOptions>,
    most: u64,
    /// Numbers of patterns at which it may end, ascending; the last one is `most`.
    ends: Vec<u64>,
}

impl Goal {
    /// The goal of `study` in a folder that holds `held` patterns.
    pub(super) fn new(study: &Study, held: u64) -> Self {
        let most = u64::from(study.patterns);
        let mut ends = match &study.stop {
            Some(stop) => stop.rule(most).looks(),
            None => vec![most],
        };
        ends.retain(|&patterns| patterns >= held.min(most));
        Self {
            stop: study.stop,
            most,
            ends,
        }
    }

    pub(super) fn ends(&self) -> &[u64] {
        &self.ends
    }

    /// Looks at the rows of the patterns `ids`, the first ones of the study, which are stored.
    pub(super) fn look(
        &self,
        store: &RowStore,
        ids: &[u32],
        scenarios: usize,
    ) -> Result<Verdict, PipelineError> {
        let Some(stop) = self.stop else {
            return Ok(Verdict {
                ends: true,
                outcome: None,
            });
        };
        let mut columns: Vec<Vec<Option<f64>>> = vec![Vec::with_capacity(ids.len()); scenarios];
        store.visit(|row| {
            if ids.binary_search(&row.pattern).is_ok() {
                columns[row.scenario].push(stop.quantity.of(&row));
            }
            Ok(())
        })?;
        let sample = |column: &Vec<Option<f64>>, patterns: u64| {
            let first = &column[..column.len().min(patterns as usize)];
            let mut good: Vec<f64> = first.iter().flatten().copied().collect();
            good.sort_unstable_by(f64::total_cmp);
            let failed = patterns - good.len() as u64;
            (good, failed)
        };
        let mut outcome = StopOutcome::new(stop, self.most);
        for patterns in outcome.looks.clone() {
            if patterns <= ids.len() as u64 {
                let samples: Vec<_> = columns
                    .iter()
                    .map(|column| sample(column, patterns))
                    .collect();
                outcome.look(&samples);
            }
        }
        Ok(Verdict {
            ends: outcome.met || ids.len() as u64 >= self.most,
            outcome: Some(outcome),
        })
    }
}

/// What a look came to.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Verdict {
    /// Whether the study ends here.
    pub(super) ends: bool,
    /// What its stopping rule saw, if it has one.
    pub(super) outcome: Option<StopOutcome>,
}

/// Whether `study` can be solved in shards.
///
/// # Errors
/// It has a stopping rule, which needs the rows of all patterns so far.
pub fn can_be_cut(study: &Study) -> Result<(), PipelineError> {
    match study.stop {
        None => Ok(()),
        Some(_) => Err(PipelineError::Shards {
            reason: format!(
                "{} has a [stop], and a shard sees its own patterns only, so that it cannot tell when \
                 to stop; run the study without shards, or take [stop] out to solve all of its {} \
                 patterns",
                study.path.display(),
                study.patterns
            ),
        }),
    }
}

/// Whether the patterns of `study` can be cut so that `shard` is one of the shares.
///
/// # Errors
/// There are more shards than patterns, or no such share of them.
pub fn is_shard_of(study: &Study, shard: Shard) -> Result<(), PipelineError> {
    let patterns = u64::from(study.patterns);
    if shard.is_of(patterns) {
        return Ok(());
    }
    let most = Shard::most(patterns);
    let reason = format!(
        "{} has {patterns} patterns, of which {shard} is no share; accepted: k/n with n from 1 to {most} \
         and k from 1 to n",
        study.path.display()
    );
    Err(PipelineError::Shards { reason })
}
