//! The engine of a study on tuned receptances, and what its blade shapes leave out.

use std::sync::Arc;

use super::PipelineError;
use super::Study;
use super::basis_choice::{BasisError, BasisEvidence};
use super::fixed_interface::expected_deviation;
use super::load_cases::Excitation;
use crate::model::ReducedModel;
use crate::model::sector::{ModelError, StiffnessKind};
use crate::response::forced_response::{
    ContactCondition, EngineRow, FrequencyBand, PointSettings, Window, receptance_peak,
};
use crate::response::harmonic_balance::TransformError;
use crate::response::mistuning::{Distribution, Pattern, PatternSource};
use crate::response::receptance::{
    EngineModel, EngineOptions, EngineWheel, Limit, ReceptanceEngine, WaveForce,
};

/// Standard deviations that a blade deviates by at most, for the choice of its shapes.
const LARGEST: f64 = 3.0;
/// Wheels by which the shapes are judged.
const WHEELS: u32 = 4;
/// Seed of their deviations.
const SEED: u64 = 0x0062_6c69_736b;
/// Relative tolerance of their peaks.
const PEAK_TOLERANCE: f64 = 1e-5;
/// Modes of the companion model of each kind.
pub(super) const COMPANION_MODES: usize = 4;

/// What the engine of a study is made for.
pub(super) fn engine_options(
    study: &Study,
    excitations: &[Excitation],
    model: &ReducedModel,
) -> EngineOptions {
    let forces = excitations.iter().flat_map(|case| {
        let model = case.of(model);
        let amplitude_n = case.study.amplitude_n;
        let orders = case.study.engine_orders.clone().into_iter();
        orders.map(move |order| WaveForce::new(&model, order, amplitude_n))
    });
    EngineOptions {
        damping: study.damping,
        projection: study.mistuning.projection,
        forces: forces.collect(),
        deviation: LARGEST * expected_deviation(study),
        band_hz: match study.solver.frequency_band {
            FrequencyBand::Auto => None,
            FrequencyBand::Fixed { start_hz, stop_hz } => Some((start_hz, stop_hz)),
        },
        more_shapes: 1,
    }
}

/// The engine on `own`.
///
/// # Errors
/// The modes of a nodal diameter are not found.
pub(super) fn engine_of(
    own: &EngineModel,
    options: &EngineOptions,
) -> Result<Arc<ReceptanceEngine>, PipelineError> {
    let engine = ReceptanceEngine::new(own, options);
    Ok(Arc::new(engine.ok_or_else(no_modes)?))
}

/// A model whose modes are not found.
pub(super) fn no_modes() -> ModelError {
    ModelError::StiffnessNotPositiveDefinite {
        nodal_diameter: 0,
        what: StiffnessKind::Structure,
    }
}

/// Evidence for an engine: largest relative change of the stuck and sliding peaks of some mistuned wheels by twice the shapes.
///
/// # Errors
/// The modes of a nodal diameter are not found.
pub(super) fn shape_evidence(
    study: &Study,
    own: &EngineModel,
    options: &EngineOptions,
) -> Result<BasisEvidence, PipelineError> {
    let engine = engine_of(own, options)?;
    let more = EngineOptions {
        more_shapes: 2,
        ..options.clone()
    };
    let finer = engine_of(own, &more)?;
    let source = PatternSource::Random {
        seed: SEED,
        count: WHEELS,
        sectors: engine.sectors(),
        distribution: Distribution::Normal,
    };
    let sigma = expected_deviation(study);
    let patterns = (0..WHEELS).filter_map(|id| source.pattern(id, Some(sigma)));
    let patterns: Vec<Pattern> = patterns.collect();
    let mut error = Some(0.0_f64);
    let points = linear_points(study, &own.model)?;
    let window = Window {
        resonances_hz: None,
        band: study.solver.frequency_band,
    };
    for force in &options.forces {
        for condition in [ContactCondition::Stuck, ContactCondition::Slide] {
            for pattern in &patterns {
                let peaks = [&engine, &finer].map(|engine| {
                    let wheel = EngineWheel::new(Some(pattern), engine.sectors());
                    let row = EngineRow {
                        engine,
                        wheel: &wheel,
                        force,
                        condition,
                    };
                    receptance_peak(&row, &points, None, window, PEAK_TOLERANCE).amplitude_m()
                });
                error = match (error, peaks) {
                    (Some(error), [Some(a), Some(b)]) => Some(error.max((a / b - 1.0).abs())),
                    _ => None,
                };
            }
        }
    }
    let error = if engine.is_exact() { Some(0.0) } else { error };
    Ok(BasisEvidence {
        whole_space: false,
        craig_bampton_reach: None,
        tried: vec![BasisError {
            basis: "tuned_receptances".to_owned(),
            vectors: engine.shape_count(Limit::Stuck, 1),
            error,
            contact_displacement: None,
        }],
    })
}

/// Settings of the points of linear limits.
fn linear_points(study: &Study, model: &ReducedModel) -> Result<PointSettings, TransformError> {
    PointSettings::new(&study.solver, &[1], None, model.contact.clone())
}
