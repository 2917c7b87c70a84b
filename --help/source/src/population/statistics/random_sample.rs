//! Random samples of delivered rows, and of the patterns of a file.

use std::collections::BTreeSet;

use chacha20::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

/// Stream of a sample of rows, apart from those of the patterns.
const SAMPLE_STREAM: u64 = u64::MAX;

/// `count` different places of `0..rows`, ascending, each set of them as likely as any other (Floyd 1987).
pub(crate) fn draw(rows: usize, count: usize, seed: u64) -> Vec<usize> {
    draw_in(SAMPLE_STREAM, rows, count, seed)
}

/// Such places from a stream of their own.
pub(crate) fn draw_in(stream: u64, rows: usize, count: usize, seed: u64) -> Vec<usize> {
    let mut generator = ChaCha8Rng::seed_from_u64(seed);
    generator.set_stream(stream);
    let mut places = BTreeSet::new();
    for last in rows - count.min(rows)..rows {
        let place = generator.random_range(0..=last as u64) as usize;
        if !places.insert(place) {
            places.insert(last);
        }
    }
    places.into_iter().collect()
}

#[cfg(test)]
mod tests {
    use super::draw;

    #[test]
    fn a_sample_is_without_repeats_and_depends_on_its_seed_alone() {
        let sample = draw(1000, 20, 7);
        assert_eq!(sample.len(), 20);
        assert!(sample.windows(2).all(|pair| pair[0] < pair[1]) && sample[19] < 1000);
        assert_eq!(sample, draw(1000, 20, 7));
        assert_ne!(sample, draw(1000, 20, 8));
        assert_eq!(draw(3, 20, 7), [0, 1, 2]);
        assert!(draw(0, 5, 7).is_empty());
    }

    #[test]
    fn every_row_is_as_likely_as_any_other() {
        let mut counts = [0_u32; 10];
        for seed in 0..2000 {
            for place in draw(10, 3, seed) {
                counts[place] += 1;
            }
        }
        // 600 expected of each, standard deviation 20.5.
        assert!(
            counts.iter().all(|&count| count.abs_diff(600) < 100),
            "{counts:?}"
        );
    }
}
