//! What a ladder of settings will cost: counted from the time of its first pattern at the base setting.
//!
//! ```text
//! cost of a setting = cost of the base  (v / v_base)^2  s  h
//! ```
//!
//! v: vectors per nodal diameter; s, h: what samples and harmonics cost beside those of the base, as measured
//! on the built-in wheel. It is an estimate of the size, good to a factor of two or so.

use std::time::Instant;

use super::bench::LadderBench;
use super::reference::LadderEnds;
use super::{HarmonicLevel, Knob, LadderSetting};
use crate::model::reduction::BasisChoice;
use crate::report::{ExpectedCost, ExpectedTime};
use crate::response::mistuning::PatternSource;
use crate::settings::Progress;
use crate::study::PipelineError;

/// Least cost of a setting over that of the base: what does not depend on the basis.
const LEAST: f64 = 0.4;
/// Cost of harmonics chosen for each load over those of the base.
const AUTOMATIC: f64 = 1.5;
/// Share of the cost of the base that goes with its samples.
const SAMPLES: f64 = 0.2;

/// What is about to be measured.
pub(crate) struct LadderPlan<'a> {
    /// The base and the best settings.
    pub(crate) ends: &'a LadderEnds,
    /// Levels of single knobs.
    pub(crate) levels: &'a [(Knob, LadderSetting)],
    /// Combinations, about.
    pub(crate) combinations: usize,
    /// Threads.
    pub(crate) threads: usize,
}

impl LadderPlan<'_> {
    /// Solves the first pattern at the base setting, and says what all settings will take.
    ///
    /// # Errors
    /// The model cannot be reduced.
    pub(crate) fn announce(
        &self,
        bench: &mut LadderBench<'_>,
        patterns: &PatternSource,
        progress: &dyn Progress,
    ) -> Result<(), PipelineError> {
        let ids = bench.sample().patterns.clone();
        progress.begin_rows(bench.sample().scenarios.len() as u64, 0);
        let began = Instant::now();
        let engine = bench.engine(&self.ends.base)?;
        let set_up_s = began.elapsed().as_secs_f64();
        let rows = engine.rows(patterns, &ids[..ids.len().min(1)]);
        let pattern_s = began.elapsed().as_secs_f64() - set_up_s;
        let cost = self.cost_over_base(bench);
        let time = |patterns: usize| cost * (set_up_s + patterns as f64 * pattern_s);
        let side_by_side = self.threads.min(ids.len()).max(1);
        // On a busy machine the clock runs on while other programs have the processor.
        let cpu_s: f64 = rows.iter().map(|row| row.cpu_s).sum();
        let share = if cpu_s > 0.0 {
            (cpu_s / pattern_s).min(1.0)
        } else {
            1.0
        };
        progress.cost(&ExpectedCost {
            what: format!(
                "about {} settings of {} patterns",
                self.settings(),
                ids.len()
            ),
            rows: (self.settings() * ids.len() * rows.len()) as u64,
            time: Some(ExpectedTime {
                cpu_s: share * time(ids.len()),
                wall_s: time(ids.len().div_ceil(side_by_side)),
                threads: self.threads,
                measured_on: "the first pattern, to a factor of two".to_owned(),
            }),
        });
        Ok(())
    }

    /// Settings measured: base, parts of the reference, levels and combinations.
    fn settings(&self) -> usize {
        1 + self.parts().len() + self.levels.len() + self.combinations
    }

    /// The base with one knob at its best at a time, and all at once.
    fn parts(&self) -> [LadderSetting; 3] {
        let LadderEnds { base, best } = self.ends;
        [
            base.with(Knob::Basis, best),
            base.with(Knob::Harmonics, best),
            best.clone(),
        ]
    }

    /// Cost of all settings over that of the base.
    fn cost_over_base(&self, bench: &LadderBench<'_>) -> f64 {
        let of = |setting: &LadderSetting| self.cost_of(bench, setting);
        let levels: f64 = self.levels.iter().map(|(_, setting)| of(setting)).sum();
        let parts: f64 = self.parts().iter().map(of).sum();
        let mean = levels / self.levels.len().max(1) as f64;
        1.0 + parts + levels + self.combinations as f64 * mean
    }

    /// Cost of one setting over that of the base.
    fn cost_of(&self, bench: &LadderBench<'_>, setting: &LadderSetting) -> f64 {
        let base = &self.ends.base;
        let vectors = |basis: BasisChoice| bench.space(basis).most_vectors as f64;
        let ratio = match (setting.basis, base.basis) {
            (BasisChoice::CraigBampton, _) | (_, BasisChoice::CraigBampton) => 1.0,
            (basis, base) => vectors(basis) / vectors(base),
        };
        let samples = setting.samples_per_period as f64 / base.samples_per_period as f64;
        let automatic =
            |candidate: &LadderSetting| matches!(candidate.harmonics, HarmonicLevel::Automatic(_));
        let harmonics = if automatic(setting) && !automatic(base) {
            AUTOMATIC
        } else {
            1.0
        };
        (ratio * ratio).max(LEAST) * (1.0 - SAMPLES + SAMPLES * samples) * harmonics
    }
}
