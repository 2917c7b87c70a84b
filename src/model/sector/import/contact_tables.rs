//! The contacts of an import file: which surfaces each one joins, and what contacts and bodies have to do with each other.

use super::files::missing;
use super::problem::body_name;
use super::side::{Side, Surface};
use super::tables::{ContactTable, ContactTables, Pairing, RawFile, Weights};
use crate::input::Problem;
use crate::model::sector::sector_model::Body;

/// A contact whose sides are known.
#[derive(Debug)]
pub(super) struct Contact {
    /// Key of its table: `contact`, or `contact[1]`.
    pub key: String,
    /// The side out of which normals point, and the key that names it.
    pub first: Surface,
    pub first_key: String,
    pub second: Side,
    pub second_key: String,
    pub tolerance_m: Option<f64>,
    pub pairing: Pairing,
    pub weights: Weights,
    /// Share of all its pairs together, relative to the other contacts; none: pairs share among those of all contacts.
    pub weight: Option<f64>,
    pub normal: Option<[f64; 3]>,
}

/// What is wrong, by key.
type Problems = Vec<(String, Problem)>;

impl Contact {
    /// Whether its pairs count alike: by its key, or since nodes without faces have no area.
    pub fn is_equal(&self) -> bool {
        self.weights == Weights::Equal || self.normal.is_some()
    }

    /// What stands before the name of a surface's set in the file: nothing under the keys `blisk` and `ring`.
    pub fn prefix_of(&self, surface: &Surface) -> String {
        match self.first_key.rsplit_once('.') {
            Some((_, "blisk")) => String::new(),
            _ => surface.prefix(),
        }
    }

    /// Its surfaces with their keys.
    pub fn surfaces(&self) -> impl Iterator<Item = (&str, &Surface)> {
        let second = match &self.second {
            Side::Surface(surface) => Some((self.second_key.as_str(), surface)),
            Side::Ground => None,
        };
        std::iter::once((self.first_key.as_str(), &self.first)).chain(second)
    }
}

/// The contacts of a file; what is not accepted goes to `problems`.
pub(super) fn contacts(raw: &RawFile, problems: &mut Problems) -> Vec<Contact> {
    let tables: Vec<(String, &ContactTable)> = match &raw.contact {
        None => Vec::new(),
        Some(ContactTables::One(table)) => vec![("contact".to_owned(), table)],
        Some(ContactTables::More(tables)) => {
            let keys = (0..tables.len()).map(|index| format!("contact[{index}]"));
            keys.zip(tables).collect()
        }
    };
    let is_list = matches!(raw.contact, Some(ContactTables::More(_)));
    let count = tables.len();
    let contacts: Vec<Contact> = tables
        .into_iter()
        .filter_map(|(key, table)| contact(key, table, is_list, problems))
        .collect();
    for (index, contact) in contacts.iter().enumerate() {
        check_sides(raw, contact, problems);
        check_pairing(contact, &contacts[..index], problems);
    }
    bodies_there(raw, &contacts, problems);
    // Contacts that are wrong themselves may be meant for a body that none touches.
    if contacts.len() == count {
        bodies_held(raw, &contacts, problems);
    }
    contacts
}

/// The contact of one table, if its sides are known.
fn contact(
    key: String,
    table: &ContactTable,
    is_list: bool,
    problems: &mut Problems,
) -> Option<Contact> {
    let by_body = [("blisk", &table.blisk), ("ring", &table.ring)];
    let by_order = [("first", &table.first), ("second", &table.second)];
    let given = |keys: &[(&str, &Option<String>); 2]| keys.iter().any(|(_, set)| set.is_some());
    let is_by_body = given(&by_body) || !is_list && !given(&by_order);
    if given(&by_body) && given(&by_order) {
        let name = if table.first.is_some() {
            "first"
        } else {
            "second"
        };
        let reason = "surfaces of blisk and ring are also given; accepted: blisk and ring, or first and second";
        conflict(problems, format!("{key}.{name}"), reason);
        return None;
    }
    let keys = if is_by_body { by_body } else { by_order };
    let mut sides = Vec::new();
    for (name, text) in keys {
        let full_key = format!("{key}.{name}");
        let Some(text) = text else {
            let accepted = match name {
                "blisk" | "ring" => "a set of the mesh",
                "first" => "BODY.SET, the surface out of which normals point",
                _ => "BODY.SET, next.BODY.SET or ground, what it touches",
            };
            problems.push(missing(full_key, accepted));
            continue;
        };
        let side = match name {
            "blisk" => Ok(Side::Surface(Surface::own(Body::Blisk, text))),
            "ring" => Ok(Side::Surface(Surface::own(Body::Ring, text))),
            _ => Side::of(text),
        };
        match side {
            Ok(side) => sides.push((full_key, side)),
            Err(problem) => problems.push((full_key, problem)),
        }
    }
    if table
        .normal
        .is_some_and(|normal| normal.iter().all(|&part| part == 0.0))
    {
        let reason = "the normal has no direction; accepted: one number at least that is not 0";
        conflict(problems, format!("{key}.normal"), reason);
    }
    let [(first_key, first), (second_key, second)] = <[_; 2]>::try_from(sides).ok()?;
    let Side::Surface(first) = first else {
        problems.push((
            first_key,
            Problem::NotAccepted {
                value: "\"ground\"".to_owned(),
                accepted:
                    "BODY.SET or next.BODY.SET, as normals point out of it; the ground is second"
                        .to_owned(),
                suggestion: None,
            },
        ));
        return None;
    };
    Some(Contact {
        key,
        first,
        first_key,
        second,
        second_key,
        tolerance_m: table.tolerance_m,
        pairing: table.pairing,
        weights: table.weights,
        weight: table.weight,
        normal: table.normal,
    })
}

/// What the two sides of a contact may be together.
fn check_sides(raw: &RawFile, contact: &Contact, problems: &mut Problems) {
    let first = &contact.first;
    let key = contact.second_key.clone();
    match &contact.second {
        Side::Ground if first.is_next => {
            let reason = "the ground is the same for every sector; accepted: a surface of the sector itself, BODY.SET";
            conflict(problems, contact.first_key.clone(), reason);
        }
        Side::Surface(second) if first.is(second) => {
            let reason = "it is the first side, too; accepted: another surface, that of the next sector, or ground";
            conflict(problems, key, reason);
        }
        Side::Surface(second) if first.is_next && second.is_next => {
            let reason = "both sides are of the next sector; accepted: one of them of the sector itself, BODY.SET";
            conflict(problems, key, reason);
        }
        _ => {}
    }
    for (key, surface) in contact.surfaces() {
        if surface.is_next && raw.sectors == 1 {
            let reason = "a wheel of one sector has no next one; accepted: surfaces of the sector itself, BODY.SET";
            conflict(problems, key.to_owned(), reason);
        }
    }
}

/// Pairing and weights, which contacts have together; `earlier` are the contacts before.
fn check_pairing(contact: &Contact, earlier: &[Contact], problems: &mut Problems) {
    let key = &contact.key;
    let is_of_ring = matches!(&contact.second, Side::Surface(second)
        if second.body == Body::Ring && !second.is_next);
    let is_under_blisk = contact.first.body == Body::Blisk && !contact.first.is_next;
    if contact.pairing == Pairing::Projection {
        let mut projected = earlier
            .iter()
            .filter(|earlier_contact| earlier_contact.pairing == Pairing::Projection);
        let accepted = if is_of_ring && is_under_blisk {
            let earlier = projected.next();
            earlier.map(|earlier_contact| {
                format!("\"nodes\": {} is projected already", earlier_contact.key)
            })
        } else {
            Some("\"nodes\": only a ring is projected on the blisk, first = \"blisk.SET\" and second = \"ring.SET\"".to_owned())
        };
        if let Some(accepted) = accepted {
            let problem = Problem::NotAccepted {
                value: "\"projection\"".to_owned(),
                accepted,
                suggestion: None,
            };
            problems.push((format!("{key}.pairing"), problem));
        }
    }
    let second = contact.second.to_string();
    let first = contact.first.to_string();
    let same = |earlier_contact: &&Contact| {
        let sides = [
            earlier_contact.first.to_string(),
            earlier_contact.second.to_string(),
        ];
        let is = |a: &String, b: &String| {
            sides[0].eq_ignore_ascii_case(a) && sides[1].eq_ignore_ascii_case(b)
        };
        is(&first, &second) || is(&second, &first)
    };
    if let Some(same_contact) = earlier.iter().find(same) {
        let reason = format!(
            "{} joins the same surfaces; accepted: each two once",
            same_contact.key
        );
        conflict(problems, contact.first_key.clone(), &reason);
    }
    let Some(other) = earlier.first() else { return };
    if other.weight.is_some() != contact.weight.is_some() {
        let (key, without) = if contact.weight.is_some() {
            (format!("{key}.weight"), &other.key)
        } else {
            (format!("{}.weight", other.key), key)
        };
        let reason = format!(
            "the share of a contact is relative to those of the others, and {without} has none; accepted: weight in every \
             contact or in none"
        );
        conflict(problems, key, &reason);
    } else if contact.weight.is_none() && other.is_equal() != contact.is_equal() {
        let (name, reason) = if contact.normal.is_some() {
            ("normal", "nodes with this key have no area, those of")
        } else {
            (
                "weights",
                "they are shared out among all contacts, and are others in",
            )
        };
        let reason = format!(
            "{reason} {}; accepted: weights = \"equal\" (or normal) in every contact or in none, or a weight in each",
            other.key
        );
        conflict(problems, format!("{key}.{name}"), &reason);
    }
}

/// Key of the first surface of a body in contact.
fn touched(contacts: &[Contact], body: Body) -> Option<&str> {
    let mut surfaces = contacts.iter().flat_map(Contact::surfaces);
    let found = surfaces.find(|(_, surface)| surface.body == body);
    found.map(|(key, _)| key)
}

/// Every body that is touched must be there.
fn bodies_there(raw: &RawFile, contacts: &[Contact], problems: &mut Problems) {
    for (body, table) in [(Body::Ring, &raw.ring), (Body::Damper, &raw.damper)] {
        if let (None, Some(key)) = (table, touched(contacts, body)) {
            let what = if key == "contact.ring" {
                "there is a [contact]".to_owned()
            } else {
                format!("{key} is a surface of it")
            };
            let name = body_name(body);
            let accepted = format!("a table with the files of the {name}, as {what}");
            problems.push(missing(name, &accepted));
        }
    }
}

/// A body that only contact holds must be touched.
fn bodies_held(raw: &RawFile, contacts: &[Contact], problems: &mut Problems) {
    if raw.ring.is_some() && raw.contact.is_none() {
        problems.push(missing(
            "contact",
            "a table with the surfaces that touch, blisk and ring, as there is a [ring]",
        ));
    }
    let has_contact = raw.contact.is_some();
    for (body, is_there) in [
        (Body::Ring, raw.ring.is_some() && has_contact),
        (Body::Damper, raw.damper.is_some()),
    ] {
        if is_there && touched(contacts, body).is_none() {
            let name = body_name(body);
            let reason = format!(
                "nothing holds the {name}: no contact has a surface of it; accepted: a [[contact]] with {name}.SET as first or second"
            );
            conflict(problems, name.to_owned(), &reason);
        }
    }
}

fn conflict(problems: &mut Problems, key: String, reason: &str) {
    let reason = reason.to_owned();
    problems.push((key, Problem::Conflict { reason }));
}
