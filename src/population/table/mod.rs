//! Parquet tables and manifest of a results folder: schema, atomic writing, reading, parts.

mod atomic;
mod column;
mod curve;
mod distribution;
mod error;
mod manifest;
mod parts;
mod pattern_file;
mod patterns;
mod peak_audit;
mod percentiles;
mod reader;
mod responses;
mod scenarios;
mod tail_fits;
mod traced_curve;
mod verification;
mod writer;

pub use atomic::write_atomically;
pub use column::{ColumnKind, ColumnSpec};
pub use curve::{CURVE_COLUMNS, CurveFormat, CurvePoint, write_curve};
pub use distribution::{DISTRIBUTION_COLUMNS, write_distribution};
pub use error::TableError;
pub use manifest::{Manifest, RunRecord, RunState, ScenarioEntry, StatusCounts};
pub use parts::{PartSink, PartStore};
pub use pattern_file::{PatternParquetError, read_pattern_parquet};
pub use patterns::{PATTERN_COLUMNS, StoredPatterns, read_patterns, write_patterns};
pub use peak_audit::{PEAK_AUDIT_COLUMNS, PeakAuditRecord, write_peak_audit};
pub use percentiles::{PERCENTILE_COLUMNS, write_percentiles};
pub use responses::{RESPONSE_COLUMNS, ResponseReader, ResponseWriter};
pub use scenarios::{
    SCENARIO_COLUMNS, STATISTICS_TABLES, ScenarioRecord, write_scenarios, write_statistics,
};
pub use tail_fits::{TAIL_FIT_COLUMNS, TailFitRecord, write_tail_fits};
pub use traced_curve::{Direction, TRACE_COLUMNS, TracePoint, write_traced_curve};
pub use verification::{VERIFICATION_COLUMNS, VerificationRecord, write_verification};
pub use writer::{Compression, SCHEMA_VERSION, TableHeader};
