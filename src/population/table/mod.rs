//! Parquet tables and manifest of a results folder: schema, atomic writing, reading, parts.

mod atomic;
mod checked_json;
mod column;
mod curve;
mod error;
mod manifest;
mod parts;
mod pattern_file;
mod patterns;
mod peak_audit;
mod publication;
mod reader;
mod responses;
mod row_file;
mod scenarios;
mod traced_curve;
mod verification;
mod writer;

pub use atomic::{digest_file, remove_leftovers, write_atomically};
pub use column::{ColumnKind, ColumnSpec};
pub use curve::{CURVE_COLUMNS, CurveFormat, CurvePoint, write_curve};
pub use error::TableError;
pub use manifest::{MANIFEST, Manifest, RunRecord, RunState, ScenarioEntry, Shard, StatusCounts};
pub use parts::{PartSink, RowSchema, RowStore, part_files, remove_parts};
pub use pattern_file::{PatternParquetError, read_pattern_parquet};
pub use patterns::{PATTERN_COLUMNS, write_patterns};
pub use peak_audit::{PEAK_AUDIT_COLUMNS, PeakAuditRecord, write_peak_audit};
pub use publication::{Staging, complete_publication, keep_as_part, set_aside};
pub use responses::{RESPONSE_COLUMNS, ResponseReader, ResponseWriter};
pub use row_file::RowFile;
pub use scenarios::{SCENARIO_COLUMNS, ScenarioRecord, write_scenarios};
pub use traced_curve::{Direction, TRACE_COLUMNS, TracePoint, write_traced_curve};
pub use verification::{VERIFICATION_COLUMNS, VerificationRecord, write_verification};
pub use writer::{Compression, SCHEMA_VERSION, TableHeader};
