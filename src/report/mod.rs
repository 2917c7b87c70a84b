//! The numbers of a report as one struct, warnings with advice, and the summary as text.

mod comparison;
mod comparison_text;
mod estimate;
mod model_report;
mod numerical_error;
mod optimum;
mod peak_audit;
mod plan;
mod summary;
mod summary_text;
mod tail_report;
mod text_table;
mod time_domain;
mod tradeoff;
mod verification;
mod warning;

pub use comparison::{
    BestLoads, ComparedFolder, ComparedScenario, ComparisonReport, LoadOfSet, QuantityComparison,
    ScenarioComparison,
};
pub use estimate::{EstimateReport, QuantityEstimate, ScenarioEstimate};
pub use model_report::{ModelReport, NodalDiameterFacts};
pub use numerical_error::{NumericalError, NumericalFinding};
pub use optimum::OptimumReport;
pub use peak_audit::PeakAuditReport;
pub use plan::{PlannedDisk, PlannedLook, PlannedPercentile, PlannedStop, PlannedTime, StudyPlan};
pub use summary::{BasisSummary, BestLoad, ScenarioSummary, StudySummary, SummaryContext};
pub use tail_report::StatisticsReport;
pub use time_domain::{StepReport, TimeDomainReport};
pub use tradeoff::{FullContactCheck, TradeoffChoice, TradeoffReference, TradeoffReport};
pub use verification::{ErrorDistribution, RegimeErrors, VerificationContext, VerificationReport};
pub use warning::Warning;
