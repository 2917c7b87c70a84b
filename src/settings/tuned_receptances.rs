//! The engine of a study on tuned receptances: its fixed-interface modes, and what its blade shapes leave out.

use std::sync::Arc;

use super::basis_choice::{BasisError, BasisEvidence};
use super::fixed_interface::{FixedInterface, ModesTried, expected_deviation, reduction_with};
use super::harmonics_on_receptances::{JudgedSet, JudgedTop, Judges, JudgingWheels, TopOf};
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
/// Largest change of a judged peak by twice as many shapes, over `reduction.error`, under loads between the lowest, the middle and the
/// highest one, which keep that. The shapes of the harmonics above the first make rows slow, and every row states what they leave out
/// under its load.
pub(crate) const SHAPES_BETWEEN: f64 = 5.0;
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
        let model = reduction.reduce_large(BasisChoice::CraigBampton, modes)?;
        let options = engine_options(study, excitations, &model);
        let made = ReceptanceEngine::of_model(model, &options, shape_factor);
        let (own, engine) = made.ok_or_else(no_modes)?;
        let receptances = Arc::new(engine);
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
        let options = engine_options(study, excitations, &own.model);
        let engine = self.receptances.with_shapes_of(&own, &options);
        let receptances = Arc::new(engine.ok_or_else(no_modes)?);
        Ok(Self { own, receptances })
    }

    /// The wheels that judge, under each force vector.
    pub(super) fn judges<'a>(
        &'a self,
        excitations: &[Excitation],
        wheels: JudgingWheels<'a>,
    ) -> Vec<Judges<'a>> {
        let under = |case| Judges::new(&self.receptances, &self.own.model, case, wheels);
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
    /// What the model leaves out of peaks under linear limits; none where that is not known.
    pub(super) of_limits: Option<f64>,
}

/// As many fixed-interface modes as the study says, or the first of 60, 120, ... that half as many change no judged peak by more than
/// `reduction.error`; their error is that change, which is larger than what is left of it, or a half more than what twice as many as the
/// study says change. Blade shapes the first that twice as many change no linear peak by more, and none with friction by more than
/// that, or [`SHAPES_BETWEEN`] times that under loads between: the shapes of the harmonics above the first show there alone. Harmonics by `chosen`, once.
///
/// # Errors
/// The model cannot be reduced, or samples cannot tell harmonics apart.
pub(super) fn refined<'a>(
    (study, sector): (&Study, &'a SectorModel),
    excitations: &[Excitation],
    wheels: JudgingWheels<'_>,
    chosen: impl for<'j> Fn(&'j Judges<'_>) -> Result<Vec<JudgedSet<'j>>, TransformError>,
) -> Result<Refined<'a>, PipelineError> {
    let fixed = study.reduction.craig_bampton_modes;
    let mut modes = fixed.map_or(FIRST_MODES, |modes| 2 * modes);
    let mut harmonics: Option<Vec<Vec<HarmonicChoice>>> = None;
    let mut tried = Vec::new();
    let mut shape_factor = 1;
    loop {
        let step = format!("receptances of the tuned wheel with {modes} fixed-interface modes");
        wheels.progress.step(&step);
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
        let judges = shaped.engine.judges(excitations, wheels);
        let is_exact = other.is_none() && shaped.finer.is_none();
        let (mut sets, tops) = match harmonics.take() {
            None => sets_and_tops(&judges, study, !is_exact, |of_case, _| chosen(of_case))?,
            Some(sets) if is_exact => (sets, Vec::new()),
            Some(sets) => sets_and_tops(&judges, study, true, |of_case, case| {
                of_case.with_sets(sets[case].clone())
            })?,
        };
        drop(judges);
        let mut of_modes = Vec::new();
        let change = match &other {
            None => Some(0.0),
            Some(other) => {
                let other = Made::new(study, other, excitations, shape_factor)?;
                of_modes = changes_of(&tops, &other.judges(excitations, wheels));
                largest(&of_modes)
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
        let mut of_shapes = shaped.changes(&tops, excitations, wheels);
        let mut shaped = shaped.with_change(of_friction(&of_shapes, &study.contacts));
        while shaped.lacks_shapes(study) {
            shaped = shaped.with_twice_the_shapes(study, excitations)?;
            let judges = shaped.engine.judges(excitations, wheels);
            let (_, tops) = sets_and_tops(&judges, study, true, |of_case, case| {
                of_case.with_sets(sets[case].clone())
            })?;
            drop(judges);
            of_shapes = shaped.changes(&tops, excitations, wheels);
            shaped = shaped.with_change(of_friction(&of_shapes, &study.contacts));
        }
        let margin = if fixed.is_some() { FIXED_MARGIN } else { 1.0 };
        let errors = ModelErrors {
            linear: shaped.linear.filter(|_| change.is_some()),
            shapes: &of_shapes,
            modes: &of_modes,
            margin,
        };
        for (case, sets) in sets.iter_mut().enumerate() {
            for set in sets {
                set.reduced_model = errors.under(case, (set.engine_order, set.contact));
            }
        }
        let of_limits = errors.of_limits();
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
            of_limits,
        });
    }
}

/// Sets of harmonics, and the tops of the wheels that judge with them, under each force vector.
type SetsAndTops = (Vec<Vec<HarmonicChoice>>, Vec<Vec<JudgedTop>>);

/// The sets of harmonics under each force vector, and the tops of the wheels that judge with them, where these are asked for.
fn sets_and_tops<'j>(
    judges: &'j [Judges<'_>],
    study: &Study,
    with_tops: bool,
    judged: impl Fn(&'j Judges<'_>, usize) -> Result<Vec<JudgedSet<'j>>, TransformError>,
) -> Result<SetsAndTops, TransformError> {
    let (mut sets, mut tops) = (Vec::new(), Vec::new());
    for (case, of_case) in judges.iter().enumerate() {
        let judged = judged(of_case, case)?;
        if with_tops {
            tops.push(of_case.judged_tops(&study.contacts, &judged)?);
        }
        sets.push(judged.into_iter().map(|set| set.choice).collect());
    }
    Ok((sets, tops))
}

/// A relative change of a top, by force vector, engine order and condition.
type Change = ((usize, TopOf), f64);

/// Relative changes of `tops` to the tops of the same wheels on another engine, of those that are found on both.
fn changes_of(tops: &[Vec<JudgedTop>], others: &[Judges<'_>]) -> Vec<Change> {
    let cases = tops.iter().zip(others).enumerate();
    let changes = cases.flat_map(|(case, (tops, other))| {
        let changes = other.changes(tops).into_iter();
        changes.map(move |(of, change)| ((case, of), change))
    });
    changes.collect()
}

/// The largest of the changes with friction: under the lowest, the middle and the highest load, and under those between.
fn of_friction(changes: &[Change], conditions: &[ContactCondition]) -> [f64; 2] {
    let loads = conditions.iter().map(|condition| condition.normal_load_n());
    let mut loads: Vec<f64> = loads.flatten().collect();
    loads.sort_by(f64::total_cmp);
    let places = [0, loads.len() / 2, loads.len().saturating_sub(1)];
    let spread = places.map(|place| loads.get(place).copied());
    [true, false].map(|wanted| {
        let wanted_changes = { changes.iter() }.filter(|((_, (_, condition)), _)| {
            let load = condition.normal_load_n();
            load.is_some() && spread.contains(&load) == wanted
        });
        wanted_changes.map(|change| change.1).fold(0.0, f64::max)
    })
}

/// The largest of some changes; none of none.
fn largest(changes: &[Change]) -> Option<f64> {
    changes.iter().map(|change| change.1).reduce(f64::max)
}

/// What the reduced model leaves out, by its blade shapes and by its fixed-interface modes.
struct ModelErrors<'a> {
    /// Of linear peaks, by the shapes; none where that of the modes is not known.
    linear: Option<f64>,
    shapes: &'a [Change],
    modes: &'a [Change],
    /// On the changes by the modes.
    margin: f64,
}

impl ModelErrors<'_> {
    /// Under one engine order and condition, so that it does not depend on the other loads of a study; where no top is known there, the
    /// largest of all.
    fn under(&self, case: usize, of: TopOf) -> Option<f64> {
        let here = |change: &Change| change.0 == (case, of);
        self.of(here)
    }

    /// Under the linear limits.
    fn of_limits(&self) -> Option<f64> {
        self.of(|(of, _)| of.1.1.normal_load_n().is_none())
    }

    fn of(&self, is_meant: impl Fn(&Change) -> bool) -> Option<f64> {
        let largest_of = |all: &[Change]| -> f64 {
            let meant = all.iter().filter(|change| is_meant(change));
            let meant: Vec<Change> = meant.copied().collect();
            largest(&meant).or(largest(all)).unwrap_or(0.0)
        };
        let shapes = self.linear?.max(largest_of(self.shapes));
        Some(shapes + self.margin * largest_of(self.modes))
    }
}

/// An engine with enough blade shapes for linear peaks, and one with twice as many.
struct Shaped {
    engine: Made,
    /// None where no shape is left out.
    finer: Option<Made>,
    factor: usize,
    /// What twice as many change of linear peaks; none where one is not found.
    linear: Option<f64>,
    /// What twice as many change of judged peaks with friction, as it counts for the choice.
    with_friction: f64,
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
        let mut shaped = Self::judged(study, engine, excitations, factor, tried)?;
        while shaped.lacks_shapes(study) {
            shaped = shaped.with_twice_the_shapes(study, excitations)?;
        }
        Ok(shaped)
    }

    /// `engine` of so many shapes, with what twice as many change of linear peaks.
    fn judged(
        study: &Study,
        engine: Made,
        excitations: &[Excitation],
        factor: usize,
        mut tried: Vec<BasisError>,
    ) -> Result<Self, PipelineError> {
        let is_whole = engine.receptances.acts_on_cantilever_modes();
        let finer = (!is_whole).then(|| engine.with_shape_factor(study, excitations, 2 * factor));
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
            linear: error,
            with_friction: 0.0,
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
        let wanted = study.reduction.error;
        let enough =
            self.linear.is_some_and(|error| error <= wanted) && self.with_friction <= wanted;
        !enough && self.finer.is_some() && self.factor < MOST_SHAPES
    }

    /// What twice as many change of `tops`, which are those of this engine.
    fn changes(
        &self,
        tops: &[Vec<JudgedTop>],
        excitations: &[Excitation],
        wheels: JudgingWheels<'_>,
    ) -> Vec<Change> {
        let finer = self.finer.as_ref();
        finer.map_or_else(Vec::new, |finer| {
            changes_of(tops, &finer.judges(excitations, wheels))
        })
    }

    /// These shapes with the changes of the tops with friction by twice as many shapes, under spread loads and under those between.
    fn with_change(mut self, [spread, between]: [f64; 2]) -> Self {
        self.with_friction = spread.max(between / SHAPES_BETWEEN);
        if let Some(taken) = self.tried.last_mut() {
            taken.error = taken.error.map(|error| error.max(spread).max(between));
        }
        self
    }
}

/// Largest relative change of the stuck and sliding peaks of some mistuned wheels from one engine to another; none where a peak
/// is not found.
fn linear_change(
    study: &Study,
    made: &Made,
    finer: &Made,
    excitations: &[Excitation],
) -> Result<Option<f64>, PipelineError> {
    let engines = [&made.receptances, &finer.receptances];
    let source = PatternSource::Random {
        seed: SEED,
        count: WHEELS,
        sectors: made.receptances.sectors(),
        distribution: Distribution::Normal,
    };
    let sigma = expected_deviation(study);
    let patterns = (0..WHEELS).filter_map(|id| source.pattern(id, Some(sigma)));
    let patterns: Vec<Pattern> = patterns.collect();
    let mut error = Some(0.0_f64);
    let points = linear_points(study, &made.own.model)?;
    let window = Window {
        resonances_hz: None,
        band: study.solver.frequency_band,
    };
    for force in &engine_options(study, excitations, &made.own.model).forces {
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

#[cfg(test)]
mod tests;
