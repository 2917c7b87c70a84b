//! How the patterns of a study are cut into blocks, the unit of work that survives an interruption.

use std::collections::BTreeSet;

/// Consecutive patterns that are solved and stored together.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PatternBlock {
    /// Place of the first pattern in the ascending list of all ids; names the block.
    pub index: usize,
    /// Ids of the patterns, ascending and neighbours in the list of all ids.
    pub patterns: Vec<u32>,
}

/// Blocks of at most `size` patterns that cover every id of `ids` (ascending) that is not `done`.
///
/// Results never depend on the cut; it only decides how much work an interruption costs.
#[must_use]
pub fn plan_blocks(ids: &[u32], done: &BTreeSet<u32>, size: usize) -> Vec<PatternBlock> {
    let mut blocks: Vec<PatternBlock> = Vec::new();
    let mut open = false;
    for (index, &id) in ids.iter().enumerate() {
        if done.contains(&id) {
            open = false;
            continue;
        }
        match blocks.last_mut() {
            Some(block) if open && block.patterns.len() < size => block.patterns.push(id),
            _ => blocks.push(PatternBlock {
                index,
                patterns: vec![id],
            }),
        }
        open = true;
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
    use super::{block_size, plan_blocks};

    #[test]
    fn blocks_cover_what_is_not_done_without_spanning_a_gap() {
        let ids = [0, 1, 2, 3, 4, 5, 6, 7];
        let blocks = plan_blocks(&ids, &[2].into(), 3);
        let cut: Vec<_> = blocks
            .iter()
            .map(|block| (block.index, block.patterns.clone()))
            .collect();
        assert_eq!(cut, [(0, vec![0, 1]), (3, vec![3, 4, 5]), (6, vec![6, 7])]);
    }

    #[test]
    fn block_size_stays_within_its_bounds() {
        assert_eq!(
            [1, 200, 20_000, 10_000_000].map(block_size),
            [8, 8, 32, 1024]
        );
    }
}
