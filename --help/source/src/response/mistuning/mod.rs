//! Patterns of blade deviations: distributions, random streams, tables, and their application.

mod contact_factors;
mod contact_variation;
mod distribution;
mod modes;
mod options;
mod pattern;
mod pattern_csv;
mod pattern_table;
mod source;
mod stream;
mod wheel_basis;

pub use contact_factors::{ContactFactors, PairFactors};
pub use contact_variation::{
    ContactQuantity, ContactSource, ContactVariation, FactorLaw, VariesPer,
};
pub use distribution::{DistributionError, TRUNCATION_RANGE};
pub use modes::{ModalRows, StructuralModes};
pub use options::{Distribution, Projection};
pub use pattern::{Deviations, Pattern};
pub use pattern_csv::read_pattern_csv;
pub use pattern_table::{PatternFileError, PatternRecord, PatternRecords, PatternTable};
pub use source::PatternSource;
pub use stream::{GENERATOR, pattern_stream};
pub use wheel_basis::WheelBasis;
