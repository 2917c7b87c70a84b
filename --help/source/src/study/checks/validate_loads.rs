//! The checks of the normal loads: newtons and limits of `[sweep]`, rotation of `[contact.normal_load]`.

use std::collections::BTreeSet;

use super::check::Check;
use crate::response::forced_response::ContactCondition;
use crate::study::RotationOptions;
use crate::study::keys::NORMAL_LOAD_N;
use crate::study::raw::{RawLoad, RawNormalLoad, RawNumbers, RawSweep};

/// The contact conditions written as newtons or limits; there may be none `besides` those by rotation.
pub(super) fn contacts(
    check: &mut Check,
    sweep: &RawSweep,
    besides: bool,
) -> Vec<ContactCondition> {
    let key = "sweep.normal_load_n";
    let accepted = "a list of different normal loads per sector: numbers from 0 to 1e30 in N, \
                    \"stuck\", \"slide\" or \"free\"; at least one";
    let Some(loads) = &sweep.normal_load_n else {
        if !besides {
            check.missing(key, accepted);
        }
        return Vec::new();
    };
    if loads.is_empty() && !besides {
        check.refuse(key, accepted);
    }
    let mut contacts: Vec<ContactCondition> = Vec::new();
    let mut seen = BTreeSet::new();
    for (place, load) in loads.iter().enumerate() {
        let contact = match load {
            RawLoad::Number(value) if NORMAL_LOAD_N.holds(*value) => {
                // The sum turns -0.0 into 0.0.
                Some(ContactCondition::Full {
                    normal_load_n: value + 0.0,
                })
            }
            RawLoad::Name(name) if name == "stuck" => Some(ContactCondition::Stuck),
            RawLoad::Name(name) if name == "slide" => Some(ContactCondition::Slide),
            RawLoad::Name(name) if name == "free" => Some(ContactCondition::Free),
            _ => None,
        };
        match contact {
            Some(contact) if seen.insert(order_of(contact)) => contacts.push(contact),
            _ => check.refuse(&format!("{key}[{place}]"), accepted),
        }
    }
    contacts
}

/// Two conditions are the same if they have the same name and the same load, which is no negative zero.
fn order_of(contact: ContactCondition) -> (&'static str, Option<u64>) {
    (contact.name(), contact.normal_load_n().map(f64::to_bits))
}

/// Normal loads by rotation; none where they cannot be told.
pub(super) fn rotation(check: &mut Check, raw: &RawNormalLoad) -> Option<RotationOptions> {
    if raw.from.is_none() {
        check.missing("contact.normal_load.from", "\"rotation\"");
    }
    let ring_mass_factor = raw.ring_mass_factor.unwrap_or(1.0);
    let ring_mass_factor = check.within(
        "contact.normal_load.ring_mass_factor",
        ring_mass_factor,
        (1e-3..=1e3).contains(&ring_mass_factor),
        "a number from 1e-3 to 1e3",
    );
    if let Some(radius_m) = raw.ring_radius_m {
        check.within(
            "contact.normal_load.ring_radius_m",
            radius_m,
            radius_m.is_finite() && radius_m > 0.0,
            "a finite number above 0, in m",
        );
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
        speeds_rpm: speeds(check, raw.speed_rpm.as_ref())?,
        hoop: raw.hoop.unwrap_or_default(),
        share: raw.share.unwrap_or_default(),
        ring_mass_factor,
        ring_radius_m: raw.ring_radius_m,
    })
}

fn speeds(check: &mut Check, raw: Option<&RawNumbers>) -> Option<Vec<f64>> {
    let key = "contact.normal_load.speed_rpm";
    let accepted =
        "a speed above 0 in revolutions per minute, at most 1e6, or a list of different ones";
    let speeds = match raw {
        None => {
            check.missing(key, accepted);
            return None;
        }
        Some(RawNumbers::One(speed)) => vec![*speed],
        Some(RawNumbers::List(speeds)) => speeds.clone(),
    };
    let possible = |speed: &f64| *speed > 0.0 && *speed <= 1e6;
    if speeds.is_empty() || !speeds.iter().all(possible) || holds_twice(&speeds) {
        check.refuse(key, accepted);
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
