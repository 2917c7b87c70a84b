//! Direct time integration: exact solutions for the integrator, and harmonic balance held against it.
//!
//! The long forms, in release:
//!
//! ```text
//! cargo test --release --test physics time_integration -- --ignored --nocapture
//! ```

mod lumped;
mod march;
mod one_dof;
mod stability;
mod wheel8;
