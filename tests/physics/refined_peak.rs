//! Peaks in two stages are those of one search with all harmonics.

use blisk::response::forced_response::{
    FrequencyBand, Harmonics, Peak, PointSettings, Search, SearchHarmonics, SolverOptions,
    mistuned_window, peak, refined, tuned_span,
};
use blisk::response::friction::Ring;
use blisk::response::harmonic_balance::Status;

use super::contact::random::Random;
use super::wheels::{Wheel, full, relative};
use super::work_counts::wheel24;

const SET: [u32; 3] = [1, 3, 5];

/// Peak of a wheel by one search, and after a search with harmonic 1, if that leads to one.
fn both(wheel: &Wheel, deviations: &[f64], load: f64) -> (Peak, Option<Peak>) {
    let options = SolverOptions {
        harmonics: Harmonics::Set(SET.to_vec()),
        search_harmonics: SearchHarmonics::Set(vec![1]),
        ..SolverOptions::default()
    };
    let contact = Some((wheel.law, wheel.sector));
    let settings = PointSettings::new(&options, &SET, contact, wheel.model.contact.clone())
        .unwrap()
        .with_ring(wheel.ring);
    let span = tuned_span(&wheel.tuned(&SET), full(load), None).unwrap();
    let largest = deviations.iter().fold(0.0, |a: f64, d| a.max(d.abs()));
    let window = mistuned_window(span, largest, FrequencyBand::Auto);
    let excited = wheel.mistuned(deviations, &SET);
    let coarse = wheel.mistuned(deviations, &[1]);
    let search = Search {
        excited: &coarse,
        settings: settings.search().unwrap(),
    };
    let (load, tolerance) = (full(load), options.peak_tolerance);
    let one = peak(&excited, load, &settings, window, tolerance);
    let two = refined(&excited, search, load, &settings, window, tolerance);
    (one, two.ok())
}

fn amplitude(peak: &Peak) -> f64 {
    assert_eq!(peak.status, Status::Ok);
    peak.amplitude_m().unwrap()
}

#[test]
fn a_peak_of_a_large_equation_is_the_same_in_two_stages_for_less_work() {
    let wheel = wheel24();
    let mut random = Random(11);
    for load in [160.0, 320.0, 1280.0] {
        let deviations = wheel.deviations(&mut random, 0.03);
        let (one, two) = both(&wheel, &deviations, load);
        let two = two.expect("a peak in two stages");
        let error = relative(amplitude(&two), amplitude(&one));
        println!("{load} N: {error:.1e}; {:?}, {:?}", one.work, two.work);
        assert!(error < 5e-4, "{load} N: {error}");
        let [one, two] = [one, two].map(|peak| peak.point.unwrap());
        assert!(two.residual <= 1e-8 && one.residual <= 1e-8);
        assert!(relative(two.frequency_hz, one.frequency_hz) < 2e-4);
    }
}

/// A small equation has its whole Jacobian: the two stages without its simplification.
#[test]
fn a_peak_of_a_small_equation_is_the_same_in_two_stages() {
    let wheel = Wheel {
        amplitude_n: 10.0,
        ..Wheel::lumped24()
    };
    let mut random = Random(5);
    for load in [15.0, 25.0, 50.0, 75.0, 150.0, 1e6] {
        let deviations = wheel.deviations(&mut random, 0.03);
        let (one, two) = both(&wheel, &deviations, load);
        let two = two.expect("a peak in two stages");
        let error = relative(amplitude(&two), amplitude(&one));
        println!("{load} N: {error:.1e}");
        assert!(error < 5e-4, "{load} N: {error}");
    }
}

/// Where contact opens or a ring creeps, two stages end without a peak, and the whole set is searched with.
#[test]
fn where_few_harmonics_mislead_the_search_is_made_with_all() {
    let opening = Wheel::wheel8();
    let creeping = Wheel {
        ring: Ring::Creeping,
        ..Wheel::wheel8()
    };
    for (wheel, load) in [(opening, 60.0), (creeping, 400.0)] {
        let deviations = wheel.deviations(&mut Random(3), 0.03);
        let (one, two) = both(&wheel, &deviations, load);
        assert!(two.is_none(), "{load} N");
        assert_eq!(one.status, Status::Ok, "{load} N");
        let separates = one.point.unwrap().shares.separated > 0.0;
        assert_eq!(separates, load < 100.0);
    }
}

/// Wheels with few contact rows read far points from harmonic 1; with `search_harmonics = "all"` they do not.
#[test]
fn a_screened_search_finds_the_peaks_of_one_with_all_harmonics() {
    let wheel = Wheel {
        amplitude_n: 10.0,
        ..Wheel::lumped24()
    };
    let mut random = Random(17);
    for load in [15.0, 25.0, 50.0, 75.0, 150.0, 200.0, 400.0] {
        for _ in 0..3 {
            let deviations = wheel.deviations(&mut random, 0.03);
            let largest = deviations.iter().fold(0.0, |a: f64, d| a.max(d.abs()));
            let span = tuned_span(&wheel.tuned(&SET), full(load), None).unwrap();
            let window = mistuned_window(span, largest, FrequencyBand::Auto);
            let excited = wheel.mistuned(&deviations, &SET);
            let contact = Some((wheel.law, wheel.sector));
            let found = [SearchHarmonics::All, SearchHarmonics::Auto].map(|search_harmonics| {
                let options = SolverOptions {
                    harmonics: Harmonics::Set(SET.to_vec()),
                    search_harmonics,
                    ..SolverOptions::default()
                };
                let geometry = wheel.model.contact.clone();
                let settings = PointSettings::new(&options, &SET, contact, geometry).unwrap();
                peak(
                    &excited,
                    full(load),
                    &settings,
                    window,
                    options.peak_tolerance,
                )
            });
            let [whole, screened] = &found;
            let error = relative(amplitude(screened), amplitude(whole));
            assert!(error < 1e-3, "{load} N: {error:e}");
            // Else nothing was screened.
            assert_ne!(screened.work, whole.work, "{load} N");
            let point = screened.point.as_ref().unwrap();
            assert!(point.residual <= 1e-8 && screened.bracketed);
            assert_eq!(
                point.solution.len(),
                whole.point.as_ref().unwrap().solution.len()
            );
        }
    }
}
