//! The report as one HTML file that needs nothing else.

mod page;
mod table;
mod tables;

pub use page::html_report;
