//! Monte Carlo forced response of randomly mistuned bladed disks with friction ring dampers.

pub mod linalg;
pub mod model;
pub mod population;
pub mod response;
pub mod study;
