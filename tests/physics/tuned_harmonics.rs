//! Harmonics other than 1 in the tuned wheel: the same equations by other means.

use std::sync::Arc;

use blisk::response::forced_response::{
    Excited, HigherHarmonics, Point, PointSettings, PointSolver, SolverOptions,
};
use blisk::response::harmonic_balance::TunedWaves;

use super::contact::random::Random;
use super::wheels::{Wheel, full, pattern, relative, scenario};

const SET: [u32; 3] = [1, 3, 4];
const TOLERANCE: f64 = 1e-8;

fn settings(wheel: &Wheel, higher_harmonics: HigherHarmonics, set: &[u32]) -> PointSettings {
    let options = SolverOptions {
        higher_harmonics,
        ..SolverOptions::default()
    };
    let contact = Some((wheel.law, wheel.sector));
    PointSettings::new(&options, set, contact, wheel.model.contact.clone()).unwrap()
}

fn waves(wheel: &Wheel) -> Arc<TunedWaves> {
    Arc::new(TunedWaves::new(&wheel.model, wheel.damping).unwrap())
}

fn point(excited: &Excited, settings: &PointSettings, load: f64, frequency_hz: f64) -> Point {
    let mut solver = PointSolver::new(excited, full(load), settings);
    let point = solver.solve(frequency_hz).unwrap().clone();
    assert!(point.residual <= TOLERANCE && point.shares.separated == 0.0);
    assert!(point.shares.slipping > 0.5, "{:?}", point.shares);
    point
}

/// A frequency near the peak of the tuned wheel.
fn frequency_hz(wheel: &Wheel, load: f64) -> f64 {
    let solver = wheel.solver(&[1], SolverOptions::default());
    let peak = solver.tuned_peak(3, full(load));
    peak.point.unwrap().frequency_hz
}

#[test]
fn the_tuned_wheel_by_waves_is_one_sector() {
    for (wheel, load) in [(Wheel::wheel8(), 400.0), (Wheel::lumped24(), 15.0)] {
        let hz = frequency_hz(&wheel, load);
        let sector = point(
            &wheel.tuned(&SET),
            &settings(&wheel, HigherHarmonics::Mistuned, &SET),
            load,
            hz,
        );
        let zero = vec![0.0; wheel.model.sectors];
        let whole = point(
            &wheel.mistuned(&zero, &SET).with_waves(&waves(&wheel)),
            &settings(&wheel, HigherHarmonics::Tuned, &SET),
            load,
            hz,
        );
        for amplitude in &whole.amplitudes_m {
            let error = relative(*amplitude, sector.amplitudes_m[0]);
            assert!(error < 1e-6, "{load} N: {error:.1e}");
        }
    }
}

/// Modal coordinates of the wheel without deviations in the place of waves, and its whole Jacobian.
#[test]
fn a_mistuned_wheel_by_waves_is_that_with_tuned_modes_in_its_harmonics() {
    let mut random = Random(7);
    for (wheel, load) in [(Wheel::wheel8(), 400.0), (Wheel::lumped24(), 15.0)] {
        let hz = frequency_hz(&wheel, load);
        let deviations = wheel.deviations(&mut random, 0.03);
        let zero = vec![0.0; wheel.model.sectors];
        let plain = wheel.mistuned(&deviations, &SET);
        let modal = plain.clone().with_harmonics_of(wheel.mistuned(&zero, &SET));
        let by_modes = point(
            &modal,
            &settings(&wheel, HigherHarmonics::Mistuned, &SET),
            load,
            hz,
        );
        let by_waves = point(
            &plain.clone().with_waves(&waves(&wheel)),
            &settings(&wheel, HigherHarmonics::Tuned, &SET),
            load,
            hz,
        );
        let alone = point(
            &wheel.mistuned(&deviations, &[1]),
            &settings(&wheel, HigherHarmonics::Mistuned, &[1]),
            load,
            hz,
        );
        let largest = by_modes.largest_amplitude_m();
        let mut changed: f64 = 0.0;
        for blade in 0..deviations.len() {
            let error = (by_waves.amplitudes_m[blade] - by_modes.amplitudes_m[blade]).abs();
            assert!(error < 1e-6 * largest, "{load} N, {blade}: {error:.1e}");
            changed = changed.max((alone.amplitudes_m[blade] - by_modes.amplitudes_m[blade]).abs());
        }
        // The harmonics do matter here.
        assert!(changed > 1e-4 * largest, "{load} N: {changed:.1e}");
    }
}

/// Rows as a study has them: the stated error beside what fifteen harmonics change. At 300 N harmonic 6 falls on a
/// resonance of slipping contact.
#[test]
fn the_stated_error_holds_what_the_harmonics_left_out_do() {
    let wheel = Wheel::wheel8();
    let deviations = wheel.deviations(&mut Random(3), 0.03);
    for load in [300.0, 500.0, 800.0] {
        let row = |set: &[u32]| {
            let options = SolverOptions {
                higher_harmonics: HigherHarmonics::Tuned,
                peak_tolerance: 1e-4,
                ..SolverOptions::default()
            };
            let solver = wheel
                .solver(set, options)
                .with_tuned_harmonics(Some(Arc::clone(&wheel.model)));
            let scenario = scenario(full(load));
            let tuned = solver.tuned(&scenario);
            let rows = solver.rows(&pattern(&deviations), &[(&scenario, &tuned)]);
            assert_eq!(rows[0].shortcut, "tuned_harmonics", "{:?}", rows[0]);
            rows[0].clone()
        };
        let all: Vec<u32> = (1..=15).collect();
        let (few, all) = (row(&[1, 3]), row(&all));
        let change = all.peak_amplitude_m.unwrap() / few.peak_amplitude_m.unwrap() - 1.0;
        let (column, stated) = (few.harmonic_error.unwrap(), few.stated_error.unwrap());
        println!("{load} N: {change:.2e}, column {column:.2e}, stated {stated:.2e}");
        assert!(change.abs() > 5e-3, "{load} N: {change:.1e}");
        assert!(change.abs() <= stated, "{load} N: {change} {stated}");
        // Settled, but where the resonance is.
        let settled = (column - change).abs() < 0.2 * change.abs();
        assert!(settled || load < 400.0, "{load} N: {change} {column}");
    }
}
