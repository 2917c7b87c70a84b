//! The keys of a study file that say what wheels there are, and under which loads.

use serde::{Deserialize, Serialize};

use super::ranges::{MODES, TRUNCATION};
use super::written::NumberOrName;
use crate::input::Value::{Either, List, Name, Number, Table, Text};
use crate::input::{REQUIRED, Range, key, toml_table};
use crate::response::mistuning::Projection;

/// Normal load per sector, N.
pub(in crate::study) const NORMAL_LOAD_N: Range = Range::from_to(0.0, 1e30);
/// Standard deviation of the blades' relative deviation.
pub(in crate::study) const DEVIATION: Range = Range::from_to(0.0, 0.5);

/// What is mistuned.
#[derive(Debug, Clone, Copy, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub(in crate::study) enum MistunedQuantity {
    BladeStiffness,
}

toml_table! {
    /// `[mistuning]`.
    pub(in crate::study) struct MistuningTable {
        quantity: MistunedQuantity = key(Name(&["blade_stiffness"]), "`\"blade_stiffness\"`",
            "a relative deviation delta of the blade's stiffness; the deviation in frequency is about delta/2"),
        projection: Projection = key(Name(&["exact", "cantilever_modes"]), "`\"exact\"`",
            "`cantilever_modes`: the classical component mode mistuning; required for deviations per mode"),
        cantilever_mode_count: usize = key(MODES, "10", "only with `cantilever_modes`"),
        distribution: DistributionTable = key(Table, "required without `mistuning.file`",
            "the law of the deviations").with(DistributionTable::KEYS),
        file: String = key(Text("`.parquet`, or anything else as CSV"), "none",
            "measured wheels instead of a distribution: columns `pattern`, `blade`, `deviation` and optionally `mode`")
            .neutral(),
    }
}

/// Law of the deviations.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub(in crate::study) enum DistributionKind {
    Normal,
    Uniform,
    TruncatedNormal,
}

toml_table! {
    /// `[mistuning.distribution]`.
    pub(in crate::study) struct DistributionTable {
        kind: DistributionKind = key(Name(&["normal", "uniform", "truncated_normal"]), REQUIRED, ""),
        truncation: f64 = key(TRUNCATION, "required for `truncated_normal`",
            "in standard deviations of the normal law before it is cut")
            .and(", in standard deviations of the normal law"),
        standard_deviation: f64 = key(Number(DEVIATION), "in `[sweep]`", "of the law after truncation"),
    }
}

toml_table! {
    /// `[sweep]`.
    pub(in crate::study) struct SweepTable {
        normal_load_n: Vec<NumberOrName> = key(List(&Either(&[Number(NORMAL_LOAD_N), Name(&["stuck", "slide", "free"])])), "required without `contact.normal_load`",
            "N per sector, and the linear limits; only `free` for a model without contact")
            .told("a list of different normal loads per sector: numbers from 0 to 1e30 in N, \"stuck\", \"slide\" or \"free\"; at least one"),
        standard_deviation: Vec<f64> = key(List(&Number(DEVIATION)), "in the distribution",
            "not with `mistuning.file`").told("a list of different numbers from 0 to 0.5, at least one"),
    }
}
