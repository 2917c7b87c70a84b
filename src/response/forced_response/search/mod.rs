//! The search for the highest peak of curves over frequency: what is known beforehand, samples, summits between them.

mod envelope;
mod peak_search;
mod samples;
mod sloped;
pub(super) mod summit;

pub(super) use envelope::VERTEX_SHARE;
pub use envelope::{Envelope, SearchSettings};
pub use peak_search::{SearchEnd, SearchResult, find_peak};
pub(super) use samples::Samples;
pub use samples::{Curve, Reading, Sample};
