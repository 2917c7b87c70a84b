//! The commented study that `blisk init` writes.

/// A study of the built-in bladed disk, with every key that is usually touched.
pub const STUDY_TEMPLATE: &str = include_str!("template.toml");
