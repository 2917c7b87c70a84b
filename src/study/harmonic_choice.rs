//! Choice of the harmonics of each scenario by the tuned wheel, on one sector.

use std::sync::Arc;

use super::PipelineError;
use crate::model::ReducedModel;
use crate::population::monte_carlo::{HarmonicChoice, RowSettings, RowSolver};
use crate::response::forced_response::{ContactCondition, Screening};

/// Relative tolerance of the peaks at which harmonics are judged.
const PEAK_TOLERANCE: f64 = 1e-4;
/// Harmonics added at most, one at a time.
const LARGEST_GROWTH: usize = 15;

/// Harmonic set of every engine order and nonlinear condition: `first`, enlarged until the tuned
/// peak of `model` (the full contact model) leaves out at most `tolerance`, by one harmonic at a
/// time, that of the largest effect; then less those that the later ones made dispensable, from the
/// last one added. No harmonic left out may have a larger effect by itself either: on the tuned wheel
/// effects can cancel that do not cancel on a mistuned one. Without a tolerance the set stays, and its
/// remainder is measured.
///
/// # Errors
/// If the samples per period cannot tell the harmonics apart.
pub fn choose_harmonics(
    model: &Arc<ReducedModel>,
    settings: &RowSettings,
    engine_orders: &[u32],
    conditions: &[ContactCondition],
    first: &[u32],
    tolerance: Option<f64>,
) -> Result<Vec<HarmonicChoice>, PipelineError> {
    let mut choices = Vec::new();
    for &engine_order in engine_orders {
        for &contact in conditions {
            if contact.normal_load_n().is_none() {
                continue;
            }
            let tuned = TunedWheel {
                model,
                settings,
                engine_order,
                contact,
            };
            choices.push(match tolerance {
                None => tuned.judged(tuned.choice(first))?.0,
                Some(tolerance) => tuned.chosen(first, tolerance)?,
            });
        }
    }
    Ok(choices)
}

/// The choices with the harmonics that separation needs, and the remainder of each such set.
///
/// # Errors
/// As [`choose_harmonics`].
pub fn with_separation(
    model: &Arc<ReducedModel>,
    settings: &RowSettings,
    choices: Vec<HarmonicChoice>,
) -> Result<Vec<HarmonicChoice>, PipelineError> {
    let admitted = choices.into_iter().map(|mut choice| {
        if choice.admits_separation() {
            return Ok(choice);
        }
        choice.admit_separation();
        let tuned = TunedWheel {
            model,
            settings,
            engine_order: choice.engine_order,
            contact: choice.contact,
        };
        Ok(tuned.judged(choice)?.0)
    });
    admitted.collect()
}

/// The tuned wheel whose peak judges a set.
struct TunedWheel<'a> {
    model: &'a Arc<ReducedModel>,
    settings: &'a RowSettings,
    engine_order: u32,
    contact: ContactCondition,
}

/// What the tuned peak of a set says of it.
struct Verdict {
    /// Whether contacts separate and the set lacks what they need.
    lacks_separation: bool,
    /// None where there is no peak, or it cannot be screened.
    screening: Option<Screening>,
}

impl Verdict {
    /// The harmonic left out that has the largest effect, with that effect.
    fn largest(&self) -> Option<(u32, f64)> {
        let effects = self.screening.iter().flat_map(|screening| {
            let sizes = screening.effects.iter();
            sizes.map(|&(harmonic, effect)| (harmonic, effect.abs()))
        });
        effects
            .filter(|(_, effect)| effect.is_finite())
            .max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Whether the set leaves out at most `tolerance`, together and by every single harmonic.
    fn within(&self, tolerance: f64) -> bool {
        let together = self.screening.as_ref().map(remainder);
        !self.lacks_separation
            && together.is_some_and(|together| together <= tolerance)
            && self.largest().is_none_or(|(_, effect)| effect <= tolerance)
    }
}

/// What the harmonics left out change the peak by, and what that estimate may be off by.
fn remainder(screening: &Screening) -> f64 {
    screening.errors.harmonics.abs() + screening.errors.unsettled
}

impl TunedWheel<'_> {
    /// A set not yet judged.
    fn choice(&self, harmonics: &[u32]) -> HarmonicChoice {
        HarmonicChoice {
            engine_order: self.engine_order,
            contact: self.contact,
            harmonics: harmonics.to_vec(),
            remainder: None,
        }
    }

    /// The set with its remainder, and what else its peak says.
    fn judged(
        &self,
        mut choice: HarmonicChoice,
    ) -> Result<(HarmonicChoice, Verdict), PipelineError> {
        let mut settings = self.settings.clone();
        settings.harmonics.clone_from(&choice.harmonics);
        settings.solver.peak_tolerance = PEAK_TOLERANCE;
        let solver = RowSolver::new(Arc::clone(self.model), settings)?;
        let (peak, screening) = solver.tuned_screening(self.engine_order, self.contact);
        let separated = peak
            .point
            .as_ref()
            .is_some_and(|point| point.shares.separated > 0.0);
        choice.remainder = screening.as_ref().map(remainder);
        let verdict = Verdict {
            lacks_separation: separated && !choice.admits_separation(),
            screening,
        };
        Ok((choice, verdict))
    }

    /// `first`, enlarged and then pruned.
    fn chosen(&self, first: &[u32], tolerance: f64) -> Result<HarmonicChoice, PipelineError> {
        let mut added = Vec::new();
        let (mut choice, mut verdict) = self.judged(self.choice(first))?;
        for _ in 0..LARGEST_GROWTH {
            if verdict.lacks_separation {
                choice.admit_separation();
            } else if let Some((harmonic, _)) =
                verdict.largest().filter(|_| !verdict.within(tolerance))
            {
                added.push(harmonic);
                choice.harmonics.push(harmonic);
                choice.harmonics.sort_unstable();
            } else {
                break;
            }
            (choice, verdict) = self.judged(choice)?;
        }
        if !verdict.within(tolerance) {
            return Ok(choice);
        }
        for &harmonic in added.iter().rev() {
            let mut fewer = choice.clone();
            fewer.harmonics.retain(|&k| k != harmonic);
            let (fewer, verdict) = self.judged(fewer)?;
            if verdict.within(tolerance) {
                choice = fewer;
            }
        }
        Ok(choice)
    }
}
