//! Accounting by status, moments, order statistics with distribution-free intervals, tail fits.

mod accounting;
mod beta_law;
mod binomial;
mod comparison;
mod distribution_band;
mod error_bound;
mod extreme_value;
mod extreme_value_fit;
mod joint_law;
mod main_effects;
mod multiplicity;
mod order_statistics;
mod pairs;
mod percentile_resamples;
mod pilot;
mod quantity;
mod random_sample;
mod resampling;
mod sample;
mod scenario;
mod stability;
mod stopping;
mod surrogate_worth;
mod tail_fit;
mod two_phase_design;
mod two_phase_estimate;

pub use accounting::Accounting;
pub use binomial::{CONFIDENCE, proportion_interval, proportion_upper_bound};
pub use comparison::{
    Expansion, IntervalEstimate, PercentileComparison, compare_independent, compare_paired,
};
pub use distribution_band::{BandPoint, DistributionBand, dkw_half_width};
pub use error_bound::{ErrorBound, LoadCaseErrors};
pub use extreme_value::{ExtremeValueLaw, anderson_darling};
pub use extreme_value_fit::{FEWEST_VALUES, FitStatus, SHAPE_RANGE, fit_extreme_value, fit_gumbel};
pub use main_effects::{FEWEST_ROWS, MainEffects, VarianceShare, main_effects};
pub use multiplicity::{best_set, best_set_at, holm, holm_with_origins};
pub use order_statistics::{
    Percentile, PercentileRanks, PointStatus, failure_gate, percentile, percentile_at,
    percentile_ranks, percentile_ranks_at, point_rank, smallest_sample, wilks_sample,
};
pub use pairs::{Deterioration, PairFacts};
pub use percentile_resamples::{PercentileEstimator, PercentileResamples, resample_percentile};
pub use pilot::{ExpectedSum, expected_relative_width, expected_sum};
pub use quantity::Quantity;
pub(crate) use random_sample::{draw, draw_in};
pub use resampling::{RESAMPLES, resampling_stream};
pub use sample::{PERCENTILE_LEVELS, PERCENTILES, SampleStatistics};
pub use scenario::{ScenarioAccumulator, ScenarioStatistics};
pub use stability::{ScenarioStability, nearest_rows};
pub use stopping::{
    Look, MOST_LOOKS, ScenarioLook, StopOptions, StopOutcome, StoppingRule, StudyLook,
};
pub use surrogate_worth::SurrogateWorth;
pub use tail_fit::{
    Estimate, MOST_RESAMPLED, TAIL_PERCENTILES, TailFit, TailLaw, TailParameters, TailPercentile,
    fit_tails,
};
pub use two_phase_design::{Allocation, EstimateTarget, Population, SamplingMethod, pilot_places};
pub use two_phase_estimate::{MeanEstimate, StratumSample, TwoPhasePercentile, TwoPhaseSample};
