//! The errors that a choice of settings claims, on wheels that it did not see.

use blisk::population::statistics::ErrorBound;
use blisk::response::forced_response::{ContactCondition, Harmonics, SearchHarmonics};
use blisk::settings::{AccuracyChoice, AccuracyEvidence};
use blisk::study::{AccuracyOptions, Study, load_sector_model};
use rayon::prelude::*;

use super::support::{Case, package};

/// The wheel of masses of lumped24, with `sectors` of them and random blades, and with further keys.
fn lumped(sectors: u32, patterns: u32, keys: &str) -> Study {
    let text = std::fs::read_to_string(package("studies/lumped24.toml")).unwrap();
    let (before, _) = text.split_once("[mistuning]").unwrap();
    let before = before
        .replace("seed = 1", &format!("seed = 1\npatterns = {patterns}"))
        .replace("sectors = 24", &format!("sectors = {sectors}"));
    let text = format!(
        "{before}[mistuning]\ndistribution = {{ kind = \"normal\" }}\n[sweep]\n\
         normal_load_n = [30, 50, 100]\nstandard_deviation = [0.03]\n{keys}"
    );
    Study::parse(&package("studies/lumped24.toml"), &text).unwrap()
}

/// Further keys for rows in the whole space of a sector, searched as on any basis.
const ON_A_BASIS: &str = "[reduction]\nbasis = \"stick_slide\"\n";

/// The built-in bladed disk of the quickstart.
fn quickstart(patterns: u32) -> Study {
    let text = std::fs::read_to_string(package("studies/quickstart.toml")).unwrap();
    let (before, _) = text.split_once("[sweep]").unwrap();
    let before = before.replace("patterns = 440", &format!("patterns = {patterns}"));
    let text =
        format!("{before}[sweep]\nnormal_load_n = [240, 480, 1600]\nstandard_deviation = [0.03]\n");
    Study::parse(&package("studies/quickstart.toml"), &text).unwrap()
}

/// More of everything than a choice is checked with, fixed-interface modes among it.
fn best(study: &Study, choice: &AccuracyChoice) -> Study {
    let mut best = study.clone();
    best.solver.samples_per_period = 512;
    best.solver.peak_tolerance = 1e-4;
    best.reduction.error = 0.1 * choice.setting.reduction_error;
    let law = best.contact.as_ref().unwrap().law;
    let all = (0..=17).filter(|harmonic| law.has_variable_load() || harmonic % 2 == 1);
    best.solver.harmonics = Harmonics::Set(all.collect());
    best
}

fn choice(study: &Study, amplitude_error: f64) -> AccuracyChoice {
    let sector = load_sector_model(study).unwrap();
    AccuracyChoice::of(
        study,
        AccuracyOptions::within(amplitude_error),
        &sector,
        None,
    )
    .unwrap()
}

/// Signed amplitude errors of `own` against `reference` over patterns and loads.
fn errors(own: &Case, reference: &Case, ids: &[u32]) -> Vec<Option<f64>> {
    let conditions: Vec<ContactCondition> = own.study.contacts.clone();
    let tuned = |case: &Case| -> Vec<_> {
        let conditions = conditions.iter();
        conditions.map(|&condition| case.tuned(condition)).collect()
    };
    let (own_tuned, reference_tuned) = (tuned(own), tuned(reference));
    let of_pattern = |&id: &u32| -> Vec<Option<f64>> {
        let pattern = own.pattern(id, Some(0.03));
        let error = |(place, &condition): (usize, &ContactCondition)| {
            let own = own
                .row(&pattern, condition, &own_tuned[place])
                .peak_amplitude_m;
            let reference = reference.row(&pattern, condition, &reference_tuned[place]);
            own.map(|own| own / reference.peak_amplitude_m.unwrap() - 1.0)
        };
        conditions.iter().enumerate().map(error).collect()
    };
    ids.par_iter().flat_map_iter(of_pattern).collect()
}

/// A choice, the wheel at its settings, and the wheel at the best ones.
struct Chosen {
    accepted: f64,
    evidence: AccuracyEvidence,
    own: Case,
    reference: Case,
}

impl Chosen {
    fn new(study: &Study, accepted: f64) -> Self {
        let choice = choice(study, accepted);
        assert!(choice.met);
        let evidence = choice.evidence.clone().unwrap();
        println!("accepted {accepted}: {:?}", choice.setting);
        Self {
            accepted,
            own: Case::new(choice.applied_to(study)),
            reference: Case::new(best(study, &choice)),
            evidence,
        }
    }

    fn errors(&self, ids: &[u32]) -> Vec<Option<f64>> {
        errors(&self.own, &self.reference, ids)
    }

    /// What a choice measures is what the rows delivered at its settings are off by, beside another reference: to a quarter of the
    /// tolerance of the peak.
    fn is_made_of_delivered_rows(&self) {
        let again = ErrorBound::of(&self.errors(&self.evidence.patterns)).unwrap();
        let claimed = &self.evidence.amplitude;
        println!("sample: claimed {claimed:?}, found {again:?}");
        assert_eq!((again.rows, again.failed), (claimed.rows, claimed.failed));
        let known_to = 0.25 * self.own.study.solver.peak_tolerance;
        for (found, claimed) in [(again.median, claimed.median), (again.worst, claimed.worst)] {
            assert!(
                (found - claimed).abs() <= known_to,
                "{found:e}, {claimed:e}"
            );
        }
    }

    /// Whether of wheels that the choice did not see at least 95 % are within the claimed 95th
    /// percentile, and none beyond three times the claimed worst.
    fn holds_on(&self, fresh: &[u32]) -> bool {
        assert!(fresh.iter().all(|id| !self.evidence.patterns.contains(id)));
        let found = self.errors(fresh);
        let claimed = self.evidence.amplitude;
        let worst_claimed = self.evidence.amplitude_worst_upper;
        let within = |error: &&Option<f64>| error.is_some_and(|e| e.abs() <= claimed.p95_upper);
        let share = found.iter().filter(within).count() as f64 / found.len() as f64;
        let seen = ErrorBound::of(&found).unwrap();
        let size = |row: &usize| found[*row].map_or(f64::INFINITY, f64::abs);
        let worst = (0..found.len())
            .max_by(|a, b| size(a).total_cmp(&size(b)))
            .unwrap();
        println!(
            "accepted {}: claimed P95 <= {:.3e}, worst <= {:.3e} ({} rows, worst {:.3e}); of {} fresh rows {:.2} % \
             within; P95 {:.3e}, worst {:.3e} (pattern {})",
            self.accepted,
            claimed.p95_upper,
            worst_claimed,
            claimed.rows,
            claimed.worst,
            found.len(),
            100.0 * share,
            seen.p95,
            seen.worst,
            fresh[worst / self.own.study.contacts.len()],
        );
        share >= 0.95 && seen.worst <= 3.0 * worst_claimed
    }
}

#[test]
fn claimed_errors_are_those_of_delivered_rows_and_hold_on_wheels_that_were_not_seen() {
    let chosen = Chosen::new(&lumped(12, 16, ""), 0.02);
    chosen.is_made_of_delivered_rows();
    assert!(chosen.holds_on(&(6..16).collect::<Vec<u32>>()));
}

/// Harmonics of these rows meet resonances of the ring at their tops: humps that the points of a broad top do not see,
/// which were missed by up to 0.54 %.
#[test]
fn humps_on_broad_tops_are_found_within_the_tolerance_of_the_peak() {
    let mut study = lumped(24, 506, ON_A_BASIS);
    study.solver.harmonics = Harmonics::Set(vec![1, 3, 5]);
    study.solver.peak_tolerance = 3e-3;
    // In two stages: what looks into the gaps of a top is the second.
    study.solver.search_harmonics = SearchHarmonics::Set(vec![1]);
    let mut whole = study.clone();
    whole.solver.search_harmonics = SearchHarmonics::All;
    whole.solver.peak_tolerance = 1e-4;
    let [own, whole] = [study, whole].map(Case::new);
    let found = errors(&own, &whole, &[234, 237, 295, 342]);
    println!("{found:?}");
    let within = |error: &Option<f64>| error.is_some_and(|error| error.abs() <= 3e-3);
    assert!(found.iter().all(within), "{found:?}");
}

/// Tops that a search with harmonic 1 hardly shows, missed in two stages by 0.2 to 1.4 %: large equations whose search slopes
/// lead are not searched in two stages, and what is asked for more exactly than slopes tell starts from where they lead.
#[test]
fn tops_that_harmonic_1_hardly_shows_are_found_to_any_tolerance() {
    // Pattern, load in N, amplitude in m: of searches to 1e-4 that dense sweeps of the frequency (`verify --dense-sweep`) beat
    // by no more than 0.1 %.
    let known = [
        (178, 100.0, 5.4370e-04),
        (219, 50.0, 5.6865e-04),
        (266, 30.0, 9.8228e-04),
        (304, 100.0, 5.6775e-04),
        // A top of a blade that another one exceeds beside it: a search by local maxima of the largest blade is 0.86 % low.
        (480, 50.0, 5.488e-04),
    ];
    for tolerance in [1e-3, 1e-4] {
        let mut study = lumped(24, 506, ON_A_BASIS);
        study.solver.harmonics = Harmonics::Set(vec![1, 3, 5, 7]);
        study.solver.peak_tolerance = tolerance;
        let case = Case::new(study);
        for (id, normal_load_n, expected) in known {
            let condition = ContactCondition::Full { normal_load_n };
            let row = case.row(
                &case.pattern(id, Some(0.03)),
                condition,
                &case.tuned(condition),
            );
            let error = row.peak_amplitude_m.unwrap() / expected - 1.0;
            println!("pattern {id}, {normal_load_n} N, to {tolerance}: {error:.1e}");
            assert!(error.abs() <= 1e-3, "pattern {id}: {error:e}");
        }
    }
}

#[test]
#[ignore = "minutes: cargo test --release --test cases claimed_errors_hold_on_500 -- --ignored --nocapture"]
fn claimed_errors_hold_on_500_wheels_that_were_not_seen() {
    let fresh: Vec<u32> = (6..506).collect();
    // All are shown before any is judged.
    let held = [0.05, 0.01, 0.003]
        .map(|accepted| Chosen::new(&lumped(24, 506, ""), accepted).holds_on(&fresh));
    assert_eq!(held, [true; 3]);
}

#[test]
#[ignore = "minutes: cargo test --release --test cases claimed_errors_hold_on_100 -- --ignored --nocapture"]
fn claimed_errors_hold_on_100_wheels_of_the_default_model_that_were_not_seen() {
    let fresh: Vec<u32> = (6..106).collect();
    let held =
        [0.01, 0.001].map(|accepted| Chosen::new(&quickstart(106), accepted).holds_on(&fresh));
    assert_eq!(held, [true; 2]);
}
