//! Choice of the harmonics of each scenario by the tuned wheel, on one sector.

use std::sync::Arc;

use crate::model::ReducedModel;
use crate::population::monte_carlo::{HarmonicChoice, RowSettings, RowSolver};
use crate::response::forced_response::{ContactCondition, Screening};
use crate::response::harmonic_balance::Status;
use crate::study::PipelineError;

/// Relative tolerance of the peaks at which harmonics are judged.
const PEAK_TOLERANCE: f64 = 1e-4;
/// Harmonics added at most, one at a time.
const LARGEST_GROWTH: usize = 15;
/// Sets tried at most in place of one with which the tuned peak is not found.
const SETS_TRIED: usize = 4;
/// Harmonics added to 0 and 2 where these alone have no tuned peak.
const FURTHER_WITH_SEPARATION: [&[u32]; 3] = [&[3], &[3, 4], &[3, 4, 5]];

/// Harmonic set of every engine order and nonlinear condition: `first`, enlarged until the tuned
/// peak of `model` (the full contact model) leaves out at most `tolerance`, by one harmonic at a
/// time, that of the largest effect; then less those that the later ones made dispensable, from the
/// last one added. No harmonic left out may have a larger effect by itself either: on the tuned wheel
/// effects can cancel that do not cancel on a mistuned one. Without a tolerance the set stays, and its
/// remainder is measured.
///
/// A set with which the tuned peak is not found has no amplification factors: another is taken in its
/// place, with the harmonic of the next smaller effect, or with more than 0 and 2 where contacts
/// separate. If none of a few has a peak, the set before them stays, and says by its remainder what it
/// leaves out; only a wheel that separates then has 0 and 2, and a tuned peak with a status.
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

/// The choices with the harmonics that separation needs, and the remainder of each such set; with more
/// of them, as in [`choose_harmonics`], where the tuned peak is not found with these alone.
///
/// # Errors
/// If the samples per period cannot tell the harmonics apart.
pub fn with_separation(
    model: &Arc<ReducedModel>,
    settings: &RowSettings,
    choices: Vec<HarmonicChoice>,
) -> Result<Vec<HarmonicChoice>, PipelineError> {
    let admitted = choices.into_iter().map(|choice| {
        if choice.admits_separation() {
            return Ok(choice);
        }
        let tuned = TunedWheel {
            model,
            settings,
            engine_order: choice.engine_order,
            contact: choice.contact,
        };
        let sets = separating_sets(&choice);
        let smallest = sets[0].clone();
        match tuned.first_with_a_peak(sets)? {
            Some((choice, _)) => Ok(choice),
            None => Ok(tuned.judged(smallest)?.0),
        }
    });
    admitted.collect()
}

/// Sets with the harmonics that separation needs, the smallest first.
fn separating_sets(choice: &HarmonicChoice) -> Vec<HarmonicChoice> {
    let mut least = choice.clone();
    least.admit_separation();
    let more = FURTHER_WITH_SEPARATION.map(|further| {
        let mut set = least.clone();
        set.harmonics.extend(further);
        set.harmonics.sort_unstable();
        set.harmonics.dedup();
        set
    });
    let mut sets = vec![least];
    for set in more {
        if !sets.contains(&set) {
            sets.push(set);
        }
    }
    sets
}

/// The tuned wheel whose peak judges a set.
struct TunedWheel<'a> {
    model: &'a Arc<ReducedModel>,
    settings: &'a RowSettings,
    engine_order: u32,
    contact: ContactCondition,
}

/// What the tuned peak with a harmonic set says of the set.
struct Verdict {
    /// Whether the tuned peak was found.
    has_peak: bool,
    /// Whether contacts separate and the set lacks what they need.
    lacks_separation: bool,
    /// None where there is no peak, or it cannot be screened.
    screening: Option<Screening>,
}

impl Verdict {
    /// The harmonics left out with their effects, the largest first.
    fn effects(&self) -> Vec<(u32, f64)> {
        let mut effects: Vec<(u32, f64)> = self
            .screening
            .iter()
            .flat_map(|screening| &screening.effects)
            .map(|&(harmonic, effect)| (harmonic, effect.abs()))
            .filter(|(_, effect)| effect.is_finite())
            .collect();
        effects.sort_by(|a, b| b.1.total_cmp(&a.1).then(b.0.cmp(&a.0)));
        effects
    }

    /// Whether the set leaves out at most `tolerance`, together and by every single harmonic.
    fn within(&self, tolerance: f64) -> bool {
        let together = self.screening.as_ref().map(remainder);
        !self.lacks_separation
            && together.is_some_and(|together| together <= tolerance)
            && self
                .effects()
                .iter()
                .all(|(_, effect)| *effect <= tolerance)
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
            sampling: None,
            reduced_model: None,
        }
    }

    /// The set with its remainder, and what else its peak says.
    fn judged(
        &self,
        mut choice: HarmonicChoice,
    ) -> Result<(HarmonicChoice, Verdict), PipelineError> {
        let mut settings = self.settings.clone();
        settings.harmonics.clone_from(&choice.harmonics);
        let as_delivered = RowSolver::new(Arc::clone(self.model), settings.clone())?;
        settings.solver.peak_tolerance = PEAK_TOLERANCE;
        let solver = RowSolver::new(Arc::clone(self.model), settings)?;
        let (peak, screening) = solver.tuned_screening(self.engine_order, self.contact);
        let separated = peak
            .point
            .as_ref()
            .is_some_and(|point| point.shares.separated > 0.0);
        choice.remainder = screening.as_ref().map(remainder);
        // Where contacts open, the search of the study may end otherwise than the finer one here.
        let is_delivered = || {
            let found = as_delivered.tuned_peak(self.engine_order, self.contact);
            found.status == Status::Ok
        };
        let verdict = Verdict {
            has_peak: peak.status == Status::Ok && (!separated || is_delivered()),
            lacks_separation: separated && !choice.admits_separation(),
            screening,
        };
        Ok((choice, verdict))
    }

    /// The first of the sets with which the tuned peak is found, among the first few of them.
    fn first_with_a_peak(
        &self,
        sets: Vec<HarmonicChoice>,
    ) -> Result<Option<(HarmonicChoice, Verdict)>, PipelineError> {
        for set in sets.into_iter().take(SETS_TRIED) {
            let (set, verdict) = self.judged(set)?;
            if verdict.has_peak {
                return Ok(Some((set, verdict)));
            }
        }
        Ok(None)
    }

    /// The sets that may follow on one that leaves out too much, the most wanted first.
    fn larger(choice: &HarmonicChoice, verdict: &Verdict) -> Vec<HarmonicChoice> {
        if verdict.lacks_separation || !verdict.has_peak {
            return separating_sets(choice);
        }
        let with = |(harmonic, _): (u32, f64)| {
            let mut set = choice.clone();
            set.harmonics.push(harmonic);
            set.harmonics.sort_unstable();
            set
        };
        verdict.effects().into_iter().map(with).collect()
    }

    /// `first`, enlarged and then pruned.
    fn chosen(&self, first: &[u32], tolerance: f64) -> Result<HarmonicChoice, PipelineError> {
        let mut added: Vec<u32> = Vec::new();
        let (mut choice, mut verdict) = self.judged(self.choice(first))?;
        for _ in 0..LARGEST_GROWTH {
            if verdict.within(tolerance) {
                break;
            }
            let sets = Self::larger(&choice, &verdict);
            let Some((set, next)) = self.first_with_a_peak(sets)? else {
                if verdict.lacks_separation {
                    // Better no reference than rows that separate without what they need.
                    choice.admit_separation();
                    (choice, verdict) = self.judged(choice)?;
                }
                break;
            };
            if !verdict.lacks_separation && verdict.has_peak {
                let new = set.harmonics.iter();
                added.extend(new.filter(|&k| !choice.harmonics.contains(k)));
            }
            (choice, verdict) = (set, next);
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
