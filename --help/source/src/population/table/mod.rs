//! Parquet tables and manifest of a results folder: schema, atomic writing, reading, parts.

mod accuracy_ladder;
mod atomic;
mod checked_json;
mod column;
mod curve;
mod distribution;
mod error;
mod estimate_rows;
mod header;
mod main_effects;
mod manifest;
#[cfg(feature = "parquet")]
mod parquet;
#[cfg(not(feature = "parquet"))]
#[path = "no_parquet.rs"]
mod parquet;
mod part_header;
mod parts;
mod patterns;
mod peak_audit;
mod percentiles;
mod places;
mod publication;
mod response_columns;
mod responses;
mod row_file;
mod scenarios;
mod side_tables;
mod tail_fits;
mod traced_curve;
mod tradeoff;
mod verification;

pub use accuracy_ladder::{AccuracyLadder, MeasuredSetting};
pub use atomic::{abandon_unfinished, digest_file, remove_leftovers, write_atomically};
pub use checked_json::{ESTIMATE, SAMPLE, read_estimate, write_estimate};
pub use column::{ColumnKind, ColumnSpec};
pub use curve::{CURVE_COLUMNS, CurveFormat, CurvePoint, write_curve};
pub use distribution::{DISTRIBUTION_COLUMNS, write_distribution};
pub use error::{PatternParquetError, TableError};
pub use estimate_rows::{ESTIMATE_ROW_COLUMNS, EstimateRow, write_estimate_rows, write_sample};
pub use header::{Compression, SCHEMA_VERSION, TableHeader};
pub use main_effects::{EffectRows, MAIN_EFFECT_COLUMNS, write_main_effects};
pub use manifest::{Manifest, RunRecord, RunState, ScenarioEntry, Shard, StatusCounts};
pub use parquet::read_pattern_parquet;
pub use part_header::{
    PartHeader, check_parts, holds_results, part_files, renew_header, unlisted_parts,
};
pub use parts::{PartSink, RowSchema, RowStore, remove_parts};
pub use patterns::{PATTERN_COLUMNS, StoredPatterns, read_patterns, write_patterns};
pub use peak_audit::{PEAK_AUDIT_COLUMNS, PeakAuditRecord, write_peak_audit};
pub use percentiles::{PERCENTILE_COLUMNS, write_percentiles};
pub use places::{
    ASIDE, FOLDERS, MANIFEST, SIDE_FILES, Standing, TABLES, digest_stored, is_file, is_folder,
    misplacements,
};
pub use publication::{Staging, complete_publication, keep_as_part, set_aside, supersede};
pub use response_columns::RESPONSE_COLUMNS;
pub use responses::{ResponseReader, ResponseWriter};
pub use row_file::RowFile;
pub use scenarios::{SCENARIO_COLUMNS, ScenarioExtras, ScenarioRecord, write_scenarios};
pub use side_tables::{CHECKSUMS, SideTable, SideTables, write_side_table};
pub use tail_fits::{TAIL_FIT_COLUMNS, TailFitRecord, write_tail_fits};
pub use traced_curve::{Direction, TRACE_COLUMNS, TracePoint, write_traced_curve};
pub use tradeoff::{
    TRADEOFF_COLUMNS, TRADEOFF_ROW_COLUMNS, TRADEOFF_TARGETS, TRADEOFF_TIME_COLUMNS,
    TradeoffRecord, TradeoffRow, write_tradeoff, write_tradeoff_rows, write_tradeoff_times,
};
pub use verification::{VERIFICATION_COLUMNS, VerificationRecord, write_verification};
