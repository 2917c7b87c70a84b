//! A ring whose nodes do not match the blisk's: projected, it moves and vibrates as the matching one.

use blisk::linalg::lowest_modes;
use blisk::model::cyclic::{CyclicSector, contact_free_frequencies_hz};
use blisk::model::sector::import::Imported;
use blisk::model::sector::{Component, ModelError, SectorModel};

use super::calculix::{import_changed, try_import_changed};

fn projected(ring: &str, tolerance_m: f64) -> Imported {
    try_projected(ring, tolerance_m).unwrap()
}

fn try_projected(ring: &str, tolerance_m: f64) -> Result<Imported, ModelError> {
    try_import_changed("rest", |text| {
        text.replace("ring_rest", ring).replace(
            "[contact]",
            &format!("[contact]\npairing = \"projection\"\ntolerance_m = {tolerance_m:e}"),
        )
    })
}

/// The lowest frequencies with the contact stuck, Hz.
fn stuck_hz(model: &SectorModel, h: usize, count: usize) -> Vec<f64> {
    let sector = CyclicSector::new(model);
    let springs = sector.contact().springs([4e8, 2e8, 2e8]);
    let stiffness = sector
        .stiffness(h)
        .plus(1.0, &sector.contact_stiffness(&springs, h));
    let factor = stiffness.factor().unwrap();
    let (values, _) = lowest_modes(&factor, &sector.mass(h), 0.0, count).unwrap();
    values
        .into_iter()
        .map(|value| value.sqrt() / std::f64::consts::TAU)
        .collect()
}

/// Where nodes match, the weights are one and nought, and the ring is what it was.
#[test]
fn a_matching_ring_is_unchanged_by_projection() {
    let paired = import_changed("rest", |text| text);
    let projected = projected("ring_rest", 1e-6);
    assert_eq!(
        projected
            .report
            .contact
            .as_ref()
            .unwrap()
            .projected_ring_nodes,
        Some(8)
    );
    assert_eq!(
        projected.model.contact_pairs.len(),
        paired.model.contact_pairs.len()
    );
    for (own, other) in projected
        .model
        .contact_pairs
        .iter()
        .zip(&paired.model.contact_pairs)
    {
        assert_eq!(own.first, other.first);
        assert!((own.weight - other.weight).abs() < 1e-12);
    }
    let own = contact_free_frequencies_hz(&projected.model, 12).unwrap();
    let other = contact_free_frequencies_hz(&paired.model, 12).unwrap();
    for (own, other) in own.iter().flatten().zip(other.iter().flatten()) {
        assert!((own / other - 1.0).abs() < 1e-7, "{own} {other}");
    }
    for h in [0, 2, 7, 12] {
        for (own, other) in
            stuck_hz(&projected.model, h, 6)
                .iter()
                .zip(stuck_hz(&paired.model, h, 6))
        {
            assert!((own / other - 1.0).abs() < 1e-9, "{h}: {own} {other}");
        }
    }
}

#[test]
fn a_ring_of_other_divisions_is_held_like_the_matching_one() {
    let paired = import_changed("rest", |text| text);
    // The faces of the linear bricks are chords: the nodes between are up to 0.24 mm off.
    let projected = projected("ring_free", 3e-4);
    let report = projected.report.contact.as_ref().unwrap();
    assert_eq!(report.projected_ring_nodes, Some(10));
    assert!(report.worst_distance_m > 1e-4 && report.worst_distance_m < 3e-4);
    for (h, tolerance) in [(0, 2e-3), (1, 2e-3), (2, 2e-3), (5, 2e-3), (12, 2e-3)] {
        for (own, other) in
            stuck_hz(&projected.model, h, 4)
                .iter()
                .zip(stuck_hz(&paired.model, h, 4))
        {
            println!("ND {h}: {own:.3} {other:.3} Hz");
            assert!((own / other - 1.0).abs() < tolerance, "{h}: {own} {other}");
        }
    }
    // The mass is kept, and so is the motion along the axis: weights of a node sum to one.
    let mass = |imported: &Imported| imported.report.bodies[1].mass_kg;
    assert!((mass(&projected) / mass(&paired) - 1.0).abs() < 0.01);
    assert!(projected.report.bodies[1].rigid_shift_residual.unwrap() < 1e-12);
    let axial = projected
        .model
        .dofs
        .iter()
        .filter(|dof| dof.component == Component::Axial)
        .count();
    assert_eq!(3 * axial, projected.model.dofs.len());
}

/// Between a micrometre and 0.24 mm, some rows of the ring's nodes are on the surface and some are not.
#[test]
fn rings_that_cannot_follow_are_refused() {
    // Those at 0, 7.5 and 15 degrees: too few for the blisk's at 0, 6.5, 8.5 and 15.
    let coarse = try_projected("ring_free", 3e-5).err().unwrap().to_string();
    assert!(
        coarse.contains("the 6 nodes of the ring do not determine"),
        "{coarse}"
    );
    let far = try_import_changed("rest", |text| {
        text.replace("LANDING", "BORE")
            .replace("[contact]", "[contact]\npairing = \"projection\"")
    });
    let far = far.err().unwrap().to_string();
    assert!(
        far.contains("no node of the ring's contact surface is within"),
        "{far}"
    );
    // Those at 0 and 15 degrees alone: accepted, and said.
    let report = projected("ring_free", 1e-5).report.contact.unwrap();
    assert_eq!((report.pairs, report.ring_nodes_without_pair), (2, 6));
}

/// In a list of contacts a ring is projected as it is alone, and only once.
#[test]
fn a_listed_ring_is_projected_like_one_alone() {
    let listed = |more: &str| {
        try_import_changed("rest", |text| {
            let sides = "[[contact]]\npairing = \"projection\"\ntolerance_m = 3e-4\nfirst = \"blisk.LANDING\"\nsecond = \"ring.RING_OUTER\"";
            text.replace("ring_rest", "ring_free").replace(
                "[contact]\nblisk = \"LANDING\"\nring = \"RING_OUTER\"",
                &format!("{sides}\n{more}"),
            )
        })
    };
    assert_eq!(
        listed("").unwrap().model,
        projected("ring_free", 3e-4).model
    );
    let more = "[[contact]]\npairing = \"projection\"\nfirst = \"blisk.BORE\"\nsecond = \"ring.RING_OUTER\"";
    let refused = listed(more).err().unwrap().to_string();
    let words = "contact[1].pairing = \"projection\" is not accepted; accepted: \"nodes\": contact[0] is projected already";
    assert!(refused.contains(words), "{refused}");
}
