//! Monte Carlo forced response of randomly mistuned bladed disks with friction ring dampers.

pub mod cli;
pub mod linalg;
pub mod model;
pub mod population;
pub mod report;
pub mod response;
pub mod study;
