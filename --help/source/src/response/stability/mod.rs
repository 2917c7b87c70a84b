//! Whether a wheel stays on the periodic motion that harmonic balance has found: multipliers of the linearised motion with
//! the memory of its sliders.

mod arnoldi;
mod contact_path;
mod contact_tangent;
mod judge;
mod neutral;
mod period_map;
mod sector_waves;
mod wave_step;

pub use contact_path::ContactMotion;
pub use judge::{Multipliers, StabilityOptions, multipliers};
