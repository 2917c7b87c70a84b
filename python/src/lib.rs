//! The native part of the Python package `blisk`: what Python calls, one file per subject.
//!
//! Values that Python only looks at cross the border as JSON, tables as Arrow streams without a copy.

mod command;
mod errors;
mod files;
mod questions;
mod results;
mod run;
mod sector;
mod study;
mod table;
mod watch;

use pyo3::prelude::*;

/// Functions and types behind the package; its own modules are what is documented.
#[pymodule(gil_used = true)]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("VERSION", blisk::identity::VERSION)?;
    module.add("BUILD", blisk::identity::BUILD)?;
    module.add("COMMIT", blisk::identity::COMMIT)?;
    module.add_class::<study::CheckedStudy>()?;
    module.add_class::<table::Table>()?;
    module.add_function(wrap_pyfunction!(command::main, module)?)?;
    module.add_function(wrap_pyfunction!(files::examples, module)?)?;
    module.add_function(wrap_pyfunction!(files::init, module)?)?;
    module.add_function(wrap_pyfunction!(files::slurm, module)?)?;
    module.add_function(wrap_pyfunction!(files::explain, module)?)?;
    module.add_function(wrap_pyfunction!(files::schema, module)?)?;
    module.add_function(wrap_pyfunction!(study::key_names, module)?)?;
    module.add_function(wrap_pyfunction!(study::tables_of, module)?)?;
    module.add_function(wrap_pyfunction!(run::run, module)?)?;
    module.add_function(wrap_pyfunction!(run::optimum, module)?)?;
    module.add_function(wrap_pyfunction!(run::plan, module)?)?;
    module.add_function(wrap_pyfunction!(run::response, module)?)?;
    module.add_function(wrap_pyfunction!(results::compare, module)?)?;
    module.add_function(wrap_pyfunction!(results::summary, module)?)?;
    module.add_function(wrap_pyfunction!(results::status, module)?)?;
    module.add_function(wrap_pyfunction!(results::tails, module)?)?;
    module.add_function(wrap_pyfunction!(results::manifest, module)?)?;
    module.add_function(wrap_pyfunction!(results::report, module)?)?;
    module.add_function(wrap_pyfunction!(results::table, module)?)?;
    module.add_function(wrap_pyfunction!(questions::model, module)?)?;
    module.add_function(wrap_pyfunction!(questions::campbell, module)?)?;
    module.add_function(wrap_pyfunction!(questions::merge, module)?)?;
    module.add_function(wrap_pyfunction!(questions::replay, module)?)?;
    module.add_function(wrap_pyfunction!(questions::verify, module)?)?;
    module.add_function(wrap_pyfunction!(questions::repair, module)?)?;
    module.add_function(wrap_pyfunction!(questions::tradeoff, module)?)?;
    module.add_function(wrap_pyfunction!(questions::estimate, module)?)?;
    module.add_function(wrap_pyfunction!(questions::figure_names, module)?)?;
    module.add_function(wrap_pyfunction!(questions::figure, module)?)?;
    module.add_function(wrap_pyfunction!(sector::import_sector, module)?)?;
    module.add_function(wrap_pyfunction!(sector::bundle_facts, module)?)?;
    module.add_function(wrap_pyfunction!(sector::bundle_frequencies, module)?)?;
    Ok(())
}
