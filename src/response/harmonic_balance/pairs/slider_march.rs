//! Sliders under constant limits marched side by side, a vector lane each.

#![expect(
    clippy::inline_always,
    reason = "only what is inlined is compiled for vectors"
)]

use super::lanes::{LANES, clip, lanes_at, larger, smaller};
use crate::linalg::Loops;

/// The chains of clips of all lanes: a period, from which on they are periodic, and the samples looked at.
pub(super) struct SliderMarch<'a> {
    pub(super) lanes: usize,
    /// Times that the samples make up a period.
    pub(super) periods: usize,
    pub(super) then: f64,
    pub(super) limit: &'a [f64],
    pub(super) elastic: &'a [f64],
    pub(super) offset: &'a mut [f64],
    pub(super) least: &'a mut [f64],
    pub(super) most: &'a mut [f64],
}

impl Loops for SliderMarch<'_> {
    type Output = ();

    /// Several blocks at a time: a clip waits for the one before it.
    #[inline(always)]
    fn call(mut self) {
        let mut first = 0;
        while first < self.lanes {
            first += match (self.lanes - first) / LANES {
                1 => self.blocks::<1>(first),
                2 => self.blocks::<2>(first),
                _ => self.blocks::<3>(first),
            };
        }
    }
}

impl SliderMarch<'_> {
    /// The blocks from lane `first` on; returns their lanes.
    #[inline(always)]
    fn blocks<const BLOCKS: usize>(&mut self, first: usize) -> usize {
        let place = |block: usize| first + block * LANES;
        let limit: [_; BLOCKS] = std::array::from_fn(|block| lanes_at(self.limit, place(block)));
        let mut least = [[f64::INFINITY; LANES]; BLOCKS];
        let mut most = [[f64::NEG_INFINITY; LANES]; BLOCKS];
        let mut y = [[0.0; LANES]; BLOCKS];
        for period in 0..self.periods {
            for elastic in self.elastic.chunks_exact(self.lanes) {
                for block in 0..BLOCKS {
                    let elastic = lanes_at(elastic, place(block));
                    for lane in 0..LANES {
                        if period == 0 {
                            least[block][lane] = smaller(elastic[lane], least[block][lane]);
                            most[block][lane] = larger(elastic[lane], most[block][lane]);
                        }
                        y[block][lane] = clip(y[block][lane], limit[block][lane], elastic[lane]);
                    }
                }
            }
            y = y.map(|y| y.map(|y| self.then * y));
        }
        for (elastic, offset) in self
            .elastic
            .chunks_exact(self.lanes)
            .zip(self.offset.chunks_exact_mut(self.lanes))
        {
            for block in 0..BLOCKS {
                let elastic = lanes_at(elastic, place(block));
                for lane in 0..LANES {
                    y[block][lane] = clip(y[block][lane], limit[block][lane], elastic[lane]);
                }
                offset[place(block)..place(block) + LANES].copy_from_slice(&y[block]);
            }
        }
        for block in 0..BLOCKS {
            for lane in 0..LANES {
                let (low, high) = (least[block][lane], most[block][lane]);
                let half = self.then < 0.0;
                self.least[place(block) + lane] = if half { smaller(low, -high) } else { low };
                self.most[place(block) + lane] = if half { larger(high, -low) } else { high };
            }
        }
        BLOCKS * LANES
    }
}

#[cfg(test)]
mod tests {
    use super::SliderMarch;
    use crate::linalg::vectorized;

    /// Blocks by themselves, in twos, in threes, and what is left of them.
    #[test]
    fn any_number_of_lanes_is_marched_like_one_slider_after_another() {
        const SAMPLES: usize = 30;
        for (lanes, then) in (0..6).flat_map(|blocks| [(8 * blocks, 1.0), (8 * blocks, -1.0)]) {
            let number = |i: usize| (0.9 * i as f64 + (i * i) as f64 * 0.37).sin();
            let elastic: Vec<f64> = (0..lanes * SAMPLES).map(number).collect();
            let limit: Vec<f64> = (0..lanes).map(|i| 0.1 + number(i).abs()).collect();
            let mut offset = vec![0.0; lanes * SAMPLES];
            let [mut least, mut most] = [vec![0.0; lanes], vec![0.0; lanes]];
            vectorized(SliderMarch {
                lanes,
                periods: if then < 0.0 { 2 } else { 1 },
                then,
                limit: &limit,
                elastic: &elastic,
                offset: &mut offset,
                least: &mut least,
                most: &mut most,
            });
            for lane in 0..lanes {
                let history: Vec<f64> = (0..SAMPLES).map(|j| elastic[j * lanes + lane]).collect();
                let before = history.iter().map(|x| then * x);
                let period: Vec<f64> = history.iter().copied().chain(before).collect();
                let whole = if then < 0.0 {
                    &period[..]
                } else {
                    &history[..]
                };
                let mut y = 0.0_f64;
                for x in whole {
                    y = y.max(-limit[lane] - x).min(limit[lane] - x);
                }
                let expected = history.iter().map(|x| {
                    y = y.max(-limit[lane] - x).min(limit[lane] - x);
                    y
                });
                let found = (0..SAMPLES).map(|j| offset[j * lanes + lane]);
                assert!(expected.eq(found), "{lanes} lanes, {lane}");
                let largest = whole.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                let smallest = whole.iter().copied().fold(f64::INFINITY, f64::min);
                assert!(largest.total_cmp(&most[lane]).is_eq());
                assert!(smallest.total_cmp(&least[lane]).is_eq());
            }
        }
    }
}
