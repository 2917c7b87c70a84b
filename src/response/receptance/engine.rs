//! What the rows of a study share: the tuned wheel under each linear contact condition, its receptances and blade shapes.

use std::f64::consts::TAU;
use std::sync::{Arc, OnceLock};

use serde::{Deserialize, Serialize};

use crate::identity::bytes_of;
use crate::linalg::{Complex64, Matrix};
use crate::model::{BladeEnergy, ReducedModel};
use crate::response::harmonic_balance::Damping;
use crate::response::mistuning::{Deviations, Pattern, Projection};

use super::blade_shapes::{
    Participation, SHAPES_OF_ROUNDS, ShapesWanted, blade_shapes, in_cantilever_modes, in_shapes,
    strain_coordinates,
};
use super::fields::SectorTransform;
use super::linear_limits::LinearLimits;
use super::receptance_tables::Receptances;
use super::resonances::{BandModes, MistunedModes, Resonance, reach_of_mistuning};
use super::tuned_diameter::TunedDiameter;
use super::wave_force::WaveForce;

/// Blade shapes of harmonic 1, and of every other one.
const SHAPES: [usize; 2] = [3, 2];
/// Frequencies of the band at which the shapes of harmonic 1 are made, and of every other one.
const SHAPE_FREQUENCIES: [usize; 2] = [9, 5];
/// Relative margin of the band whose modes make the resonances of a limit.
const BAND_MARGIN: f64 = 0.1;

/// A Craig-Bampton model with every contact degree of freedom, its blade strain in few coordinates.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EngineModel {
    /// The model, without the strain energy of its blade.
    pub model: ReducedModel,
    /// Participation of the contact-free modes of nodal diameters 0..=N/2 in coordinates of the blade's strain.
    strain: Vec<Matrix<Complex64>>,
    /// Factor on the number of blade shapes.
    shape_factor: usize,
}

impl EngineModel {
    /// From a Craig-Bampton model and its limits, for the harmonics of the resonances that the excitations meet.
    fn new(
        model: ReducedModel,
        limits: &LinearLimits,
        options: &EngineOptions,
        shape_factor: usize,
    ) -> Self {
        let band = band(limits, options);
        let of_harmonic = |k: u32| (f64::from(k) * band.0, f64::from(k) * band.1);
        let bands: Vec<(f64, f64)> = (1..=HIGHEST_OF_SHAPES).map(of_harmonic).collect();
        let strain = if model.blade_energy.size() == 0 {
            Vec::new()
        } else {
            strain_coordinates(&model, limits.stuck(), &bands)
        };
        Self {
            model: ReducedModel {
                blade_energy: BladeEnergy::unknown(),
                ..model
            },
            strain,
            shape_factor,
        }
    }

    /// This model for an engine with `shape_factor` times as many blade shapes as an engine has at least.
    #[must_use]
    pub fn with_shape_factor(self, shape_factor: usize) -> Self {
        Self {
            shape_factor,
            ..self
        }
    }

    /// This model for an engine with twice as many blade shapes.
    #[must_use]
    pub fn with_twice_the_shapes(self) -> Self {
        let shape_factor = 2 * self.shape_factor;
        self.with_shape_factor(shape_factor)
    }
}

/// What an engine is made for.
#[derive(Debug, Clone)]
pub struct EngineOptions {
    /// Damping of the structure.
    pub damping: Damping,
    /// How deviations enter.
    pub projection: Projection,
    /// The excitations.
    pub forces: Vec<WaveForce>,
    /// Largest deviation of a blade that is expected.
    pub deviation: f64,
    /// The band that is asked for, Hz; none for that of the resonances.
    pub band_hz: Option<(f64, f64)>,
}

impl EngineOptions {
    /// What engines for two options differ by.
    #[must_use]
    pub fn bytes(&self) -> Vec<u8> {
        let Self {
            damping,
            projection,
            forces,
            deviation,
            band_hz,
        } = self;
        let forces: Vec<_> = forces.iter().map(WaveForce::parts).collect();
        bytes_of(&(damping, projection, forces, deviation, band_hz))
    }
}

/// Receptances of the tuned wheel, shared by all threads.
#[derive(Debug)]
pub struct ReceptanceEngine {
    pub(super) transform: SectorTransform,
    pub(super) loss_factor: f64,
    /// What engines with other numbers of blade shapes share with this one.
    limits: LinearLimits,
    /// Under stuck springs, under sliding ones, and without.
    tuned_wheels: [TunedWheel; 3],
}

/// The tuned wheel with one set of contact springs.
#[derive(Debug)]
pub(super) struct TunedWheel {
    pub(super) diameters: Arc<Vec<TunedDiameter>>,
    /// What takes part in all strain coordinates, or in exactly the cantilever modes.
    strain: Participation,
    in_cantilever_modes: bool,
    /// Motion times spring of the contact rows under the excitation, N.
    contact_forces: Vec<f64>,
    /// Frequencies of harmonic 1, rad/s.
    band: (f64, f64),
    forces: Vec<WaveForce>,
    deviation: f64,
    shape_factor: usize,
    sectors: usize,
    modes: Option<BandModes>,
    /// The strongest [`SHAPES_OF_ROUNDS`] shapes by harmonic, shared by engines that differ by their number of shapes alone.
    strongest_shapes: Arc<StrongestShapes>,
    /// By harmonic.
    tables: Vec<OnceLock<Option<HarmonicTables>>>,
}

/// Shapes over the strain coordinates by harmonic, made when first asked for.
type StrongestShapes = Vec<OnceLock<Option<Matrix<f64>>>>;

/// No shapes made yet, under each limit.
fn no_shapes() -> [Arc<StrongestShapes>; 3] {
    std::array::from_fn(|_| Arc::new((0..=HIGHEST_HARMONIC).map(|_| OnceLock::new()).collect()))
}

/// Blade shapes and receptances of one harmonic.
#[derive(Debug)]
pub(super) struct HarmonicTables {
    pub(super) shapes: usize,
    pub(super) receptances: Receptances,
}

/// A linear contact condition.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Limit {
    /// Normal and tangential springs.
    Stuck,
    /// Normal springs.
    Slide,
    /// No springs.
    Free,
}

/// Highest harmonic of a solution that an engine has tables for.
pub const HIGHEST_HARMONIC: u32 = 100;
/// Highest harmonic by whose motions strain coordinates are chosen.
const HIGHEST_OF_SHAPES: u32 = 15;

impl ReceptanceEngine {
    /// An engine on `engine_model`; none where modes are not found.
    #[must_use]
    pub fn new(engine_model: &EngineModel, options: &EngineOptions) -> Option<Self> {
        let limits = LinearLimits::new(&engine_model.model, options.damping)?;
        Self::on(engine_model, limits, options, &no_shapes())
    }

    /// From a Craig-Bampton model: an engine with `shape_factor` times as many blade shapes as an engine has at least, and what it is made
    /// of; none where modes are not found.
    #[must_use]
    pub fn of_model(
        model: ReducedModel,
        options: &EngineOptions,
        shape_factor: usize,
    ) -> Option<(EngineModel, Self)> {
        let limits = LinearLimits::new(&model, options.damping)?;
        let engine_model = EngineModel::new(model, &limits, options, shape_factor);
        let engine = Self::on(&engine_model, limits, options, &no_shapes())?;
        Some((engine_model, engine))
    }

    /// An engine on `engine_model`, which differs from that of this one by its number of blade shapes alone, for the `options` of this
    /// one; none where modes are not found.
    #[must_use]
    pub fn with_shapes_of(
        &self,
        engine_model: &EngineModel,
        options: &EngineOptions,
    ) -> Option<Self> {
        let shapes =
            { self.tuned_wheels.each_ref() }.map(|tuned| Arc::clone(&tuned.strongest_shapes));
        Self::on(engine_model, self.limits.clone(), options, &shapes)
    }

    fn on(
        engine_model: &EngineModel,
        limits: LinearLimits,
        options: &EngineOptions,
        strongest_shapes: &[Arc<StrongestShapes>; 3],
    ) -> Option<Self> {
        let model = &engine_model.model;
        let loss_factor = match options.damping {
            Damping::StructuralLossFactor(eta) => eta,
            Damping::ModalRatio(_) | Damping::Rayleigh { .. } => 0.0,
        };
        let cantilever_modes = match options.projection {
            Projection::Exact => None,
            Projection::CantileverModes => Some(in_cantilever_modes(model)?),
        };
        let strain = cantilever_modes.as_ref().unwrap_or(&engine_model.strain);
        let band = band(&limits, options);
        let tuned_wheels = std::array::from_fn(|place| TunedWheel {
            strain: strain.clone(),
            in_cantilever_modes: cantilever_modes.is_some(),
            contact_forces: contact_forces(&limits.diameters()[place], band, &options.forces),
            band,
            forces: options.forces.clone(),
            deviation: options.deviation,
            shape_factor: engine_model.shape_factor,
            sectors: model.sectors,
            modes: None,
            tables: (0..=HIGHEST_HARMONIC).map(|_| OnceLock::new()).collect(),
            strongest_shapes: Arc::clone(&strongest_shapes[place]),
            diameters: Arc::clone(&limits.diameters()[place]),
        });
        let mut engine = Self {
            transform: SectorTransform::new(model.sectors),
            loss_factor,
            limits,
            tuned_wheels,
        };
        for tuned in &mut engine.tuned_wheels {
            let near = (band.0 * (1.0 - BAND_MARGIN), band.1 * (1.0 + BAND_MARGIN));
            let shapes = tuned.shapes(1)?;
            let (diameters, sectors) = (&tuned.diameters, tuned.sectors);
            let modes = BandModes::new(diameters, &shapes, sectors, loss_factor, near);
            tuned.modes = Some(modes);
        }
        Some(engine)
    }

    /// Number of sectors.
    #[must_use]
    pub fn sectors(&self) -> usize {
        self.transform.sectors()
    }

    /// Whether deviations act on exactly the cantilever modes, so that no shape is left out.
    #[must_use]
    pub fn acts_on_cantilever_modes(&self) -> bool {
        self.tuned_wheels
            .iter()
            .all(|tuned| tuned.in_cantilever_modes)
    }

    /// Largest relative error of the interpolated receptances so far.
    #[must_use]
    pub fn table_error(&self) -> f64 {
        let tables = self.tuned_wheels.iter().flat_map(|tuned| &tuned.tables);
        let tables = tables.filter_map(|table| table.get()?.as_ref());
        tables
            .map(|table| table.receptances.error())
            .fold(0.0, f64::max)
    }

    /// Strain coordinates of the blades in a harmonic under a limit.
    #[must_use]
    pub fn shape_count(&self, limit: Limit, harmonic: u32) -> usize {
        self.tuned_wheel(limit)
            .tables(harmonic)
            .map_or(0, |tables| tables.shapes)
    }

    /// Springs of the contact rows of a sector under a limit, N/m; empty where there are none.
    #[must_use]
    pub fn springs(&self, limit: Limit) -> &[f64] {
        let diameters = self.tuned_wheel(limit).diameters.first();
        diameters.map_or(&[], TunedDiameter::springs)
    }

    pub(super) fn tuned_wheel(&self, limit: Limit) -> &TunedWheel {
        match limit {
            Limit::Stuck => &self.tuned_wheels[0],
            Limit::Slide => &self.tuned_wheels[1],
            Limit::Free => &self.tuned_wheels[2],
        }
    }

    /// Resonances of the tuned wheel under a limit and an excitation, ascending.
    #[must_use]
    pub fn tuned_peaks(&self, limit: Limit, force: &WaveForce) -> Vec<Resonance> {
        let tuned = self.tuned_wheel(limit);
        let modes = tuned.modes.as_ref();
        modes.map_or_else(Vec::new, |modes| modes.tuned_peaks(&tuned.diameters, force))
    }

    /// Resonances of a mistuned wheel under a limit and an excitation, ascending; none if they are not found.
    #[must_use]
    pub fn peaks(
        &self,
        limit: Limit,
        wheel: &EngineWheel,
        force: &WaveForce,
    ) -> Option<Vec<Resonance>> {
        let tuned = self.tuned_wheel(limit);
        let modes = tuned.modes.as_ref()?;
        let place = match limit {
            Limit::Stuck => 0,
            Limit::Slide => 1,
            Limit::Free => 2,
        };
        let mistuned = wheel.modes[place].get_or_init(|| {
            let shapes = self.shape_count(limit, 1);
            modes.mistuned(&wheel.deviations(shapes))
        });
        Some(modes.peaks(&tuned.diameters, mistuned.as_ref()?, force))
    }
}

/// One pattern on an engine.
#[derive(Debug)]
pub struct EngineWheel {
    sectors: usize,
    pattern: Deviations,
    modes: [OnceLock<Option<MistunedModes>>; 3],
}

impl EngineWheel {
    /// A wheel with the deviations of `pattern`, or a tuned one of so many sectors.
    #[must_use]
    pub fn new(pattern: Option<&Pattern>, sectors: usize) -> Self {
        Self {
            sectors,
            pattern: pattern.map_or_else(
                || Deviations::PerBlade(vec![0.0; sectors]),
                |pattern| pattern.deviations.clone(),
            ),
            modes: std::array::from_fn(|_| OnceLock::new()),
        }
    }

    /// Deviation of every shape and sector, shape after shape.
    pub(super) fn deviations(&self, shapes: usize) -> Vec<f64> {
        (0..shapes)
            .flat_map(|shape| (0..self.sectors).map(move |n| (shape, n)))
            .map(|(shape, n)| match &self.pattern {
                Deviations::PerBlade(values) => values[n],
                Deviations::PerMode { modes, values } => {
                    let place = modes.iter().position(|&mode| mode as usize == shape);
                    place.map_or(0.0, |place| values[n * modes.len() + place])
                }
            })
            .collect()
    }
}

impl TunedWheel {
    /// What takes part in all strain coordinates.
    pub(super) fn strain(&self) -> &Participation {
        &self.strain
    }

    /// Motion times spring of the contact rows under the excitation, N.
    pub(super) fn contact_forces(&self) -> &[f64] {
        &self.contact_forces
    }

    /// The excitations.
    pub(super) fn forces(&self) -> &[WaveForce] {
        &self.forces
    }

    /// Largest deviation of a blade that is expected.
    pub(super) fn deviation(&self) -> f64 {
        self.deviation
    }

    /// Shapes and receptances of a harmonic, made when first asked for.
    pub(super) fn tables(&self, harmonic: u32) -> Option<&HarmonicTables> {
        let cell = self.tables.get(harmonic as usize)?;
        let made = cell.get_or_init(|| {
            let participation = self.shapes(harmonic)?;
            Some(HarmonicTables {
                shapes: participation[0].rows(),
                receptances: Receptances::new(&self.diameters, &participation, self.sectors),
            })
        });
        made.as_ref()
    }

    fn shapes(&self, harmonic: u32) -> Option<Participation> {
        if self.in_cantilever_modes {
            return Some(self.strain.clone());
        }
        let place = usize::from(harmonic != 1);
        let count = SHAPE_FREQUENCIES[place];
        let at = |i: usize| {
            let way = i as f64 / (count - 1) as f64;
            f64::from(harmonic) * (self.band.0 + way * (self.band.1 - self.band.0))
        };
        let frequencies: Vec<f64> = if harmonic == 0 {
            vec![0.0]
        } else {
            (0..count).map(at).collect()
        };
        let strongest = |count: usize| {
            let wanted = ShapesWanted {
                frequencies: &frequencies,
                contact_forces: &self.contact_forces,
                excitations: if harmonic == 1 { &self.forces } else { &[] },
                deviation: self.deviation,
                count,
            };
            blade_shapes(&self.diameters, &self.strain, &wanted)
        };
        let count = SHAPES[place] * self.shape_factor;
        let shapes = if count <= SHAPES_OF_ROUNDS {
            let known = self.strongest_shapes.get(harmonic as usize)?;
            let all = known.get_or_init(|| strongest(SHAPES_OF_ROUNDS)).as_ref()?;
            all.column_range(0, count.min(all.columns()))
        } else {
            strongest(count)?
        };
        Some(in_shapes(&self.strain, &shapes))
    }
}

/// Angular frequencies, rad/s, of harmonic 1 in which peaks of mistuned wheels lie.
fn band(limits: &LinearLimits, options: &EngineOptions) -> (f64, f64) {
    if let Some((start_hz, stop_hz)) = options.band_hz {
        return (TAU * start_hz, TAU * stop_hz);
    }
    limits
        .span(&options.forces)
        .map_or((0.0, 0.0), |(low, high)| {
            let reach = reach_of_mistuning(options.deviation);
            (low * (1.0 - reach), high * (1.0 + reach))
        })
}

/// Largest motion of every contact row under the excitations over the band, times its spring.
fn contact_forces(diameters: &[TunedDiameter], band: (f64, f64), forces: &[WaveForce]) -> Vec<f64> {
    let Some(count) = diameters.first().map(TunedDiameter::spring_count) else {
        return Vec::new();
    };
    let mut largest = vec![0.0_f64; count];
    for force in forces {
        let diameter = &diameters[force.diameter.index];
        let inside = diameter.natural.0.iter().copied();
        let inside = inside.filter(|omega| *omega > band.0 && *omega < band.1);
        for s in inside.chain([band.0, band.1]).filter(|&s| s > 0.0) {
            let motion =
                diameter.response(s, &diameter.contact, &force.modal, force.diameter.conjugate);
            for (largest, value) in largest.iter_mut().zip(motion.into_iter().flatten()) {
                *largest = largest.max(value.norm());
            }
        }
    }
    let springs = diameters.first().map_or(&[][..], TunedDiameter::springs);
    largest.iter().zip(springs).map(|(u, k)| u * k).collect()
}
