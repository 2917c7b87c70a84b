//! What rows are verified by: the full-contact model of the wheel, and direct time integration.

pub mod reference;
pub mod time_integration;
