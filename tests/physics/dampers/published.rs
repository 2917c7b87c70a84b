//! Lumped wheels whose results others have published.

use std::path::Path;

use blisk::model::cyclic::contact_free_frequencies_hz;
use blisk::model::reduction::BasisChoice;
use blisk::model::sector::{Body, LumpedOptions, lumped};
use blisk::response::forced_response::ContactCondition;
use blisk::response::friction::{ContactLaw, PairParameters};
use blisk::response::harmonic_balance::Damping;

use crate::extremes::wheels::{tight, under};
use crate::wheels::{Wheel, pattern};

/// Deviations of the six springs.
const DEVIATIONS: [f64; 6] = [0.0091, -0.0003, 0.0060, -0.0072, -0.0016, 0.0083];

/// Amplification factor of six coupled oscillators (m = k = 1, damping 0.01 each) under engine order 1.
fn amplification_factor(coupling: f64, deviations: &[f64]) -> f64 {
    let options = LumpedOptions {
        sectors: 6,
        blade_mass_kg: 1.0,
        blade_stiffness_n_per_m: 1.0,
        blade_coupling_stiffness_n_per_m: coupling,
        ..LumpedOptions::default()
    };
    let wheel = Wheel::of(
        &lumped::build(&options).unwrap(),
        ContactLaw::MacroSlip1d,
        PairParameters {
            normal_load_n: 0.0,
            normal_stiffness_n_per_m: 0.0,
            tangential_stiffness_n_per_m: 0.0,
            friction_coefficient: 0.0,
        },
        Damping::Rayleigh {
            mass_per_s: 0.01,
            stiffness_s: 0.0,
        },
        BasisChoice::CraigBampton,
    );
    let solver = wheel.solver(&[1], tight());
    let scenario = under(1, ContactCondition::Free);
    let tuned = solver.tuned(&scenario);
    let row = solver
        .rows(&pattern(deviations), &[(&scenario, &tuned)])
        .remove(0);
    row.amplification_factor.unwrap()
}

/// Six of the 72 natural frequencies of the wheel of Laxalde, Thouverez, Sinou & Lombard (2007) without its ring, Hz.
#[test]
fn natural_frequencies_are_those_of_laxalde_2007() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("studies/laxalde-2007.toml");
    let study: toml::Table = toml::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    let mut options: LumpedOptions = study["model"]["lumped"].clone().try_into().unwrap();
    options.mass.retain(|mass| mass.body == Body::Blisk);
    let on_ring = |ends: &[String; 2]| ends.iter().any(|end| end.ends_with("ring"));
    options.spring.retain(|spring| !on_ring(&spring.between));
    options.contact.clear();
    let found = contact_free_frequencies_hz(&lumped::build(&options).unwrap(), 3).unwrap();
    // Nodal diameters 0 and 12 once, the others twice.
    let count: usize = found
        .iter()
        .enumerate()
        .map(|(h, own)| own.len() * if h.is_multiple_of(12) { 1 } else { 2 })
        .sum();
    assert_eq!(count, 72);
    let published = [
        (88.263_743_99, 1),
        (169.344_129_5, 2),
        (189.301_852_6, 2),
        (249.311_651_61, 1),
        (335.565_379_39, 2),
        (2_062.975_677_61, 1),
    ];
    for (hz, times) in published {
        let near = |own: &&f64| (*own / hz - 1.0).abs() < 1e-9;
        let places: Vec<usize> = (0..found.len())
            .filter(|&h| found[h].iter().any(|own| near(&own)))
            .collect();
        assert_eq!(places.len(), 1, "{hz} Hz: nodal diameters {places:?}");
        let standing = places[0].is_multiple_of(12);
        assert_eq!(times, if standing { 1 } else { 2 }, "{hz} Hz");
    }
}

/// The numbering of the blades and the direction of the wave: what is published for this order of the deviations
/// and for the reverse one.
#[test]
fn amplification_factors_of_six_oscillators_are_the_published_ones() {
    let mut reverse = DEVIATIONS;
    reverse.reverse();
    for (coupling, own, reversed) in [
        (0.01, 1.126_607_438, 1.169_994_553),
        (0.05, 1.170_045_143, 1.151_335_170),
    ] {
        for (deviations, expected) in [(DEVIATIONS, own), (reverse, reversed)] {
            let found = amplification_factor(coupling, &deviations);
            println!("coupling {coupling}: {found:.9}, published {expected:.9}");
            assert!((found - expected).abs() < 1e-8, "{found} {expected}");
        }
    }
}
