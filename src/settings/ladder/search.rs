//! From levels of single knobs to combinations: which are worth measuring, the cheapest first.
//!
//! What a level changes of a row, as a ratio to the base, is taken to be the same in a combination. That
//! proposes combinations; their errors are measured as they are.

use super::bench::{LadderBench, LadderValues};
use super::measure::{Compared, Measured, error_bound};
use super::reference::LadderReference;
use super::{Knob, LadderSetting};
use crate::population::monte_carlo::{RowWork, SystemSize};
use crate::population::statistics::ErrorBound;
use crate::response::mistuning::PatternSource;
use crate::study::PipelineError;

/// Settings measured on the sample.
pub struct LadderSearch<'a, 'b> {
    bench: &'a mut LadderBench<'b>,
    patterns: &'a PatternSource,
    reference: &'a LadderReference,
    /// Levels of each knob in the order of [`Knob::ALL`]: places in `levels`.
    of_knob: Vec<Vec<usize>>,
    levels: Vec<Measured>,
}

/// A combination that has not been measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Proposal {
    /// The setting.
    pub setting: LadderSetting,
    /// Its amplitude errors if ratios multiply: beside the reference, and beside the best levels together found in the same
    /// way. They are the same unless the reference is a joint one; then what knobs do together is an error of every
    /// combination in the first, of none in the second, and either may be nearer.
    pub predicted: [ErrorBound; 2],
    /// Mean floating-point operations of a row if work counts multiply.
    pub operations: f64,
}

impl<'a, 'b> LadderSearch<'a, 'b> {
    /// A search beside `reference`, with its base and its best levels.
    #[must_use]
    pub fn new(
        bench: &'a mut LadderBench<'b>,
        patterns: &'a PatternSource,
        reference: &'a LadderReference,
    ) -> Self {
        let mut search = Self {
            bench,
            patterns,
            reference,
            of_knob: vec![Vec::new(); Knob::ALL.len()],
            levels: vec![reference.base.clone()],
        };
        for knob in [Knob::Basis, Knob::Harmonics] {
            let best = reference.parts.iter().find(|part| part.knob == Some(knob));
            if let Some(best) = best {
                search.add(knob, best.clone());
            }
        }
        search
    }

    fn add(&mut self, knob: Knob, level: Measured) {
        self.levels.push(level);
        // The other projection has an error and saves nothing.
        if knob != Knob::Projection {
            self.of_knob[knob as usize].push(self.levels.len() - 1);
        }
    }

    /// The base, and every level of a single knob.
    #[must_use]
    pub fn levels(&self) -> &[Measured] {
        &self.levels
    }

    /// Measures levels of single knobs on the sample.
    ///
    /// # Errors
    /// The model cannot be reduced.
    pub fn measure_levels(
        &mut self,
        levels: impl IntoIterator<Item = (Knob, LadderSetting)>,
    ) -> Result<(), PipelineError> {
        for (knob, setting) in levels {
            if setting == self.levels[0].setting {
                self.of_knob[knob as usize].push(0);
                continue;
            }
            let level = self.measured(&setting, Some(knob))?;
            self.add(knob, level);
        }
        Ok(())
    }

    /// Measures a setting on the whole sample.
    ///
    /// # Errors
    /// The model cannot be reduced.
    pub fn measure(&mut self, setting: &LadderSetting) -> Result<Measured, PipelineError> {
        self.measured(setting, None)
    }

    fn measured(
        &mut self,
        setting: &LadderSetting,
        knob: Option<Knob>,
    ) -> Result<Measured, PipelineError> {
        let ids = self.bench.sample().patterns.clone();
        let engine = self.bench.engine(setting)?;
        let rows = engine.rows(self.patterns, &ids);
        Ok(Measured::new(setting.clone(), knob, &engine, rows))
    }

    /// Amplitude errors of a setting that was measured on the whole sample.
    #[must_use]
    pub fn error_of(&self, measured: &Measured) -> Option<ErrorBound> {
        error_bound(
            &measured.values(),
            &self.reference.values,
            Compared::Amplitude,
        )
    }

    /// Every combination of levels, the cheapest first.
    #[must_use]
    pub fn proposals(&self) -> Vec<Proposal> {
        let rows = self.levels[0].rows.len();
        let references =
            [&self.reference.values, &self.reference.by_ratios].map(|all| &all[..rows]);
        let mut combinations: Vec<Vec<usize>> = vec![Vec::new()];
        for levels in &self.of_knob {
            let of_knob = if levels.is_empty() { &[0][..] } else { levels };
            combinations = combinations
                .iter()
                .flat_map(|before| {
                    of_knob.iter().map(move |&level| {
                        let mut longer = before.clone();
                        longer.push(level);
                        longer
                    })
                })
                .collect();
        }
        let mut proposals: Vec<Proposal> = combinations
            .iter()
            .filter_map(|levels| self.proposal(levels, references))
            .collect();
        proposals.sort_by(|a, b| a.operations.total_cmp(&b.operations));
        proposals
    }

    /// The combination of `levels`, one of each knob.
    fn proposal(&self, levels: &[usize], references: [&[LadderValues]; 2]) -> Option<Proposal> {
        let base = &self.levels[0];
        let mut setting = base.setting.clone();
        for (knob, &level) in Knob::ALL.into_iter().zip(levels) {
            setting = setting.with(knob, &self.levels[level].setting);
        }
        if setting.is_redundant() {
            return None;
        }
        let predicted: Vec<LadderValues> = (0..base.rows.len())
            .map(|row| {
                let of_base = base.rows[row].values;
                levels.iter().fold(of_base, |product, &level| {
                    product.changed(&self.levels[level].rows[row].values, &of_base)
                })
            })
            .collect();
        let bound = |reference| error_bound(&predicted, reference, Compared::Amplitude);
        let operations: f64 = (0..base.rows.len())
            .map(|row| self.operations(levels, row))
            .sum();
        Some(Proposal {
            setting,
            predicted: [bound(references[0])?, bound(references[1])?],
            operations: operations / base.rows.len().max(1) as f64,
        })
    }

    /// Predicted operations of one row of a combination.
    fn operations(&self, levels: &[usize], row: usize) -> f64 {
        let base = &self.levels[0];
        let scenario = base.rows[row].scenario;
        let size_of = |knob: Knob| self.levels[levels[knob as usize]].sizes[scenario];
        let size = SystemSize {
            coordinates: size_of(Knob::Basis).coordinates,
            coefficients: size_of(Knob::Harmonics).coefficients,
            samples: size_of(Knob::SamplesPerPeriod).samples,
            law: size_of(Knob::ContactLaw).law,
            ..base.sizes[scenario]
        };
        let product = |count: fn(&RowWork) -> f64| {
            let of_base = count(&base.rows[row].work);
            levels.iter().fold(of_base, |product, &level| {
                let level = count(&self.levels[level].rows[row].work);
                if of_base > 0.0 {
                    product * level / of_base
                } else {
                    product.max(level)
                }
            })
        };
        size.operations(&RowWork {
            nonlinear_solves: product(|work| work.nonlinear_solves),
            newton_iterations: product(|work| work.newton_iterations),
            factorisations: product(|work| work.factorisations),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::reference::{LadderEnds, ReferenceKind};
    use super::*;
    use crate::study::{Study, load_sector_model, pattern_source};

    #[test]
    fn what_knobs_do_together_is_no_error_of_their_best_levels() {
        let file = "studies/lumped24.toml";
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
        let study = Study::read(&path).expect("a study");
        let sector = load_sector_model(&study).expect("a sector");
        let patterns = pattern_source(&study, &sector).expect("patterns");
        let mut bench = LadderBench::new(&study, &sector, vec![0], &()).expect("a bench");
        let ends = LadderEnds::choose(&mut bench, 0.002).expect("two ends");
        let engine = bench.engine(&ends.base).expect("an engine");
        let rows = engine.rows(&patterns, &[0]);
        let base = Measured::new(ends.base.clone(), None, &engine, rows);
        let times = |factor: f64| {
            let mut scaled = base.clone();
            for row in &mut scaled.rows {
                row.values.amplitude_m = row
                    .values
                    .amplitude_m
                    .map(|amplitude_m| factor * amplitude_m);
            }
            scaled
        };
        let part = |knob, factor| Measured {
            knob: Some(knob),
            ..times(factor)
        };
        let reference = LadderReference {
            kind: ReferenceKind::Joint,
            // Together they do not do what they do one by one.
            values: times(1.05).values(),
            by_ratios: times(0.98 * 1.03).values(),
            parts: vec![part(Knob::Basis, 0.98), part(Knob::Harmonics, 1.03)],
            base: base.clone(),
            product_error: None,
        };
        let search = LadderSearch::new(&mut bench, &patterns, &reference);
        let [best] = &search.proposals()[..] else {
            panic!("one level of each knob")
        };
        let [beside_reference, beside_ratios] = best.predicted.map(|bound| bound.worst);
        let together = 1.0 - 0.98 * 1.03 / 1.05;
        assert!(
            (beside_reference - together).abs() < 1e-12,
            "{beside_reference:e}"
        );
        assert!(beside_ratios < 1e-12, "{beside_ratios:e}");
        let error = search.error_of(&base).expect("an error");
        assert!(
            (error.worst - 0.05 / 1.05).abs() < 1e-12,
            "{:e}",
            error.worst
        );
    }
}
