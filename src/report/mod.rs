//! The numbers of a report as one struct, warnings with advice, and the summary as text.

mod accuracy_trials;
mod answers;
mod campbell;
mod comparison;
mod comparison_text;
mod cost;
mod estimate;
mod figures;
mod html;
mod model_report;
mod model_section;
mod numerical_error;
mod optimum;
mod peak_audit;
mod plan;
mod plot;
mod rotation;
mod stated_errors;
mod statistics_csv;
mod study_echo;
mod study_report;
mod summary;
mod summary_text;
mod tail_report;
mod text_table;
mod time_domain;
mod tradeoff;
mod verification;
mod visible;
mod warning;
mod wheel_report;
mod words;

pub use accuracy_trials::{AccuracyTrial, AccuracyTrials};
pub use answers::{Answer, answers};
pub use campbell::{CampbellCrossing, CampbellMode, CampbellReport};
pub use comparison::{
    BaselineChoice, BestLoads, ComparedFolder, ComparedScenario, ComparisonReport, LoadOfSet,
    QuantityComparison, ScenarioComparison,
};
pub use cost::{ExpectedCost, ExpectedTime};
pub use estimate::{EstimateReport, QuantityEstimate, ScenarioEstimate};
pub use figures::{DiagramRange, FIGURES, Figure, FigureName, diagram_of_model, figure, missing};
pub use html::html_report;
pub use model_report::{ModelReport, NodalDiameterFacts};
pub use model_section::{
    BodyMass, ContactFacts, ContactPlace, ModelSection, PictureNode, SectorPicture, ShownModel,
};
pub use numerical_error::{NumericalError, NumericalFinding, RowTolerance};
pub use optimum::{OptimumExcitation, OptimumReport};
pub use peak_audit::PeakAuditReport;
pub use plan::{
    PlannedDisk, PlannedLook, PlannedPercentile, PlannedRest, PlannedStop, PlannedTime, StudyPlan,
};
pub use rotation::RotationFacts;
pub use stated_errors::{CommonErrors, ErrorRows, ErrorSpread, PercentileError, StatedErrors};
pub use statistics_csv::statistics_csv;
pub use study_echo::{EchoedExcitation, EchoedLoad, EchoedModel, Remark, StudyEcho, Travel};
pub use study_report::{
    DistributionReport, GroupReport, LoadChoice, MeasuredPeak, Provenance, ScenarioErrors,
    StudyReport, Wheels, setting,
};
pub use summary::{BasisSummary, BestLoad, ScenarioSummary, StudySummary, SummaryContext};
pub use tail_report::StatisticsReport;
pub use time_domain::{StepReport, TimeDomainReport};
pub use tradeoff::{FullContactCheck, TradeoffChoice, TradeoffReference, TradeoffReport};
pub use verification::{ErrorDistribution, RegimeErrors, VerificationContext, VerificationReport};
pub use visible::{is_order, visible, with_orders_escaped};
pub use warning::{MOST_WHEELS_NAMED, Warning};
pub use wheel_report::{PairReport, ResponseCurve, WheelCurves, WheelReport, WheelStateReport};
pub use words::LengthUnit;
pub(crate) use words::{basis_words, duration, excitation, short_load_with_unit};
