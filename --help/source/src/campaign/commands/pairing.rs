//! Which rows of two scenarios belong together: those of the same pattern.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::campaign::store::ResultColumns;
use crate::population::monte_carlo::Scenario;
use crate::population::table::{StoredPatterns, read_patterns};
use crate::study::PipelineError;

/// How two populations belong together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Pairing {
    /// Both populations have the same wheels: pairs.
    SamePatterns,
    /// Both populations have the same blades, each with other random contact: pairs, of different
    /// wheels.
    SameBlades,
    /// Both populations have the same unit draws, at two standard deviations: pairs, of different
    /// wheels.
    SameUnitDraws,
    /// No wheel in common: two independent populations.
    Independent,
}

/// Places of the common patterns in the columns of both sides; all places of both where they are
/// independent.
#[derive(Debug, Clone, PartialEq)]
pub struct PairedPlaces {
    /// How they belong together.
    pub pairing: Pairing,
    /// Places in the columns of the baseline.
    pub baseline: Vec<usize>,
    /// Places in the columns of the candidate.
    pub candidate: Vec<usize>,
}

/// Result folders with what it takes to tell whether their patterns are the same.
pub(super) struct PatternMatcher<'a> {
    folders: &'a [ResultColumns],
    /// Values of the patterns, where `patterns.parquet` has them and more than one folder asks.
    stored: Vec<Option<StoredPatterns>>,
}

impl<'a> PatternMatcher<'a> {
    pub(super) fn new(folders: &'a [ResultColumns]) -> Result<Self, PipelineError> {
        let stored = |columns: &ResultColumns| -> Result<_, PipelineError> {
            let path = columns.folder.join("patterns.parquet");
            let wanted =
                folders.len() > 1 && columns.manifest.tables.contains_key("patterns.parquet");
            Ok(if wanted {
                Some(read_patterns(&path)?)
            } else {
                None
            })
        };
        Ok(Self {
            folders,
            stored: folders.iter().map(stored).collect::<Result<_, _>>()?,
        })
    }

    /// Pairs the rows of a scenario of folder `a` with those of a scenario of folder `b`: the same id
    /// and the same deviations. Within a folder these follow from the id; between folders they are
    /// compared value by value where both hold `patterns.parquet`, otherwise the keys that they
    /// follow from. Random contact is always compared by the keys that it follows from.
    pub(super) fn pair(
        &self,
        (a, baseline): (usize, &Scenario),
        (b, candidate): (usize, &Scenario),
    ) -> PairedPlaces {
        let (left, right) = (&self.folders[a], &self.folders[b]);
        let same_deviation = baseline.standard_deviation == candidate.standard_deviation;
        let same_values = |id: u32| match (&self.stored[a], &self.stored[b]) {
            (Some(ours), Some(theirs)) if same_deviation => {
                let key = (baseline.standard_deviation.map(f64::to_bits), id);
                ours.get(&key).is_some() && ours.get(&key) == theirs.get(&key)
            }
            _ => follow_from_the_same(left, right),
        };
        let places: BTreeMap<u32, usize> = right.patterns.iter().copied().zip(0..).collect();
        let (mut ours, mut theirs) = (Vec::new(), Vec::new());
        for (place, id) in left.patterns.iter().enumerate() {
            if let Some(&other) = places.get(id)
                && (a == b || same_values(*id))
            {
                ours.push(place);
                theirs.push(other);
            }
        }
        if ours.is_empty() {
            return PairedPlaces {
                pairing: Pairing::Independent,
                baseline: (0..left.patterns.len()).collect(),
                candidate: (0..right.patterns.len()).collect(),
            };
        }
        PairedPlaces {
            pairing: if !same_deviation {
                Pairing::SameUnitDraws
            } else if a == b || same_contact_factors(left, right) {
                Pairing::SamePatterns
            } else {
                Pairing::SameBlades
            },
            baseline: ours,
            candidate: theirs,
        }
    }
}

/// Whether the blades of two folders follow from the same seed, law or file, and wheel.
pub(super) fn follow_from_the_same(a: &ResultColumns, b: &ResultColumns) -> bool {
    let prefixes = [
        "study.seed",
        "mistuning.",
        "input mistuning.",
        "model",
        "input model",
    ];
    same_keys(a, b, &prefixes)
}

/// Whether the contact of the same blades is the same in two folders: it does not vary, or its factors
/// follow from the same seed, laws and wheel.
pub(super) fn same_contact_factors(a: &ResultColumns, b: &ResultColumns) -> bool {
    const LAWS: &str = "contact.variation.";
    let varies = |columns: &ResultColumns| {
        let mut keys = columns.manifest.number_keys.keys();
        keys.any(|key| key.starts_with(LAWS))
    };
    (!varies(a) && !varies(b)) || same_keys(a, b, &[LAWS, "study.seed", "model", "input model"])
}

/// Whether all keys with these beginnings are the same, and the generator.
fn same_keys(a: &ResultColumns, b: &ResultColumns, prefixes: &[&str]) -> bool {
    let decisive = |columns: &ResultColumns| -> BTreeMap<String, String> {
        let keys = columns.manifest.number_keys.iter();
        keys.filter(|(key, _)| prefixes.iter().any(|prefix| key.starts_with(prefix)))
            .map(|(key, value)| (key.clone(), value.clone()))
            .collect()
    };
    a.manifest.generator == b.manifest.generator && decisive(a) == decisive(b)
}
