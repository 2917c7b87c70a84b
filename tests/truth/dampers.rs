//! Mistuned wheels with every built-in damper, against the truth with the same harmonics and samples.

use blisk::model::sector::{ContactSide, SectorModel};
use blisk::response::harmonic_balance::Status;
use blisk::settings::{EngineSource, ReducedEngineSource};
use blisk::study::{Study, load_sector_model, pattern_source};
use rayon::prelude::*;

use super::contact::{Law, Period};
use super::iteration::{Case, Contact};
use super::peak::close_peak;
use super::sector::Sector;

const HARMONICS: [u32; 4] = [0, 1, 2, 3];
const SAMPLES: usize = 512;
/// Fixed-interface modes of a sector in the truth.
const MODES: usize = 480;
/// Those of the long test: with 480 the truth itself is up to 8e-4 off where a few pairs just open.
const MANY_MODES: usize = 700;
const PATTERNS: u32 = 3;
/// Those of the long test.
const MANY_PATTERNS: u32 = 10;
/// Largest relative difference of a row.
const BAR: f64 = 5e-4;

/// A damper, its stiffness along tangents and normal in N/m, three loads, N, and whether pairs open under some of them.
struct Kind {
    name: &'static str,
    /// The damper in the words of the study.
    keys: &'static str,
    stiffness_n_per_m: [f64; 2],
    loads_n: [f64; 3],
    opens: bool,
    /// Fixed-interface modes of a nodal diameter in the program.
    modes: usize,
}

const KINDS: [Kind; 5] = [
    Kind {
        name: "ring",
        keys: "damper = \"ring\"",
        stiffness_n_per_m: [1e8, 1e8],
        loads_n: [40.0, 80.0, 160.0],
        opens: true,
        modes: 120,
    },
    Kind {
        name: "underplatform",
        keys: "damper = \"underplatform\"",
        stiffness_n_per_m: [4e7, 8e7],
        loads_n: [20.0, 60.0, 400.0],
        opens: true,
        modes: 120,
    },
    Kind {
        name: "shroud",
        keys: "damper = \"shroud\"",
        stiffness_n_per_m: [1e7, 2e7],
        loads_n: [40.0, 80.0, 600.0],
        opens: true,
        modes: 120,
    },
    Kind {
        name: "blade_to_ground",
        keys: "damper = \"blade_to_ground\"",
        stiffness_n_per_m: [4e7, 8e7],
        loads_n: [20.0, 200.0, 800.0],
        opens: false,
        modes: 120,
    },
    Kind {
        name: "cylinder",
        keys: "damper = \"underplatform\"\ndamper_shape = \"cylinder\"",
        stiffness_n_per_m: [4e7, 8e7],
        loads_n: [100.0, 200.0, 400.0],
        opens: false,
        // A peak with 120 is 2.5e-4 from that with 480 (pattern 0, 100 N).
        modes: 240,
    },
];

const FRICTION_COEFFICIENT: f64 = 0.3;
const LOSS_FACTOR: f64 = 0.004;
const STANDARD_DEVIATION: f64 = 0.03;
const ENGINE_ORDER: u32 = 3;

/// The model with what its contact touches in the next sector as further dofs of the high face, so that every pair lies in
/// one sector: they have neither stiffness nor mass there.
pub fn within_one_sector(mut model: SectorModel) -> SectorModel {
    let mut copies: Vec<(usize, usize)> = Vec::new();
    let mut next = model.dofs.iter().map(|dof| dof.node).max().unwrap_or(0) + 1;
    for pair in &mut model.contact_pairs {
        for side in [&mut pair.first, &mut pair.second] {
            let ContactSide::NextSector(node) = *side else {
                continue;
            };
            let known = copies.iter().find(|copy| copy.0 == node);
            let copy = known.map_or(next, |copy| copy.1);
            if copy == next {
                copies.push((node, copy));
                next += 1;
            }
            *side = ContactSide::Node(copy);
        }
    }
    for (node, copy) in copies {
        let own = (0..model.dofs.len()).filter(|&dof| model.dofs[dof].node == node);
        for low in own.collect::<Vec<_>>() {
            let mut dof = model.dofs[low].clone();
            dof.node = copy;
            model.cyclic_pairs.push((low, model.dofs.len()));
            model.dofs.push(dof);
        }
    }
    let n = model.dofs.len();
    for matrix in [
        &mut model.stiffness,
        &mut model.mass,
        &mut model.blade_stiffness,
    ] {
        let entries: Vec<_> = matrix.lower_entries().collect();
        *matrix = blisk::linalg::SymmetricSparse::from_lower_triplets(n, &entries);
    }
    model
}

fn study(kind: &Kind, patterns: u32) -> Study {
    let text = format!(
        "schema = 1\n[study]\nname = \"{}\"\nseed = 20261125\npatterns = {patterns}\n\
         [model]\nsource = \"parametric\"\n[model.parametric]\nsectors = 8\n{}\nblade_radial_elements = 4\n\
         [reduction]\nbasis = \"tuned_receptances\"\ncraig_bampton_modes = {}\nerror = 2e-4\n\
         [contact]\nfriction_coefficient = {FRICTION_COEFFICIENT}\ntangential_stiffness_n_per_m = {:e}\n\
         normal_stiffness_n_per_m = {:e}\n[damping]\nstructural_loss_factor = {LOSS_FACTOR}\n\
         [excitation]\nengine_orders = [{ENGINE_ORDER}]\n\
         [mistuning]\ndistribution = {{ kind = \"normal\", standard_deviation = {STANDARD_DEVIATION} }}\n\
         [sweep]\nnormal_load_n = {:?}\n\
         [solver]\nharmonics = {HARMONICS:?}\nsamples_per_period = {SAMPLES}\npeak_tolerance = 1e-5\nsearch_harmonics = \"all\"\n",
        kind.name,
        kind.keys,
        kind.modes,
        kind.stiffness_n_per_m[0],
        kind.stiffness_n_per_m[1],
        kind.loads_n
    );
    Study::parse(std::path::Path::new("dampers.toml"), &text).expect("a study")
}

/// Rows of some patterns under three loads: none further from the truth than the bar, some that open and some that slip.
fn hold(kind: &Kind, patterns: u32, modes: usize) {
    faer::set_global_parallelism(faer::Par::Seq);
    let study = study(kind, patterns);
    let model = load_sector_model(&study).expect("a model");
    let engine = ReducedEngineSource
        .build(&study, &model, None)
        .expect("an engine");
    let source = pattern_source(&study, &model).expect("patterns");
    let sector = Sector::new(&within_one_sector(model), modes);
    let period = Period::new(&HARMONICS, SAMPLES);
    let scenarios = study.scenarios();
    let tuned: Vec<_> = scenarios.iter().map(|own| engine.tuned(own)).collect();
    let solved: Vec<[bool; 2]> = (0..patterns)
        .into_par_iter()
        .flat_map_iter(|id| {
            let pattern = source
                .pattern(id, Some(STANDARD_DEVIATION))
                .expect("a pattern");
            let wanted: Vec<_> = scenarios.iter().zip(&tuned).collect();
            let rows = engine.rows(&pattern, &wanted);
            let deviations = match &pattern.deviations {
                blisk::response::mistuning::Deviations::PerBlade(values) => values.clone(),
                blisk::response::mistuning::Deviations::PerMode { .. } => Vec::new(),
            };
            let (sector, period) = (&sector, &period);
            let compared = rows
                .into_iter()
                .zip(kind.loads_n)
                .map(move |(row, load_n)| {
                    let name = format!("{}, pattern {id}, {load_n} N", kind.name);
                    assert_eq!(row.status, Status::Ok, "{name}");
                    let case = Case {
                        loss_factor: LOSS_FACTOR,
                        engine_order: ENGINE_ORDER,
                        deviations: deviations.clone(),
                        contact: Contact::Friction(Law {
                            normal_load_n: load_n,
                            normal_stiffness_n_per_m: kind.stiffness_n_per_m[1],
                            tangential_stiffness_n_per_m: kind.stiffness_n_per_m[0],
                            friction_coefficient: FRICTION_COEFFICIENT,
                        }),
                    };
                    let hint_hz = row.peak_frequency_hz.expect("a peak");
                    let truth = close_peak(sector, &case, period, hint_hz).expect("a peak");
                    let error =
                        row.peak_amplitude_m.expect("a peak") / truth.top.amplitude_m() - 1.0;
                    println!(
                        "{name}: {error:.1e}, stated {:.1e}, {} pairs open, {} slip",
                        row.stated_error.unwrap_or(f64::NAN),
                        truth.top.opening_pairs,
                        truth.top.slipping_pairs,
                    );
                    assert!(error.abs() < BAR, "{name}: {error:e}");
                    [truth.top.opening_pairs > 0, truth.top.slipping_pairs > 0]
                });
            compared.collect::<Vec<_>>()
        })
        .collect();
    let all = solved.len();
    assert_eq!(all, patterns as usize * kind.loads_n.len());
    let [opening, slipping] = [0, 1].map(|what| solved.iter().filter(|own| own[what]).count());
    println!(
        "{}: {opening} rows with opening pairs, {slipping} with slip",
        kind.name
    );
    assert!(3 * slipping >= all, "{slipping} rows with slip");
    assert!(
        !kind.opens || 3 * opening >= all,
        "{opening} rows that open"
    );
}

#[test]
fn mistuned_wheels_with_a_ring_are_the_full_contact_model() {
    hold(&KINDS[0], PATTERNS, MODES);
}

#[test]
fn mistuned_wheels_with_wedges_are_the_full_contact_model() {
    hold(&KINDS[1], PATTERNS, MODES);
}

#[test]
fn mistuned_wheels_with_shrouds_are_the_full_contact_model() {
    hold(&KINDS[2], PATTERNS, MODES);
}

#[test]
fn mistuned_wheels_on_the_ground_are_the_full_contact_model() {
    hold(&KINDS[3], PATTERNS, MODES);
}

#[test]
#[ignore = "minutes: 30 rows"]
fn thirty_rows_with_shrouds_are_the_full_contact_model() {
    hold(&KINDS[2], MANY_PATTERNS, MANY_MODES);
}

#[test]
fn mistuned_wheels_with_cylinders_are_the_full_contact_model() {
    hold(&KINDS[4], PATTERNS, MODES);
}

#[test]
#[ignore = "minutes: 30 rows"]
fn thirty_rows_with_a_ring_are_the_full_contact_model() {
    hold(&KINDS[0], MANY_PATTERNS, MANY_MODES);
}

#[test]
#[ignore = "minutes: 30 rows"]
fn thirty_rows_on_the_ground_are_the_full_contact_model() {
    hold(&KINDS[3], MANY_PATTERNS, MANY_MODES);
}

#[test]
#[ignore = "minutes: 30 rows"]
fn thirty_rows_with_wedges_are_the_full_contact_model() {
    hold(&KINDS[1], MANY_PATTERNS, MANY_MODES);
}

#[test]
#[ignore = "minutes: 30 rows"]
fn thirty_rows_with_cylinders_are_the_full_contact_model() {
    hold(&KINDS[4], MANY_PATTERNS, MANY_MODES);
}
