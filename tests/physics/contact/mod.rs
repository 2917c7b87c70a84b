//! Contact laws: exact loops, brute force, limits, derivatives.

mod coulomb;
mod friction_circle_effect;
mod harmonic_transform;
mod jenkins_oracles;
mod pair_derivatives;
mod periodic_state;
pub mod random;
mod ring_friction;
mod system_oracles;
mod transition_criteria;
