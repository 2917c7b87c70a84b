//! One cell of a study: load case, engine order, standard deviation, contact condition.

use std::fmt;

use serde::{Deserialize, Deserializer, Serialize, Serializer, de};

use crate::response::forced_response::ContactCondition;

/// One scenario; `index` is its place in the product order of the study.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scenario {
    /// Index in the order load case, engine order, standard deviation, normal load, each as written.
    pub index: usize,
    /// Load case; none in a study with the force vector of its model alone.
    pub load_case: Option<LoadCaseName>,
    /// Engine order of the excitation.
    pub engine_order: u32,
    /// Standard deviation of the blades' relative deviation; none for patterns from a file.
    pub standard_deviation: Option<f64>,
    /// Contact condition.
    pub contact: ContactCondition,
}

impl Scenario {
    /// Whether both are under the same force: load case and engine order.
    #[must_use]
    pub fn same_excitation(&self, other: &Self) -> bool {
        self.load_case == other.load_case && self.engine_order == other.engine_order
    }

    /// Whether both differ in nothing but the contact condition.
    #[must_use]
    pub fn same_group(&self, other: &Self) -> bool {
        self.same_excitation(other) && self.standard_deviation == other.standard_deviation
    }
}

/// Name of a load case: 1 to [`Self::LONGEST`] ASCII letters, digits, `-` and `_`, the first a letter or digit.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub struct LoadCaseName {
    bytes: [u8; Self::LONGEST],
    length: u8,
}

impl LoadCaseName {
    /// Most characters of a name.
    pub const LONGEST: usize = 40;

    /// The name as written; none if it is no name.
    #[must_use]
    pub fn new(written: &str) -> Option<Self> {
        let well_formed = written
            .bytes()
            .all(|c| c.is_ascii_alphanumeric() || c == b'-' || c == b'_')
            && written.starts_with(|c: char| c.is_ascii_alphanumeric());
        if !well_formed || written.len() > Self::LONGEST {
            return None;
        }
        let mut bytes = [0; Self::LONGEST];
        bytes[..written.len()].copy_from_slice(written.as_bytes());
        Some(Self {
            bytes,
            length: u8::try_from(written.len()).ok()?,
        })
    }

    /// The name as written.
    #[must_use]
    pub fn as_str(&self) -> &str {
        // Nothing but ASCII was taken.
        std::str::from_utf8(&self.bytes[..usize::from(self.length)]).unwrap_or_default()
    }
}

impl fmt::Display for LoadCaseName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.as_str())
    }
}

impl fmt::Debug for LoadCaseName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(self.as_str(), f)
    }
}

impl Serialize for LoadCaseName {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.as_str())
    }
}

impl<'de> Deserialize<'de> for LoadCaseName {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let written = String::deserialize(deserializer)?;
        Self::new(&written)
            .ok_or_else(|| de::Error::custom(format!("{written:?} is no name of a load case")))
    }
}
