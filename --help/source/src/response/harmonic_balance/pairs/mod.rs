//! Contact forces of the pairs in harmonic space, with their derivatives: one pair by itself, or many side by side.

mod clip_slopes;
mod contact_interface;
mod coupled_derivative;
mod lanes;
mod macro_slip_pairs;
mod pair_harmonics;
mod pair_jacobian;
mod quarter_waves;
mod simplified_3d_pairs;
mod slider_march;
mod wheel_pairs;

pub use contact_interface::ContactInterface;
pub(super) use macro_slip_pairs::MacroSlipPairs;
pub use pair_harmonics::PairHarmonics;
pub use pair_jacobian::PairJacobian;
pub(super) use simplified_3d_pairs::Simplified3dPairs;
pub use wheel_pairs::ContactShares;
pub(super) use wheel_pairs::WheelPairs;
