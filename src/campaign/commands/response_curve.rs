//! The response of one pattern over frequency.

use super::TracedCurve;
use crate::model::sector::SectorModel;
use crate::population::monte_carlo::{CurveSettings, LoadCaseName, Scenario};
use crate::population::table::CurvePoint;
use crate::response::forced_response::ContactCondition;
use crate::response::mistuning::Pattern;
use crate::settings::{EngineSource, FullModel, FullSettings};
use crate::study::{MistuningSource, PipelineError, Study, load_sector_model, pattern_source};

/// Which curve is wanted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurveRequest<'a> {
    /// Pattern id; none for the tuned wheel.
    pub pattern: Option<u32>,
    /// Contact condition; it need not be in the sweep of the study.
    pub contact: ContactCondition,
    /// Load case; none in a study without.
    pub load_case: Option<LoadCaseName>,
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
/// The model is refused or cannot be reduced, model or study lack the contact that is asked for, or
/// the study has no such pattern.
pub fn response_curve(
    study: &Study,
    source: &dyn EngineSource,
    request: CurveRequest<'_>,
) -> Result<Vec<CurvePoint>, PipelineError> {
    let wanted = Wanted::of(study, request)?;
    let engine = source.build(study, &wanted.sector, None)?;
    let pattern = wanted.pattern.as_ref();
    Ok(engine.curve(
        &wanted.scenario,
        pattern,
        request.frequencies_hz,
        CurveSettings::default(),
    ))
}

/// The response of one pattern followed by continuation over frequency, upwards and downwards, and
/// what the two traces make of each other.
///
/// # Errors
/// The model is refused or cannot be reduced, model or study lack the contact that is asked for, or
/// the study has no such pattern.
pub fn traced_response(
    study: &Study,
    source: &dyn EngineSource,
    request: CurveRequest<'_>,
) -> Result<TracedCurve, PipelineError> {
    let wanted = Wanted::of(study, request)?;
    let engine = source.build(study, &wanted.sector, None)?;
    let pattern = wanted.pattern.as_ref();
    let traces = engine.traces(&wanted.scenario, pattern, request.frequencies_hz);
    Ok(TracedCurve::of(&traces, request.frequencies_hz))
}

/// Amplitude of every blade, m, at each frequency on the full-contact model, ordered by frequency,
/// then blade.
///
/// # Errors
/// The model is refused or cannot be reduced, model or study lack the contact that is asked for,
/// the study has no such pattern, or the samples per period cannot tell the harmonics apart.
pub fn full_response_curve(
    study: &Study,
    settings: &FullSettings,
    request: CurveRequest<'_>,
) -> Result<Vec<CurvePoint>, PipelineError> {
    let wanted = Wanted::of(study, request)?;
    let full = FullModel::build(study, &wanted.sector, settings)?;
    let harmonics = full.harmonics(&wanted.scenario)?;
    let settings = full.settings(&harmonics)?;
    Ok(full.curve(
        &wanted.scenario,
        wanted.pattern.as_ref(),
        &settings,
        request.frequencies_hz,
    ))
}

/// What a curve is of: it exists in the study.
struct Wanted {
    sector: SectorModel,
    pattern: Option<Pattern>,
    scenario: Scenario,
}

impl Wanted {
    fn of(study: &Study, request: CurveRequest<'_>) -> Result<Self, PipelineError> {
        let sector = load_sector_model(study)?;
        if request.contact != ContactCondition::Free {
            let reason = match (&study.contact, sector.contact_pairs.is_empty()) {
                (_, true) => Some("the model has no contact"),
                (None, false) => Some("the study has no [contact]"),
                (Some(_), false) => None,
            };
            if let Some(reason) = reason {
                return Err(PipelineError::NoContact { reason });
            }
        }
        let patterns = pattern_source(study, &sector)?;
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
        Ok(Self {
            sector,
            pattern,
            scenario: Scenario {
                index: 0,
                load_case: request.load_case,
                engine_order: request.engine_order,
                standard_deviation: request.standard_deviation,
                contact: request.contact,
            },
        })
    }
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
