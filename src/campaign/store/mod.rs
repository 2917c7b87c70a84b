//! A results folder: its lock, whether it is of this study, what stands in it, and whether it is whole.

mod checked_table;
mod folder_status;
mod folders_inside;
mod integrity;
mod lock;
mod result_columns;
mod results_folder;
mod stored_study;
mod summary;
mod superseded;

pub use checked_table::checked_table;
pub use folder_status::{FolderStatus, Work, status_of_folder};
pub(super) use folders_inside::{folder_of_shard, folders_of_loads, shard_folders};
pub(super) use integrity::damaged_entries;
pub use integrity::{CheckedFile, FileState, Integrity, integrity};
pub use lock::LockHolder;
pub(super) use lock::{FolderLock, unix_seconds};
pub(super) use result_columns::sorted_values;
pub use result_columns::{ResultColumns, ScenarioColumns};
pub(super) use results_folder::{
    Found, GROWING, RESPONSES, ResultsFolder, changed_tables, continued, finished_rows,
    is_complete, manifest_lost, verify_tables,
};
pub(super) use stored_study::study_of;
pub use stored_study::{StoredModel, StoredStudy};
pub use summary::{PartialSummary, summarise, summarise_partly};
pub(super) use summary::{context_of, records_of, summary_of_rows};
pub use superseded::set_other_builds_aside;
