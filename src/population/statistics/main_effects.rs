//! How much of the variance of a result each random input explains by itself, from the rows of a study.
//!
//! Main effect of input X on Y: `S = Var(E[Y | X]) / Var(Y)` (Sobol' 1993). E[Y | X] is taken as constant
//! within classes of equally many rows by rank of X; the share of the variance between classes,
//! corrected for the number of classes (epsilon squared, Kelley 1935),
//!
//! ```text
//! S = 1 - (n - 1) / (n - c) * (sum of squares within classes) / (total sum of squares)
//! ```
//!
//! is unbiased where X has no effect. Bounds: 1.96 standard errors by the jackknife over groups of rows
//! (Efron & Tibshirani 1993, chapter 11).

/// Fewest rows of which main effects are given.
pub const FEWEST_ROWS: usize = 100;
/// Rows of a class: few, so that a class holds a small part of an input's tail.
const ROWS_OF_CLASS: usize = 10;
/// Groups of rows that are left out in turn.
const GROUPS: usize = 20;
/// Standard errors to either bound.
const STANDARD_ERRORS: f64 = 1.96;

/// A share of the variance with its bounds, in `[0, 1]`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VarianceShare {
    /// Estimate.
    pub share: f64,
    /// Lower bound, 95 %.
    pub lower: f64,
    /// Upper bound, 95 %.
    pub upper: f64,
}

/// Main effects of a set of inputs.
#[derive(Debug, Clone, PartialEq)]
pub struct MainEffects {
    /// One per input.
    pub inputs: Vec<VarianceShare>,
    /// What no input explains by itself: the blades, and inputs acting together.
    pub rest: VarianceShare,
}

/// Main effects of `inputs` (each of `n` rows) on `result` (`n` rows); none for fewer than
/// [`FEWEST_ROWS`] rows or a result that does not vary.
#[must_use]
pub fn main_effects(inputs: &[Vec<f64>], result: &[f64]) -> Option<MainEffects> {
    let all: Vec<usize> = (0..result.len()).collect();
    if all.len() < FEWEST_ROWS {
        return None;
    }
    let classes = all.len() / ROWS_OF_CLASS;
    let shares = |rows: &[usize]| -> Option<Vec<f64>> {
        let mut shares: Vec<f64> = inputs
            .iter()
            .map(|input| share(input, result, rows, classes))
            .collect::<Option<_>>()?;
        shares.push(1.0 - shares.iter().sum::<f64>());
        Some(shares)
    };
    let whole = shares(&all)?;
    let without: Vec<Vec<f64>> = (0..GROUPS)
        .map(|group| {
            let others = all.iter().copied().filter(|row| row % GROUPS != group);
            shares(&others.collect::<Vec<_>>())
        })
        .collect::<Option<_>>()?;
    let mut bounded = whole.iter().enumerate().map(|(place, &share)| {
        let groups = GROUPS as f64;
        let mean = without.iter().map(|shares| shares[place]).sum::<f64>() / groups;
        let squares = without.iter().map(|shares| (shares[place] - mean).powi(2));
        let error = ((groups - 1.0) / groups * squares.sum::<f64>()).sqrt();
        let clamped = |value: f64| value.clamp(0.0, 1.0);
        VarianceShare {
            share: clamped(share),
            lower: clamped(share - STANDARD_ERRORS * error),
            upper: clamped(share + STANDARD_ERRORS * error),
        }
    });
    let of_inputs = bounded.by_ref().take(inputs.len()).collect();
    Some(MainEffects {
        inputs: of_inputs,
        rest: bounded.next()?,
    })
}

/// Share of the variance of `result` between classes of `input`, over the given rows.
fn share(input: &[f64], result: &[f64], rows: &[usize], classes: usize) -> Option<f64> {
    let n = rows.len();
    let mut ranked = rows.to_vec();
    ranked.sort_by(|&a, &b| input[a].total_cmp(&input[b]));
    let mean =
        |rows: &[usize]| rows.iter().map(|&row| result[row]).sum::<f64>() / rows.len() as f64;
    let squares = |rows: &[usize]| {
        let mean_of_rows = mean(rows);
        rows.iter()
            .map(|&row| (result[row] - mean_of_rows).powi(2))
            .sum::<f64>()
    };
    let total = squares(&ranked);
    let within: f64 = (0..classes)
        .map(|class| squares(&ranked[class * n / classes..(class + 1) * n / classes]))
        .sum();
    let correction = (n - 1) as f64 / (n - classes) as f64;
    (total > 0.0).then(|| 1.0 - correction * within / total)
}
