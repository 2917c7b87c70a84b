//! The keys of a study file: its root, what it says of itself, and its tables.

use super::contact::ContactTable;
use super::excitation::ExcitationTable;
use super::mistuning::{MistuningTable, SweepTable};
use super::model::{MODEL_KEYS, ModelTable};
use super::reduction::ReductionTable;
use super::solver::{AccuracyTable, OutputTable, SolverTable, StopTable};
use super::structure::{DampingTable, NodalDiameterDampingTable};
use crate::input::Value::{Table, Text, Whole};
use crate::input::{REQUIRED, key, table, toml_table};

/// Version of the study file.
pub(in crate::study) const SCHEMA: u64 = 1;

toml_table! {
    /// A study file.
    pub(in crate::study) struct StudyFile {
        schema: u64 = key(Whole(1, 1), REQUIRED, "version of the study file").told("1"),
        study: HeadTable = key(Table, REQUIRED, "what the study is").with(HeadTable::KEYS),
        model: ModelTable = key(Table, REQUIRED, "where the sector comes from").with(MODEL_KEYS),
        reduction: ReductionTable = table("the reduced model", ReductionTable::KEYS),
        contact: ContactTable = table(
            "the contacts of the damper: with ring or damper body, of neighbouring blades, or with the ground", ContactTable::KEYS),
        damping: DampingTable = key(Table, REQUIRED,
            "exactly one model of damping of the structure").with(DampingTable::KEYS),
        nodal_diameter_damping: NodalDiameterDampingTable = table(
            "damping of the tuned modes by nodal diameter, besides", NodalDiameterDampingTable::KEYS),
        excitation: ExcitationTable = key(Table, REQUIRED, "the rotating force").with(ExcitationTable::KEYS),
        mistuning: MistuningTable = key(Table, REQUIRED, "the random blades").with(MistuningTable::KEYS),
        sweep: SweepTable = table("the scenarios", SweepTable::KEYS).of_scenarios(),
        solver: SolverTable = table("the solution of a row", SolverTable::KEYS),
        accuracy: AccuracyTable = table(
            "basis, harmonics and tolerances by a measured error", AccuracyTable::KEYS),
        stop: StopTable = table("when a study may end before all patterns", StopTable::KEYS).neutral(),
        output: OutputTable = table("what is written, and how", OutputTable::KEYS).neutral(),
    }
}

toml_table! {
    /// `[study]`.
    pub(in crate::study) struct HeadTable {
        name: String = key(Text("letters, digits, `-`, `_`, the first a letter or digit, at most 100"), REQUIRED,
            "names the results folder")
            .neutral().told("a name of letters, digits, - and _, beginning with a letter or digit"),
        seed: u64 = key(Whole(0, i64::MAX), REQUIRED,
            "patterns follow from it and their id alone")
            .and("; there is no default, so that every study says which patterns it has"),
        patterns: u64 = key(Whole(1, i32::MAX as i64), "required with a distribution; the number in the file with `mistuning.file`",
            "a total: raise it and run again, and only the new patterns are solved").neutral(),
    }
}
