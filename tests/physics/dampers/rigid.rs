//! The rigid wedge: its inertia, the limit of the elastic one, what presses it, its bundle, and what is refused.

use std::f64::consts::TAU;

use blisk::linalg::SymmetricSparse;
use blisk::model::cyclic::{CyclicSector, Hoop, centrifugal_contact};
use blisk::model::reduction::BasisChoice;
use blisk::model::reduction_digest;
use blisk::model::sector::{
    Body, Component, Damper, DamperBody, ObservedNode, ParametricOptions, SectorModel, bundle,
    parametric, validate,
};
use blisk::population::monte_carlo::{ResponseRow, Scenario};
use blisk::response::forced_response::{ContactCondition, SolverOptions};
use blisk::response::friction::{ContactLaw, PairParameters};
use blisk::response::harmonic_balance::{Damping, Status};

use crate::extremes::wheels::{under, uneven};
use crate::wheels::{Wheel, full, pattern, relative};

pub const SECTORS: usize = 12;
const ORDER: u32 = 3;
pub const NORMAL_STIFFNESS: f64 = 8e7;

pub fn options(damper_body: DamperBody) -> ParametricOptions {
    ParametricOptions {
        sectors: SECTORS,
        damper: Damper::Underplatform,
        damper_body,
        ..ParametricOptions::default()
    }
}

fn rigid() -> SectorModel {
    parametric::build(&options(DamperBody::Rigid)).unwrap()
}

/// Dofs and position of the centre of mass.
pub fn reference(model: &SectorModel) -> ([usize; 6], [f64; 3]) {
    let node = model.rigid_points[0].reference;
    let dofs = Component::RIGID.map(|component| model.dof_of(node, component).unwrap());
    (dofs, model.dofs[dofs[0]].position_m)
}

pub fn entry(matrix: &SymmetricSparse, row: usize, column: usize) -> f64 {
    let (row, column) = (row.max(column), row.min(column));
    let mut entries = matrix.lower_entries();
    entries
        .find(|&(i, j, _)| (i, j) == (row, column))
        .map_or(0.0, |(.., value)| value)
}

pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3])
}

/// Cartesian components of a vector given in (r, theta, z) at an angle.
pub fn cartesian([r, theta, z]: [f64; 3], angle: f64) -> [f64; 3] {
    let (sin, cos) = angle.sin_cos();
    [r * cos - theta * sin, r * sin + theta * cos, z]
}

pub fn assert_near(found_m: [f64; 3], expected_m: [f64; 3], tolerance_m: f64) {
    let is_near = (0..3).all(|axis| (found_m[axis] - expected_m[axis]).abs() < tolerance_m);
    assert!(is_near, "{found_m:?} {expected_m:?}");
}

pub fn angle_of([x, y, _]: [f64; 3]) -> f64 {
    y.atan2(x)
}

/// Mass, centre and moments of inertia of a prism with a trapezoidal section, whose ends are as long at every radius.
#[test]
fn the_inertia_of_a_rigid_wedge_is_that_of_a_trapezoidal_prism() {
    for angle_deg in [20.0, 35.0] {
        let options = ParametricOptions {
            flank_angle_deg: angle_deg,
            blade_tip_axial_chord_m: 0.04,
            ring_grounding_frequency_hz: 7.0,
            ..options(DamperBody::Rigid)
        };
        let model = parametric::build(&options).unwrap();
        let (dofs, centre_m) = reference(&model);
        let height = options.platform_thickness_m;
        let length = options.blade_root_axial_chord_m;
        let b = options.platform_gap_m;
        let a = b + 2.0 * height * f64::tan(angle_deg.to_radians());
        let area = 0.5 * height * (a + b);
        let about_theta = height.powi(3) * (a * a + 4.0 * a * b + b * b) / (36.0 * (a + b));
        let about_r = height * (a + b) * (a * a + b * b) / 48.0;
        let along_z = area * length.powi(3) / 12.0;
        let density = options.ring_density_kg_per_m3;
        let mass = density * area * length;
        let diagonal = [
            mass,
            mass,
            mass,
            density * (length * about_r + along_z),
            density * (length * about_theta + along_z),
            density * length * (about_r + about_theta),
        ];
        for (i, &row) in dofs.iter().enumerate() {
            for (j, &column) in dofs.iter().enumerate() {
                let expected = if i == j { diagonal[i] } else { 0.0 };
                let error = entry(&model.mass, row, column) - expected;
                let scale = (diagonal[i] * diagonal[j]).sqrt();
                assert!(
                    error.abs() < 1e-9 * scale,
                    "{angle_deg} deg, {i} {j}: {error:e}"
                );
                let held = (TAU * 7.0).powi(2) * entry(&model.mass, row, column);
                let error = entry(&model.stiffness, row, column) - held;
                assert!(error.abs() <= 1e-12 * held.abs(), "{error:e}");
            }
        }
        let inner = options.rim_radius_m + options.platform_height_m;
        let radius = inner + height / 3.0 * (a + 2.0 * b) / (a + b);
        let expected = cartesian([radius, 0.0, 0.0], 0.5 * TAU / SECTORS as f64);
        assert_near(centre_m, expected, 1e-12);
    }
}

/// A rigid motion of the wedge moves the contact as that motion of the nodes of the elastic one.
#[test]
fn rows_of_a_rigid_wedge_are_those_of_the_elastic_one_in_rigid_motion() {
    let (rigid, elastic) = (
        rigid(),
        parametric::build(&options(DamperBody::Elastic)).unwrap(),
    );
    let (dofs, centre_m) = reference(&rigid);
    let turn = angle_of(centre_m);
    // 1 in each of the six dofs alone.
    for (place, &dof) in dofs.iter().enumerate() {
        let mut unit = [0.0; 6];
        unit[place] = 1.0;
        let shift = cartesian([unit[0], unit[1], unit[2]], turn);
        let spin = cartesian([unit[3], unit[4], unit[5]], turn);
        let by_node: Vec<f64> = elastic
            .dofs
            .iter()
            .map(|own| {
                if own.body != Body::Damper {
                    return 0.0;
                }
                let arm = [0, 1, 2].map(|axis| own.position_m[axis] - centre_m[axis]);
                let turned = cross(spin, arm);
                let moved = [0, 1, 2].map(|axis| shift[axis] + turned[axis]);
                let along =
                    Component::DISPLACEMENTS.map(|component| f64::from(component == own.component));
                let along = cartesian(along, angle_of(own.position_m));
                (0..3).map(|axis| moved[axis] * along[axis]).sum()
            })
            .collect();
        let by_reference: Vec<f64> = (0..rigid.dofs.len())
            .map(|own| f64::from(own == dof))
            .collect();
        let opened = |model: &SectorModel, motion: &[f64]| -> Vec<f64> {
            // Dofs of the damper are on no cyclic face, so that they come in the order of the model.
            let mut high = vec![false; model.dofs.len()];
            for &(_, own) in &model.cyclic_pairs {
                high[own] = true;
            }
            let kept: Vec<f64> = (0..motion.len())
                .filter(|&own| !high[own])
                .map(|own| motion[own])
                .collect();
            let rows = CyclicSector::new(model).contact_rows(0);
            rows.iter()
                .map(|row| row.iter().map(|&(own, factor)| factor.re * kept[own]).sum())
                .collect()
        };
        let (found, expected) = (opened(&rigid, &by_reference), opened(&elastic, &by_node));
        assert_eq!(found.len(), 24);
        assert!(expected.iter().any(|value| value.abs() > 1e-3));
        for (found, expected) in found.iter().zip(&expected) {
            assert!(
                (found - expected).abs() < 1e-13,
                "{place}: {found} {expected}"
            );
        }
    }
}

pub fn rows(
    options: &ParametricOptions,
    deviations: &[f64],
    conditions: &[ContactCondition],
) -> Vec<ResponseRow> {
    let contact = PairParameters {
        normal_load_n: 0.0,
        normal_stiffness_n_per_m: NORMAL_STIFFNESS,
        tangential_stiffness_n_per_m: 0.7 * NORMAL_STIFFNESS,
        friction_coefficient: 0.3,
    };
    let basis = BasisChoice::StickSlide { stick: 3, slide: 3 };
    let damping = Damping::StructuralLossFactor(0.002);
    let sector = parametric::build(options).unwrap();
    let wheel = Wheel::of(&sector, ContactLaw::Simplified3d, contact, damping, basis);
    let settings = SolverOptions {
        peak_tolerance: 1e-6,
        residual_tolerance: 1e-9,
        ..SolverOptions::default()
    };
    let solver = wheel.solver(&[1], settings);
    let scenarios: Vec<Scenario> = conditions.iter().map(|&own| under(ORDER, own)).collect();
    let tuned: Vec<_> = scenarios.iter().map(|own| solver.tuned(own)).collect();
    let wanted: Vec<_> = scenarios.iter().zip(&tuned).collect();
    let rows = solver.rows(&pattern(deviations), &wanted);
    assert!(rows.iter().all(|row| row.status == Status::Ok));
    rows
}

/// A load under which the contact slips, N for 1 N of excitation.
pub const SLIPPING_N: f64 = 500.0;

#[test]
fn a_rigid_wedge_is_the_limit_of_an_elastic_one() {
    let deviations = uneven(SECTORS, 0.03);
    let conditions = [
        ContactCondition::Stuck,
        ContactCondition::Slide,
        full(SLIPPING_N),
    ];
    let expected = rows(&options(DamperBody::Rigid), &deviations, &conditions);
    let slipping = expected[2].slipping_fraction.unwrap();
    println!("slipping {slipping:.2}");
    assert!((0.1..0.9).contains(&slipping), "{slipping}");
    let mut errors = Vec::new();
    for factor in [1.0, 1e2, 1e4, 1e5] {
        let mut options = options(DamperBody::Elastic);
        options.ring_youngs_modulus_pa *= factor;
        let found = rows(&options, &deviations, &conditions);
        let error: Vec<f64> = found
            .iter()
            .zip(&expected)
            .map(|(found, expected)| {
                let peak = |row: &ResponseRow| row.peak_amplitude_m.unwrap();
                let frequency = |row: &ResponseRow| row.peak_frequency_hz.unwrap();
                relative(peak(found), peak(expected))
                    .max(relative(frequency(found), frequency(expected)))
            })
            .collect();
        println!("{factor:e}: {error:?}");
        errors.push(error);
    }
    let largest: Vec<f64> = errors
        .iter()
        .map(|error| error.iter().copied().fold(0.0, f64::max))
        .collect();
    println!("{largest:?}");
    assert!(largest[2] < 1e-5 && largest[3] < 2e-6, "{largest:?}");
    assert!(largest.windows(2).all(|two| two[0] > two[1]), "{largest:?}");
}

/// The tuned wheel answers as one of its sectors, and blades numbered from another one on answer alike.
#[test]
fn the_wheel_with_rigid_wedges_is_cyclic() {
    let options = options(DamperBody::Rigid);
    let condition = [full(SLIPPING_N)];
    let tuned = rows(&options, &[0.0; SECTORS], &condition).remove(0);
    let factor = tuned.amplification_factor.unwrap();
    assert!((factor - 1.0).abs() < 1e-6, "{factor}");
    let deviations = uneven(SECTORS, 0.03);
    let mut shifted = deviations.clone();
    shifted.rotate_left(2);
    let row = rows(&options, &deviations, &condition).remove(0);
    let other = rows(&options, &shifted, &condition).remove(0);
    let (amplitude, again) = (
        row.peak_amplitude_m.unwrap(),
        other.peak_amplitude_m.unwrap(),
    );
    assert!(relative(again, amplitude) < 1e-5, "{again} {amplitude}");
    let blades = [&row, &other].map(|row| row.peak_blade.unwrap() as usize);
    assert_eq!((blades[1] + 2) % SECTORS, blades[0]);
    assert!(relative(tuned.peak_amplitude_m.unwrap(), amplitude) > 1e-3);
}

/// Without friction each flank of a symmetric wedge carries `m r Omega^2 / (2 sin a)`.
#[test]
fn a_rigid_wedge_presses_its_flanks_as_statics_says() {
    for angle_deg in [20.0, 35.0, 55.0] {
        let options = ParametricOptions {
            flank_angle_deg: angle_deg,
            ring_grounding_frequency_hz: 0.0,
            ..options(DamperBody::Rigid)
        };
        let model = parametric::build(&options).unwrap();
        let found = centrifugal_contact(&model, NORMAL_STIFFNESS, Hoop::Closed).unwrap();
        let (dofs, centre_m) = reference(&model);
        let mass = entry(&model.mass, dofs[0], dofs[0]);
        assert!(relative(found.ring_mass_kg, mass) < 1e-12);
        let load = mass * centre_m[0].hypot(centre_m[1]);
        assert!(relative(found.ring_load_kg_m, load) < 1e-12);
        let expected = load / (2.0 * f64::sin(angle_deg.to_radians()));
        for side in [0, 1] {
            let flank: f64 = found.pair_loads_kg_m.iter().skip(side).step_by(2).sum();
            println!("{angle_deg} deg: {:e}", flank / expected - 1.0);
            assert!(relative(flank, expected) < 1e-6, "{flank} {expected}");
        }
    }
}

/// A body of point masses, skew to the axes: the pairs balance the centrifugal forces on its points and their moment.
#[test]
fn a_skew_rigid_body_is_in_equilibrium() {
    let mut model = parametric::build(&ParametricOptions {
        ring_grounding_frequency_hz: 0.0,
        ..options(DamperBody::Rigid)
    })
    .unwrap();
    let (dofs, centre_m) = reference(&model);
    let turn = angle_of(centre_m);
    let mass = entry(&model.mass, dofs[0], dofs[0]);
    let points: Vec<[f64; 3]> = [[0.001, 0.004, 0.010], [-0.002, 0.001, 0.012]]
        .into_iter()
        .flat_map(|point| [point, point.map(|value: f64| -value)])
        .collect();
    let mut triplets: Vec<_> = model
        .mass
        .lower_entries()
        .filter(|&(row, column, _)| !(dofs[3..].contains(&row) && dofs[3..].contains(&column)))
        .collect();
    for i in 0..3 {
        for j in 0..=i {
            let sum = |s: &[f64; 3]| {
                let square: f64 = s.iter().map(|value| value * value).sum();
                0.25 * mass * (if i == j { square } else { 0.0 } - s[i] * s[j])
            };
            triplets.push((dofs[3 + i], dofs[3 + j], points.iter().map(sum).sum()));
        }
    }
    model.mass = SymmetricSparse::from_lower_triplets(model.dofs.len(), &triplets);
    validate(&model).unwrap();

    let mut moment = [0.0; 3];
    for point in &points {
        let arm = cartesian(*point, turn);
        let field = [centre_m[0] + arm[0], centre_m[1] + arm[1], 0.0];
        let own = cross(arm, field);
        moment = [0, 1, 2].map(|axis| moment[axis] + 0.25 * mass * own[axis]);
    }
    let size = moment.iter().map(|value| value.abs()).fold(0.0, f64::max);
    assert!(size > 1e-5 * mass, "the body is skew: {moment:?}");
    let found = centrifugal_contact(&model, NORMAL_STIFFNESS, Hoop::Closed).unwrap();
    println!("{:?}", found.pair_loads_kg_m);
    for (pair, load) in model.contact_pairs.iter().zip(&found.pair_loads_kg_m) {
        let (_, position_m) = model.place_of(pair.second.node().unwrap()).unwrap();
        let arm = [0, 1, 2].map(|axis| position_m[axis] - centre_m[axis]);
        let own = cross(arm, cartesian(pair.normal, angle_of(position_m)));
        moment = [0, 1, 2].map(|axis| moment[axis] + load * own[axis]);
    }
    println!("{moment:?} of {size:e} kg m2");
    assert!(
        moment.iter().all(|left| left.abs() < 1e-4 * size),
        "{moment:?}"
    );
}

/// A bundle holds the rigid body to the last bit; one without has neither the file nor a word of it.
#[test]
fn bundles_of_a_rigid_wedge_read_back_equal() {
    let model = rigid();
    let folder = tempfile::tempdir().unwrap();
    bundle::write(&model, folder.path()).unwrap();
    assert_eq!(bundle::read(folder.path()).unwrap(), model);
    let text = |folder: &tempfile::TempDir, name: &str| {
        std::fs::read_to_string(folder.path().join(name)).unwrap()
    };
    let table = text(&folder, "rigid.csv");
    assert!(table.starts_with("node,reference,x,y,z\n"), "{table}");
    assert_eq!(table.lines().count(), 9);
    let dofs = text(&folder, "dofs.csv");
    for word in ["rr", "rt", "rz"] {
        assert_eq!(dofs.matches(&format!(",{word},")).count(), 1, "{word}");
    }
    std::fs::write(folder.path().join("dofs.csv"), dofs.replace(",rr,", ",rx,")).unwrap();
    let error = bundle::read(folder.path()).unwrap_err().to_string();
    assert!(error.contains("r, t, z, rr, rt or rz"), "{error}");

    let elastic = parametric::build(&options(DamperBody::Elastic)).unwrap();
    let folder = tempfile::tempdir().unwrap();
    bundle::write(&elastic, folder.path()).unwrap();
    assert!(!text(&folder, "model.toml").contains("rigid"));
    assert!(!folder.path().join("rigid.csv").exists());
}

/// Where the points lie is part of the identity of a model; the key says nothing to other dampers.
#[test]
fn rigid_points_belong_to_the_identity() {
    let model = rigid();
    let mut moved = model.clone();
    moved.rigid_points[3].position_m[2] += 1e-4;
    assert_ne!(reduction_digest(&model, ""), reduction_digest(&moved, ""));
    let ring = |damper_body| ParametricOptions {
        damper: Damper::Ring,
        ..options(damper_body)
    };
    assert_eq!(
        parametric::build(&ring(DamperBody::Rigid)).unwrap(),
        parametric::build(&ring(DamperBody::Elastic)).unwrap()
    );
}

#[test]
fn points_of_rigid_bodies_are_refused_with_place_and_value() {
    type Spoil = fn(&mut SectorModel);
    let cases: [(Spoil, &str); 9] = [
        (
            |m| m.rigid_points[1].position_m[1] = f64::NAN,
            "y of rigid point 1 is NaN",
        ),
        (
            |m| m.rigid_points[2].node = m.dofs[0].node,
            "has dofs of its own; accepted: a number that no node of the dofs has",
        ),
        (
            |m| m.rigid_points[2].node = m.rigid_points[0].node,
            "is rigid point 0 too; accepted: each number once",
        ),
        (
            |m| m.rigid_points[2].reference = 999_999,
            "rigid point 2 refers to node 999999, which has no dof",
        ),
        (
            |m| m.rigid_points[2].reference = m.dofs[m.cyclic_pairs[0].1].node,
            "on the high cyclic face",
        ),
        (
            |m| m.rigid_points[2].reference = m.observed[0].node,
            "has no component rr; accepted: a node with r, t, z, rr, rt and rz",
        ),
        (
            |m| {
                let (dofs, _) = reference(m);
                let entry = (dofs[4], dofs[2], 1e-8);
                let entries: Vec<_> = m
                    .mass
                    .lower_entries()
                    .filter(|&(i, j, _)| (i, j) != (entry.0, entry.1))
                    .chain([entry])
                    .collect();
                m.mass = SymmetricSparse::from_lower_triplets(m.dofs.len(), &entries);
            },
            "has a mass of 1e-8 between z and rt; accepted: the centre of mass",
        ),
        (
            |m| {
                let [x, y, z] = m.rigid_points[0].position_m;
                m.rigid_points[0].position_m = [x, y + 1e-3, z];
            },
            "rad apart; accepted: the same theta",
        ),
        (
            |m| {
                m.observed.push(ObservedNode {
                    name: "corner".to_owned(),
                    node: m.rigid_points[0].node,
                });
            },
            "which has no dof; accepted: a node of the dof table",
        ),
    ];
    let whole = rigid();
    for (spoil, message) in cases {
        let mut model = whole.clone();
        spoil(&mut model);
        let error = validate(&model).unwrap_err().to_string();
        assert!(error.contains(message), "{message}: {error}");
    }
}
