//! Many comparisons at once: adjusted probabilities, and which of several could be the best.

use super::CONFIDENCE;
use super::percentile_resamples::PercentileResamples;

/// Probabilities adjusted by the method of Holm (1979): rejecting those below 0.05 makes a false
/// rejection among all of them no more likely than 5 %. Comparisons without a probability stay without.
#[must_use]
pub fn holm(p_values: &[Option<f64>]) -> Vec<Option<f64>> {
    let adjusted = holm_with_origins(p_values).into_iter();
    adjusted
        .map(|adjusted| adjusted.map(|(value, _)| value))
        .collect()
}

/// Probabilities adjusted by the method of Holm, each with the place of the probability that it is a
/// multiple of: its own, or a smaller one.
#[must_use]
pub fn holm_with_origins(p_values: &[Option<f64>]) -> Vec<Option<(f64, usize)>> {
    let mut order: Vec<usize> = (0..p_values.len())
        .filter(|&place| p_values[place].is_some())
        .collect();
    let value = |place: usize| p_values[place].unwrap_or(1.0);
    order.sort_by(|&a, &b| value(a).total_cmp(&value(b)));
    let mut adjusted = vec![None; p_values.len()];
    let mut largest = (0.0, 0);
    for (step, &place) in order.iter().enumerate() {
        let factor = (order.len() - step) as f64;
        let value_of_step = (factor * value(place)).min(1.0);
        if step == 0 || value_of_step > largest.0 {
            largest = (value_of_step, place);
        }
        adjusted[place] = Some(largest);
    }
    adjusted
}

/// Which of several percentiles over the same patterns could be the lowest, at [`CONFIDENCE`].
#[must_use]
pub fn best_set(columns: &[PercentileResamples]) -> Vec<bool> {
    best_set_at(columns, CONFIDENCE)
}

/// Which of several percentiles over the same patterns could be the lowest, at `confidence`: the truly
/// lowest is in the set with at least this probability, however many there are (inversion of one-sided
/// tests against the largest of all studentised differences; Mogstad, Romano, Shaikh & Wilhelm 2024,
/// section 3). Failed rows stand at minus infinity in the one that is judged and at plus infinity in
/// those that it is compared with.
#[must_use]
pub fn best_set_at(columns: &[PercentileResamples], confidence: f64) -> Vec<bool> {
    (0..columns.len())
        .map(|judged| !is_worse(columns, judged, confidence))
        .collect()
}

fn is_worse(columns: &[PercentileResamples], judged: usize, confidence: f64) -> bool {
    let column = &columns[judged];
    let count = column.low_resamples.len();
    let mut statistic = f64::NEG_INFINITY;
    let mut largest = vec![f64::NEG_INFINITY; count];
    for (place, other) in columns.iter().enumerate() {
        if place == judged {
            continue;
        }
        let difference = column.low - other.high;
        let resampled: Vec<f64> = column
            .low_resamples
            .iter()
            .zip(&other.high_resamples)
            .map(|(low, high)| low - high)
            .collect();
        let mean = resampled.iter().sum::<f64>() / count as f64;
        let squares: f64 = resampled.iter().map(|value| (value - mean).powi(2)).sum();
        let deviation = (squares / count as f64).sqrt();
        // Without a finite difference the failed rows leave it open, without a spread they are equal.
        if !deviation.is_finite() || deviation <= 0.0 || !difference.is_finite() {
            if difference > 0.0 && deviation == 0.0 {
                return true;
            }
            continue;
        }
        statistic = statistic.max(difference / deviation);
        for (largest, value) in largest.iter_mut().zip(&resampled) {
            *largest = largest.max((value - difference) / deviation);
        }
    }
    largest.sort_unstable_by(f64::total_cmp);
    let rank = (confidence * (count as f64 + 1.0)).ceil() as usize;
    largest
        .get(rank.min(count).saturating_sub(1))
        .is_some_and(|&limit| statistic > limit)
}
