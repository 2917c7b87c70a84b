//! Contact laws as pure functions of a displacement history: force, derivative, contact state. They are also marched from
//! one instant to the next.

mod contact_march;
mod contact_pair;
mod coulomb_3d;
mod coulomb_slider;
mod friction_circle;
mod law_parts;
mod laws;
mod macro_slip;
mod options;
mod periodic_slider;
mod simplified_3d;

pub use contact_march::PairMemory;
pub use contact_pair::{ContactHistory, PairDisplacement, PairParameters, PairState};
pub use coulomb_slider::{CoupledSlider, Slip};
pub use law_parts::{SideBySide, TangentialFriction};
pub use laws::march;
pub use options::{ContactLaw, ContactOptions, Ring};
pub use periodic_slider::PeriodicSlider;
