//! The top of a wheel on another engine than that on which its peak was found, against the full-contact model.

use blisk::response::forced_response::{
    EngineRow, PointSettings, SolverOptions, Window, receptance_peak, receptance_plan,
    receptance_top_m,
};
use blisk::response::friction::ContactLaw;
use blisk::response::harmonic_balance::Status;
use blisk::response::mistuning::Projection;
use blisk::response::receptance::EngineWheel;
use blisk::verification::reference::ReferenceSolver;

use super::{Case, load};

const HARMONICS: [u32; 8] = [0, 1, 2, 3, 4, 5, 6, 7];
/// Distance of the points of a top, in half-bandwidths of a linear resonance.
const STEP: f64 = 0.35;
const TOLERANCE: f64 = 1e-6;

/// The top of the full-contact model, m, near a frequency, Hz: by points at a fifth of the distance, and the parabola of the highest three.
fn top_of(reference: &mut ReferenceSolver, near_hz: f64, step_hz: f64) -> f64 {
    let height_m = |step: i32| {
        let hz = near_hz + 0.2 * step_hz * f64::from(step);
        let solved = reference.solve(hz).unwrap();
        solved.amplitudes_m.iter().copied().fold(0.0, f64::max)
    };
    let heights_m: Vec<f64> = (-6..=6).map(height_m).collect();
    let highest = |a: &usize, b: &usize| heights_m[*a].total_cmp(&heights_m[*b]);
    let at = (0..heights_m.len()).max_by(highest).unwrap();
    let [low, middle, high] = [heights_m[at - 1], heights_m[at], heights_m[at + 1]];
    middle + (high - low).powi(2) / (8.0 * (2.0 * middle - low - high))
}

/// Relative change of the top by 25 fixed-interface modes in the place of 18, beside the peak with these: by harmonics that few of them
/// lead to, and by the full-contact model.
fn changes(law: ContactLaw, normal_load_n: f64) -> [f64; 2] {
    let [coarse, fine] = [18, 25].map(|modes| Case {
        projection: Projection::CantileverModes,
        ..Case::new("wheel8", [8e8, 4e8], law, modes)
    });
    let condition = load(normal_load_n);
    let contact = Some((law, fine.contact));
    let geometry = fine.model.contact.clone();
    let options = SolverOptions::default();
    let settings = PointSettings::new(&options, &HARMONICS, contact, geometry).unwrap();
    let engines = [coarse.engine(), fine.engine()];
    let wheel = EngineWheel::new(Some(&fine.pattern), fine.model.sectors);
    let [there, here] = engines.each_ref().map(|(engine, force)| EngineRow {
        engine,
        wheel: &wheel,
        force,
        condition,
    });
    let window = Window {
        resonances_hz: None,
        band: options.frequency_band,
    };
    let found = receptance_peak(&there, &settings, settings.search(), window, 1e-3).peak;
    assert_eq!(found.status, Status::Ok, "{law:?} {normal_load_n} N");
    let point = found.point.unwrap();
    let envelope = receptance_plan(&there, window).unwrap().envelope;
    let step_hz = STEP * envelope.linear_half_bandwidth_hz;
    let top_m =
        |row: &EngineRow<'_>| receptance_top_m(row, &settings, &point, step_hz, TOLERANCE).unwrap();
    let change = top_m(&here) / top_m(&there) - 1.0;
    let [before_m, after_m] = [&coarse, &fine].map(|case| {
        let mut reference = case.reference(&HARMONICS, condition);
        top_of(&mut reference, point.frequency_hz, step_hz)
    });
    let own_change = after_m / before_m - 1.0;
    println!(
        "{law:?} {normal_load_n} N: {change:.2e}, full contact {own_change:.2e}, {:.2} slip, {:.2} open",
        point.shares.slipping, point.shares.separated
    );
    [change, own_change]
}

/// `cargo test --release --test receptance tops -- --nocapture`
#[test]
fn tops_on_another_engine_are_those_of_the_full_contact_model() {
    faer::set_global_parallelism(faer::Par::Seq);
    // Pairs open under the first load.
    let laws = [ContactLaw::Simplified3d; 6].into_iter();
    let laws = laws.chain([ContactLaw::Coulomb3d]);
    let mut largest: f64 = 0.0;
    for (law, load_n) in laws.zip([150.0, 200.0, 300.0, 600.0, 1200.0, 2400.0, 600.0]) {
        let [change, own_change] = changes(law, load_n);
        assert!(
            (change - own_change).abs() < f64::max(2e-4, 0.1 * own_change.abs()),
            "{law:?} {load_n} N: {change:.2e}, full contact {own_change:.2e}"
        );
        largest = largest.max(own_change.abs());
    }
    assert!(largest > 2e-4, "the engines differ by {largest:.1e} alone");
}
