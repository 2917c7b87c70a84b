//! Contact forces of the pairs in harmonic space, with their derivatives: one pair by itself, or many side by side.

mod clip_slopes;
mod contact_interface;
mod contact_states;
mod coupled_derivative;
mod interface_forces;
mod lanes;
mod macro_slip_pairs;
mod pair_harmonics;
mod pair_jacobian;
mod quarter_waves;
mod simplified_3d_pairs;
mod slider_march;
mod wheel_contact;
mod wheel_pairs;

pub use contact_interface::ContactInterface;
pub use contact_states::PairContact;
pub(super) use interface_forces::{InterfaceForces, InterfaceWorkspace};
pub(super) use macro_slip_pairs::MacroSlipPairs;
pub use pair_harmonics::PairHarmonics;
pub use pair_jacobian::PairJacobian;
pub(super) use simplified_3d_pairs::Simplified3dPairs;
pub use wheel_contact::{MeanTangent, WheelContact};
pub use wheel_pairs::ContactShares;
pub(super) use wheel_pairs::WheelPairs;
