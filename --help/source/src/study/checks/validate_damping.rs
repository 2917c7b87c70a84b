//! The checks of the table `[damping]`.

use std::collections::BTreeSet;

use super::check::Check;
use crate::response::harmonic_balance::Damping;
use crate::study::NodalDiameterTable;
use crate::study::raw::{RawDamping, RawNodalDiameterDamping};

/// The damping of the structure; none where it cannot be told.
pub(super) fn damping(check: &mut Check, raw: Option<RawDamping>) -> Option<Damping> {
    let accepted = "exactly one of structural_loss_factor, modal_ratio and rayleigh";
    let Some(raw) = raw else {
        check.missing("damping", accepted);
        return None;
    };
    let ratio = |value: f64| value > 0.0 && value < 1.0;
    let in_words = "a number above 0 and below 1; a wheel without damping has no bounded resonance";
    match (raw.structural_loss_factor, raw.modal_ratio, raw.rayleigh) {
        (Some(factor), None, None) => Some(Damping::StructuralLossFactor(check.within(
            "damping.structural_loss_factor",
            factor,
            ratio(factor),
            in_words,
        ))),
        (None, Some(zeta), None) => Some(Damping::ModalRatio(check.within(
            "damping.modal_ratio",
            zeta,
            ratio(zeta),
            in_words,
        ))),
        (None, None, Some(rayleigh)) => {
            let factor = |value: f64| value.is_finite() && value >= 0.0;
            let mut required = |key: &str, value: Option<f64>| {
                check.required(key, value, factor, "a finite number of at least 0")
            };
            let mass_per_s = required("damping.rayleigh.mass_per_s", rayleigh.mass_per_s);
            let stiffness_s = required("damping.rayleigh.stiffness_s", rayleigh.stiffness_s);
            if mass_per_s == 0.0 && stiffness_s == 0.0 {
                check.refuse(
                    "damping.rayleigh",
                    "mass_per_s or stiffness_s above 0; a wheel without damping has no bounded resonance",
                );
            }
            Some(Damping::Rayleigh {
                mass_per_s,
                stiffness_s,
            })
        }
        (None, None, None) => {
            check.missing("damping", accepted);
            None
        }
        _ => {
            check.conflict(
                "damping",
                &format!("several models of damping; accepted: {accepted}"),
            );
            None
        }
    }
}

/// Highest nodal diameter of the largest wheel.
const MOST_NODAL_DIAMETERS: u32 = 5000;

/// Damping by nodal diameter; none where it cannot be told.
pub(super) fn nodal_diameter_damping(
    check: &mut Check,
    raw: RawNodalDiameterDamping,
) -> Option<NodalDiameterTable> {
    let key = "nodal_diameter_damping.damping_ratios";
    let accepted = "a list of [nodal diameter, damping ratio] like [[3, 0.0012], [4, 0.0009]]: nodal diameters \
                    from 0 to 5000, each once, ratios of at least 0 and below 1";
    let Some(ratios) = raw.damping_ratios else {
        check.missing(key, accepted);
        return None;
    };
    if ratios.is_empty() {
        check.refuse(key, accepted);
    }
    let mut seen = BTreeSet::new();
    for (place, &(h, ratio)) in ratios.iter().enumerate() {
        let twice = !seen.insert(h);
        if twice || h > MOST_NODAL_DIAMETERS || !(0.0..1.0).contains(&ratio) {
            check.refuse(&format!("{key}[{place}]"), accepted);
        }
    }
    Some(NodalDiameterTable {
        ratios,
        modes: raw.modes.unwrap_or_default(),
    })
}
