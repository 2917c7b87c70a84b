//! The built-in bladed disk: size, mass, faces, contact, frequencies, and options refused.

use std::f64::consts::{PI, TAU};

use blisk::linalg::lowest_modes;
use blisk::model::cyclic::CyclicSector;
use blisk::model::sector::{
    Body, Component, ModelError, ParametricOptions, SectorModel, parametric,
};

fn built(change: impl FnOnce(&mut ParametricOptions)) -> SectorModel {
    let mut options = ParametricOptions::default();
    change(&mut options);
    parametric::build(&options).unwrap()
}

/// Mass of a body that is free to move, kg per sector: rigid axial motion.
fn mass_kg(model: &SectorModel, body: Body) -> f64 {
    let motion: Vec<f64> = model
        .dofs
        .iter()
        .map(|dof| {
            f64::from(u8::from(
                dof.body == body && dof.component == Component::Axial,
            ))
        })
        .collect();
    model
        .mass
        .multiply(&motion)
        .iter()
        .zip(&motion)
        .map(|(f, u)| f * u)
        .sum()
}

/// The `count` lowest frequencies of a nodal diameter, Hz, with contact springs per sector in N/m.
fn frequencies(
    model: &SectorModel,
    h: usize,
    normal: f64,
    tangential: f64,
    count: usize,
) -> Vec<f64> {
    let sector = CyclicSector::new(model);
    let springs: Vec<f64> = model
        .contact_pairs
        .iter()
        .flat_map(|pair| [normal, tangential, tangential].map(|k| k * pair.weight))
        .collect();
    let stiffness = sector
        .stiffness(h)
        .plus(1.0, &sector.contact_stiffness(&springs, h));
    let factor = stiffness.factor().unwrap();
    let (values, _) = lowest_modes(&factor, &sector.mass(h), 0.0, count).unwrap();
    values.iter().map(|value| value.sqrt() / TAU).collect()
}

#[test]
fn default_model_has_a_thousand_dofs_a_light_ring_and_few_pairs() {
    let model = built(|_| {});
    assert_eq!(model.sectors, 24);
    assert!(
        (1000..=2000).contains(&model.dofs.len()),
        "{} dofs",
        model.dofs.len()
    );
    assert!((4..=6).contains(&model.contact_pairs.len()));
    let share = mass_kg(&model, Body::Ring) / mass_kg(&model, Body::Blisk);
    assert!(
        (0.02..0.06).contains(&share),
        "the ring has {share} of the blisk's mass"
    );
    let weights: f64 = model.contact_pairs.iter().map(|pair| pair.weight).sum();
    assert!((weights - 1.0).abs() < 1e-14);
    assert_eq!(model.observed[0].name, "tip_le");
    assert_eq!(model.observed[1].name, "tip_te");
    let force: f64 = model.force.iter().map(|(_, force)| force.norm_sqr()).sum();
    assert!((force - 1.0).abs() < 1e-14);
}

#[test]
fn mass_of_the_ring_is_that_of_its_section() {
    let o = ParametricOptions::default();
    let outer = o.flange_inner_radius_m();
    let section =
        PI * (outer.powi(2) - (outer - o.ring_thickness_m).powi(2)) * o.ring_axial_width_m;
    let exact = o.ring_density_kg_per_m3 * section / o.sectors as f64;
    let mass = mass_kg(&built(|_| {}), Body::Ring);
    // Quadratic arcs stand for circular ones.
    assert!(
        (mass / exact - 1.0).abs() < 1e-6,
        "{mass} instead of {exact}"
    );
}

#[test]
fn stick_and_slide_differ_where_the_disk_takes_part_and_the_blade_family_is_apart() {
    let model = built(|_| {});
    let (normal, tangential) = (2.0e8, 1.0e8);
    let stick = frequencies(&model, 3, normal, tangential, 3);
    let slide = frequencies(&model, 3, normal, 0.0, 3);
    let shift = stick[0] / slide[0] - 1.0;
    assert!(
        (0.005..0.03).contains(&shift),
        "stick {} Hz, slide {} Hz",
        stick[0],
        slide[0]
    );
    assert!((300.0..900.0).contains(&stick[0]), "{} Hz", stick[0]);
    assert!(stick[1] > 1.2 * stick[0], "{stick:?}");
}

#[test]
fn ungrounded_ring_has_its_rigid_modes_and_the_grounding_lifts_them_to_five_hertz() {
    let grounded = frequencies(&built(|_| {}), 0, 0.0, 0.0, 2);
    for frequency in grounded {
        assert!((frequency - 5.0).abs() < 1e-3, "{frequency} Hz");
    }
    let free = built(|options| options.ring_grounding_frequency_hz = 0.0);
    let sector = CyclicSector::new(&free);
    let (stiffness, mass) = (sector.stiffness(0), sector.mass(0));
    let shift = -1.0e4;
    let factor = stiffness.plus(-shift, &mass).factor().unwrap();
    let (values, _) = lowest_modes(&factor, &mass, shift, 2).unwrap();
    for value in values {
        assert!(value.abs() < 1e-2 * TAU * TAU, "eigenvalue {value:e}");
    }
}

#[test]
fn frequencies_settle_as_the_mesh_is_refined() {
    let coarse = frequencies(&built(|_| {}), 3, 2.0e8, 1.0e8, 1)[0];
    let fine = frequencies(
        &built(|options| {
            options.disk_radial_elements = 5;
            options.blade_radial_elements = 8;
            options.rim_axial_elements = 2;
            options.disk_axial_elements = 2;
        }),
        3,
        2.0e8,
        1.0e8,
        1,
    )[0];
    assert!(
        (coarse / fine - 1.0).abs() < 0.02,
        "{coarse} Hz, refined {fine} Hz"
    );
}

#[test]
fn turning_the_stagger_over_mirrors_the_wheel() {
    // The mirrored sector has the same frequencies at the same nodal diameter.
    let one = frequencies(&built(|_| {}), 3, 2.0e8, 1.0e8, 4);
    let mirrored = built(|options| {
        options.blade_stagger_angle_deg = -options.blade_stagger_angle_deg;
        options.blade_twist_deg = -options.blade_twist_deg;
    });
    for (a, b) in one.iter().zip(frequencies(&mirrored, 3, 2.0e8, 1.0e8, 4)) {
        assert!((a / b - 1.0).abs() < 1e-8, "{a} Hz and {b} Hz");
    }
}

#[test]
fn other_shapes_build_too() {
    for (name, model) in [
        ("8 sectors", built(|o| o.sectors = 8)),
        (
            "96 thin blades",
            built(|o| {
                o.sectors = 96;
                o.blade_root_thickness_m = 0.003;
            }),
        ),
        (
            "thin flange, short ring",
            built(|o| {
                o.flange_thickness_m = 0.006;
                o.ring_axial_width_m = 0.010;
            }),
        ),
        ("narrow root", built(|o| o.blade_root_axial_chord_m = 0.030)),
        (
            "root as thin as the disk",
            built(|o| o.blade_root_axial_chord_m = 0.006),
        ),
        (
            "no stagger",
            built(|o| {
                o.blade_stagger_angle_deg = 0.0;
                o.blade_twist_deg = 0.0;
            }),
        ),
        (
            "fine mesh",
            built(|o| {
                o.passage_elements = 2;
                o.blade_thickness_elements = 2;
                o.flange_axial_elements = 2;
                o.ring_radial_elements = 2;
            }),
        ),
    ] {
        let weights: f64 = model.contact_pairs.iter().map(|pair| pair.weight).sum();
        assert!((weights - 1.0).abs() < 1e-12, "{name}: {weights}");
        assert!(frequencies(&model, 2, 2.0e8, 1.0e8, 1)[0] > 10.0, "{name}");
    }
}

#[test]
fn options_out_of_range_are_refused_by_key_value_and_what_is_accepted() {
    type Change = fn(&mut ParametricOptions);
    let cases: [(&str, &str, Change); 17] = [
        ("sectors", "is 2;", |o| o.sectors = 2),
        ("disk_radial_elements", "is 0;", |o| {
            o.disk_radial_elements = 0;
        }),
        ("blade_radial_elements", "is 65;", |o| {
            o.blade_radial_elements = 65;
        }),
        ("disk_thickness_m", "is -0.006;", |o| {
            o.disk_thickness_m = -0.006;
        }),
        ("blade_height_m", "is 0;", |o| o.blade_height_m = 0.0),
        ("blade_height_m", "is NaN;", |o| o.blade_height_m = f64::NAN),
        ("ring_density_kg_per_m3", "is inf;", |o| {
            o.ring_density_kg_per_m3 = f64::INFINITY;
        }),
        ("blisk_poisson_ratio", "is 0.5;", |o| {
            o.blisk_poisson_ratio = 0.5;
        }),
        ("ring_grounding_frequency_hz", "is -1;", |o| {
            o.ring_grounding_frequency_hz = -1.0;
        }),
        ("bore_radius_m", "is 0.196;", |o| {
            o.bore_radius_m = 0.196;
        }),
        ("flange_thickness_m", "is 0.011;", |o| {
            o.flange_thickness_m = 0.011;
        }),
        ("ring_axial_width_m", "is 0.02;", |o| {
            o.ring_axial_width_m = 0.020;
        }),
        ("disk_thickness_m", "is 0.05;", |o| {
            o.disk_thickness_m = 0.050;
        }),
        ("blade_root_axial_chord_m", "is 0.041;", |o| {
            o.blade_root_axial_chord_m = 0.041;
        }),
        ("ring_thickness_m", "is 0.2;", |o| o.ring_thickness_m = 0.2),
        ("blade_root_thickness_m", "is 0.05;", |o| {
            o.blade_root_thickness_m = 0.05;
        }),
        ("blade_twist_deg", "is 40;", |o| o.blade_twist_deg = 40.0),
    ];
    for (key, value, change) in cases {
        let mut options = ParametricOptions::default();
        change(&mut options);
        let error = parametric::build(&options).unwrap_err();
        assert!(matches!(error, ModelError::Option { .. }), "{key}: {error}");
        let message = error.to_string();
        assert!(
            message.contains(&format!("`model.parametric.{key}`")),
            "{key}: {message}"
        );
        assert!(
            message.contains(value) && message.contains("accepted:"),
            "{key}: {message}"
        );
    }
}

#[test]
fn unknown_key_is_refused() {
    let error = toml::from_str::<ParametricOptions>("rim_radius_mm = 205.0").unwrap_err();
    assert!(error.to_string().contains("rim_radius_mm"), "{error}");
}
