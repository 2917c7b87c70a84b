//! Which rows of a scenario are looked at for their stability, and what was found.

use serde::{Deserialize, Serialize};

/// What is known of the stability of the motions of a scenario.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct ScenarioStability {
    /// Whether the tuned wheel stays on its motion; none: not settled.
    pub tuned: Option<bool>,
    /// Rows looked at.
    pub rows: u64,
    /// Rows looked at that stay on their motion.
    pub stable: u64,
    /// Rows looked at that leave their motion.
    pub unstable: u64,
}

impl ScenarioStability {
    /// Of a scenario whose tuned wheel has been looked at.
    #[must_use]
    pub fn of_tuned(tuned: Option<bool>) -> Self {
        Self {
            tuned,
            rows: 0,
            stable: 0,
            unstable: 0,
        }
    }

    /// Takes a row that has been looked at.
    pub fn add(&mut self, stable: Option<bool>) {
        self.rows += 1;
        self.stable += u64::from(stable == Some(true));
        self.unstable += u64::from(stable == Some(false));
    }
}

/// The `count` rows nearest to each of the values `wanted`, as places in `rows`, ascending; every row has an amplitude and the id
/// of its pattern. Of two that are as near that of the lower id is taken.
#[must_use]
pub fn nearest_rows(rows: &[(f64, u32)], wanted: &[f64], count: usize) -> Vec<usize> {
    let mut places: Vec<usize> = Vec::new();
    for &value in wanted {
        let mut order: Vec<usize> = (0..rows.len()).collect();
        order.sort_unstable_by(|&a, &b| {
            let away = |place: usize| (rows[place].0 - value).abs();
            let nearer = away(a).total_cmp(&away(b));
            nearer.then(rows[a].1.cmp(&rows[b].1))
        });
        places.extend(order.into_iter().take(count));
    }
    places.sort_unstable();
    places.dedup();
    places
}

#[cfg(test)]
mod tests {
    use super::nearest_rows;

    #[test]
    fn the_nearest_rows_of_every_value_are_taken_once() {
        let rows = [(1.0, 4), (3.0, 0), (2.0, 1), (4.0, 2), (2.0, 3)];
        assert_eq!(nearest_rows(&rows, &[2.9], 2), [1, 2]);
        assert_eq!(nearest_rows(&rows, &[2.0, 3.9], 2), [1, 2, 3, 4]);
        assert_eq!(nearest_rows(&rows, &[1.0], 9), [0, 1, 2, 3, 4]);
        assert!(nearest_rows(&rows, &[1.0], 0).is_empty());
        // 1 and 3 are as far from 2 as each other: pattern 0 comes first.
        assert_eq!(nearest_rows(&rows, &[2.0], 3), [1, 2, 4]);
    }
}
