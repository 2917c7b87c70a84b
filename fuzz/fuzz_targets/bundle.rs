//! Any bytes in place of one file of a sound bundle: a valid sector model or an error, never a panic.
#![no_main]

use std::fs;

use blisk::model::sector::{
    Damper, DamperBody, LumpedOptions, ParametricOptions, SectorModel, bundle, lumped, parametric,
};
use libfuzzer_sys::fuzz_target;

const FILES: [&str; 10] = [
    "model.toml",
    "K.mtx",
    "M.mtx",
    "K_blade.mtx",
    "dofs.csv",
    "cyclic.csv",
    "contact.csv",
    "force.csv",
    "observe.csv",
    "rigid.csv",
];

/// Masses and springs, or the built-in wheel with rigid wedges.
fn sound(is_rigid: bool) -> SectorModel {
    if is_rigid {
        return parametric::build(&ParametricOptions {
            sectors: 12,
            damper: Damper::Underplatform,
            damper_body: DamperBody::Rigid,
            disk_radial_elements: 1,
            blade_radial_elements: 3,
            ..ParametricOptions::default()
        })
        .expect("sound options");
    }
    lumped::build(&LumpedOptions {
        sectors: 5,
        blade_mass_kg: 0.25,
        disk_mass_kg: 1.0,
        ring_mass_kg: 0.03,
        blade_stiffness_n_per_m: 2.5e6,
        disk_ground_stiffness_n_per_m: 7.0e6,
        disk_coupling_stiffness_n_per_m: 2.5e5,
        ring_coupling_stiffness_n_per_m: 8.0e5,
        ring_disk_stiffness_n_per_m: 1.0e4,
        ..LumpedOptions::default()
    })
    .expect("sound options")
}

fuzz_target!(|input: (u8, &[u8])| {
    let (choice, bytes) = input;
    let file = FILES[usize::from(choice) % FILES.len()];
    let model = sound(choice >= 200 || file == "rigid.csv");
    let folder = tempfile::tempdir().expect("a temporary folder");
    bundle::write(&model, folder.path()).expect("a writable folder");
    fs::write(folder.path().join(file), bytes).expect("a writable folder");
    match bundle::read(folder.path()) {
        // What was read is a model like any other: it can be written, unless a name forbids it.
        Ok(model) => drop(bundle::write(&model, folder.path())),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
});
