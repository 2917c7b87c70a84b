//! The engine of a study on tuned receptances: its fixed-interface modes, and what its blade shapes leave out.

use std::sync::Arc;

use super::basis_choice::{BasisError, BasisEvidence};
use super::fixed_interface::{FixedInterface, ModesTried, expected_deviation, reduction_with};
use super::harmonics_on_receptances::{JudgedTop, Judges};
use crate::model::ReducedModel;
use crate::model::reduction::{BasisChoice, Reduction};
use crate::model::sector::{ModelError, SectorModel, StiffnessKind};
use crate::population::monte_carlo::{HarmonicChoice, TUNED_RECEPTANCES};
use crate::response::forced_response::{
    ContactCondition, EngineRow, FrequencyBand, PointSettings, Window, receptance_peak,
};
use crate::response::harmonic_balance::TransformError;
use crate::response::mistuning::{Distribution, Pattern, PatternSource};
use crate::response::receptance::{
    EngineModel, EngineOptions, EngineWheel, Limit, ReceptanceEngine, WaveForce,
};
use crate::study::{Excitation, PipelineError, Study};

/// Standard deviations that a blade deviates by at most, for the choice of its shapes.
const LARGEST: f64 = 3.0;
/// Wheels by which the shapes are judged.
const WHEELS: u32 = 4;
/// Seed of their deviations.
const SEED: u64 = 0x0062_6c69_736b;
/// Factor on the number of shapes beyond which none are added.
const MOST_SHAPES: usize = 16;
/// Relative tolerance of their peaks.
const PEAK_TOLERANCE: f64 = 1e-5;
/// Fixed-interface modes per nodal diameter that are tried first.
const FIRST_MODES: usize = 60;
/// Modes from which on none are added without being asked for.
const MOST_MODES: usize = 320;
/// Error of as many modes as the study says, over what twice as many change.
const FIXED_MARGIN: f64 = 1.5;
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

/// An engine with what it was made of.
pub(super) struct Made {
    pub(super) own: EngineModel,
    pub(super) receptances: Arc<ReceptanceEngine>,
}

impl Made {
    fn new(
        study: &Study,
        reduction: &Reduction<'_>,
        excitations: &[Excitation],
        shape_factor: usize,
    ) -> Result<Self, PipelineError> {
        let modes = study.mistuning.cantilever_mode_count;
        let model = reduction.reduce(BasisChoice::CraigBampton, modes)?;
        let options = engine_options(study, excitations, &model);
        let own = EngineModel::new(&model, &options).ok_or_else(no_modes)?;
        let own = own.with_shape_factor(shape_factor);
        let receptances = engine_of(&own, &options)?;
        Ok(Self { own, receptances })
    }

    /// This engine with `shape_factor` times as many blade shapes as an engine has at least.
    fn with_shape_factor(
        &self,
        study: &Study,
        excitations: &[Excitation],
        shape_factor: usize,
    ) -> Result<Self, PipelineError> {
        let own = self.own.clone().with_shape_factor(shape_factor);
        let receptances = engine_of(&own, &engine_options(study, excitations, &own.model))?;
        Ok(Self { own, receptances })
    }

    /// The wheels that judge, under each force vector.
    pub(super) fn judges(
        &self,
        excitations: &[Excitation],
        patterns: &[Pattern],
    ) -> Vec<Judges<'_>> {
        let under = |case| Judges::new(&self.receptances, &self.own.model, case, patterns);
        excitations.iter().map(under).collect()
    }
}

/// Fixed-interface modes and harmonics of a study on tuned receptances.
pub(super) struct Refined<'a> {
    pub(super) reduction: Reduction<'a>,
    pub(super) engine: Made,
    pub(super) fixed_interface: FixedInterface,
    /// Evidence of the blade shapes.
    pub(super) evidence: BasisEvidence,
    /// Harmonic choices under each force vector.
    pub(super) harmonics: Vec<Vec<HarmonicChoice>>,
}

/// As many fixed-interface modes as the study says, or the first of 60, 120, ... that half as many change no judged peak by more than
/// `reduction.error`; their error is that change, which is larger than what is left of it, or a half more than what twice as many as the
/// study says change. Blade shapes the first that twice as many change no judged peak by more, with friction among them: the shapes
/// of the harmonics above the first show there alone. Harmonics by `chosen`, once.
///
/// # Errors
/// The model cannot be reduced, or samples cannot tell harmonics apart.
pub(super) fn refined<'a>(
    study: &Study,
    sector: &'a SectorModel,
    excitations: &[Excitation],
    patterns: &[Pattern],
    chosen: impl Fn(&Judges<'_>) -> Result<Vec<HarmonicChoice>, TransformError>,
) -> Result<Refined<'a>, PipelineError> {
    let fixed = study.reduction.craig_bampton_modes;
    let mut modes = fixed.map_or(FIRST_MODES, |own| 2 * own);
    let mut harmonics: Option<Vec<Vec<HarmonicChoice>>> = None;
    let mut tried = Vec::new();
    let mut shape_factor = 1;
    loop {
        let fine = reduction_with(study, sector, modes)
            .with_residual_vectors()
            .completed()?;
        let coarse = fine.with_fewer_modes(modes / 2);
        let whole = fine.is_whole_space();
        let (taken, other) = match fixed {
            Some(_) if !whole => (coarse, Some(fine)),
            _ => (fine, (!whole).then_some(coarse)),
        };
        let engine = Made::new(study, &taken, excitations, shape_factor)?;
        let shaped = Shaped::new(study, engine, excitations, shape_factor)?;
        shape_factor = shaped.factor;
        let own = shaped.engine.judges(excitations, patterns);
        let sets = match harmonics.take() {
            Some(sets) => sets,
            None => own.iter().map(&chosen).collect::<Result<_, _>>()?,
        };
        let tops = if other.is_none() && shaped.finer.is_none() {
            Vec::new()
        } else {
            judged_tops(&own, &study.contacts, &sets)?
        };
        drop(own);
        let change = match &other {
            None => Some(0.0),
            Some(other) => {
                let other = Made::new(study, other, excitations, shape_factor)?;
                change_of(&tops, &other.judges(excitations, patterns))
            }
        };
        tried.push(ModesTried {
            modes: taken.fixed_interface_modes(),
            change,
        });
        let enough = change.is_none_or(|change| change <= study.reduction.error);
        if !enough && fixed.is_none() && modes < MOST_MODES {
            harmonics = Some(sets);
            modes *= 2;
            continue;
        }
        let of_shapes = shaped.change(&tops, excitations, patterns);
        let mut shaped = shaped.with_change(of_shapes);
        while shaped.lacks_shapes(study) {
            shaped = shaped.with_twice_the_shapes(study, excitations)?;
            let own = shaped.engine.judges(excitations, patterns);
            let tops = judged_tops(&own, &study.contacts, &sets)?;
            drop(own);
            let of_shapes = shaped.change(&tops, excitations, patterns);
            shaped = shaped.with_change(of_shapes);
        }
        let margin = if fixed.is_some() { FIXED_MARGIN } else { 1.0 };
        return Ok(Refined {
            fixed_interface: FixedInterface {
                modes: taken.fixed_interface_modes(),
                error: change.map(|change| margin * change),
                tried,
            },
            reduction: taken,
            engine: shaped.engine,
            evidence: BasisEvidence {
                whole_space: false,
                craig_bampton_reach: None,
                tried: shaped.tried,
            },
            harmonics: sets,
        });
    }
}

/// The tops of the wheels that judge, under each force vector.
fn judged_tops(
    own: &[Judges<'_>],
    conditions: &[ContactCondition],
    sets: &[Vec<HarmonicChoice>],
) -> Result<Vec<Vec<JudgedTop>>, TransformError> {
    let judges = own.iter().zip(sets);
    judges
        .map(|(own, sets)| own.judged_tops(conditions, sets))
        .collect()
}

/// Largest relative change of `tops` to the tops of the same wheels on another engine; none where no top is found on both.
fn change_of(tops: &[Vec<JudgedTop>], others: &[Judges<'_>]) -> Option<f64> {
    let cases = tops.iter().zip(others);
    let changes = cases.filter_map(|(tops, other)| other.change(tops));
    changes.reduce(f64::max)
}

/// An engine with enough blade shapes for linear peaks, and one with twice as many.
struct Shaped {
    engine: Made,
    /// None where no shape is left out.
    finer: Option<Made>,
    factor: usize,
    /// What was tried, the engine last.
    tried: Vec<BasisError>,
}

impl Shaped {
    /// With `factor` or the first of twice, four times ... as many shapes that twice as many again change no linear peak by more than
    /// `reduction.error`.
    fn new(
        study: &Study,
        engine: Made,
        excitations: &[Excitation],
        factor: usize,
    ) -> Result<Self, PipelineError> {
        let tried = Vec::new();
        let mut own = Self::judged(study, engine, excitations, factor, tried)?;
        while own.lacks_shapes(study) {
            own = own.with_twice_the_shapes(study, excitations)?;
        }
        Ok(own)
    }

    /// `engine` of so many shapes, with what twice as many change of linear peaks.
    fn judged(
        study: &Study,
        engine: Made,
        excitations: &[Excitation],
        factor: usize,
        mut tried: Vec<BasisError>,
    ) -> Result<Self, PipelineError> {
        let exact = engine.receptances.is_exact();
        let finer = (!exact).then(|| engine.with_shape_factor(study, excitations, 2 * factor));
        let finer = finer.transpose()?;
        let error = match &finer {
            None => Some(0.0),
            Some(finer) => linear_change(study, &engine, finer, excitations)?,
        };
        tried.push(BasisError {
            basis: TUNED_RECEPTANCES.to_owned(),
            vectors: engine.receptances.shape_count(Limit::Stuck, 1),
            error,
        });
        Ok(Self {
            engine,
            finer,
            factor,
            tried,
        })
    }

    fn with_twice_the_shapes(
        self,
        study: &Study,
        excitations: &[Excitation],
    ) -> Result<Self, PipelineError> {
        match self.finer {
            None => Ok(self),
            Some(finer) => Self::judged(study, finer, excitations, 2 * self.factor, self.tried),
        }
    }

    /// Whether twice as many change a peak by more than `reduction.error`, and may be taken.
    fn lacks_shapes(&self, study: &Study) -> bool {
        let error = self.tried.last().and_then(|taken| taken.error);
        let enough = error.is_some_and(|error| error <= study.reduction.error);
        !enough && self.finer.is_some() && self.factor < MOST_SHAPES
    }

    /// What twice as many change of `tops`, which are those of this engine.
    fn change(
        &self,
        tops: &[Vec<JudgedTop>],
        excitations: &[Excitation],
        patterns: &[Pattern],
    ) -> Option<f64> {
        let finer = self.finer.as_ref()?.judges(excitations, patterns);
        change_of(tops, &finer)
    }

    /// These shapes with a stated error of at least `change`, the change of the tops by twice as many shapes.
    fn with_change(mut self, change: Option<f64>) -> Self {
        if let Some(taken) = self.tried.last_mut() {
            taken.error = taken.error.map(|own| own.max(change.unwrap_or(0.0)));
        }
        self
    }
}

/// Largest relative change of the stuck and sliding peaks of some mistuned wheels from one engine to another; none where a peak
/// is not found.
fn linear_change(
    study: &Study,
    own: &Made,
    finer: &Made,
    excitations: &[Excitation],
) -> Result<Option<f64>, PipelineError> {
    let engines = [&own.receptances, &finer.receptances];
    let source = PatternSource::Random {
        seed: SEED,
        count: WHEELS,
        sectors: own.receptances.sectors(),
        distribution: Distribution::Normal,
    };
    let sigma = expected_deviation(study);
    let patterns = (0..WHEELS).filter_map(|id| source.pattern(id, Some(sigma)));
    let patterns: Vec<Pattern> = patterns.collect();
    let mut error = Some(0.0_f64);
    let points = linear_points(study, &own.own.model)?;
    let window = Window {
        resonances_hz: None,
        band: study.solver.frequency_band,
    };
    for force in &engine_options(study, excitations, &own.own.model).forces {
        for condition in [ContactCondition::Stuck, ContactCondition::Slide] {
            for pattern in &patterns {
                let peaks = engines.map(|engine| {
                    let wheel = EngineWheel::new(Some(pattern), engine.sectors());
                    let row = EngineRow {
                        engine,
                        wheel: &wheel,
                        force,
                        condition,
                    };
                    let found = receptance_peak(&row, &points, None, window, PEAK_TOLERANCE);
                    found.peak.amplitude_m()
                });
                error = match (error, peaks) {
                    (Some(error), [Some(a), Some(b)]) => Some(error.max((a / b - 1.0).abs())),
                    _ => None,
                };
            }
        }
    }
    Ok(error)
}

/// Settings of the points of linear limits.
fn linear_points(study: &Study, model: &ReducedModel) -> Result<PointSettings, TransformError> {
    PointSettings::new(&study.solver, &[1], None, model.contact.clone())
}
