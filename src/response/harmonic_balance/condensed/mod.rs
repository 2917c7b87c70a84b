//! Newton's step of a wheel with few contact rows, by an equation in the contact forces alone.

mod contact_couplings;
mod linear_factors;
pub(super) mod newton_step;
mod pivoted_factors;

pub(super) use newton_step::CondensedJacobian;
