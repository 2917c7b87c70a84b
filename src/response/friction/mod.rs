//! Contact laws as pure functions of a displacement history: force, derivative, contact state. They are also marched from
//! one instant to the next.

mod contact_march;
mod contact_pair;
mod coulomb_slider;
mod friction_circle;
mod law_kinds;
mod law_parts;
mod laws;
mod options;
mod periodic_slider;

pub use contact_march::PairMemory;
pub use contact_pair::{ContactHistory, PairDisplacement, PairParameters, PairState};
pub use coulomb_slider::{CoupledSlider, Slip};
pub use law_kinds::{SideBySide, TangentialFriction};
pub use laws::{ContactLaw, march};
pub use options::{ContactOptions, Ring};
pub use periodic_slider::PeriodicSlider;
