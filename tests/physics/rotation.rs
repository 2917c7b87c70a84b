//! The ring under rotation: closed forms of thin rings on foundations, and what a study makes of it.

use std::f64::consts::TAU;
use std::path::Path;

use blisk::linalg::{Complex64, SymmetricSparse};
use blisk::model::cyclic::{CentrifugalError, Hoop, centrifugal_contact};
use blisk::model::sector::{
    Body, Component, ContactPair, ContactSide, Dof, ObservedNode, ParametricOptions, SectorModel,
    parametric,
};
use blisk::response::forced_response::ContactCondition;
use blisk::study::{Study, load_sector_model};

const SECTORS: usize = 24;
const ALPHA: f64 = TAU / SECTORS as f64;
/// Ring per sector: mass, radius, stiffness of the chord from sector to sector.
const RING_KG: f64 = 0.03;
const RING_M: f64 = 0.19;
const CHORD: f64 = 3.0e8;

/// A foundation: grounded stiffness along r, mass, radius.
#[derive(Clone, Copy)]
struct Foundation {
    stiffness: f64,
    kg: f64,
    radius_m: f64,
}

const RIGID: Foundation = Foundation {
    stiffness: 1e16,
    kg: 1e-9,
    radius_m: 0.2,
};

/// A ring of chords round foundations of equal weight, one pair each; the contact faces the axis.
fn thin_ring(foundations: &[Foundation]) -> SectorModel {
    let mut dofs = Vec::new();
    let mut node = |component: &[Component], radius_m: f64, angle: f64, body: Body| {
        let id = dofs.last().map_or(0, |dof: &Dof| dof.node + 1);
        let first = dofs.len();
        dofs.extend(component.iter().map(|&component| Dof {
            node: id,
            component,
            position_m: [radius_m * angle.cos(), radius_m * angle.sin(), 0.0],
            body,
        }));
        (id, first)
    };
    let (r, t) = (Component::Radial, Component::Tangential);
    let on: Vec<_> = foundations
        .iter()
        .map(|own| node(&[r], own.radius_m, 0.0, Body::Blisk))
        .collect();
    let low = node(&[r, t], RING_M, 0.0, Body::Ring);
    let high = node(&[r, t], RING_M, ALPHA, Body::Ring);
    let mut stiffness = Vec::new();
    let mut mass = Vec::new();
    for (own, &(_, dof)) in foundations.iter().zip(&on) {
        stiffness.push((dof, dof, own.stiffness));
        mass.push((dof, dof, own.kg));
    }
    // The chord in the frames of its ends; its extension is e . u.
    let (s, c) = (0.5 * ALPHA).sin_cos();
    let e = [s, -c, s, c];
    let place = [low.1, low.1 + 1, high.1, high.1 + 1];
    for i in 0..4 {
        mass.push((place[i], place[i], 0.5 * RING_KG));
        for j in 0..=i {
            stiffness.push((place[i], place[j], CHORD * e[i] * e[j]));
        }
    }
    let n = dofs.len();
    let count = on.len() as f64;
    SectorModel {
        name: "thin ring".to_owned(),
        sectors: SECTORS,
        stiffness: SymmetricSparse::from_lower_triplets(n, &stiffness),
        mass: SymmetricSparse::from_lower_triplets(n, &mass),
        blade_stiffness: SymmetricSparse::from_lower_triplets(n, &[(0, 0, 0.0)]),
        dofs,
        cyclic_pairs: vec![(low.1, high.1), (low.1 + 1, high.1 + 1)],
        contact_pairs: on
            .iter()
            .map(|&(node, _)| ContactPair {
                first: ContactSide::Node(node),
                second: ContactSide::Node(low.0),
                normal: [-1.0, 0.0, 0.0],
                weight: 1.0 / count,
                load_weight: None,
            })
            .collect(),
        force: vec![(0, Complex64::new(1.0, 0.0))],
        rigid_points: Vec::new(),
        load_case_forces: Vec::new(),
        observed: vec![ObservedNode {
            name: "foundation".to_owned(),
            node: 0,
        }],
    }
}

/// Radial stiffness of the closed ring per sector: both chords at a node stretch by `2 u sin(alpha/2)`.
fn hoop_stiffness() -> f64 {
    let s = (0.5 * ALPHA).sin();
    4.0 * CHORD * s * s
}

#[track_caller]
fn assert_close(found: f64, expected: f64, tolerance: f64) {
    let off = (found / expected - 1.0).abs();
    assert!(off < tolerance, "{found} and {expected}: {off:e}");
}

#[test]
fn a_split_ring_presses_with_its_mass_times_radius() {
    let model = thin_ring(&[RIGID]);
    for kn in [1e5, 1e8, 1e11] {
        let found = centrifugal_contact(&model, kn, Hoop::Split).unwrap();
        // What nothing else holds is held by mass times (2 pi 1 Hz)^2, against kn 1e-5 at most.
        assert_close(found.sector_load_kg_m(), RING_KG * RING_M, 2e-5);
        assert_close(found.ring_mass_kg, RING_KG, 1e-12);
        assert_close(found.ring_radius_m(), RING_M, 1e-12);
    }
}

#[test]
fn hoop_stiffness_of_a_closed_ring_takes_its_part() {
    let model = thin_ring(&[RIGID]);
    for kn in [1e5, 1e7, 1e9] {
        let found = centrifugal_contact(&model, kn, Hoop::Closed).unwrap();
        let expected = RING_KG * RING_M * kn / (kn + hoop_stiffness());
        assert_close(found.sector_load_kg_m(), expected, 1e-6);
    }
}

#[test]
fn an_elastic_foundation_with_mass_of_its_own_moves_out_too() {
    let own = Foundation {
        stiffness: 4e7,
        kg: 0.05,
        radius_m: 0.2,
    };
    let (kn, hoop) = (2e7, hoop_stiffness());
    let model = thin_ring(&[own]);
    // [hoop + kn, -kn; -kn, stiffness + kn] [ring; foundation] = [m r; m r] by Cramer's rule.
    let (ring_load, own_load) = (RING_KG * RING_M, own.kg * own.radius_m);
    let determinant = (hoop + kn) * (own.stiffness + kn) - kn * kn;
    let ring = (ring_load * (own.stiffness + kn) + kn * own_load) / determinant;
    let foundation = ((hoop + kn) * own_load + kn * ring_load) / determinant;
    let expected = kn * (ring - foundation);
    assert!(expected > 0.0);
    let found = centrifugal_contact(&model, kn, Hoop::Closed).unwrap();
    assert_close(found.sector_load_kg_m(), expected, 1e-6);
    // Split: the ring's whole load, whatever the foundation does.
    let found = centrifugal_contact(&model, kn, Hoop::Split).unwrap();
    assert_close(found.sector_load_kg_m(), ring_load, 1e-6);
}

#[test]
fn a_pair_that_would_pull_is_let_go() {
    let soft = Foundation {
        stiffness: 1e6,
        kg: 1.0,
        radius_m: 0.2,
    };
    let kn = 2e7;
    let found = centrifugal_contact(&thin_ring(&[RIGID, soft]), kn, Hoop::Closed).unwrap();
    let pressed = 0.5 * kn;
    let expected = RING_KG * RING_M * pressed / (pressed + hoop_stiffness());
    assert_close(found.pair_loads_kg_m[0], expected, 1e-6);
    assert!(found.pair_loads_kg_m[1].abs() < f64::MIN_POSITIVE);
    // Alone it lets the ring go altogether.
    let found = centrifugal_contact(&thin_ring(&[soft]), kn, Hoop::Closed).unwrap();
    assert!(found.sector_load_kg_m().abs() < f64::MIN_POSITIVE);
}

/// The built-in ring in a blisk that neither moves nor weighs.
fn solid_ring() -> ParametricOptions {
    ParametricOptions {
        blisk_youngs_modulus_pa: 2.1e16,
        blisk_density_kg_per_m3: 1e-3,
        ring_grounding_frequency_hz: 0.1,
        ..ParametricOptions::default()
    }
}

#[test]
fn the_solid_ring_is_a_thin_ring_on_an_elastic_foundation() {
    let options = solid_ring();
    let model = parametric::build(&options).unwrap();
    let alpha = TAU / options.sectors as f64;
    let outer = options.flange_inner_radius_m();
    let inner = outer - options.ring_thickness_m;
    let mean = 0.5 * (outer + inner);
    let area = options.ring_thickness_m * options.ring_axial_width_m;
    let load = options.ring_density_kg_per_m3
        * options.ring_axial_width_m
        * alpha
        * (outer.powi(3) - inner.powi(3))
        / 3.0;
    let hoop = options.ring_youngs_modulus_pa * area * alpha / mean;
    for (kn, tolerance) in [
        (1e-3 * hoop, 0.01),
        (0.03 * hoop, 0.015),
        (0.1 * hoop, 0.02),
    ] {
        // Contact at single nodes: stiffer springs are in line with the ring's own give under them.
        let found = centrifugal_contact(&model, kn, Hoop::Closed).unwrap();
        assert_close(found.ring_load_kg_m, load, 2e-4);
        let expected = load * kn / (kn + hoop);
        assert_close(found.sector_load_kg_m(), expected, tolerance);
        let split = centrifugal_contact(&model, kn, Hoop::Split).unwrap();
        // Without hoop force a wider ring is still less curved, `E I alpha / R^3`.
        let bending = hoop * (options.ring_thickness_m / mean).powi(2) / 12.0;
        let expected = load * kn / (kn + bending);
        assert_close(split.sector_load_kg_m(), expected, 2e-3);
    }
}

const STUDY: &str = r#"schema = 1
[study]
name = "ring"
seed = 7
patterns = 2
[model]
source = "lumped"
[model.lumped]
sectors = 6
blade_mass_kg = 0.25
disk_mass_kg = 1.0
ring_mass_kg = 0.03
blade_stiffness_n_per_m = 2.5e6
disk_ground_stiffness_n_per_m = 7.0e6
[contact]
law = "macro_slip_1d"
friction_coefficient = 0.3
tangential_stiffness_n_per_m = 8.0e5
normal_load = { from = "rotation", speed_rpm = [3000, 6000], ring_radius_m = 0.2 }
[damping]
structural_loss_factor = 0.002
[excitation]
engine_orders = [2]
[mistuning]
distribution = { kind = "normal", standard_deviation = 0.03 }
[sweep]
normal_load_n = ["stuck", 50]
"#;

fn study(text: &str) -> Study {
    Study::parse(Path::new("study.toml"), text).unwrap()
}

fn loads(study: &Study) -> Vec<Option<f64>> {
    let contacts = study.contacts.iter();
    contacts.map(|contact| contact.normal_load_n()).collect()
}

#[test]
fn speeds_are_loads_after_those_in_newtons() {
    let of = |factor: f64| {
        [3000.0, 6000.0].map(|rpm: f64| factor * 0.03 * 0.2 * (TAU * rpm / 60.0).powi(2))
    };
    let one = study(STUDY);
    let found = loads(&one);
    assert_eq!(found[..2], [None, Some(50.0)]);
    for (found, expected) in found[2..].iter().zip(of(1.0)) {
        assert_close(found.unwrap(), expected, 1e-8);
    }
    let rotation = one.rotation.as_ref().unwrap();
    assert_eq!(rotation.speed_rpm(one.contacts[3]), Some(6000.0));
    assert_eq!(rotation.speed_rpm(one.contacts[1]), None);
    assert_eq!(rotation.speed_rpm(ContactCondition::Stuck), None);
    let heavy = study(&STUDY.replace("ring_radius_m", "ring_mass_factor = 2.5, ring_radius_m"));
    for (found, expected) in loads(&heavy)[2..].iter().zip(of(2.5)) {
        assert_close(found.unwrap(), expected, 1e-8);
    }
    // The ring vibrates with that mass too, the rest with its own.
    let (light, heavy) = (
        load_sector_model(&one).unwrap().mass.diagonal(),
        load_sector_model(&heavy).unwrap().mass.diagonal(),
    );
    for ((light, heavy), factor) in light.iter().zip(&heavy).zip([1.0, 1.0, 2.5]) {
        assert_close(*heavy, factor * light, 1e-15);
    }
}

#[test]
fn a_study_is_read_back_from_what_it_resolves_to() {
    let one = study(STUDY);
    let resolved = one.resolved();
    let text =
        toml::to_string(&serde_json::from_value::<toml::Table>(without_null(&resolved)).unwrap());
    let again = study(&text.unwrap());
    assert_eq!(again.resolved(), resolved);
    assert_eq!(again.scenarios(), one.scenarios());
}

fn without_null(value: &serde_json::Value) -> serde_json::Value {
    match value {
        serde_json::Value::Object(fields) => fields
            .iter()
            .filter(|(_, value)| !value.is_null())
            .map(|(key, value)| (key.clone(), without_null(value)))
            .collect(),
        other => other.clone(),
    }
}

#[test]
fn the_equilibrium_can_share_out_the_load() {
    let text = STUDY
        .replace("source = \"lumped\"", "source = \"parametric\"")
        .replace("law = \"macro_slip_1d\"", "normal_stiffness_n_per_m = 2e8")
        .replace(
            "ring_radius_m = 0.2",
            "share = \"equilibrium\", hoop = \"split\"",
        );
    let (start, end) = (
        text.find("[model.lumped]").unwrap(),
        text.find("[contact]").unwrap(),
    );
    let text = format!("{}{}", &text[..start], &text[end..]);
    let even = study(&text.replace("equilibrium", "weight"));
    let uneven = study(&text);
    assert_eq!(loads(&even), loads(&uneven));
    let rotation = uneven.rotation.as_ref().unwrap();
    let shares = |study: &Study| -> Vec<Option<f64>> {
        let pairs = load_sector_model(study).unwrap().contact_pairs;
        pairs.iter().map(|pair| pair.load_weight).collect()
    };
    assert!(shares(&even).iter().all(Option::is_none));
    let whole = rotation.contact.sector_load_kg_m();
    for (share, load) in shares(&uneven)
        .iter()
        .zip(&rotation.contact.pair_loads_kg_m)
    {
        assert_close(share.unwrap(), load / whole, 1e-14);
    }
    assert_close(shares(&uneven).iter().flatten().sum(), 1.0, 1e-12);
}

#[test]
fn models_without_what_is_needed_are_told() {
    let lumped = blisk::model::sector::lumped::build(&crate::sector_sources::lumped::lumped24());
    assert_eq!(
        centrifugal_contact(&lumped.unwrap(), 1e8, Hoop::Closed),
        Err(CentrifugalError::NoRadialMotion)
    );
    let alone = SectorModel {
        contact_pairs: Vec::new(),
        ..thin_ring(&[RIGID])
    };
    assert_eq!(
        centrifugal_contact(&alone, 1e8, Hoop::Closed),
        Err(CentrifugalError::NoContact)
    );
}

/// The study with the built-in wheel in the place of masses and springs.
fn parametric_study(keys: &str, law: &str, normal_load: &str) -> String {
    let (start, end) = (
        STUDY.find("[model.lumped]").unwrap(),
        STUDY.find("[contact]").unwrap(),
    );
    format!("{}{keys}{}", &STUDY[..start], &STUDY[end..])
        .replace("source = \"lumped\"", "source = \"parametric\"")
        .replace("law = \"macro_slip_1d\"", law)
        .replace(", ring_radius_m = 0.2", normal_load)
}

#[test]
fn what_presses_no_ring_is_refused_with_its_key_and_a_way_out() {
    let full = "law = \"simplified_3d\"\nnormal_stiffness_n_per_m = 2e8";
    let stiff = "[model.parametric]\nring_youngs_modulus_pa = 2.1e13\n";
    let damper = |name: &str| format!("[model.parametric]\ndamper = \"{name}\"\n");
    let nothing = "rotation presses nothing on in this model: its contacts join blades with each other or with the ground";
    let cases = [
        (
            parametric_study("", full, ", ring_radius_m = 0.2"),
            "contact.normal_load.ring_radius_m",
            "the model says where its ring lies; accepted: no ring_radius_m",
        ),
        (
            parametric_study("", "law = \"macro_slip_1d\"", ""),
            "contact.normal_stiffness_n_per_m is missing",
            "the equilibrium of the ring under rotation needs it",
        ),
        (
            parametric_study(stiff, full, ""),
            "contact.normal_load",
            "rotation does not press the ring on",
        ),
        (
            parametric_study(&damper("shroud"), full, ""),
            "contact.normal_load: ",
            nothing,
        ),
        (
            parametric_study(&damper("blade_to_ground"), full, ", ring_radius_m = 0.2"),
            "contact.normal_load: ",
            nothing,
        ),
        (
            parametric_study(&damper("underplatform"), full, ", ring_radius_m = 0.2"),
            "contact.normal_load.ring_radius_m",
            "the model says where its damper body lies; accepted: no ring_radius_m",
        ),
        (
            parametric_study(&damper("underplatform"), "law = \"macro_slip_1d\"", ""),
            "contact.normal_stiffness_n_per_m is missing",
            "the equilibrium of the damper body under rotation needs it",
        ),
        (
            STUDY.replace("ring_mass_kg = 0.03\n", ""),
            "contact.normal_load",
            "the model has no contact",
        ),
        (
            STUDY.replace("50]", "592.176264]"),
            "contact.normal_load.speed_rpm",
            "3000 rpm is the load 592.176264 N, which the sweep has already",
        ),
    ];
    for (text, key, reason) in cases {
        let told = Study::parse(Path::new("study.toml"), &text)
            .expect_err(reason)
            .to_string();
        assert!(told.contains(key) && told.contains(reason), "{told}");
    }
    // A damper body is called one where a run says what is pressed, a ring a ring.
    let said = |text: &str| study(text).rotation.unwrap().facts().to_string();
    let wedge = said(&parametric_study(&damper("underplatform"), full, ""));
    assert!(wedge.starts_with("rotation: damper body of "), "{wedge}");
    let ring = said(&parametric_study("", full, ""));
    assert!(ring.starts_with("rotation: ring of "), "{ring}");
    // A stiff ring that is split presses all the same.
    let split = parametric_study(stiff, full, ", hoop = \"split\"");
    assert!(study(&split).rotation.unwrap().contact_fraction() > 0.99);
}
