//! Sectors with every built-in damper: where their contacts lie, what presses them, and their bundles.

use std::f64::consts::TAU;

use blisk::model::cyclic::{CentrifugalError, Hoop, centrifugal_contact};
use blisk::model::sector::{
    Body, ContactSide, Damper, ParametricOptions, SectorModel, bundle, lumped, parametric,
};

use super::chains::{ground, ring, shroud, underplatform};

fn built_in(damper: Damper) -> SectorModel {
    let options = ParametricOptions {
        damper,
        ..ParametricOptions::default()
    };
    parametric::build(&options).unwrap()
}

/// Position of a side, m; none for the ground.
fn position_m(model: &SectorModel, side: ContactSide) -> Option<[f64; 3]> {
    let node = side.node()?;
    let dof = model.dofs.iter().find(|dof| dof.node == node)?;
    let [x, y, z] = dof.position_m;
    let turn = match side {
        ContactSide::NextSector(_) => TAU / model.sectors as f64,
        ContactSide::Node(_) | ContactSide::Ground => 0.0,
    };
    let (sin, cos) = turn.sin_cos();
    Some([x * cos - y * sin, x * sin + y * cos, z])
}

#[test]
fn the_two_sides_of_every_pair_are_one_point() {
    for (damper, pairs) in [
        (Damper::Ring, 4),
        (Damper::Underplatform, 8),
        (Damper::Shroud, 4),
        (Damper::BladeToGround, 4),
    ] {
        let model = built_in(damper);
        assert_eq!(model.contact_pairs.len(), pairs, "{damper:?}");
        for pair in &model.contact_pairs {
            let here = position_m(&model, pair.first).unwrap();
            if let Some(there) = position_m(&model, pair.second) {
                let apart: f64 = (0..3).map(|axis| (here[axis] - there[axis]).powi(2)).sum();
                assert!(apart.sqrt() < 1e-12, "{damper:?}: {here:?} {there:?}");
            }
        }
        let has_damper = model.dofs.iter().any(|dof| dof.body == Body::Damper);
        assert_eq!(has_damper, damper == Damper::Underplatform);
    }
}

/// A wedge has four points on each flank, on two lines: enough to hold it but for friction.
#[test]
fn a_flank_has_points_that_are_not_on_one_line() {
    let model = built_in(Damper::Underplatform);
    for side in [0, 1] {
        let flank = model.contact_pairs.iter().skip(side).step_by(2);
        let points: Vec<[f64; 3]> = flank
            .map(|pair| position_m(&model, pair.first).unwrap())
            .collect();
        let heights = points.iter().map(|point| point[2]);
        let radii = points.iter().map(|point| point[0].hypot(point[1]));
        let spread = |values: Vec<f64>| {
            let low = values.iter().copied().fold(f64::INFINITY, f64::min);
            values.iter().copied().fold(f64::NEG_INFINITY, f64::max) - low
        };
        assert!(points.len() >= 3);
        assert!(spread(heights.collect()) > 0.01 && spread(radii.collect()) > 0.003);
    }
}

/// Without friction a symmetric wedge presses each flank by `m r Omega^2 / (2 sin a)`, a between flank and radius.
#[test]
fn a_wedge_presses_its_flanks_as_statics_says() {
    for angle_deg in [20.0, 35.0, 55.0] {
        let options = ParametricOptions {
            damper: Damper::Underplatform,
            flank_angle_deg: angle_deg,
            ..ParametricOptions::default()
        };
        let model = parametric::build(&options).unwrap();
        let found = centrifugal_contact(&model, 8e7, Hoop::Closed).unwrap();
        let expected = found.ring_load_kg_m / (2.0 * f64::sin(angle_deg.to_radians()));
        for side in [0, 1] {
            let loads = found.pair_loads_kg_m.iter().skip(side).step_by(2);
            let flank: f64 = loads.sum();
            println!("{angle_deg} deg: {flank:.6e}, statics {expected:.6e} kg m");
            assert!((flank / expected - 1.0).abs() < 1e-3, "{flank} {expected}");
        }
        // Mass times the radius of its middle, of a prism.
        let width = |radius: f64| {
            options.platform_gap_m
                + 2.0
                    * (options.rim_radius_m
                        + options.platform_height_m
                        + options.platform_thickness_m
                        - radius)
                    * f64::tan(angle_deg.to_radians())
        };
        let inner = options.rim_radius_m + options.platform_height_m;
        let outer = inner + options.platform_thickness_m;
        let area = 0.5 * (width(inner) + width(outer)) * options.platform_thickness_m;
        let share = (0.5 * (inner + outer) - options.rim_radius_m) / options.blade_height_m;
        let chord = options.blade_root_axial_chord_m
            + share * (options.blade_tip_axial_chord_m - options.blade_root_axial_chord_m);
        let mass = area * chord * options.ring_density_kg_per_m3;
        assert!((found.ring_mass_kg / mass - 1.0).abs() < 5e-3, "{mass}");
    }
}

/// What is pressed by nothing of its own has no load by rotation.
#[test]
fn shrouds_and_platforms_on_the_ground_have_no_load_by_rotation() {
    for damper in [Damper::Shroud, Damper::BladeToGround] {
        let found = centrifugal_contact(&built_in(damper), 8e7, Hoop::Closed);
        assert_eq!(found.unwrap_err(), CentrifugalError::NoRadialMotion);
    }
}

/// A bundle holds every kind of contact to the last bit, and that of a ring is one that readers knew before.
#[test]
fn bundles_of_every_kind_read_back_equal() {
    let lumped = |options| lumped::build(&options).unwrap();
    let models = [
        lumped(ring(6)),
        lumped(shroud(6)),
        lumped(ground(6)),
        lumped(underplatform(6)),
        built_in(Damper::Ring),
        built_in(Damper::Underplatform),
        built_in(Damper::Shroud),
        built_in(Damper::BladeToGround),
    ];
    for (place, model) in models.iter().enumerate() {
        let folder = tempfile::tempdir().unwrap();
        bundle::write(model, folder.path()).unwrap();
        assert_eq!(&bundle::read(folder.path()).unwrap(), model);
        let contact = std::fs::read_to_string(folder.path().join("contact.csv")).unwrap();
        let header = contact.lines().next().unwrap();
        let of_ring = header == "pair,blisk_node,ring_node,nr,nt,nz,weight";
        assert_eq!(of_ring, [0, 4].contains(&place), "{header}");
    }
}

/// A gap or a flank that leaves no platform beside the blade is refused by its key; what leaves little is built.
#[test]
fn a_platform_needs_room_beside_the_blade() {
    for damper in [Damper::Underplatform, Damper::BladeToGround] {
        let with = |platform_gap_m: f64, flank_angle_deg: f64| {
            parametric::build(&ParametricOptions {
                damper,
                platform_gap_m,
                flank_angle_deg,
                ..ParametricOptions::default()
            })
        };
        let refused = with(0.05, 35.0).unwrap_err().to_string();
        assert!(refused.contains("platform_gap_m"), "{refused}");
        let limit = refused.rsplit_once(" = ").and_then(|(_, limit)| {
            let number = limit.split_whitespace().next()?;
            number.parse::<f64>().ok()
        });
        let limit = limit.unwrap_or_else(|| panic!("no limit in {refused}"));
        let above = with(1.01 * limit, 35.0).unwrap_err().to_string();
        assert!(above.contains("platform_gap_m"), "{above}");
        assert!(with(0.9 * limit, 35.0).is_ok(), "{damper:?}, {limit} m");
    }
    // Flanks so flat that no gap would help.
    let refused = parametric::build(&ParametricOptions {
        damper: Damper::Underplatform,
        sectors: 36,
        flank_angle_deg: 64.0,
        platform_thickness_m: 0.012,
        ..ParametricOptions::default()
    });
    let refused = refused.unwrap_err().to_string();
    assert!(refused.contains("flank_angle_deg"), "{refused}");
}
