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
/// time, that of the largest effect. No harmonic left out may have a larger effect by itself either:
/// on the tuned wheel effects can cancel that do not cancel on a mistuned one. Without a tolerance the
/// set stays, and its remainder is measured.
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
            let mut choice = HarmonicChoice {
                engine_order,
                contact,
                harmonics: first.to_vec(),
                remainder: None,
            };
            for _ in 0..=LARGEST_GROWTH {
                let settled = judge(model, settings, &mut choice, tolerance)?;
                if settled {
                    break;
                }
            }
            choices.push(choice);
        }
    }
    Ok(choices)
}

/// Measures the remainder of a choice, and enlarges its set where that is above the tolerance;
/// true if the set stays as it is.
fn judge(
    model: &Arc<ReducedModel>,
    settings: &RowSettings,
    choice: &mut HarmonicChoice,
    tolerance: Option<f64>,
) -> Result<bool, PipelineError> {
    let mut settings = settings.clone();
    settings.harmonics.clone_from(&choice.harmonics);
    settings.solver.peak_tolerance = PEAK_TOLERANCE;
    let solver = RowSolver::new(Arc::clone(model), settings)?;
    let (peak, screening) = solver.tuned_screening(choice.engine_order, choice.contact);
    let separated = peak
        .point
        .as_ref()
        .is_some_and(|point| point.shares.separated > 0.0);
    let remainder =
        |screening: &Screening| screening.errors.harmonics.abs() + screening.errors.unsettled;
    choice.remainder = screening.as_ref().map(remainder);
    let Some(tolerance) = tolerance else {
        return Ok(true);
    };
    if separated && !choice.admits_separation() {
        choice.admit_separation();
        return Ok(false);
    }
    let Some(screening) = screening else {
        return Ok(true);
    };
    let largest = screening
        .effects
        .iter()
        .filter(|(_, effect)| effect.is_finite())
        .max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
    let Some(&(harmonic, effect)) = largest else {
        return Ok(true);
    };
    if remainder(&screening) <= tolerance && effect.abs() <= tolerance {
        return Ok(true);
    }
    choice.harmonics.push(harmonic);
    choice.harmonics.sort_unstable();
    Ok(false)
}
