//! From the study file as written to a [`Study`](super::Study): one file for the checks of each table.

mod check;
mod replaced;
mod validate;
mod validate_accuracy;
mod validate_contact;
mod validate_damping;
mod validate_excitation;
mod validate_loads;
mod validate_mistuning;
mod validate_solver;
mod validate_stop;

pub(crate) use validate::against_receptances;
