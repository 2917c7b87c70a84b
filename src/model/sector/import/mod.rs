//! Sectors from finite-element codes: `CalculiX`, Ansys, Nastran.
//!
//! An import file names meshes, matrices and sets; the guide is `docs/import.md`.

mod ansys;
mod blade;
mod build;
mod bulk;
mod contact;
mod cyclic_faces;
mod cylindrical;
mod deck;
mod equations;
mod import_file;
mod matrices;
mod mesh;
mod nastran;
mod problem;
mod projection;
mod report;
mod run;
mod source;
mod surface;

pub use build::{Imported, import};
pub use equations::calculix_equations;
pub use problem::ImportProblem;
pub use report::{BladeSource, BodyReport, ContactReport, ImportReport};
