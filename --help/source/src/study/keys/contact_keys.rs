//! The keys of a study file that say what the contacts of the damper are.

use super::Value::{Either, List, Name, Number, Table};
use super::study_keys::{ABOVE_ZERO, TRUNCATION};
use super::{Range, Value};
use crate::input::{Entry, REQUIRED, entry};

const SPEED: Value = Number(Range::above(0.0).up_to(1e6));

pub(super) const CONTACT_KEYS: &[Entry] = &[
    entry(
        "contact",
        Table,
        "",
        "the contacts of the damper: with ring or damper body, of neighbouring blades, or with the ground",
    ),
    entry(
        "contact.law",
        Name(&[
            "simplified_3d",
            "coulomb_3d",
            "macro_slip_2d",
            "macro_slip_1d",
        ]),
        "`\"simplified_3d\"`",
        "`coulomb_3d` has the friction circle, `macro_slip_2d` a constant normal load ([formulation.md](formulation.md))",
    ),
    entry(
        "contact.friction_coefficient",
        Number(Range::from_to(0.0, 10.0)),
        REQUIRED,
        "",
    ),
    entry(
        "contact.tangential_stiffness_n_per_m",
        ABOVE_ZERO,
        REQUIRED,
        "N/m per sector, shared out over the pairs by weight",
    ),
    entry(
        "contact.normal_stiffness_n_per_m",
        ABOVE_ZERO,
        "required for `simplified_3d` and `coulomb_3d`; none otherwise",
        "N/m per sector, shared out likewise",
    ),
    entry(
        "contact.ring",
        Name(&["locked", "creeping"]),
        "`\"locked\"`",
        "`creeping`: a ring that is free drifts so that friction has no mean along its rigid motions; not with `coulomb_3d` ([formulation.md](formulation.md))",
    ),
    entry(
        "contact.normal_load",
        Table,
        "",
        "normal loads by rotation, besides those of the sweep",
    ),
    entry(
        "contact.normal_load.from",
        Name(&["rotation"]),
        REQUIRED,
        "the centrifugal load of ring or damper body",
    ),
    entry(
        "contact.normal_load.speed_rpm",
        Either(&[SPEED, List(&SPEED)]),
        REQUIRED,
        "revolutions per minute; each is a load of the sweep, after those of `sweep.normal_load_n`",
    ),
    entry(
        "contact.normal_load.hoop",
        Name(&["closed", "split"]),
        "`\"closed\"`",
        "`closed`: hoop force takes a part of the load; `split`: a ring with a free gap, all of the load on the contact",
    ),
    entry(
        "contact.normal_load.share",
        Name(&["weight", "equilibrium"]),
        "`\"weight\"`",
        "how the load of a sector is shared out: by the weights of the pairs, or as the static equilibrium has it",
    ),
    entry(
        "contact.normal_load.ring_mass_factor",
        Number(Range::from_to(1e-3, 1e3)),
        "1.0",
        "on the mass of ring or damper body, in its load and in its vibration",
    ),
    entry(
        "contact.normal_load.ring_radius_m",
        ABOVE_ZERO,
        "required for a ring or damper body without radial dofs",
        "radius r of masses on springs: `N0 = m r Omega^2`, without `hoop` and `share`; m",
    ),
    entry(
        "contact.variation",
        Table,
        "",
        "what of the contact is random besides the blades",
    ),
    entry(
        "contact.variation.*",
        Table,
        "",
        "a factor on the nominal value",
    ),
    entry(
        "contact.variation.*.kind",
        Name(&["normal", "uniform", "truncated_normal", "lognormal"]),
        REQUIRED,
        "factor `1 + s z` with z of unit standard deviation; `lognormal`: factor `exp(s z)`, median 1",
    ),
    entry(
        "contact.variation.*.standard_deviation",
        Number(Range::above(0.0).up_to(2.0)),
        REQUIRED,
        "s: up to 0.5; `lognormal` up to 2",
    ),
    entry(
        "contact.variation.*.truncation",
        TRUNCATION,
        "required for `truncated_normal` only",
        "standard deviations of the normal law",
    ),
    entry(
        "contact.variation.*.per",
        Name(&["wheel", "sector", "pair"]),
        "`\"wheel\"`",
        "what has a value of its own",
    ),
];
