//! Lumped sectors of named masses: four kinds of damper, and options refused.

use blisk::model::sector::{
    Body, LumpedOptions, ModelError, NamedContact, NamedMass, NamedSpring, lumped,
};

/// Tangential stiffness of the contact of a sector, N/m.
pub const KT: f64 = 4e5;

pub fn mass(name: &str, mass_kg: f64, body: Body) -> NamedMass {
    NamedMass {
        name: name.to_owned(),
        mass_kg,
        body,
    }
}

pub fn spring(between: [&str; 2], stiffness_n_per_m: f64, mistuned: bool) -> NamedSpring {
    NamedSpring {
        between: between.map(str::to_owned),
        stiffness_n_per_m,
        mistuned,
    }
}

pub fn contact(between: [&str; 2]) -> NamedContact {
    NamedContact {
        between: between.map(str::to_owned),
        weight: 1.0,
    }
}

/// Blade and disk of `sectors` sectors without a damper.
fn undamped(sectors: usize) -> LumpedOptions {
    LumpedOptions {
        sectors,
        mass: vec![
            mass("blade", 0.25, Body::Blisk),
            mass("disk", 1.0, Body::Blisk),
        ],
        spring: vec![
            spring(["blade", "disk"], 2.5e6, true),
            spring(["disk", "ground"], 7e6, false),
            spring(["disk", "next.disk"], 1e6, false),
        ],
        force: Some("blade".to_owned()),
        ..LumpedOptions::default()
    }
}

/// Friction between neighbouring blades: shrouds.
pub fn shroud(sectors: usize) -> LumpedOptions {
    LumpedOptions {
        contact: vec![contact(["blade", "next.blade"])],
        ..undamped(sectors)
    }
}

/// Friction between blade and ground.
pub fn ground(sectors: usize) -> LumpedOptions {
    LumpedOptions {
        contact: vec![contact(["ground", "blade"])],
        ..undamped(sectors)
    }
}

/// A body between neighbouring blades, that touches each of them, and is held by a weak spring.
pub fn underplatform(sectors: usize) -> LumpedOptions {
    let mut options = undamped(sectors);
    options.mass.push(mass("wedge", 0.01, Body::Damper));
    options.spring.push(spring(["wedge", "ground"], 1e3, false));
    options.contact = vec![
        contact(["blade", "wedge"]),
        contact(["next.blade", "wedge"]),
    ];
    options
}

/// A ring under the disk, locked to it by friction alone, with two contacts of different weight.
pub fn ring(sectors: usize) -> LumpedOptions {
    let mut options = undamped(sectors);
    options.mass.push(mass("ring", 0.05, Body::Ring));
    options.spring.push(spring(["ring", "disk"], 1e4, false));
    options
        .spring
        .push(spring(["ring", "next.ring"], 8e5, false));
    options.contact = vec![contact(["disk", "ring"]), contact(["blade", "ring"])];
    options.contact[1].weight = 0.5;
    options
}

/// Blade, disk and ring by their keys are the same chain as by name.
#[test]
fn named_masses_are_the_wheel_of_the_keys() {
    let by_key = crate::sector_sources::lumped::lumped24();
    let by_name = LumpedOptions {
        sectors: 24,
        mass: vec![
            mass("blade", 0.25, Body::Blisk),
            mass("disk", 1.0, Body::Blisk),
            mass("ring", 0.03, Body::Ring),
        ],
        spring: vec![
            spring(["disk", "ground"], 7e6, false),
            spring(["blade", "disk"], 2.5e6, true),
            spring(["ring", "disk"], 1e4, false),
            spring(["disk", "next.disk"], 2.5e5, false),
            spring(["ring", "next.ring"], 8e5, false),
        ],
        contact: vec![contact(["disk", "ring"])],
        force: Some("blade".to_owned()),
        ..LumpedOptions::default()
    };
    let (mut key, name) = (
        lumped::build(&by_key).unwrap(),
        lumped::build(&by_name).unwrap(),
    );
    // Where the masses stand is a matter of pictures.
    for (dof, other) in key.dofs.iter_mut().zip(&name.dofs) {
        dof.position_m = other.position_m;
    }
    assert_eq!(key, name);
}

#[test]
fn named_masses_are_refused_with_key_and_value() {
    type Spoil = fn(&mut LumpedOptions);
    let cases: [(Spoil, &str, &str); 12] = [
        (
            |o| o.contact[0] = contact(["blade", "blade"]),
            "model.lumped.contact[0].between",
            "it is [\"blade\", \"blade\"]; accepted: two different ends",
        ),
        (
            |o| o.contact[0] = contact(["next.blade", "next.disk"]),
            "model.lumped.contact[0].between",
            "one of them a mass of the sector",
        ),
        (
            |o| o.contact[0] = contact(["ground", "next.blade"]),
            "model.lumped.contact[0].between",
            "one of them a mass of the sector",
        ),
        (
            |o| o.spring[1] = spring(["disk", "earth"], 1.0, false),
            "model.lumped.spring[1].between[1]",
            "there is no mass \"earth\"; accepted: blade, disk",
        ),
        (
            |o| o.spring[2].mistuned = true,
            "model.lumped.spring[2].mistuned",
            "belongs to two blades",
        ),
        (
            |o| o.spring[0].mistuned = false,
            "model.lumped.spring",
            "no spring has mistuned = true",
        ),
        (
            |o| o.spring[0].stiffness_n_per_m = -1.0,
            "model.lumped.spring[0].stiffness_n_per_m",
            "is -1; accepted",
        ),
        (
            |o| o.mass[1].name = "ground".to_owned(),
            "model.lumped.mass[1].name",
            "it is \"ground\"; accepted",
        ),
        (
            |o| o.mass[1].name = "blade".to_owned(),
            "model.lumped.mass[1].name",
            "it is \"blade\"; accepted: a name of its own",
        ),
        (
            |o| o.force = None,
            "model.lumped.force",
            "it is missing; accepted",
        ),
        (
            |o| o.disk_mass_kg = 2.0,
            "model.lumped.disk_mass_kg",
            "it is 2; accepted: no such key",
        ),
        (
            |o| o.contact[0].weight = 0.0,
            "model.lumped.contact[0].weight",
            "is 0; accepted",
        ),
    ];
    for (spoil, key, message) in cases {
        let mut options = shroud(6);
        spoil(&mut options);
        let error = lumped::build(&options).unwrap_err();
        let (ModelError::Chain { key: found, .. } | ModelError::Option { key: found, .. }) = &error
        else {
            panic!("{error}");
        };
        assert_eq!(found, key);
        assert!(error.to_string().contains(message), "{error}");
    }
}

/// A contact that reaches the next sector needs one.
#[test]
fn a_wheel_of_one_sector_has_no_neighbour() {
    let error = lumped::build(&shroud(1)).unwrap_err().to_string();
    assert!(
        error.contains("next sector of a wheel of one sector"),
        "{error}"
    );
}
