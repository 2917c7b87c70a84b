//! One delivered row integrated in time beside its harmonic balance.

use super::VerifyRequest;
use crate::campaign::store::StoredStudy;
use crate::population::monte_carlo::{ResponseRow, Scenario};
use crate::population::statistics::draw;
use crate::report::TimeDomainReport;
use crate::response::forced_response::ContactCondition;
use crate::response::friction::Ring;
use crate::response::harmonic_balance::Status;
use crate::settings::{EngineSource, Progress, Stage};
use crate::study::PipelineError;
use crate::verification::time_integration::TimeOptions;

/// Which row is to be integrated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TimeDomainRequest {
    /// Scenario index and pattern id; none = the first row of the sample under friction.
    pub row: Option<(usize, u32)>,
    /// The sample, and the number of threads.
    pub sample: VerifyRequest,
}

/// Solves the point of one delivered row by time integration.
///
/// # Errors
/// There is no such row, or it cannot be integrated; a table cannot be read, or the model not be
/// reduced. A difference is no error, nor is a motion that is not periodic: the report says so.
pub fn verify_in_time(
    stored: &StoredStudy,
    source: &dyn EngineSource,
    request: TimeDomainRequest,
    progress: &dyn Progress,
) -> Result<TimeDomainReport, PipelineError> {
    let ring = stored.study.contact.as_ref().map(|contact| contact.ring);
    if ring == Some(Ring::Creeping) {
        return Err(PipelineError::NoTimeDomain {
            reason: "a creeping ring is not integrated in time; accepted: a study with contact.ring = \"locked\"",
        });
    }
    let (scenario, row) = row_of(stored, request)?;
    request.sample.pool()?.install(|| {
        progress.stage(Stage::LoadModel);
        let model = stored.model()?;
        let pattern = model
            .pattern(row.pattern, &scenario)
            .ok_or_else(|| no_row(stored, row.scenario, row.pattern))?;
        progress.stage(Stage::Reduce);
        let engine = stored.engine(&model, source)?;
        progress.begin_rows(1, 0);
        let found = engine.compare_in_time(&pattern, &scenario, &row, &TimeOptions::default());
        progress.row(
            found
                .as_ref()
                .map_or_else(|status| *status, |found| found.status),
        );
        let (name, digest) = (&stored.manifest.name, &stored.manifest.study_digest);
        Ok(TimeDomainReport::new(name, digest, &scenario, &row, &found))
    })
}

/// The row asked for, or the first of the sample, with its scenario.
fn row_of(
    stored: &StoredStudy,
    request: TimeDomainRequest,
) -> Result<(Scenario, ResponseRow), PipelineError> {
    let with_scenario = |row: ResponseRow| {
        let (scenario, _) = stored
            .scenario(row.scenario)
            .ok_or_else(|| no_row(stored, row.scenario, row.pattern))?;
        Ok::<_, PipelineError>((scenario, row))
    };
    if let Some((scenario, pattern)) = request.row {
        let row = stored
            .row(scenario, pattern)?
            .ok_or_else(|| no_row(stored, scenario, pattern))?;
        let (scenario, row) = with_scenario(row)?;
        if is_marchable(&scenario, &row) {
            return Ok((scenario, row));
        }
        return Err(PipelineError::NoTimeDomain {
            reason: "this row has no peak under friction; accepted: a row with status ok and a normal load in N",
        });
    }
    let seed = request.sample.seed.unwrap_or(stored.manifest.seed);
    let places = draw(stored.row_count()?, request.sample.sample, seed);
    for row in stored.rows_at(&places)? {
        let (scenario, row) = with_scenario(row)?;
        if is_marchable(&scenario, &row) {
            return Ok((scenario, row));
        }
    }
    Err(PipelineError::NoTimeDomain {
        reason: "no row of the sample has a peak under friction; accepted: a larger --sample, or --scenario and --pattern",
    })
}

fn is_marchable(scenario: &Scenario, row: &ResponseRow) -> bool {
    row.status == Status::Ok && matches!(scenario.contact, ContactCondition::Full { .. })
}

fn no_row(stored: &StoredStudy, scenario: usize, pattern: u32) -> PipelineError {
    PipelineError::NoRow {
        scenario,
        pattern,
        scenarios: stored.manifest.scenarios.len(),
    }
}
