//! The keys of a study file that say what a row is reduced to.

use super::options_table::options_table;
use super::ranges::MODES;
use crate::input::Value::{Name, Number, Whole};
use crate::input::{Range, key};
use crate::model::reduction::{Basis, ReductionOptions};

options_table! {
    /// `[reduction]`.
    pub(in crate::study) struct ReductionTable of ReductionOptions {
        basis: Basis = key(Name(&["auto", "stick_slide", "stick_attachment", "tuned_receptances"]), "`\"auto\"`",
            "to which motions of the wheel a row is reduced ([formulation.md](formulation.md)). Leave it at `auto`; the others are there to compare ways of reduction. `auto` is `tuned_receptances`, which leaves out no motion of the contact, where the contact has pairs that act; else a basis of modes is chosen by `error`. `stick_attachment` means `auto`, and warns that its modes are left out")
            .of_accuracy(),
        error: f64 = key(Number(Range::above(0.0).up_to(0.5)), "0.001",
            "wanted relative error of the judged peaks by the modes left out, by which their number is chosen where it is not fixed")
            .of_accuracy(),
        stick_modes: Option<usize> = key(MODES, "chosen",
            "with `stick_slide`, beside `slide_modes`").of_accuracy().or_null(),
        slide_modes: Option<usize> = key(MODES, "chosen",
            "with `stick_slide`, beside `stick_modes`").of_accuracy().or_null(),
        craig_bampton_modes: Option<usize> = key(MODES, "chosen: 25 or more",
            "how many modes of the sector with its contact nodes held stand for its elastic motion (fixed-interface modes, per nodal diameter). More are more accurate and slower. Leave it out, and the program chooses: so many that half as many more change no tuned peak by more than `error`; with `tuned_receptances` 60 or more, so many that half of them change no judged peak by more than that. Set it to a larger number to see that a result does not depend on it")
            .or_null(),
        sensitivity_vectors: Option<usize> = key(Whole(0, 1000), "2 where a standard deviation (or the root mean square of the file) reaches 0.05, else 0",
            "per nodal diameter").or_null(),
    }
}
