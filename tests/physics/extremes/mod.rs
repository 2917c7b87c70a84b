//! The extremes, one at a time, on the smallest model that shows each: a value meets its limit or an
//! invariance to the tolerance stated beside it, or the row ends in a status of the closed set.
//!
//! Every test has a quick form and, where there are more values to try, a long one:
//!
//! ```text
//! cargo test --release --test physics extremes
//! cargo test --release --test physics extremes -- --ignored
//! ```

mod damping;
mod degenerate;
mod excitation;
mod harmonics;
mod load;
mod mistuning;
mod reduction;
mod sectors;
mod stiffness;
pub mod wheels;
