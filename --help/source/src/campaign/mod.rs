//! A study carried out: the run, what it stores, and the work of every command.

mod commands;
mod pipeline;
mod store;

pub use commands::{
    CampbellRequest, CompareRequest, CurveRequest, EstimateRequest, OptimumRequest, PairedPlaces,
    Pairing, PlanRequest, Repair, Replay, ReplayRequest, ReportRequest, TimeDomainRequest,
    TracedCurve, TracedFold, TradeoffRequest, VerifyRequest, audit_peaks, campbell, compare,
    estimate, find_optimum, fit_result_tails, full_response_curve, merge, plan, repair, replay,
    report, response_curve, traced_response, tradeoff, verify, verify_in_time,
};
pub use pipeline::{RunOutcome, RunRequest, can_be_cut, is_shard_of, run, run_shard};
pub use store::{
    CheckedFile, FileState, FolderStatus, Integrity, LockHolder, PartialSummary, ResultColumns,
    ScenarioColumns, StoredModel, StoredStudy, Work, checked_table, integrity,
    set_other_builds_aside, status_of_folder, summarise, summarise_partly,
};
