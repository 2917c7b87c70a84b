//! Mistuned lumped wheels at default settings, against the truth with harmonics up to 25.

use blisk::response::harmonic_balance::Status;
use blisk::response::mistuning::Deviations;
use blisk::settings::{EngineSource, ReducedEngineSource};
use blisk::study::{Study, load_sector_model, pattern_source};
use rayon::prelude::*;

use super::contact::{Law, Period};
use super::iteration::{Case, Contact};
use super::peak::close_peak;
use super::sector::Sector;

const SAMPLES: usize = 512;
const PATTERNS: u32 = 12;
const LOADS_N: [f64; 4] = [3.0, 10.0, 30.0, 60.0];
const STIFFNESS_N_PER_M: f64 = 5e6;
const FRICTION_COEFFICIENT: f64 = 0.2;
const LOSS_FACTOR: f64 = 0.002;
const STANDARD_DEVIATION: f64 = 0.04;
const ENGINE_ORDER: u32 = 4;
/// A sector has three masses, and all of them are kept in the truth or are its modes.
const MODES: usize = 3;

/// The physics alone: every setting is the default.
fn study() -> Study {
    let text = format!(
        "schema = 1\n[study]\nname = \"lumped36\"\nseed = 36\npatterns = {PATTERNS}\n\
         [model]\nsource = \"lumped\"\n[model.lumped]\nsectors = 36\n\
         blade_mass_kg = 0.2\nblade_stiffness_n_per_m = 1.2e6\n\
         disk_mass_kg = 1.0\ndisk_ground_stiffness_n_per_m = 1e7\ndisk_coupling_stiffness_n_per_m = 5e6\n\
         ring_mass_kg = 0.1\nring_coupling_stiffness_n_per_m = 1e7\nring_disk_stiffness_n_per_m = 1e4\n\
         [contact]\nlaw = \"macro_slip_1d\"\nfriction_coefficient = {FRICTION_COEFFICIENT}\n\
         tangential_stiffness_n_per_m = {STIFFNESS_N_PER_M:e}\n\
         [damping]\nstructural_loss_factor = {LOSS_FACTOR}\n\
         [excitation]\nengine_orders = [{ENGINE_ORDER}]\namplitude_n = 1.0\n\
         [mistuning]\ndistribution = {{ kind = \"normal\", standard_deviation = {STANDARD_DEVIATION} }}\n\
         [sweep]\nnormal_load_n = {LOADS_N:?}\n"
    );
    Study::parse(std::path::Path::new("lumped.toml"), &text).expect("a study")
}

/// The tuned wheel slips in step; a mistuned one needs harmonics that it does not.
#[test]
fn mistuned_lumped_wheels_at_default_settings_are_within_a_percent() {
    faer::set_global_parallelism(faer::Par::Seq);
    let study = study();
    let model = load_sector_model(&study).expect("a model");
    let engine = ReducedEngineSource
        .build(&study, &model, None)
        .expect("an engine");
    let source = pattern_source(&study, &model).expect("patterns");
    let sector = Sector::new(&model, MODES);
    let harmonics: Vec<u32> = (1..=25).step_by(2).collect();
    let period = Period::new(&harmonics, SAMPLES);
    let scenarios = study.scenarios();
    let tuned: Vec<_> = scenarios.iter().map(|own| engine.tuned(own)).collect();
    let wanted: Vec<_> = scenarios.iter().zip(&tuned).collect();
    let rows: Vec<(f64, f64)> = (0..PATTERNS)
        .into_par_iter()
        .flat_map_iter(|id| {
            let pattern = source
                .pattern(id, Some(STANDARD_DEVIATION))
                .expect("a pattern");
            let Deviations::PerBlade(deviations) = &pattern.deviations else {
                panic!("a deviation a blade")
            };
            let solved = engine.rows(&pattern, &wanted).into_iter().zip(LOADS_N);
            let compared = solved.map(|(row, load_n)| {
                let name = format!("pattern {id}, {load_n} N");
                assert_eq!(row.status, Status::Ok, "{name}");
                let case = Case {
                    loss_factor: LOSS_FACTOR,
                    engine_order: ENGINE_ORDER,
                    deviations: deviations.clone(),
                    contact: Contact::Friction(Law {
                        normal_load_n: load_n,
                        normal_stiffness_n_per_m: STIFFNESS_N_PER_M,
                        tangential_stiffness_n_per_m: STIFFNESS_N_PER_M,
                        friction_coefficient: FRICTION_COEFFICIENT,
                    }),
                };
                let hint_hz = row.peak_frequency_hz.expect("a peak");
                let truth = close_peak(&sector, &case, &period, hint_hz).expect("a peak");
                let error = row.peak_amplitude_m.expect("a peak") / truth.top.amplitude_m() - 1.0;
                let stated = row.stated_error.expect("a stated error");
                println!(
                    "{name}: {error:.1e}, stated {stated:.1e}, {} pairs slip",
                    truth.top.slipping_pairs
                );
                (error.abs(), stated)
            });
            compared.collect::<Vec<_>>()
        })
        .collect();
    let all = rows.len();
    assert_eq!(all, PATTERNS as usize * LOADS_N.len());
    let beyond = |bar: f64| rows.iter().filter(|row| row.0 > bar).count();
    let unstated = rows.iter().filter(|row| row.0 > row.1).count();
    println!(
        "{all} rows: {} beyond 1 %, {} beyond 2 %, {unstated} beyond what they state",
        beyond(0.01),
        beyond(0.02)
    );
    assert!(20 * beyond(0.01) <= all);
    assert_eq!(beyond(0.02), 0);
    assert!(unstated as f64 <= 0.03 * all as f64);
}
