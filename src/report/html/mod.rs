//! The report as one HTML file that needs nothing else.

mod first_screen;
mod headline;
mod health;
mod measured_wheels;
mod model;
mod page;
mod table;
mod tables;

pub use page::html_report;
