//! The keys of a study file that say what force excites the wheel.

use super::written::OneOrMore;
use crate::input::Value::{Either, List, Number, Numbers, Tables, Text, Whole};
use crate::input::{REQUIRED, Range, key, toml_table};

/// Factor on a force vector, N: the solver was tested over this range, and its square, since the vector itself has the
/// same. Beyond, powers of the response vanish or overflow and peaks are read a few percent off.
pub(in crate::study) const EXCITATION_N: Range = Range::from_to(1e-30, 1e30);

toml_table! {
    /// `[excitation]`.
    pub(in crate::study) struct ExcitationTable {
        engine_orders: Vec<u32> = key(List(&Whole(0, 10_000)), "required unless every `load_case` has its own",
            "one scenario each, never simultaneous")
            .of_scenarios().told("a list of different whole numbers from 0 to 10000, at least one"),
        amplitude_n: OneOrMore = key(Either(&[Number(EXCITATION_N), Numbers(EXCITATION_N)]), "1.0",
            "multiplies the model's force vector; a list: one per engine order, in their order")
            .told("a number from 1e-30 to 1e30, in N, or a list of one per engine order"),
        load_case: Vec<LoadCaseTable> = key(Tables, "none",
            "load cases: force vectors with engine orders of their own").with(LoadCaseTable::KEYS),
    }
}

toml_table! {
    /// `[[excitation.load_case]]`.
    pub(in crate::study) struct LoadCaseTable {
        name: String = key(Text("letters, digits, `-`, `_`, the first a letter or digit, at most 40"), REQUIRED,
            "names the load case in every table and report; each has another")
            .told("a name of its own of 1 to 40 letters, digits, - and _, beginning with a letter or digit"),
        force: String = key(Text("a file"), "the model's force vector",
            "force vector as that of a bundle: CSV with the columns `dof`, `re`, `im`, in N"),
        node: String = key(Text("name of an observed node"), "none",
            "instead of `force`: 1 N at this node of the model"),
        direction: Vec<f64> = key(Numbers(Range::ANY), "required with `node`",
            "where that force points to: `[r, theta, z]`, of any length")
            .told("three numbers [r, theta, z], not all 0: where 1 N points to at the node"),
        engine_orders: Vec<u32> = key(List(&Whole(0, 10_000)), "those of `[excitation]`",
            "as above").told("a list of different whole numbers from 0 to 10000, at least one"),
        amplitude_n: OneOrMore = key(Either(&[Number(EXCITATION_N), Numbers(EXCITATION_N)]), "that of `[excitation]`",
            "multiplies the force vector of this load case")
            .told("a number from 1e-30 to 1e30, in N, or a list of one per engine order"),
    }
}
