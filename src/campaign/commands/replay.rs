//! One delivered row solved again: on the same path, and on the full-contact model where asked for.

use serde::Serialize;

use crate::campaign::store::{StoredModel, StoredStudy};
use crate::identity::bytes_of;
use crate::population::monte_carlo::{ResponseRow, Scenario, TunedReference};
use crate::population::table::VerificationRecord;
use crate::response::mistuning::Pattern;
use crate::settings::{EngineSource, FullModel, FullRow, FullSettings};
use crate::study::PipelineError;
use crate::verification::reference::ReferencePeak;

/// Which row is to be solved again.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ReplayRequest {
    /// Scenario index.
    pub scenario: usize,
    /// Pattern id.
    pub pattern: u32,
    /// Settings on the full-contact model; none = on the same path only.
    pub full: Option<FullSettings>,
}

/// A delivered row and the same row solved again.
#[derive(Debug, Clone, PartialEq)]
pub struct Replay {
    /// Keys.
    pub scenario: Scenario,
    /// The row as delivered.
    pub delivered: ResponseRow,
    /// The row solved again on the same path.
    pub replayed: ResponseRow,
    /// Whether both, and their tuned references, agree bit for bit.
    pub identical: bool,
    /// Peaks of the row and of the tuned wheel on the full-contact model, where asked for, and the
    /// harmonic set there.
    pub full: Option<(ReferencePeak, ReferencePeak, Vec<u32>)>,
}

impl Replay {
    /// Errors of the delivered row against the full-contact model, where it was asked for.
    #[must_use]
    pub fn record(&self) -> Option<VerificationRecord> {
        let (reference, tuned_reference, _) = self.full.as_ref()?;
        Some(VerificationRecord {
            scenario: self.scenario,
            delivered: self.delivered.clone(),
            replay_identical: self.identical,
            reference: *reference,
            tuned_reference: *tuned_reference,
        })
    }
}

/// Solves one delivered row again.
///
/// # Errors
/// There is no such row, or the model cannot be reduced.
pub fn replay(
    stored: &StoredStudy,
    source: &dyn EngineSource,
    request: &ReplayRequest,
) -> Result<Replay, PipelineError> {
    let scenarios = stored.manifest.scenarios.len();
    let no_row = || PipelineError::NoRow {
        scenario: request.scenario,
        pattern: request.pattern,
        scenarios,
    };
    let (scenario, tuned) = stored.scenario(request.scenario).ok_or_else(no_row)?;
    let delivered = stored
        .row(request.scenario, request.pattern)?
        .ok_or_else(no_row)?;
    let model = stored.model()?;
    let pattern = model
        .pattern(request.pattern, &scenario)
        .ok_or_else(no_row)?;
    let engine = stored.engine(&model, source)?;
    let tuned_again = engine.tuned(&scenario);
    let replayed = engine
        .rows(&pattern, &[(&scenario, &tuned_again)])
        .remove(0);
    let full = match &request.full {
        None => None,
        Some(settings) => Some(full_peaks(
            stored, &model, &scenario, &pattern, &delivered, &tuned, settings,
        )?),
    };
    Ok(Replay {
        identical: same_bits(&replayed, &delivered) && same_bits(&tuned_again, &tuned),
        scenario,
        delivered,
        replayed,
        full,
    })
}

fn full_peaks(
    stored: &StoredStudy,
    model: &StoredModel,
    scenario: &Scenario,
    pattern: &Pattern,
    delivered: &ResponseRow,
    tuned: &TunedReference,
    settings: &FullSettings,
) -> Result<(ReferencePeak, ReferencePeak, Vec<u32>), PipelineError> {
    let full = FullModel::build(&stored.study, &model.sector, settings)?;
    let asked = settings.harmonics.clone();
    let harmonics = match asked.or_else(|| harmonics_of(&delivered.harmonics)) {
        Some(harmonics) => harmonics,
        None => full.harmonics(scenario)?,
    };
    let settings = full.settings(&harmonics)?;
    let row = FullRow {
        scenario,
        pattern: None,
        settings: &settings,
        tuned_hz: None,
        expected_hz: tuned.frequency_hz,
    };
    let tuned = full.peak(row);
    let reference = full.peak(FullRow {
        pattern: Some(pattern),
        tuned_hz: tuned.frequency_hz,
        expected_hz: delivered.peak_frequency_hz,
        ..row
    });
    Ok((reference, tuned, harmonics))
}

/// Whether two results agree in every bit: their printed forms name every field and hold as many
/// digits as it takes.
pub(super) fn same_bits<T: Serialize>(a: &T, b: &T) -> bool {
    bytes_of(a) == bytes_of(b)
}

/// The harmonic set of the column `harmonics`; none where it is empty.
pub(super) fn harmonics_of(column: &str) -> Option<Vec<u32>> {
    column.split('-').map(|k| k.parse().ok()).collect()
}
