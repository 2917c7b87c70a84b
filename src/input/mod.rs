//! The files that a user writes in TOML: which keys they may have, where each stands, and what is wrong with it.

mod check;
mod finding;
mod glossary;
mod key;
mod schema;
mod source_map;
mod table;
mod terms;
mod value;

pub(crate) use check::check;
pub(crate) use finding::listed;
pub use finding::{Excerpt, Finding, Problem};
pub use glossary::plain;
pub(crate) use key::{Effect, Entry, REQUIRED, all_keys, entry, key, misspelling, table};
pub use key::{KeySpec, nearest_key_names};
pub(crate) use schema::schema_of;
pub(crate) use source_map::{SourceMap, nearest};
pub(crate) use table::toml_table;
pub(crate) use terms::mentions;
pub use terms::{Term, names_of_terms, term_of, terms_about, warnings_about};
pub use value::{Range, Value};
