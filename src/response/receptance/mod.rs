//! Mistuned wheels on the receptances of the tuned one: no basis and no eigenproblem of a pattern in its solution.
//!
//! The tuned wheel with stuck contact is one small matrix a wave and frequency (`receptance_tables.rs`). Blade deviations are eliminated
//! exactly in few strain coordinates (`elimination.rs`, `blade_shapes.rs`), and the motions at the contact are the only
//! unknowns of the nonlinear equation (`contact_equation.rs`), which an iteration solves (`contact_iteration.rs`,
//! `attempts_on_receptances.rs`, `preconditioner.rs`, `whole_preconditioner.rs`, `acceleration.rs`).

mod acceleration;
mod attempts_on_receptances;
mod blade_shapes;
mod contact_equation;
mod contact_forces;
mod contact_iteration;
mod contact_places;
mod elimination;
mod engine;
mod factored_stiffness;
mod fields;
mod free_waves;
mod linear_limits;
mod motions;
mod pair_preconditioner;
mod preconditioner;
mod receptance_tables;
mod resonances;
mod tuned_diameter;
mod wave_force;
mod wave_matrix;
mod wave_preconditioner;
mod wheel_harmonic;
mod wheel_solver;
mod whole_preconditioner;

pub use contact_forces::ContactForces;
pub use engine::{
    EngineModel, EngineOptions, EngineWheel, HIGHEST_HARMONIC, Limit, ReceptanceEngine,
};
pub use free_waves::{FreeWave, FreeWheel};
pub use motions::{embedded, overlay};
pub use resonances::{Resonance, SHIFT_BY_DEVIATION, reach_of_mistuning, resonances_that_count};
pub use wave_force::WaveForce;
pub use wheel_solver::{SolutionWork, WheelSolution, WheelSolver};
