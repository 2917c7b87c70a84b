//! One row of the result: reduced model + pattern -> friction + harmonic balance -> peak.

pub mod forced_response;
pub mod friction;
pub mod harmonic_balance;
pub mod mistuning;
pub mod receptance;
pub mod stability;
