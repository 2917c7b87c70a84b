//! The response of one pattern over frequency.

use super::traced_curve::TracedCurve;
use super::{
    Engine, EngineSource, MistuningSource, PipelineError, Study, load_sector_model, pattern_source,
};
use crate::population::monte_carlo::Scenario;
use crate::population::table::CurvePoint;
use crate::response::forced_response::ContactCondition;
use crate::response::mistuning::Pattern;

/// Which curve is wanted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurveRequest<'a> {
    /// Pattern id; none for the tuned wheel.
    pub pattern: Option<u32>,
    /// Contact condition; it need not be in the sweep of the study.
    pub contact: ContactCondition,
    /// Engine order.
    pub engine_order: u32,
    /// Standard deviation of the pattern; none for the tuned wheel or patterns from a file.
    pub standard_deviation: Option<f64>,
    /// Frequencies, Hz.
    pub frequencies_hz: &'a [f64],
}

/// Amplitude of every blade at each frequency, ordered by frequency, then blade.
///
/// # Errors
/// The model is refused or cannot be reduced, or the study has no such pattern.
pub fn response_curve(
    study: &Study,
    source: &dyn EngineSource,
    request: CurveRequest<'_>,
) -> Result<Vec<CurvePoint>, PipelineError> {
    let asked = asked_for(study, source, request)?;
    let pattern = asked.pattern.as_ref();
    let engine = asked.engine;
    Ok(engine.curve(&asked.scenario, pattern, request.frequencies_hz))
}

/// The curve followed by continuation upwards and downwards, and what the two make of each other.
///
/// # Errors
/// The model is refused or cannot be reduced, or the study has no such pattern.
pub fn traced_response(
    study: &Study,
    source: &dyn EngineSource,
    request: CurveRequest<'_>,
) -> Result<TracedCurve, PipelineError> {
    let asked = asked_for(study, source, request)?;
    let pattern = asked.pattern.as_ref();
    let engine = asked.engine;
    let traces = engine.traces(&asked.scenario, pattern, request.frequencies_hz);
    Ok(TracedCurve::of(&traces, request.frequencies_hz))
}

/// A request with the model built and the pattern found.
struct Asked {
    engine: Box<dyn Engine>,
    scenario: Scenario,
    pattern: Option<Pattern>,
}

fn asked_for(
    study: &Study,
    source: &dyn EngineSource,
    request: CurveRequest<'_>,
) -> Result<Asked, PipelineError> {
    let model = load_sector_model(study)?;
    if request.contact != ContactCondition::Free {
        let reason = match (&study.contact, model.contact_pairs.is_empty()) {
            (_, true) => Some("the model has no contact"),
            (None, false) => Some("the study has no [contact]"),
            (Some(_), false) => None,
        };
        if let Some(reason) = reason {
            return Err(PipelineError::NoContact { reason });
        }
    }
    let patterns = pattern_source(study, model.sectors)?;
    let pattern = match request.pattern {
        None => None,
        Some(id) => Some(
            patterns
                .pattern(id, request.standard_deviation)
                .ok_or_else(|| PipelineError::NoPattern {
                    id,
                    accepted: ids_in_words(study, &patterns.ids()),
                })?,
        ),
    };
    let engine = source.build(study, &model, None)?;
    let scenario = Scenario {
        index: 0,
        engine_order: request.engine_order,
        standard_deviation: request.standard_deviation,
        contact: request.contact,
    };
    Ok(Asked {
        engine,
        scenario,
        pattern,
    })
}

fn ids_in_words(study: &Study, ids: &[u32]) -> String {
    match (&study.mistuning.source, ids) {
        (MistuningSource::File { written, .. }, [first, .., last]) => {
            format!("an id of {written}, {first} to {last}")
        }
        (_, [first, .., last]) => format!("{first} to {last}"),
        (_, [only]) => only.to_string(),
        (_, []) => "no other".to_owned(),
    }
}
