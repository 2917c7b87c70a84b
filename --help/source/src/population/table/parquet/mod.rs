//! Parquet files, read and written by Polars, which is named nowhere else.

mod columns;
mod pattern_file;
mod reader;
mod writer;

pub use pattern_file::read_pattern_parquet;
pub(super) use reader::TableReader;
pub(super) use writer::TableWriter;
