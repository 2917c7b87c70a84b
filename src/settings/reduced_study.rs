//! What a study is solved on: its reduced models, and its harmonics, all up to 15 on tuned receptances where it says none.

use std::path::Path;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::basis_choice::{
    BasisEvidence, Judged, choose_basis_under, judged_conditions, judged_variations,
};
use super::fixed_interface::{
    FixedInterface, expected_deviation, reduce_sector, sensitivity_vectors,
};
use super::harmonics_on_basis::{choose_harmonics, with_separation};
use super::harmonics_on_receptances::{JudgingWheels, choice_of};
use super::progress::Progress;
use super::receptances_of_basis::on_receptances_of_basis;
use super::row_settings::{contact_stiffness, row_settings};
use super::tuned_receptances::{COMPANION_MODES, Refined, engine_options, no_modes, refined};
use crate::identity::bytes_of;
use crate::model::cyclic::pair_tangents;
use crate::model::reduction::{Basis, BasisChoice, Reduction};
use crate::model::sector::SectorModel;
use crate::model::{ReducedModel, read_cached, reduction_digest, write_cached};
use crate::population::monte_carlo::{
    HarmonicChoice, LoadCaseSolver, LoadCaseSolvers, RowSettings, RowSolver,
};
use crate::response::forced_response::{FEWER_HARMONICS, Harmonics, RowsBeyondTolerance};
use crate::response::friction::ContactLaw;
use crate::response::harmonic_balance::EnlargedSet;
use crate::response::receptance::{EngineModel, ReceptanceEngine};
use crate::study::{Excitation, PipelineError, Study, excitations, judging_patterns, solver_under};

/// Share of the harmonic tolerance by which the set for rows beyond it is chosen.
const BEYOND_TOLERANCE: f64 = 0.25;

/// What the cache keeps.
#[derive(Clone, Serialize, Deserialize)]
pub(super) struct Stored {
    pub(super) model: ReducedModel,
    pub(super) evidence: BasisEvidence,
    pub(super) fixed_interface: FixedInterface,
    harmonics: Vec<HarmonicChoice>,
    beyond: Option<StoredBeyond>,
    /// What the model leaves out of peaks under linear limits, on tuned receptances; none where that is not known.
    pub(super) of_limits: Option<f64>,
    /// What rows are solved on in the place of a basis, where the study asks for it.
    engine: Option<EngineModel>,
    /// The engine itself, where it was made a moment ago.
    #[serde(skip)]
    receptances: Option<Arc<ReceptanceEngine>>,
}

impl Stored {
    /// Whether rows are solved on tuned receptances.
    pub(super) fn is_on_receptances(&self) -> bool {
        self.engine.is_some()
    }

    /// Copy of what the cache keeps, with `harmonics` in every scenario and, on tuned receptances, twice as many blade shapes.
    pub(super) fn enlarged(&self, harmonics: &[u32]) -> Self {
        let enlarged = |choice: &HarmonicChoice| HarmonicChoice {
            harmonics: harmonics.to_vec(),
            remainder: None,
            sampling: None,
            ..choice.clone()
        };
        let engine = self.engine.clone();
        Self {
            harmonics: self.harmonics.iter().map(enlarged).collect(),
            beyond: None,
            engine: engine.map(EngineModel::with_twice_the_shapes),
            receptances: None,
            ..self.clone()
        }
    }

    /// Whether sectors, contact and harmonic sets are as many as `study` and `sector` have.
    pub(super) fn fits(&self, study: &Study, sector: &SectorModel) -> bool {
        let orders: usize = study.excited_orders().iter().map(|case| case.1.len()).sum();
        let nonlinear = study.contacts.iter();
        let loads = nonlinear
            .filter(|contact| contact.normal_load_n().is_some())
            .count();
        let beyond = self.beyond.as_ref();
        let models = [Some(&self.model), beyond.map(|beyond| &beyond.model)];
        let further = beyond.iter().flat_map(|beyond| &beyond.harmonics);
        let mut sets = std::iter::once(&self.harmonics).chain(further);
        self.model.contact.weights.len() == sector.contact_pairs.len()
            && models
                .into_iter()
                .flatten()
                .all(|model| model.sectors == sector.sectors)
            && sets.all(|sets| sets.len() == orders * loads)
    }
}

/// The model and harmonic sets for rows that those of [`Stored`] are not good enough for.
#[derive(Clone, Serialize, Deserialize)]
pub(super) struct StoredBeyond {
    model: ReducedModel,
    basis_error: f64,
    /// What is tried one after the other, with a set for every case each.
    harmonics: Vec<Vec<HarmonicChoice>>,
}

/// Harmonic sets under one force vector.
type Sets = Vec<HarmonicChoice>;

/// One force vector of a study, and the full contact model under it.
struct Case<'a> {
    excitation: &'a Excitation,
    settings: RowSettings,
    full: Arc<ReducedModel>,
}

impl<'a> Case<'a> {
    fn new(excitation: &'a Excitation, full: &ReducedModel) -> Self {
        Self {
            settings: row_settings(&excitation.study),
            full: Arc::new(excitation.of(full)),
            excitation,
        }
    }

    fn sets(&self, tolerance: Option<f64>) -> Result<Sets, PipelineError> {
        let study = &self.excitation.study;
        choose_harmonics(
            &self.full,
            &self.settings,
            &study.engine_orders,
            &study.contacts,
            &self.settings.harmonics,
            tolerance,
        )
    }
}

/// What rows of `study` are solved on: from `cache` if it is there, else made, and kept there.
///
/// # Errors
/// The model cannot be reduced, or the cache not be written.
pub(super) fn stored_for(
    study: &Study,
    model: &SectorModel,
    cache: Option<&Path>,
    progress: &dyn Progress,
) -> Result<Stored, PipelineError> {
    let digest = stored_digest(study, model)?;
    let cached: Option<Stored> = cache.and_then(|folder| read_cached(folder, &digest));
    if let Some(stored) = cached.filter(|stored| stored.fits(study, model)) {
        return Ok(stored);
    }
    let stored = if is_on_receptances(study, model) {
        reduced_on_receptances(study, model, progress)?
    } else {
        progress.step("fixed-interface modes of the sector");
        let (reduction, fixed_interface) = reduce_sector(study, model)?;
        progress.step("harmonics and basis of the reduced model");
        reduced(study, &reduction, fixed_interface)?
    };
    if let Some(folder) = cache {
        write_cached(folder, &digest, &stored)?;
    }
    Ok(stored)
}

/// Digest of everything that the stored models and sets of a study depend on: also of what their errors are judged by.
///
/// # Errors
/// The file of patterns does not fit to the wheel.
pub(super) fn stored_digest(study: &Study, model: &SectorModel) -> Result<String, PipelineError> {
    let settings = row_settings(study);
    let stiffness = contact_stiffness(study.contact.as_ref());
    let sensitivity = sensitivity_vectors(study);
    let judged_by = if is_on_receptances(study, model) {
        let patterns = judging_patterns(study, model)?;
        Some((
            study.mistuning.projection,
            expected_deviation(study),
            patterns,
        ))
    } else {
        None
    };
    let key = (
        (
            &study.reduction,
            study.mistuning.cantilever_mode_count,
            stiffness,
            sensitivity,
        ),
        (
            &study.engine_orders,
            &study.contacts,
            &study.contact_variations,
        ),
        (
            &study.nodal_diameter_damping,
            &study.amplitudes_n,
            &study.load_cases,
        ),
        (settings, judged_by),
    );
    Ok(reduction_digest(model, &key))
}

/// Whether rows are solved on the receptances of the tuned wheel: where the study names them, and by default wherever they are ready for
/// what it asks.
pub(super) fn is_on_receptances(study: &Study, sector: &SectorModel) -> bool {
    // A law of constant normal load acts along the tangents alone.
    let rubs = |tangents: [bool; 2]| tangents.contains(&true);
    let can_rub = || pair_tangents(sector).into_iter().any(rubs);
    let ready = || {
        let contact = study.contact.as_ref();
        !sector.contact_pairs.is_empty()
            && contact.is_none_or(|contact| contact.law.has_variable_load() || can_rub())
    };
    match study.reduction.basis {
        Basis::TunedReceptances => true,
        Basis::Auto | Basis::StickAttachment => ready(),
        Basis::StickSlide => false,
    }
}

/// Harmonics, basis and reduced model of a study, and those for rows beyond them: harmonics by
/// the full contact model, then the basis that carries these harmonics.
fn reduced(
    study: &Study,
    reduction: &Reduction<'_>,
    fixed_interface: FixedInterface,
) -> Result<Stored, PipelineError> {
    let automatic = study.solver.harmonics == Harmonics::Auto;
    let tolerance = automatic.then_some(study.solver.harmonic_tolerance);
    let full = reduction.reduce(BasisChoice::CraigBampton, None)?;
    let excitations = excitations(study);
    let cases: Vec<Case<'_>> = excitations
        .iter()
        .map(|excitation| Case::new(excitation, &full))
        .collect();
    let sets = |tolerance| -> Result<Vec<Sets>, PipelineError> {
        cases.iter().map(|case| case.sets(tolerance)).collect()
    };
    let conditions = judged_conditions(&study.contacts);
    let varied = judged_variations(&study.contact_variations);
    let basis = |sets: &[Sets]| {
        let judged: Vec<_> = cases
            .iter()
            .zip(sets)
            .map(|(case, sets)| {
                let judged = Judged {
                    settings: &case.settings,
                    engine_orders: &case.excitation.study.engine_orders,
                    conditions: &conditions,
                    sets,
                    varied: &varied,
                };
                (case.excitation, judged)
            })
            .collect();
        choose_basis_under(reduction, &study.reduction, &judged)
    };
    let modes = study.mistuning.cantilever_mode_count;
    let harmonics = sets(tolerance)?;
    let resolves = automatic && study.solver.rows_beyond_tolerance == RowsBeyondTolerance::Resolve;
    let separates = study
        .contact
        .as_ref()
        .is_some_and(|contact| contact.law.has_variable_load());
    let (choice, evidence) = basis(&harmonics)?;
    let beyond = if study.has_friction() && ((separates && automatic) || resolves) {
        let mut harmonics = if resolves {
            let larger = tolerance.map(|tolerance| BEYOND_TOLERANCE * tolerance);
            sets(larger)?
        } else {
            harmonics.clone()
        };
        if automatic && separates {
            harmonics = admitting_separation(&cases, harmonics)?;
        }
        let (choice, evidence) = basis(&harmonics)?;
        Some(StoredBeyond {
            model: reduction.reduce(choice, modes)?,
            basis_error: basis_error(&evidence),
            harmonics: vec![harmonics.concat()],
        })
    } else {
        None
    };
    Ok(Stored {
        model: reduction.reduce(choice, modes)?,
        evidence,
        fixed_interface,
        harmonics: harmonics.concat(),
        beyond,
        of_limits: None,
        engine: None,
        receptances: None,
    })
}

/// The sets with the harmonics that separation needs.
fn admitting_separation(cases: &[Case<'_>], sets: Vec<Sets>) -> Result<Vec<Sets>, PipelineError> {
    let sets = cases.iter().zip(sets);
    sets.map(|(case, sets)| with_separation(&case.full, &case.settings, sets))
        .collect()
}

/// What rows on tuned receptances are solved on: fixed-interface modes by the tuned wheel and some mistuned ones, all harmonics up to
/// 15 or those of the study, and a small companion model besides, for what is not solved there.
fn reduced_on_receptances(
    study: &Study,
    sector: &SectorModel,
    progress: &dyn Progress,
) -> Result<Stored, PipelineError> {
    let excitations = excitations(study);
    let wheels = JudgingWheels {
        patterns: &judging_patterns(study, sector)?,
        progress,
    };
    let law = study.contact.as_ref().map(|contact| contact.law);
    let separates = law.is_some_and(ContactLaw::has_variable_load);
    let sets = match &study.solver.harmonics {
        Harmonics::Auto => {
            let everything = EnlargedSet::everything(separates);
            let up_to = |highest: u32| -> Vec<u32> {
                let harmonics = everything.iter().copied();
                harmonics.filter(|&k| k <= highest).collect()
            };
            let fewer: Vec<Vec<u32>> = FEWER_HARMONICS.map(up_to).into();
            [vec![everything], fewer].concat()
        }
        Harmonics::Set(set) => vec![set.clone()],
    };
    let Refined {
        reduction,
        engine,
        fixed_interface,
        evidence,
        harmonics,
        of_limits,
    } = refined((study, sector), &excitations, wheels, |judges| {
        judges.harmonics(&study.contacts, &sets)
    })?;
    let harmonics = harmonics.concat();
    let of_fewer = |set: &Vec<u32>| -> Sets {
        let choices = harmonics.iter();
        let case = |choice: &HarmonicChoice| HarmonicChoice {
            reduced_model: choice.reduced_model,
            ..choice_of((choice.engine_order, choice.contact), set)
        };
        choices.map(case).collect()
    };
    let has_fewer = study.has_friction() && sets.len() > 1;
    let modes = study.mistuning.cantilever_mode_count;
    let choice = if reduction.is_whole_space() {
        BasisChoice::CraigBampton
    } else {
        BasisChoice::StickSlide {
            stick: COMPANION_MODES,
            slide: COMPANION_MODES,
        }
    };
    let model = reduction.reduce(choice, modes)?;
    Ok(Stored {
        beyond: has_fewer.then(|| StoredBeyond {
            model: model.clone(),
            basis_error: basis_error(&evidence),
            harmonics: sets[1..].iter().map(of_fewer).collect(),
        }),
        model,
        evidence,
        fixed_interface,
        harmonics,
        of_limits,
        engine: Some(engine.own),
        receptances: Some(engine.receptances),
    })
}

/// Measured error of the basis that was taken; 0 where nothing was left out.
fn basis_error(evidence: &BasisEvidence) -> f64 {
    evidence
        .tried
        .last()
        .map_or(0.0, |tried| tried.error.unwrap_or(f64::INFINITY))
}

/// The solver of the study; with load cases that of the first, which knows those of the others.
///
/// # Errors
/// If the samples per period cannot tell the harmonics apart, or modes are not found.
pub(super) fn solver_of(study: &Study, stored: &Stored) -> Result<LoadCaseSolvers, PipelineError> {
    // Either part is measured on its own: what the basis leaves out of the Craig-Bampton model, and
    // what that model leaves out of the sector.
    let truncation = stored.fixed_interface.error.unwrap_or(f64::INFINITY);
    // On tuned receptances every choice has the error under its load.
    let error = match stored.of_limits.filter(|_| truncation.is_finite()) {
        Some(of_limits) => of_limits,
        None => basis_error(&stored.evidence) + truncation,
    };
    let inexact = study.solver.rows_beyond_tolerance == RowsBeyondTolerance::Resolve;
    let nonlinear = study
        .contacts
        .iter()
        .filter(|contact| contact.normal_load_n().is_some());
    let loads = nonlinear.count();
    let mut first = 0;
    let excitations = excitations(study);
    let engine = stored.engine.as_ref().map(|engine_model| {
        let made = stored.receptances.clone().map(Ok);
        let engine = made.unwrap_or_else(|| {
            let options = engine_options(study, &excitations, &engine_model.model);
            let engine = ReceptanceEngine::new(engine_model, &options);
            engine.map(Arc::new).ok_or_else(no_modes)
        });
        Ok::<_, PipelineError>((engine_model, engine?))
    });
    let engine = engine.transpose()?;
    solver_under(&excitations, |case| {
        // The sets of a case stand together.
        let sets = first..first + loads * case.study.engine_orders.len();
        first = sets.end;
        let settings = row_settings(&case.study);
        let solver = RowSolver::new(Arc::new(case.of(&stored.model)), settings.clone())?
            .with_choices(stored.harmonics[sets.clone()].to_vec(), error)?;
        let on_engine = |solver: RowSolver, model: &ReducedModel| match &engine {
            Some((engine_model, engine)) => {
                let orders = &case.study.engine_orders;
                let model = case.of(&engine_model.model);
                Ok(solver.with_engine(Arc::clone(engine), &model, orders)?)
            }
            None => on_receptances_of_basis(solver, case, model),
        };
        let mut solver = LoadCaseSolver::from(on_engine(solver, &stored.model)?);
        let Some(beyond) = &stored.beyond else {
            return Ok(solver);
        };
        let model = Arc::new(case.of(&beyond.model));
        for harmonics in &beyond.harmonics {
            let other = RowSolver::new(Arc::clone(&model), settings.clone())?.with_choices(
                harmonics[sets.clone()].to_vec(),
                beyond.basis_error + truncation,
            )?;
            solver = solver.with_fallback(on_engine(other, &beyond.model)?, inexact);
        }
        Ok(solver)
    })
}

/// Digest of all that the rows of `study` are made from besides their harmonics: the reduced models, what the receptances are
/// made for, and the errors that all rows state. On tuned receptances errors are those of a load or of the linear limits, and not here.
pub(super) fn models_digest(study: &Study, stored: &Stored) -> String {
    let mut hasher = blake3::Hasher::new();
    let mut add_model = |model: &ReducedModel, error: f64| {
        hasher.update(&bytes_of(model));
        if !stored.is_on_receptances() {
            hasher.update(&error.to_bits().to_le_bytes());
        }
    };
    add_model(&stored.model, basis_error(&stored.evidence));
    if let Some(beyond) = &stored.beyond {
        add_model(&beyond.model, beyond.basis_error);
    }
    if let Some(engine) = &stored.engine {
        hasher.update(&bytes_of(engine));
    }
    let engine = stored.engine.as_ref();
    let model = engine.map_or(&stored.model, |engine| &engine.model);
    let options = engine_options(study, &excitations(study), model);
    hasher.update(&options.bytes());
    hasher.finalize().to_hex().to_string()
}
