//! What of a study is stored, and how the rest is cut into blocks, the unit that is stored.

use std::collections::{BTreeMap, BTreeSet};

/// Neighbouring patterns that are solved under the same scenarios and stored together.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PatternBlock {
    /// Ids of the patterns, ascending.
    pub patterns: Vec<u32>,
    /// Indices of the scenarios, ascending.
    pub scenarios: Vec<usize>,
}

/// Scenarios that are stored of each pattern.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StoredRows {
    /// The different sets of scenarios that occur; the first is empty.
    sets: Vec<BTreeSet<usize>>,
    /// Index into `sets`; a pattern that is not here has nothing stored.
    of_pattern: BTreeMap<u32, usize>,
}

impl Default for StoredRows {
    fn default() -> Self {
        Self {
            sets: vec![BTreeSet::new()],
            of_pattern: BTreeMap::new(),
        }
    }
}

impl StoredRows {
    /// The rows of `scenarios` of every pattern of `patterns` are stored.
    pub fn add(&mut self, patterns: impl IntoIterator<Item = u32>, scenarios: &[usize]) {
        // Few different sets occur, so that each is joined with `scenarios` once.
        let mut joined: BTreeMap<usize, usize> = BTreeMap::new();
        for pattern in patterns {
            let before = self.of_pattern.get(&pattern).copied().unwrap_or(0);
            let after = *joined.entry(before).or_insert_with(|| {
                let mut set = self.sets[before].clone();
                set.extend(scenarios);
                let known = self.sets.iter().position(|known| *known == set);
                known.unwrap_or_else(|| {
                    self.sets.push(set);
                    self.sets.len() - 1
                })
            });
            self.of_pattern.insert(pattern, after);
        }
    }

    /// Rows stored of the patterns `ids`.
    #[must_use]
    pub fn count(&self, ids: &[u32]) -> u64 {
        ids.iter()
            .map(|&id| self.sets[self.set_of(id)].len() as u64)
            .sum()
    }

    fn set_of(&self, pattern: u32) -> usize {
        self.of_pattern.get(&pattern).copied().unwrap_or(0)
    }
}

/// Blocks of at most `size` patterns of `ids` (ascending) that cover every row of `scenarios`
/// scenarios that is not stored.
///
/// Results never depend on the cut; it only decides how much work an interruption costs.
#[must_use]
pub fn plan_blocks(
    ids: &[u32],
    stored: &StoredRows,
    scenarios: usize,
    size: usize,
) -> Vec<PatternBlock> {
    let mut blocks: Vec<PatternBlock> = Vec::new();
    let mut open = None;
    for &id in ids {
        let set = stored.set_of(id);
        match blocks.last_mut() {
            Some(block) if open == Some(set) && block.patterns.len() < size => {
                block.patterns.push(id);
            }
            _ if stored.sets[set].len() == scenarios => {}
            _ => blocks.push(PatternBlock {
                patterns: vec![id],
                scenarios: (0..scenarios)
                    .filter(|scenario| !stored.sets[set].contains(scenario))
                    .collect(),
            }),
        }
        open = (stored.sets[set].len() < scenarios).then_some(set);
    }
    blocks
}

/// Patterns per block for a study of `patterns`: about 1024 blocks, between 8 and 1024 patterns each.
#[must_use]
pub fn block_size(patterns: usize) -> usize {
    (patterns / 1024).next_power_of_two().clamp(8, 1024)
}

#[cfg(test)]
mod tests {
    use super::{StoredRows, block_size, plan_blocks};

    #[test]
    fn blocks_cover_what_is_not_stored_without_spanning_a_gap() {
        let ids = [0, 1, 2, 3, 4, 5, 6, 7, 8];
        let mut stored = StoredRows::default();
        stored.add([2], &[0, 1]);
        stored.add([7, 8], &[1]);
        let cut: Vec<_> = plan_blocks(&ids, &stored, 2, 3)
            .into_iter()
            .map(|block| (block.patterns, block.scenarios))
            .collect();
        let expected = [
            (vec![0, 1], vec![0, 1]),
            (vec![3, 4, 5], vec![0, 1]),
            (vec![6], vec![0, 1]),
            (vec![7, 8], vec![0]),
        ];
        assert_eq!(cut, expected);
        assert_eq!(stored.count(&ids), 4);
        stored.add(ids, &[0, 1]);
        assert!(plan_blocks(&ids, &stored, 2, 3).is_empty());
    }

    #[test]
    fn block_size_stays_within_its_bounds() {
        assert_eq!(
            [1, 200, 20_000, 10_000_000].map(block_size),
            [8, 8, 32, 1024]
        );
    }
}
