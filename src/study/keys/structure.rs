//! The keys of a study file that say what damps the structure.

use crate::input::Value::{Name, Number, Pairs, Table};
use crate::input::{REQUIRED, Range, Value, key, toml_table};
use crate::model::reduction::DampedModes;

const SHARE: Value = Number(Range::above(0.0).below(1.0));

toml_table! {
    /// `[damping]`.
    pub(in crate::study) struct DampingTable {
        structural_loss_factor: f64 = key(SHARE, "none",
            "`K (1 + i eta)`, mistuning included").and("; a wheel without damping has no bounded resonance"),
        modal_ratio: f64 = key(SHARE, "none",
            "viscous, `2 zeta omega_r` on the tuned contact-free modes, unchanged by mistuning")
            .and("; a wheel without damping has no bounded resonance"),
        rayleigh: RayleighTable = key(Table, "none",
            "`C = a M + b K` of the tuned wheel; one of a and b above 0").with(RayleighTable::KEYS),
    }
}

toml_table! {
    /// `[damping.rayleigh]`.
    pub(in crate::study) struct RayleighTable {
        mass_per_s: f64 = key(Number(Range::at_least(0.0)), REQUIRED, "a, 1/s"),
        stiffness_s: f64 = key(Number(Range::at_least(0.0)), REQUIRED, "b, s"),
    }
}

toml_table! {
    /// `[nodal_diameter_damping]`.
    pub(in crate::study) struct NodalDiameterDampingTable {
        damping_ratios: Vec<(u32, f64)> = key(Pairs(["nodal diameter", "damping ratio"], [0, 5000], Range::at_least(0.0).below(1.0)), REQUIRED,
            "each nodal diameter once, up to N/2; those left out have none")
            .told("a list of [nodal diameter, damping ratio] like [[3, 0.0012], [4, 0.0009]]: nodal diameters from 0 to 5000, each once, ratios of at least 0 and below 1"),
        modes: DampedModes = key(Name(&["blade", "all"]), "`\"blade\"`",
            "`blade`: each mode by the share of its strain energy in the blade; `all`: every mode of the nodal diameter alike"),
    }
}
