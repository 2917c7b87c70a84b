//! The cylinder between two platforms: its size and inertia, its spin, what presses it, its bundle, and what is refused.

use std::f64::consts::{PI, TAU};

use blisk::linalg::Complex64;
use blisk::model::cyclic::{CyclicSector, Hoop, centrifugal_contact};
use blisk::model::sector::{
    Body, Component, ContactSide, Damper, DamperBody, DamperShape, ParametricOptions, SectorModel,
    bundle, parametric,
};
use blisk::population::monte_carlo::ResponseRow;
use blisk::response::forced_response::ContactCondition;

use super::rigid::{
    self, NORMAL_STIFFNESS, SECTORS, SLIPPING_N, angle_of, assert_near, cartesian, cross, entry,
    reference, rows,
};
use crate::extremes::wheels::uneven;
use crate::wheels::{full, relative};

/// Higher platforms, under which the cylinders of every flank angle here have room.
fn options(damper_body: DamperBody, flank_angle_deg: f64) -> ParametricOptions {
    ParametricOptions {
        damper_shape: DamperShape::Cylinder,
        platform_height_m: 0.02,
        flank_angle_deg,
        ..rigid::options(damper_body)
    }
}

fn built(damper_body: DamperBody, flank_angle_deg: f64) -> SectorModel {
    parametric::build(&options(damper_body, flank_angle_deg)).unwrap()
}

const ANGLES_DEG: [f64; 4] = [5.0, 20.0, 35.0, 55.0];

/// Radius, length and distance from the axis of the wheel, m: the circle that touches both flanks in their middle.
fn size_m(o: &ParametricOptions) -> [f64; 3] {
    let (sin, cos) = o.flank_angle_deg.to_radians().sin_cos();
    // The flanks meet at x = outer + g / tan a, and the circle in that corner lies R / sin a below.
    let half_gap = 0.5 * o.platform_gap_m;
    let middle = o.rim_radius_m + o.platform_height_m + 0.5 * o.platform_thickness_m;
    let corner = middle + 0.5 * o.platform_thickness_m + half_gap * cos / sin;
    let along_flank = (corner - middle) / cos;
    let radius = along_flank * sin / cos;
    let share = (middle - o.rim_radius_m) / o.blade_height_m;
    let length = o.blade_root_axial_chord_m
        + share * (o.blade_tip_axial_chord_m - o.blade_root_axial_chord_m);
    [radius, length, corner - radius / sin]
}

#[test]
fn the_inertia_of_a_rigid_cylinder_is_that_of_a_cylinder() {
    for angle_deg in ANGLES_DEG {
        let options = options(DamperBody::Rigid, angle_deg);
        let model = parametric::build(&options).unwrap();
        let (dofs, centre_m) = reference(&model);
        let [radius, length, axis] = size_m(&options);
        let mass = options.ring_density_kg_per_m3 * PI * radius * radius * length;
        let across = mass * (3.0 * radius * radius + length * length) / 12.0;
        let spin = 0.5 * mass * radius * radius;
        let grounding = (TAU * options.ring_grounding_frequency_hz).powi(2);
        for (i, (&row, expected)) in dofs
            .iter()
            .zip([mass, mass, mass, across, across, spin])
            .enumerate()
        {
            let found = entry(&model.mass, row, row);
            let error = relative(found, expected);
            println!("{angle_deg} deg, dof {i}: {error:.1e}");
            // Arcs of two parabolas enclose the area of the circle, but not quite its second moment.
            assert!(
                error < if i < 3 { 1e-9 } else { 1e-4 },
                "{angle_deg} deg, dof {i}: {error:e}"
            );
            for &column in &dofs {
                let own = entry(&model.mass, row, column);
                let held = entry(&model.stiffness, row, column) - grounding * own;
                assert!(
                    held.abs() <= 1e-12 * grounding * found,
                    "{angle_deg} deg: {held:e}"
                );
                let scale = (found * entry(&model.mass, column, column)).sqrt();
                assert!(
                    row == column || own.abs() < 1e-10 * scale,
                    "{angle_deg} deg: {own:e}"
                );
            }
        }
        let expected = cartesian([axis, 0.0, 0.0], 0.5 * TAU / SECTORS as f64);
        assert_near(centre_m, expected, 1e-11);
    }
}

/// Two pairs on a line along the axis on either flank, each a point of platform and cylinder at the radius from its axis.
#[test]
fn a_cylinder_touches_either_flank_on_a_line() {
    for body in [DamperBody::Elastic, DamperBody::Rigid] {
        for angle_deg in ANGLES_DEG {
            let model = built(body, angle_deg);
            let options = options(body, angle_deg);
            let [radius, length, axis] = size_m(&options);
            let middle = 0.5 * TAU / SECTORS as f64;
            assert_eq!(model.contact_pairs.len(), 4);
            for (place, pair) in model.contact_pairs.iter().enumerate() {
                let (flank, end) = (place % 2, place / 2);
                assert!((pair.weight - 0.25).abs() < 1e-15);
                let is_next = matches!(pair.first, ContactSide::NextSector(_));
                assert_eq!(is_next, flank == 1);
                let (_, there) = model.place_of(pair.second.node().unwrap()).unwrap();
                let (_, mut here) = model.place_of(pair.first.node().unwrap()).unwrap();
                if is_next {
                    here = cartesian(here, TAU / SECTORS as f64);
                }
                // In the frame of the radial plane between the blades.
                let [x, y, z] = cartesian(there, -middle);
                let side = if flank == 0 { -1.0 } else { 1.0 };
                let (sin, cos) = angle_deg.to_radians().sin_cos();
                let expected = [
                    axis + radius * sin,
                    side * radius * cos,
                    (end as f64 - 0.5) * length,
                ];
                let normal = cartesian(cartesian(pair.normal, angle_of(there)), -middle);
                let inwards = [-sin, -side * cos, 0.0];
                for i in 0..3 {
                    assert!((here[i] - there[i]).abs() < 1e-12, "{here:?} {there:?}");
                    assert!(
                        ([x, y, z][i] - expected[i]).abs() < 1e-12,
                        "{angle_deg} deg"
                    );
                    assert!(
                        (normal[i] - inwards[i]).abs() < 1e-12,
                        "{normal:?} {inwards:?}"
                    );
                }
            }
        }
    }
}

/// The spin of a cylinder of solid elements about its axis, by unit angle, over the dofs of the model.
fn spin(model: &SectorModel, centre_m: [f64; 3]) -> Vec<f64> {
    model
        .dofs
        .iter()
        .map(|dof| {
            if dof.body != Body::Damper {
                return 0.0;
            }
            let arm = [0, 1, 2].map(|axis| dof.position_m[axis] - centre_m[axis]);
            let moved = cross([0.0, 0.0, 1.0], arm);
            let along =
                Component::DISPLACEMENTS.map(|component| f64::from(component == dof.component));
            let along = cartesian(along, angle_of(dof.position_m));
            (0..3).map(|axis| moved[axis] * along[axis]).sum()
        })
        .collect()
}

/// Relative motion of the four pairs along normal and both tangents under a motion of the damper.
fn opened(model: &SectorModel, motion: &[f64]) -> Vec<[f64; 3]> {
    let mut high = vec![false; model.dofs.len()];
    for &(_, own) in &model.cyclic_pairs {
        high[own] = true;
    }
    let kept: Vec<f64> = (0..motion.len())
        .filter(|&own| !high[own])
        .map(|own| motion[own])
        .collect();
    let rows = CyclicSector::new(model).contact_rows(0);
    assert_eq!(rows.len(), 12);
    let value = |row: &Vec<(usize, Complex64)>| -> f64 {
        row.iter().map(|&(own, factor)| factor.re * kept[own]).sum()
    };
    rows.chunks(3)
        .map(|pair| [0, 1, 2].map(|row| value(&pair[row])))
        .collect()
}

/// Nothing but friction and grounding holds the spin: it closes no pair, and every point of contact moves by the radius.
#[test]
fn the_spin_of_a_cylinder_is_a_rigid_direction_that_slides() {
    for angle_deg in ANGLES_DEG {
        let [radius, _, _] = size_m(&options(DamperBody::Rigid, angle_deg));
        let rigid = built(DamperBody::Rigid, angle_deg);
        let (dofs, centre_m) = reference(&rigid);
        let unit = (0..rigid.dofs.len())
            .map(|own| f64::from(own == dofs[5]))
            .collect();
        let elastic = built(DamperBody::Elastic, angle_deg);
        let by_node = spin(&elastic, centre_m);
        for (model, motion) in [(&rigid, unit), (&elastic, by_node)] {
            let motion: Vec<f64> = motion;
            for [closed, along, across] in opened(model, &motion) {
                assert!(closed.abs() < 1e-12 * radius, "{angle_deg} deg: {closed:e}");
                let slid = along.hypot(across);
                assert!(
                    relative(slid, radius) < 1e-9,
                    "{angle_deg} deg: {slid} {radius}"
                );
            }
            // It strains nothing: what the stiffness answers is the grounding alone.
            let grounding = (TAU * 5.0_f64).powi(2);
            let force = model.stiffness.multiply(&motion);
            let inertia = model.mass.multiply(&motion);
            let dot = |a: &[f64]| -> f64 { a.iter().zip(&motion).map(|(a, b)| a * b).sum() };
            let frequency = (dot(&force) / dot(&inertia)).sqrt();
            assert!(relative(frequency, grounding.sqrt()) < 1e-4, "{frequency}");
            let mass = entry(&rigid.mass, dofs[5], dofs[5]);
            assert!(relative(dot(&inertia), mass) < 1e-9);
        }
    }
}

/// Without friction each line carries `m r Omega^2 / (2 sin a)`, half of it at either end.
#[test]
fn a_cylinder_presses_its_lines_as_statics_says() {
    for body in [DamperBody::Elastic, DamperBody::Rigid] {
        for angle_deg in [20.0, 35.0, 55.0] {
            let options = options(body, angle_deg);
            let model = parametric::build(&options).unwrap();
            let found = centrifugal_contact(&model, NORMAL_STIFFNESS, Hoop::Closed).unwrap();
            let [radius, length, axis] = size_m(&options);
            let mass = options.ring_density_kg_per_m3 * PI * radius * radius * length;
            assert!(relative(found.ring_mass_kg, mass) < 1e-9);
            assert!(relative(found.ring_load_kg_m, mass * axis) < 1e-3);
            let sin = f64::sin(angle_deg.to_radians());
            let expected = mass * axis / (2.0 * sin);
            for side in [0, 1] {
                let line: f64 = found.pair_loads_kg_m.iter().skip(side).step_by(2).sum();
                println!("{body:?} {angle_deg} deg: {:.1e}", line / expected - 1.0);
                assert!(relative(line, expected) < 2e-3, "{line} {expected}");
            }
            assert!(
                found
                    .pair_loads_kg_m
                    .iter()
                    .all(|load| *load > 0.3 * expected)
            );
        }
    }
}

#[test]
fn a_rigid_cylinder_is_the_limit_of_an_elastic_one() {
    let deviations = uneven(SECTORS, 0.03);
    let conditions = [
        ContactCondition::Stuck,
        ContactCondition::Slide,
        full(SLIPPING_N),
    ];
    let expected = rows(&options(DamperBody::Rigid, 35.0), &deviations, &conditions);
    let slipping = expected[2].slipping_fraction.unwrap();
    assert!((0.1..0.9).contains(&slipping), "{slipping}");
    let largest = [1.0, 1e4].map(|factor| {
        let mut options = options(DamperBody::Elastic, 35.0);
        options.ring_youngs_modulus_pa *= factor;
        let found = rows(&options, &deviations, &conditions);
        let peak = |row: &ResponseRow| row.peak_amplitude_m.unwrap();
        let error = found
            .iter()
            .zip(&expected)
            .map(|(a, b)| relative(peak(a), peak(b)));
        error.fold(0.0, f64::max)
    });
    println!("{largest:?}, slipping {slipping:.2}");
    assert!(largest[1] < 1e-5 && largest[1] < largest[0], "{largest:?}");
}

#[test]
fn bundles_of_cylinders_read_back_equal() {
    for body in [DamperBody::Elastic, DamperBody::Rigid] {
        let model = built(body, 35.0);
        let folder = tempfile::tempdir().unwrap();
        bundle::write(&model, folder.path()).unwrap();
        assert_eq!(bundle::read(folder.path()).unwrap(), model);
    }
}

/// Other dampers have no form.
#[test]
fn the_form_says_nothing_to_other_dampers() {
    for damper in [Damper::Ring, Damper::Shroud, Damper::BladeToGround] {
        let [wedge, cylinder] = [DamperShape::Wedge, DamperShape::Cylinder].map(|damper_shape| {
            parametric::build(&ParametricOptions {
                damper,
                damper_shape,
                ..ParametricOptions::default()
            })
            .unwrap()
        });
        assert_eq!(wedge, cylinder, "{damper:?}");
    }
}

/// A cylinder that reaches the rim or the blades is refused by its key; within the limit it is built.
#[test]
fn a_cylinder_needs_room_under_the_platforms() {
    type Key = fn(&mut ParametricOptions) -> &mut f64;
    let narrow =
        |sectors: usize, height_m: f64, thickness_m: f64, angle_deg: f64| ParametricOptions {
            sectors,
            platform_height_m: height_m,
            platform_thickness_m: thickness_m,
            ..options(DamperBody::Rigid, angle_deg)
        };
    let cases: [(ParametricOptions, &str, Key, f64); 3] = [
        (
            narrow(12, 1e-3, 6e-3, 35.0),
            "platform_height_m",
            |o| &mut o.platform_height_m,
            1.01,
        ),
        (
            narrow(19, 0.04, 0.012, 60.0),
            "platform_gap_m",
            |o| &mut o.platform_gap_m,
            0.99,
        ),
        (
            narrow(18, 0.06, 0.0115, 64.0),
            "platform_thickness_m",
            |o| &mut o.platform_thickness_m,
            0.8,
        ),
    ];
    for (mut options, name, key, within) in cases {
        let refused = |options: &ParametricOptions| {
            let error = parametric::build(options).err();
            error.map(|error| error.to_string()).unwrap_or_default()
        };
        let message = refused(&options);
        assert!(message.contains(name), "{name}: {message}");
        let limit = message.rsplit_once(" = ").and_then(|(_, limit)| {
            let number = limit.split_whitespace().next()?;
            number.parse::<f64>().ok()
        });
        let limit = limit.unwrap_or_else(|| panic!("no limit in {message}"));
        *key(&mut options) = within * limit;
        assert_eq!(refused(&options), "", "{name} {limit}");
        if within > 0.9 {
            *key(&mut options) = limit / within;
            assert!(refused(&options).contains(name), "{name} {limit}");
        }
    }
}
