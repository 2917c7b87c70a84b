//! The command line from outside: exit codes, messages, files.

mod bad_studies;
mod blisk;
mod commands;
mod runs;
