//! Monte Carlo forced response of randomly mistuned bladed disks with friction dampers.
//!
//! The way of the data, and the order in which modules may name each other (each only those before
//! it; a test holds it):
//!
//! | wing | rooms, in order | holds |
//! | --- | --- | --- |
//! | [`identity`] | | what the program was built from |
//! | [`platform`] | | what the operating system says of machine and processes |
//! | [`linalg`] | | a thin layer over faer |
//! | [`input`] | | the keys of TOML files, and what is wrong with them |
//! | [`model`] | `sector`, `cyclic`, `reduced_model`, `reduction`, `cache` | from a sector to the reduced model |
//! | [`response`] | `mistuning`, `friction`, `harmonic_balance`, `receptance`, `forced_response`, `stability` | one wheel to its peak |
//! | [`verification`] | `reference`, `time_integration` | what rows are verified by |
//! | [`population`] | `monte_carlo`, `statistics`, `table` | all wheels to tables |
//! | [`report`] | | the summary and its warnings |
//! | [`study`] | | the study file |
//! | [`settings`] | | what the numbers are solved with, chosen by measured error, and the engines |
//! | [`campaign`] | `store`, `pipeline`, `commands` | a study carried out |
//! | [`cli`] | | the commands; the only code that prints |

pub mod campaign;
pub mod cli;
pub mod identity;
pub mod input;
pub mod linalg;
pub mod model;
pub mod platform;
pub mod population;
pub mod report;
pub mod response;
pub mod settings;
pub mod study;
pub mod verification;
