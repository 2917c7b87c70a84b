//! The normal loads, newtons and limits of `[sweep]` and rotation of `[contact.normal_load]`: from the file, and back.

use std::collections::BTreeSet;

use super::check::Check;
use crate::response::forced_response::ContactCondition;
use crate::study::keys::contact::{LoadSource, NormalLoadTable};
use crate::study::keys::mistuning::{NORMAL_LOAD_N, SweepTable};
use crate::study::keys::written::{NumberOrName, OneOrMore};
use crate::study::{RotationLoad, RotationOptions, Study};

/// The contact conditions written as newtons or limits; there may be none `besides` those by rotation.
pub(super) fn contacts(
    check: &mut Check,
    sweep: &SweepTable,
    besides: bool,
) -> Vec<ContactCondition> {
    let key = "sweep.normal_load_n";
    let Some(loads) = &sweep.normal_load_n else {
        if !besides {
            check.missing(key);
        }
        return Vec::new();
    };
    if loads.is_empty() && !besides {
        check.refuse(key);
    }
    let mut contacts: Vec<ContactCondition> = Vec::new();
    let mut seen = BTreeSet::new();
    for (place, load) in loads.iter().enumerate() {
        let contact = match load {
            NumberOrName::Number(value) if NORMAL_LOAD_N.holds(*value) => {
                // The sum turns -0.0 into 0.0.
                Some(ContactCondition::Full {
                    normal_load_n: value + 0.0,
                })
            }
            NumberOrName::Name(name) if name == "stuck" => Some(ContactCondition::Stuck),
            NumberOrName::Name(name) if name == "slide" => Some(ContactCondition::Slide),
            NumberOrName::Name(name) if name == "free" => Some(ContactCondition::Free),
            _ => None,
        };
        match contact {
            Some(contact) if seen.insert(order_of(contact)) => contacts.push(contact),
            _ => check.refuse(&format!("{key}[{place}]")),
        }
    }
    contacts
}

/// Two conditions are the same if they have the same name and the same load, which is no negative zero.
fn order_of(contact: ContactCondition) -> (&'static str, Option<u64>) {
    (contact.name(), contact.normal_load_n().map(f64::to_bits))
}

/// Normal loads by rotation; none where they cannot be told.
pub(super) fn rotation(check: &mut Check, table: &NormalLoadTable) -> Option<RotationOptions> {
    if table.from.is_none() {
        check.missing("contact.normal_load.from");
    }
    let ring_mass_factor = check.judged(
        "contact.normal_load.ring_mass_factor",
        table.ring_mass_factor.unwrap_or(1.0),
    );
    if let Some(radius_m) = table.ring_radius_m {
        check.judged("contact.normal_load.ring_radius_m", radius_m);
        for key in ["contact.normal_load.hoop", "contact.normal_load.share"] {
            if check.is_written(key) {
                check.conflict(
                    key,
                    "with ring_radius_m the load is m r Omega^2, no equilibrium of a ring or damper body; accepted: one of the two keys",
                );
            }
        }
    }
    Some(RotationOptions {
        speeds_rpm: speeds(check, table.speed_rpm.as_ref())?,
        hoop: table.hoop.unwrap_or_default(),
        share: table.share.unwrap_or_default(),
        ring_mass_factor,
        ring_radius_m: table.ring_radius_m,
    })
}

fn speeds(check: &mut Check, raw: Option<&OneOrMore>) -> Option<Vec<f64>> {
    let key = "contact.normal_load.speed_rpm";
    let speeds = match raw {
        None => {
            check.missing(key);
            return None;
        }
        Some(OneOrMore::One(speed)) => vec![*speed],
        Some(OneOrMore::List(speeds)) => speeds.clone(),
    };
    let possible = |speed: &f64| *speed > 0.0 && *speed <= 1e6;
    if speeds.is_empty() || !speeds.iter().all(possible) || holds_twice(&speeds) {
        check.refuse(key);
        return None;
    }
    Some(speeds)
}

/// Whether a number stands in the list twice.
fn holds_twice(numbers: &[f64]) -> bool {
    let mut sorted = numbers.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    sorted
        .windows(2)
        .any(|pair| pair[0].total_cmp(&pair[1]).is_eq())
}

/// The scenarios of `[sweep]` as a study file has them; loads by rotation stand in a table of their own.
pub(super) fn sweep_table(study: &Study) -> SweepTable {
    let by_rotation = |contact: &ContactCondition| {
        let rotation = study.rotation.as_ref();
        rotation.is_some_and(|rotation| rotation.speed_rpm(*contact).is_some())
    };
    let contacts = study.contacts.iter();
    let loads = contacts.filter(|contact| !by_rotation(contact));
    let loads = loads.map(|contact| match contact {
        ContactCondition::Full { normal_load_n } => NumberOrName::Number(*normal_load_n),
        limit => NumberOrName::Name(limit.name().to_owned()),
    });
    let loads: Vec<NumberOrName> = loads.collect();
    let deviations: Vec<f64> = study
        .standard_deviations
        .iter()
        .flatten()
        .copied()
        .collect();
    SweepTable {
        normal_load_n: Some(loads).filter(|loads| !loads.is_empty()),
        standard_deviation: Some(deviations).filter(|deviations| !deviations.is_empty()),
    }
}

/// Normal loads by rotation as a study file has them.
pub(super) fn normal_load_table(rotation: &RotationLoad) -> NormalLoadTable {
    let options = &rotation.options;
    let is_equilibrium = options.ring_radius_m.is_none();
    NormalLoadTable {
        from: Some(LoadSource::Rotation),
        speed_rpm: Some(OneOrMore::List(options.speeds_rpm.clone())),
        hoop: is_equilibrium.then_some(options.hoop),
        share: is_equilibrium.then_some(options.share),
        ring_mass_factor: Some(options.ring_mass_factor),
        ring_radius_m: options.ring_radius_m,
    }
}
