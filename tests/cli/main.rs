//! The command line from outside: exit codes, messages, files.

mod bad_studies;
mod bad_study_table;
mod blisk;
mod commands;
mod faults;
mod imports;
mod interruption;
mod runs;
mod statistics;
mod tradeoff;
mod verification;
