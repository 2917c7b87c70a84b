//! Ranges that several keys of a study file share.

use crate::input::Value::{Number, Whole};
use crate::input::{Range, Value};

pub(super) const ABOVE_ZERO: Value = Number(Range::above(0.0));
pub(super) const MODES: Value = Whole(1, 1000);
/// Where a normal law is cut off, in its standard deviations.
pub(super) const TRUNCATION: Value = Number(Range::from_to(0.1, 10.0));
