//! Sectors from finite-element codes: `CalculiX`, Ansys, Nastran.
//!
//! An import file names meshes, matrices and sets; the guide is `docs/import.md`.

mod ansys;
mod blade;
mod build;
mod bulk;
mod contact;
mod contact_tables;
mod couplings;
mod cyclic_faces;
mod cylindrical;
mod deck;
mod equations;
mod files;
mod foreign;
mod import_file;
mod keys;
mod matrices;
mod mesh;
mod nastran;
mod problem;
mod projection;
mod report;
mod run;
mod side;
mod source;
mod surface;
mod tables;
mod template;

pub use build::{Imported, import};
pub use equations::calculix_equations;
pub use foreign::foreign;
pub use keys::{import_keys, import_schema};
pub use problem::ImportProblem;
pub use report::{BladeSource, BodyReport, ContactReport, ImportReport, SurfacesReport};
pub use template::IMPORT_TEMPLATES;
