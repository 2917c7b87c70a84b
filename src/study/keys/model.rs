//! The keys of a study file that say where the sector comes from.

use serde::{Deserialize, Serialize};

use super::model_options::{LUMPED_KEYS, PARAMETRIC_KEYS};
use crate::input::Value::{Name, Text};
use crate::input::{Entry, REQUIRED, key, table, toml_table};
use crate::model::sector::{LumpedOptions, ParametricOptions};

/// Where the sector comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub(in crate::study) enum ModelKind {
    Parametric,
    Lumped,
    Bundle,
}

toml_table! {
    /// `[model]`, with its keys in the order of messages.
    pub(in crate::study) struct ModelTable {
        source: ModelKind = key(Name(&["parametric", "lumped", "bundle"]), REQUIRED,
            "only the table of that source may be present"),
        parametric: ParametricOptions = table("the built-in bladed disk", PARAMETRIC_KEYS),
        lumped: LumpedOptions = table("masses and springs", LUMPED_KEYS),
        bundle: BundleTable = table(
            "a sector bundle ([sector-bundle.md](sector-bundle.md))", BundleTable::KEYS),
    }
}

/// The keys of `[model]` in the order of pages: the shortest table first.
pub(super) const MODEL_KEYS: &[Entry] = {
    const KEYS: &[Entry] = ModelTable::KEYS;
    &[KEYS[0], KEYS[3], KEYS[2], KEYS[1]]
};

toml_table! {
    /// `[model.bundle]`.
    pub(in crate::study) struct BundleTable {
        path: String = key(Text("a folder"), REQUIRED,
            "folder of a sector bundle, relative to the study file").neutral(),
    }
}
