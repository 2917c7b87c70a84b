//! The keys of a study file that say what the contacts of the damper are.

use serde::{Deserialize, Serialize};

use super::ranges::{ABOVE_ZERO, TRUNCATION};
use super::written::OneOrMore;
use crate::input::Value::{Either, List, Name, Number};
use crate::input::{REQUIRED, Range, Value, key, table, toml_table};
use crate::model::cyclic::Hoop;
use crate::response::friction::{ContactLaw, Ring};
use crate::response::mistuning::VariesPer;
use crate::study::LoadShare;

const SPEED: Value = Number(Range::above(0.0).up_to(1e6));

toml_table! {
    /// `[contact]`.
    pub(in crate::study) struct ContactTable {
        law: ContactLaw = key(Name(&ContactLaw::NAMES), "`\"simplified_3d\"`",
            "from simple to full: `macro_slip_1d` and `macro_slip_2d` have a constant normal load, `coulomb_3d` the friction circle ([formulation.md](formulation.md))"),
        friction_coefficient: f64 = key(Number(Range::from_to(0.0, 10.0)), REQUIRED, ""),
        tangential_stiffness_n_per_m: f64 = key(ABOVE_ZERO, REQUIRED,
            "N/m per sector, shared out over the pairs by weight").and(", in N/m"),
        normal_stiffness_n_per_m: f64 = key(ABOVE_ZERO, "required by laws with a variable normal load; none otherwise",
            "N/m per sector, shared out likewise").and(", in N/m").or_null(),
        ring: Ring = key(Name(&["locked", "creeping"]), "`\"locked\"`",
            "`creeping`: a ring that is free drifts so that friction has no mean along its rigid motions ([formulation.md](formulation.md))"),
        normal_load: NormalLoadTable = table(
            "normal loads by rotation, besides those of the sweep", NormalLoadTable::KEYS),
        variation: VariationTable = table(
            "what of the contact is random besides the blades", VariationTable::KEYS),
    }
}

/// What normal loads come from.
#[derive(Debug, Clone, Copy, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub(in crate::study) enum LoadSource {
    Rotation,
}

toml_table! {
    /// `[contact.normal_load]`.
    pub(in crate::study) struct NormalLoadTable {
        from: LoadSource = key(Name(&["rotation"]), REQUIRED, "the centrifugal load of ring or damper body"),
        speed_rpm: OneOrMore = key(Either(&[SPEED, List(&SPEED)]), REQUIRED,
            "revolutions per minute; each is a load of the sweep, after those of `sweep.normal_load_n`")
            .of_scenarios().told("a speed above 0 in revolutions per minute, at most 1e6, or a list of different ones"),
        hoop: Hoop = key(Name(&["closed", "split"]), "`\"closed\"`",
            "`closed`: hoop force takes a part of the load; `split`: a ring with a free gap, all of the load on the contact"),
        share: LoadShare = key(Name(&["weight", "equilibrium"]), "`\"weight\"`",
            "how the load of a sector is shared out: by the weights of the pairs, or as the static equilibrium has it"),
        ring_mass_factor: f64 = key(Number(Range::from_to(1e-3, 1e3)), "1.0",
            "on the mass of ring or damper body, in its load and in its vibration")
            .told("a number from 1e-3 to 1e3"),
        ring_radius_m: f64 = key(ABOVE_ZERO, "required for a ring or damper body without radial dofs",
            "radius r of masses on springs: `N0 = m r Omega^2`, without `hoop` and `share`; m").and(", in m"),
    }
}

toml_table! {
    /// `[contact.variation]`.
    pub(in crate::study) struct VariationTable {
        friction_coefficient: FactorTable = table("a factor on the nominal value", FactorTable::KEYS),
        tangential_stiffness: FactorTable = table("a factor on the nominal value", FactorTable::KEYS),
        normal_stiffness: FactorTable = table("a factor on the nominal value", FactorTable::KEYS),
        normal_load: FactorTable = table("a factor on the nominal value", FactorTable::KEYS),
    }
}

/// Law of a factor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub(in crate::study) enum FactorKind {
    Normal,
    Uniform,
    TruncatedNormal,
    Lognormal,
}

toml_table! {
    /// A table of `[contact.variation]`.
    pub(in crate::study) struct FactorTable {
        kind: FactorKind = key(Name(&["normal", "uniform", "truncated_normal", "lognormal"]), REQUIRED,
            "factor `1 + s z` with z of unit standard deviation; `lognormal`: factor `exp(s z)`, median 1"),
        standard_deviation: f64 = key(Number(Range::above(0.0).up_to(2.0)), REQUIRED,
            "s: up to 0.5; `lognormal` up to 2"),
        truncation: f64 = key(TRUNCATION, "required for `truncated_normal` only",
            "standard deviations of the normal law").and(", in standard deviations of the normal law"),
        per: VariesPer = key(Name(&["wheel", "sector", "pair"]), "`\"wheel\"`", "what has a value of its own"),
    }
}
