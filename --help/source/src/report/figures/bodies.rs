//! What the damper of a study and the bodies of its sector are called.

use crate::model::sector::Body;
use crate::report::StudyReport;

/// The damper of the built-in bladed disk as a study names it, and its shape; none for another model.
fn built_in_damper(report: &StudyReport) -> Option<(&str, &str)> {
    let options = &report.provenance.study["model"]["parametric"];
    let shape = options["damper_shape"].as_str().unwrap_or_default();
    options["damper"].as_str().map(|damper| (damper, shape))
}

/// What the friction of a study is at, after "bladed disks with".
pub(in crate::report) fn friction_words(report: &StudyReport) -> &'static str {
    if report.provenance.study["contact"].is_null() {
        return "no friction contact";
    }
    match built_in_damper(report) {
        Some(("ring", _)) => return "a friction ring damper",
        Some(("underplatform", "cylinder")) => return "cylinders as underplatform dampers",
        Some(("underplatform", _)) => return "wedges as underplatform dampers",
        Some(("shroud", _)) => return "shrouds that rub on one another",
        Some(("blade_to_ground", _)) => return "platforms that rub on the ground",
        _ => {}
    }
    let Some(section) = report.model.section() else {
        return "friction dampers";
    };
    let has = |body: Body| section.masses.iter().any(|mass| mass.body == body);
    let mut contacts = section.sector.contacts.iter();
    if has(Body::Ring) {
        "a friction ring damper"
    } else if has(Body::Damper) {
        "friction dampers"
    } else if contacts.any(|pair| pair.second_m.is_none()) {
        "friction on the ground"
    } else {
        "friction between blades"
    }
}

/// A body of the sector in a word.
pub(in crate::report) fn body_word(report: &StudyReport, body: Body) -> &'static str {
    match (body, built_in_damper(report)) {
        (Body::Blisk, _) => "blisk",
        (Body::Ring, _) => "ring",
        (Body::Damper, Some(("underplatform", "cylinder"))) => "cylinder",
        (Body::Damper, Some(("underplatform", _))) => "wedge",
        (Body::Damper, _) => "damper",
    }
}
