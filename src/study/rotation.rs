//! Normal loads by rotation: from speeds to newtons, and what of ring or damper body is pressed how hard.

use std::collections::BTreeSet;
use std::f64::consts::TAU;

use super::rotation_load::{pressed_body, with_ring_mass};
use super::sector_model::sector_of;
use super::{LoadShare, Problem, RotationLoad, RotationOptions, Study, StudyError};
use crate::model::cyclic::{CentrifugalContact, CentrifugalError, centrifugal_contact};
use crate::model::sector::{Body, SectorModel};
use crate::response::forced_response::ContactCondition;

/// Table of the study that asks for it.
const KEY: &str = "contact.normal_load";
/// Significant digits of the loads: rounding of the equilibrium is no key of a row.
const DIGITS: usize = 9;

/// `study` with the normal loads of the speeds of `options` after those written in newtons.
///
/// # Errors
/// The model is refused, or rotation presses nothing of it on.
pub(super) fn pressed_by(
    mut study: Study,
    options: Option<RotationOptions>,
) -> Result<Study, StudyError> {
    let Some(options) = options else {
        return Ok(study);
    };
    let model = with_ring_mass(sector_of(&study)?, options.ring_mass_factor);
    let contact = body_under_rotation(&study, &model, &options)?;
    let whole = contact.sector_load_kg_m();
    if whole <= 0.0 {
        let (body, split) = match pressed_body(&model) {
            Some(Body::Ring) => ("ring", "hoop = \"split\", or "),
            _ => ("damper body", ""),
        };
        let reason = format!(
            "rotation does not press the {body} on: the blisk gives way further than the {body}, or the {body} \
             lies outside; accepted: {split}newtons in sweep.normal_load_n"
        );
        return Err(no_rotation(&study, KEY, &reason));
    }
    let mut normal_loads_n = Vec::new();
    let loads = study
        .contacts
        .iter()
        .filter_map(|condition| condition.normal_load_n());
    let mut seen: BTreeSet<u64> = loads.map(f64::to_bits).collect();
    for speed_rpm in &options.speeds_rpm {
        let omega = TAU * speed_rpm / 60.0;
        let normal_load_n = rounded(whole * omega * omega);
        let condition = ContactCondition::Full { normal_load_n };
        if !seen.insert(normal_load_n.to_bits()) {
            let reason = format!(
                "{speed_rpm} rpm is the load {normal_load_n} N, which the sweep has already; accepted: once"
            );
            return Err(no_rotation(
                &study,
                "contact.normal_load.speed_rpm",
                &reason,
            ));
        }
        normal_loads_n.push(normal_load_n);
        study.contacts.push(condition);
    }
    let load_weights = (options.share == LoadShare::Equilibrium).then(|| {
        contact
            .pair_loads_kg_m
            .iter()
            .map(|load| load / whole)
            .collect()
    });
    let is_damper_body = pressed_body(&model) == Some(Body::Damper);
    study.rotation = Some(RotationLoad {
        options,
        normal_loads_n,
        load_weights,
        contact,
        is_damper_body,
    });
    Ok(study)
}

fn body_under_rotation(
    study: &Study,
    model: &SectorModel,
    options: &RotationOptions,
) -> Result<CentrifugalContact, StudyError> {
    let stiffness = study
        .contact
        .as_ref()
        .and_then(|contact| contact.normal_stiffness_n_per_m);
    if model.contact_pairs.is_empty() {
        return Err(no_rotation(
            study,
            KEY,
            "the model has no contact; accepted: no [contact], and normal_load_n = [\"free\"]",
        ));
    }
    let body = match pressed_body(model) {
        Some(Body::Ring) => "ring",
        Some(_) => "damper body",
        None => {
            return Err(no_rotation(
                study,
                KEY,
                "rotation presses nothing on in this model: its contacts join blades with each other or with the ground; \
                 accepted: newtons in sweep.normal_load_n",
            ));
        }
    };
    let equilibrium = centrifugal_contact(model, stiffness.unwrap_or(0.0), options.hoop);
    match (equilibrium, options.ring_radius_m) {
        (Err(CentrifugalError::NoRadialMotion), Some(radius_m)) => {
            Ok(ring_of_masses(model, radius_m))
        }
        (Err(CentrifugalError::NoRadialMotion), None) => Err(missing(
            study,
            "contact.normal_load.ring_radius_m",
            &format!(
                "a number above 0 in m, because the {body} of this model has no radial degree of freedom; or \
                 newtons in sweep.normal_load_n"
            ),
        )),
        (_, Some(_)) => Err(no_rotation(
            study,
            "contact.normal_load.ring_radius_m",
            &format!("the model says where its {body} lies; accepted: no ring_radius_m"),
        )),
        (_, None) if stiffness.is_none() => Err(missing(
            study,
            "contact.normal_stiffness_n_per_m",
            &format!(
                "a finite number above 0, in N/m: the equilibrium of the {body} under rotation needs it"
            ),
        )),
        (Err(error), None) => {
            let reason = format!("{error}; accepted: newtons in sweep.normal_load_n");
            Err(no_rotation(study, KEY, &reason))
        }
        (Ok(contact), None) => Ok(contact),
    }
}

fn no_rotation(study: &Study, key: &str, reason: &str) -> StudyError {
    refused(
        study,
        key,
        Problem::Conflict {
            reason: reason.to_owned(),
        },
    )
}

fn missing(study: &Study, key: &str, accepted: &str) -> StudyError {
    refused(
        study,
        key,
        Problem::Missing {
            accepted: accepted.to_owned(),
        },
    )
}

fn refused(study: &Study, key: &str, problem: Problem) -> StudyError {
    StudyError::Invalid {
        path: study.path.clone(),
        findings: vec![study.map.finding(key, problem)],
    }
}

/// Masses of ring or damper body at a radius, in which nothing carries hoop force: `N0 = m r Omega^2`.
fn ring_of_masses(model: &SectorModel, radius_m: f64) -> CentrifugalContact {
    let on_ring: Vec<f64> = model
        .dofs
        .iter()
        .map(|dof| f64::from(dof.body != Body::Blisk && !dof.component.is_rotation()))
        .collect();
    let moved = model.mass.multiply(&on_ring);
    let ring_mass_kg: f64 = on_ring.iter().zip(&moved).map(|(a, b)| a * b).sum();
    let ring_load_kg_m = ring_mass_kg * radius_m;
    CentrifugalContact {
        pair_loads_kg_m: model
            .contact_pairs
            .iter()
            .map(|pair| pair.weight * ring_load_kg_m)
            .collect(),
        ring_mass_kg,
        ring_load_kg_m,
    }
}

/// To [`DIGITS`] significant digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.*e}", DIGITS - 1).parse().unwrap_or(value)
}
