//! The command line from outside: exit codes, messages, files.

mod bad_studies;
mod bad_study_table;
mod blisk;
mod builds;
mod commands;
mod copied_blocks;
mod documentation;
mod documented_commands;
mod faults;
#[path = "../shared/forgery.rs"]
mod forgery;
mod imports;
mod interrupted_commands;
mod interruption;
mod load_cases;
mod manual;
mod measured_wheels;
mod missed_peaks;
mod output;
mod report;
mod report_page;
mod rotation;
mod runs;
mod stated_keys;
mod statistics;
mod stored_numbers;
mod study_keys;
mod texts;
mod tradeoff;
mod verification;
