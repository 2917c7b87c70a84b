//! From the study file as written to a [`Study`](super::Study) and back: one file for what each table needs beside its keys.

mod check;
mod replaced;
mod to_study_file;
mod validate;
mod validate_accuracy;
mod validate_contact;
mod validate_damping;
mod validate_excitation;
mod validate_loads;
mod validate_mistuning;
mod validate_solver;
mod validate_stop;
