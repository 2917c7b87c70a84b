//! Contact laws as pure functions of a displacement history: force, derivative, contact state.

mod options;

pub use options::{ContactLaw, ContactOptions};
