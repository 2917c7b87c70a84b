//! Small wheels that many tests solve: reduced model, contact law, damping, excitation.

use std::sync::Arc;

use blisk::model::ReducedModel;
use blisk::model::reduction::{BasisChoice, ContactStiffness, Reduction};
use blisk::model::sector::{SectorModel, bundle, lumped};
use blisk::population::monte_carlo::{
    ResponseRow, RowSettings, RowSolver, Scenario, TunedReference,
};
use blisk::response::forced_response::{
    ContactCondition, Excited, LimitsWanted, SolverOptions, Wheel as WheelModes, wheel_force,
};
use blisk::response::friction::{ContactLaw, PairParameters, Ring};
use blisk::response::harmonic_balance::Damping;
use blisk::response::mistuning::{
    ContactFactors, Deviations, Pattern, Projection, StructuralModes, WheelBasis,
};
use blisk::response::receptance::{EngineOptions, ReceptanceEngine, WaveForce};

use super::contact::random::Random;
use super::sector_sources::data;
use super::sector_sources::lumped::lumped24;

pub const ENGINE_ORDER: u32 = 3;

/// A reduced wheel with everything that its response depends on.
#[derive(Clone)]
pub struct Wheel {
    pub model: Arc<ReducedModel>,
    pub law: ContactLaw,
    pub sector: PairParameters,
    pub damping: Damping,
    pub amplitude_n: f64,
    pub ring: Ring,
}

/// Contact springs of a law along n, t1, t2.
pub fn springs(law: ContactLaw, sector: PairParameters) -> ContactStiffness {
    let kt = sector.tangential_stiffness_n_per_m;
    ContactStiffness {
        normal_n_per_m: sector.normal_stiffness_n_per_m,
        tangential_1_n_per_m: kt,
        tangential_2_n_per_m: if law.tangents() == 1 { 0.0 } else { kt },
    }
}

fn parameters(kn: f64, kt: f64) -> PairParameters {
    PairParameters {
        normal_load_n: 0.0,
        normal_stiffness_n_per_m: kn,
        tangential_stiffness_n_per_m: kt,
        friction_coefficient: 0.3,
    }
}

/// The sector of the reference wheel of eight blades.
pub fn wheel8_sector() -> SectorModel {
    bundle::read(&data("wheel8")).unwrap()
}

/// Contact parameters of that wheel.
pub fn wheel8_contact() -> PairParameters {
    parameters(8e8, 4e8)
}

/// Factor on the number of blade shapes with which none is left out.
const ALL_SHAPES: usize = 1000;

/// Slipping starts near a load of 1 N times this for the lumped wheel.
pub const LUMPED_KT: f64 = 8e5;

impl Wheel {
    /// Masses and springs, whole space: 72 coordinates, one-dimensional friction.
    pub fn lumped24() -> Self {
        Self::of(
            &lumped::build(&lumped24()).unwrap(),
            ContactLaw::MacroSlip1d,
            parameters(0.0, LUMPED_KT),
            Damping::Rayleigh {
                mass_per_s: 0.0,
                stiffness_s: 9e-7,
            },
            BasisChoice::CraigBampton,
        )
    }

    /// The same on a soft ground and with a held ring: the resonances of slide and stuck lie 30 % apart.
    pub fn wide_gap() -> Self {
        let mut options = lumped24();
        options.disk_ground_stiffness_n_per_m = 0.3e6;
        options.ring_ground_stiffness_n_per_m = 2e6;
        Self::of(
            &lumped::build(&options).unwrap(),
            ContactLaw::MacroSlip1d,
            parameters(0.0, LUMPED_KT),
            Damping::Rayleigh {
                mass_per_s: 0.0,
                stiffness_s: 9e-7,
            },
            BasisChoice::CraigBampton,
        )
    }

    /// Solid elements, two stick and two slide modes per nodal diameter: 32 coordinates.
    pub fn wheel8() -> Self {
        Self::of(
            &wheel8_sector(),
            ContactLaw::Simplified3d,
            wheel8_contact(),
            Damping::StructuralLossFactor(0.002),
            BasisChoice::StickSlide { stick: 2, slide: 2 },
        )
    }

    pub fn of(
        sector: &SectorModel,
        law: ContactLaw,
        contact: PairParameters,
        damping: Damping,
        basis: BasisChoice,
    ) -> Self {
        let reduction = Reduction::new(sector, springs(law, contact), 25, 0).unwrap();
        Self {
            model: Arc::new(reduction.reduce(basis, None).unwrap()),
            law,
            sector: contact,
            damping,
            amplitude_n: 1.0,
            ring: Ring::Locked,
        }
    }

    pub fn settings(&self, harmonics: &[u32], solver: SolverOptions) -> RowSettings {
        RowSettings {
            harmonics: harmonics.to_vec(),
            contact: Some((self.law, self.sector)),
            ring: self.ring,
            damping: self.damping,
            amplitude_n: self.amplitude_n,
            projection: Projection::Exact,
            solver,
        }
    }

    /// Rows on the receptances of the basis, as those of a study are solved, with every blade shape, under any engine order up to three
    /// times the sectors.
    pub fn solver(&self, harmonics: &[u32], options: SolverOptions) -> RowSolver {
        self.solver_or_none(harmonics, options).unwrap()
    }

    /// [`Self::solver`]; none where there are no receptances.
    pub fn solver_or_none(&self, harmonics: &[u32], options: SolverOptions) -> Option<RowSolver> {
        self.solver_up_to(0.1, harmonics, options)
    }

    /// [`Self::solver_or_none`] for blades that deviate by at most so much.
    pub fn solver_up_to(
        &self,
        deviation: f64,
        harmonics: &[u32],
        options: SolverOptions,
    ) -> Option<RowSolver> {
        let engine_orders: Vec<u32> = (0..=3 * self.model.sectors as u32)
            .chain([ENGINE_ORDER, 10_000])
            .collect();
        let force = |&order: &u32| WaveForce::new(&self.model, order, self.amplitude_n);
        let engine_options = EngineOptions {
            damping: self.damping,
            projection: Projection::Exact,
            forces: engine_orders.iter().map(force).collect(),
            deviation,
            band_hz: None,
        };
        let model = (*self.model).clone();
        let (own, engine) = ReceptanceEngine::of_model(model, &engine_options, ALL_SHAPES)?;
        let solver = self.newton_solver(harmonics, options);
        let solver = solver.with_engine_of_basis(Arc::new(engine), &own.model, &engine_orders);
        Some(solver.unwrap())
    }

    /// Rows on the basis by Newton's method.
    pub fn newton_solver(&self, harmonics: &[u32], options: SolverOptions) -> RowSolver {
        RowSolver::new(Arc::clone(&self.model), self.settings(harmonics, options)).unwrap()
    }

    /// The tuned wheel as one sector.
    pub fn tuned(&self, harmonics: &[u32]) -> Excited {
        Excited::tuned(
            &self.model,
            &ContactFactors::default(),
            ENGINE_ORDER,
            self.amplitude_n,
            self.damping,
            harmonics,
            LimitsWanted::of(&[full(1.0)]),
        )
    }

    /// The whole wheel with deviations of its blades.
    pub fn mistuned(&self, deviations: &[f64], harmonics: &[u32]) -> Excited {
        let basis = WheelBasis::new(Arc::clone(&self.model));
        let change = basis.blade_stiffness_change(deviations);
        let modes = StructuralModes::of_wheel(&basis, &change).unwrap();
        let force = wheel_force(&basis, &modes, ENGINE_ORDER, self.amplitude_n);
        let wheel = WheelModes::mistuned(
            modes,
            &self.model,
            &ContactFactors::default(),
            self.damping,
            LimitsWanted::of(&[full(1.0)]),
        );
        Excited::wheel(&wheel, force, harmonics)
    }

    /// Deviations of zero mean and about the given standard deviation.
    pub fn deviations(&self, random: &mut Random, standard_deviation: f64) -> Vec<f64> {
        random.vector(self.model.sectors, 3.0_f64.sqrt() * standard_deviation)
    }
}

/// Deviations of the blades of a pattern in a table `pattern,blade,deviation` of `tests/data`.
pub fn deviations_in(table: &str, pattern: u32) -> Vec<f64> {
    let text = std::fs::read_to_string(data(table)).unwrap();
    let deviations: Vec<f64> = text
        .lines()
        .map(|line| line.split(',').collect::<Vec<_>>())
        .filter(|cells| cells[0] == pattern.to_string())
        .map(|cells| cells[2].parse().unwrap())
        .collect();
    assert!(!deviations.is_empty(), "{table} has no pattern {pattern}");
    deviations
}

pub fn full(normal_load_n: f64) -> ContactCondition {
    ContactCondition::Full { normal_load_n }
}

pub fn scenario(contact: ContactCondition) -> Scenario {
    Scenario {
        index: 0,
        load_case: None,
        engine_order: ENGINE_ORDER,
        standard_deviation: None,
        contact,
    }
}

pub fn pattern(deviations: &[f64]) -> Pattern {
    Pattern {
        id: 0,
        deviations: Deviations::PerBlade(deviations.to_vec()),
        contact: ContactFactors::default(),
    }
}

/// Tuned peak and row of one pattern.
pub fn solve_row(
    solver: &RowSolver,
    pattern: &Pattern,
    contact: ContactCondition,
) -> (TunedReference, ResponseRow) {
    let scenario = scenario(contact);
    let tuned = solver.tuned(&scenario);
    let row = solver.rows(pattern, &[(&scenario, &tuned)]).remove(0);
    (tuned, row)
}

/// Relative difference.
pub fn relative(found: f64, expected: f64) -> f64 {
    (found / expected - 1.0).abs()
}
