//! The built-in wheels with every damper beyond the ring, written as files of a finite-element code and imported again.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use blisk::model::reduction::BasisChoice;
use blisk::model::sector::import::{Imported, import};
use blisk::model::sector::{
    Body, ContactSide, Damper, ParametricOptions, SectorModel, bundle, parametric,
};
use blisk::population::monte_carlo::ResponseRow;
use blisk::response::forced_response::SolverOptions;
use blisk::response::friction::{ContactLaw, PairParameters};
use blisk::response::harmonic_balance::{Damping, Status};

use super::cartesian::{cartesian, faces, nodes};
use super::writers;
use crate::extremes::wheels::{under, uneven};
use crate::wheels::{Wheel, full, pattern, relative};

const SECTORS: usize = 8;
/// Far above the rounding of the wedge's stiffness, of which its free motions see none.
const GROUNDING_HZ: f64 = 50.0;

fn built_in(damper: Damper, ring_grounding_frequency_hz: f64) -> SectorModel {
    parametric::build(&ParametricOptions {
        damper,
        sectors: SECTORS,
        ring_grounding_frequency_hz,
        disk_radial_elements: 1,
        blade_radial_elements: 3,
        ..ParametricOptions::default()
    })
    .unwrap()
}

/// Pairs that one `[[contact]]` states: those with the same bodies, sectors and normal.
#[derive(Default)]
struct Patch {
    first: Vec<usize>,
    second: Vec<usize>,
    normal: [f64; 3],
}

/// Name of what a side is on in an import file, and its node from 1.
fn side(model: &SectorModel, side: ContactSide) -> (String, Option<usize>) {
    let Some(node) = side.node() else {
        return ("ground".to_owned(), None);
    };
    let dof = model.dofs.iter().find(|dof| dof.node == node).unwrap();
    let body = match dof.body {
        Body::Blisk => "blisk",
        Body::Ring => "ring",
        Body::Damper => "damper",
    };
    let next = match side {
        ContactSide::NextSector(_) => "next.",
        ContactSide::Node(_) | ContactSide::Ground => "",
    };
    (format!("{next}{body}"), Some(node + 1))
}

/// The model's pairs as patches, by what is on either side.
fn patches(model: &SectorModel) -> BTreeMap<[String; 3], Patch> {
    let mut patches: BTreeMap<[String; 3], Patch> = BTreeMap::new();
    for pair in &model.contact_pairs {
        let (first, node) = side(model, pair.first);
        let (second, other) = side(model, pair.second);
        let normal = format!("{:.9?}", pair.normal);
        let patch = patches.entry([first, second, normal]).or_default();
        patch.first.extend(node);
        patch.second.extend(other);
        patch.normal = pair.normal;
    }
    patches
}

/// Mesh without elements, matrices and import file of a model.
fn write_files(model: &SectorModel, grounding_hz: f64, folder: &Path) {
    let names = ["A", "B", "C", "D", "E", "F", "G", "H"];
    let [low, high] = faces(model, Body::Blisk);
    let mut damper: Vec<usize> = Vec::new();
    damper.extend(
        model
            .dofs
            .iter()
            .filter(|dof| dof.body == Body::Damper)
            .map(|dof| dof.node + 1),
    );
    damper.dedup();
    let mut text = format!(
        "code = \"calculix\"\nmatrix_format = \"matrix_market\"\nname = \"parametric\"\nsectors = {SECTORS}\n[blisk]\n{}\
         low_face = \"LOW\"\nhigh_face = \"HIGH\"\n",
        writers::MATRIX_MARKET_KEYS
    );
    let mut sets = vec![("LOW", low), ("HIGH", high)];
    if !damper.is_empty() {
        writeln!(
            text,
            "[damper]\nset = \"WEDGE\"\ngrounding_hz = {grounding_hz:e}"
        )
        .unwrap();
        sets.push(("WEDGE", damper));
    }
    let mut names = names.into_iter();
    for ([first, second, _], patch) in patches(model) {
        let [n, t, z] = patch.normal;
        let own = names.next().unwrap();
        writeln!(
            text,
            "[[contact]]\nfirst = \"{first}.{own}\"\nnormal = [{n:e}, {t:e}, {z:e}]"
        )
        .unwrap();
        sets.push((own, patch.first));
        if second == "ground" {
            text.push_str("second = \"ground\"\n");
        } else {
            let other = names.next().unwrap();
            writeln!(text, "second = \"{second}.{other}\"").unwrap();
            sets.push((other, patch.second));
        }
    }
    for (dof, force) in &model.force {
        let own = &model.dofs[*dof];
        let (node, component) = (own.node + 1, own.component);
        let (re, im) = (force.re, force.im);
        writeln!(
            text,
            "[[force]]\nnode = {node}\ncomponent = \"{component}\"\nre = {re:e}\nim = {im:e}"
        )
        .unwrap();
    }
    for observed in &model.observed {
        let (name, node) = (&observed.name, observed.node + 1);
        writeln!(text, "[[observe]]\nname = \"{name}\"\nnode = {node}").unwrap();
    }
    writers::matrix_market_run(
        folder,
        &cartesian(model, model.stiffness.entries(), true),
        &cartesian(model, model.mass.entries(), true),
        &cartesian(model, model.blade_stiffness.entries(), false),
    );
    let mesh = writers::calculix_deck(&nodes(model), &sets);
    fs::write(folder.join("mesh"), mesh).unwrap();
    fs::write(folder.join("import.toml"), text).unwrap();
}

fn imported(model: &SectorModel, grounding_hz: f64) -> Imported {
    let folder = tempfile::tempdir().unwrap();
    write_files(model, grounding_hz, folder.path());
    import(&folder.path().join("import.toml")).unwrap()
}

fn row(sector: &SectorModel, load_n: f64) -> ResponseRow {
    let contact = PairParameters {
        normal_load_n: 0.0,
        normal_stiffness_n_per_m: 4e7,
        tangential_stiffness_n_per_m: 2e7,
        friction_coefficient: 0.3,
    };
    let damping = Damping::StructuralLossFactor(0.01);
    let law = ContactLaw::Simplified3d;
    let basis = BasisChoice::StickSlide { stick: 2, slide: 2 };
    let wheel = Wheel::of(sector, law, contact, damping, basis);
    let settings = SolverOptions {
        peak_tolerance: 1e-8,
        residual_tolerance: 1e-11,
        ..SolverOptions::default()
    };
    let solver = wheel.solver(&[1], settings);
    let scenario = under(2, full(load_n));
    let tuned = solver.tuned(&scenario);
    let mut rows = solver.rows(&pattern(&uneven(SECTORS, 0.02)), &[(&scenario, &tuned)]);
    let row = rows.remove(0);
    assert_eq!(row.status, Status::Ok);
    row
}

/// The grounding of the wedge is that of the import, not of the matrices.
#[test]
fn built_in_wheels_are_the_same_as_bundles_and_as_imports() {
    for (damper, load_n) in [
        (Damper::Underplatform, 60.0),
        (Damper::Shroud, 10.0),
        (Damper::BladeToGround, 10.0),
    ] {
        let model = built_in(damper, GROUNDING_HZ);
        let folder = tempfile::tempdir().unwrap();
        bundle::write(&model, folder.path()).unwrap();
        let as_bundle = bundle::read(folder.path()).unwrap();
        let imported = imported(&built_in(damper, 0.0), GROUNDING_HZ);
        let as_import = imported.model;
        assert_eq!(as_import.contact_pairs.len(), model.contact_pairs.len());
        let expected = row(&model, load_n);
        let slipping = expected.slipping_fraction.unwrap();
        println!(
            "{damper:?}: {:.6e} m, {:.6} Hz, slipping {slipping:.2}",
            expected.peak_amplitude_m.unwrap(),
            expected.peak_frequency_hz.unwrap()
        );
        assert!(slipping > 0.0);
        for (name, other) in [("bundle", &as_bundle), ("import", &as_import)] {
            let found = row(other, load_n);
            let amplitude = relative(
                found.peak_amplitude_m.unwrap(),
                expected.peak_amplitude_m.unwrap(),
            );
            let frequency = relative(
                found.peak_frequency_hz.unwrap(),
                expected.peak_frequency_hz.unwrap(),
            );
            println!("  {name}: amplitude {amplitude:.1e}, frequency {frequency:.1e}");
            assert!(amplitude < 1e-9 && frequency < 1e-9, "{damper:?}, {name}");
            assert_eq!(found.peak_blade, expected.peak_blade, "{damper:?}, {name}");
        }
    }
}
