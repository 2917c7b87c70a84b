//! The tables `[damping]` and `[nodal_diameter_damping]`: from the file, and back.

use std::collections::BTreeSet;

use super::check::Check;
use crate::response::harmonic_balance::Damping;
use crate::study::NodalDiameterTable;
use crate::study::keys::structure::{DampingTable, NodalDiameterDampingTable, RayleighTable};

/// The damping of the structure; none where it cannot be told.
pub(super) fn damping(check: &mut Check, table: Option<DampingTable>) -> Option<Damping> {
    let accepted = "exactly one of structural_loss_factor, modal_ratio and rayleigh";
    let Some(table) = table else {
        check.missing_for("damping", accepted);
        return None;
    };
    match (
        table.structural_loss_factor,
        table.modal_ratio,
        table.rayleigh,
    ) {
        (Some(factor), None, None) => {
            let factor = check.judged("damping.structural_loss_factor", factor);
            Some(Damping::StructuralLossFactor(factor))
        }
        (None, Some(zeta), None) => {
            let zeta = check.judged("damping.modal_ratio", zeta);
            Some(Damping::ModalRatio(zeta))
        }
        (None, None, Some(rayleigh)) => {
            let mass_per_s = check.required("damping.rayleigh.mass_per_s", rayleigh.mass_per_s);
            let stiffness_s = check.required("damping.rayleigh.stiffness_s", rayleigh.stiffness_s);
            if mass_per_s == 0.0 && stiffness_s == 0.0 {
                check.refuse_for(
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
            check.missing_for("damping", accepted);
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

/// The damping of the structure as a study file has it.
pub(super) fn damping_table(damping: Damping) -> DampingTable {
    let mut table = DampingTable::default();
    match damping {
        Damping::StructuralLossFactor(factor) => table.structural_loss_factor = Some(factor),
        Damping::ModalRatio(ratio) => table.modal_ratio = Some(ratio),
        Damping::Rayleigh {
            mass_per_s,
            stiffness_s,
        } => {
            table.rayleigh = Some(RayleighTable {
                mass_per_s: Some(mass_per_s),
                stiffness_s: Some(stiffness_s),
            });
        }
    }
    table
}

/// Highest nodal diameter of the largest wheel.
const MOST_NODAL_DIAMETERS: u32 = 5000;

/// Damping by nodal diameter; none where it cannot be told.
pub(super) fn nodal_diameter_damping(
    check: &mut Check,
    table: NodalDiameterDampingTable,
) -> Option<NodalDiameterTable> {
    let key = "nodal_diameter_damping.damping_ratios";
    let Some(ratios) = table.damping_ratios else {
        check.missing(key);
        return None;
    };
    if ratios.is_empty() {
        check.refuse(key);
    }
    let mut seen = BTreeSet::new();
    for (place, &(h, ratio)) in ratios.iter().enumerate() {
        let twice = !seen.insert(h);
        if twice || h > MOST_NODAL_DIAMETERS || !(0.0..1.0).contains(&ratio) {
            check.refuse(&format!("{key}[{place}]"));
        }
    }
    Some(NodalDiameterTable {
        ratios,
        modes: table.modes.unwrap_or_default(),
    })
}

/// Damping by nodal diameter as a study file has it.
pub(super) fn nodal_diameter_damping_table(
    damping: &NodalDiameterTable,
) -> NodalDiameterDampingTable {
    NodalDiameterDampingTable {
        damping_ratios: Some(damping.ratios.clone()),
        modes: Some(damping.modes),
    }
}
