//! Masses and springs: the reference wheel, the one-dof-per-sector oracle, and options refused.

use std::f64::consts::TAU;

use blisk::linalg::{SymmetricSparse, lowest_modes};
use blisk::model::cyclic::CyclicSector;
use blisk::model::sector::{
    ContactSide, LumpedOptions, ModelError, SectorModel, lumped, matrix_market,
};

use super::data;

pub fn lumped24() -> LumpedOptions {
    LumpedOptions {
        sectors: 24,
        blade_mass_kg: 0.25,
        disk_mass_kg: 1.0,
        ring_mass_kg: 0.03,
        blade_stiffness_n_per_m: 2.5e6,
        disk_ground_stiffness_n_per_m: 7.0e6,
        disk_coupling_stiffness_n_per_m: 2.5e5,
        ring_coupling_stiffness_n_per_m: 8.0e5,
        ring_disk_stiffness_n_per_m: 1.0e4,
        ..LumpedOptions::default()
    }
}

pub fn one_dof(sectors: usize) -> LumpedOptions {
    LumpedOptions {
        sectors,
        blade_mass_kg: 0.0114,
        blade_stiffness_n_per_m: 430_000.0,
        blade_coupling_stiffness_n_per_m: 45_430.0,
        ..LumpedOptions::default()
    }
}

/// The wheel of N sectors, `per_sector` independent dofs each, in the order of the sector model.
pub fn wheel(model: &SectorModel, part: &SymmetricSparse, per_sector: usize) -> SymmetricSparse {
    let n = model.sectors * per_sector;
    let mut triplets = Vec::new();
    for sector in 0..model.sectors {
        let place = |dof: usize| match model.cyclic_pairs.iter().find(|&&(_, high)| high == dof) {
            Some(&(low, _)) => ((sector + 1) % model.sectors) * per_sector + low,
            None => sector * per_sector + dof,
        };
        for (row, column, value) in part.entries() {
            let (row, column) = (place(row), place(column));
            if row >= column {
                triplets.push((row, column, value));
            }
        }
    }
    SymmetricSparse::from_lower_triplets(n, &triplets)
}

#[test]
fn lumped24_assembles_to_the_reference_matrices_exactly() {
    let model = lumped::build(&lumped24()).unwrap();
    assert_eq!(model.contact_pairs.len(), 1);
    assert_eq!(
        (model.contact_pairs[0].first, model.contact_pairs[0].second),
        (ContactSide::Node(1), ContactSide::Node(2))
    );
    for (part, file) in [(&model.stiffness, "K.mtx"), (&model.mass, "M.mtx")] {
        let reference = matrix_market::read(&data("lumped24").join(file)).unwrap();
        assert_eq!(wheel(&model, part, 3), reference, "{file}");
    }
    let blade: Vec<_> = model.blade_stiffness.lower_entries().collect();
    assert_eq!(blade, [(0, 0, 2.5e6), (1, 0, -2.5e6), (1, 1, 2.5e6)]);
}

#[test]
fn one_dof_per_sector_has_the_closed_form_frequencies() {
    for sectors in [1, 2, 3, 24] {
        let options = one_dof(sectors);
        let model = lumped::build(&options).unwrap();
        let sector = CyclicSector::new(&model);
        assert_eq!(sector.dimension(), 1);
        for h in 0..=sectors / 2 {
            let (stiffness, mass) = (sector.stiffness(h), sector.mass(h));
            let factor = stiffness.factor().unwrap();
            let (values, _) = lowest_modes(&factor, &mass, 0.0, 1).unwrap();
            // omega^2 = (k + 2 k_c (1 - cos(h alpha))) / m, for N = 1 and 2 too.
            let alpha = TAU / sectors as f64;
            let coupling = 2.0 * options.blade_coupling_stiffness_n_per_m;
            let exact = (options.blade_stiffness_n_per_m
                + coupling * (1.0 - (h as f64 * alpha).cos()))
                / options.blade_mass_kg;
            assert!(
                (values[0] / exact - 1.0).abs() < 1e-12,
                "N = {sectors}, h = {h}"
            );
        }
    }
}

#[test]
fn uncoupled_masses_have_no_high_face() {
    let mut options = lumped24();
    options.disk_coupling_stiffness_n_per_m = 0.0;
    let model = lumped::build(&options).unwrap();
    assert_eq!(model.cyclic_pairs, [(2, 3)]);
    options.ring_mass_kg = 0.0;
    options.ring_coupling_stiffness_n_per_m = 0.0;
    options.ring_disk_stiffness_n_per_m = 0.0;
    let model = lumped::build(&options).unwrap();
    assert!(model.cyclic_pairs.is_empty() && model.contact_pairs.is_empty());
}

#[test]
fn options_out_of_range_are_refused_by_key_and_value() {
    type Change = fn(&mut LumpedOptions);
    let cases: [(&str, &str, Change); 6] = [
        ("sectors", "is 0;", |o| o.sectors = 0),
        ("blade_mass_kg", "is 0;", |o| o.blade_mass_kg = 0.0),
        ("blade_stiffness_n_per_m", "is -1;", |o| {
            o.blade_stiffness_n_per_m = -1.0;
        }),
        ("disk_mass_kg", "is NaN;", |o| o.disk_mass_kg = f64::NAN),
        ("ring_coupling_stiffness_n_per_m", "is -2;", |o| {
            o.ring_coupling_stiffness_n_per_m = -2.0;
        }),
        ("disk_ground_stiffness_n_per_m", "is inf;", |o| {
            o.disk_ground_stiffness_n_per_m = f64::INFINITY;
        }),
    ];
    for (key, value, change) in cases {
        let mut options = lumped24();
        change(&mut options);
        let error = lumped::build(&options).unwrap_err();
        assert!(matches!(error, ModelError::Option { .. }), "{key}: {error}");
        let message = error.to_string();
        assert!(
            message.contains(&format!("`model.lumped.{key}`")),
            "{key}: {message}"
        );
        assert!(
            message.contains(value) && message.contains("accepted:"),
            "{key}: {message}"
        );
    }
}

#[test]
fn springs_and_rings_without_the_mass_that_holds_them_are_refused() {
    type Change = fn(&mut LumpedOptions);
    let cases: [(&str, &str, Change); 4] = [
        ("disk_ground_stiffness_n_per_m", "disk_mass_kg", |o| {
            o.disk_ground_stiffness_n_per_m = 1.0;
        }),
        ("disk_coupling_stiffness_n_per_m", "disk_mass_kg", |o| {
            o.disk_coupling_stiffness_n_per_m = 1.0;
        }),
        ("ring_mass_kg", "disk_mass_kg", |o| o.ring_mass_kg = 1.0),
        ("ring_disk_stiffness_n_per_m", "ring_mass_kg", |o| {
            o.ring_disk_stiffness_n_per_m = 1.0;
        }),
    ];
    for (key, mass, change) in cases {
        let mut options = one_dof(24);
        change(&mut options);
        let error = lumped::build(&options).unwrap_err();
        assert!(
            matches!(error, ModelError::NeedsMass { .. }),
            "{key}: {error}"
        );
        let message = error.to_string();
        assert!(
            message.contains(key) && message.contains("is 1 "),
            "{key}: {message}"
        );
        assert!(message.contains(mass), "{key}: {message}");
    }
}
