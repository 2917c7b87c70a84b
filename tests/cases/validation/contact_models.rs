//! Fast path and full contact model against each other and against rows of an independent code.

use blisk::population::monte_carlo::Scenario;
use blisk::response::forced_response::ContactCondition;
use blisk::response::mistuning::Pattern;
use blisk::settings::{FullModel, FullRow, FullSettings};
use blisk::study::{Study, load_sector_model};
use blisk::verification::reference::ReferencePeak;
use rayon::prelude::*;

use super::super::support::{Case, Row, Table, package};
use super::super::wheels::{WHEEL8, WHEEL24, Wheel, solved_for};
use super::models::default_model;
use super::report::{Section, Verdict, set_name, signed_percent, table};

/// A study on the fast path and on the full-contact model.
pub struct Both {
    pub fast: Case,
    pub full: FullModel,
}

impl Both {
    pub fn new(study: Study) -> Self {
        Self {
            full: Self::full_model(&study),
            fast: Case::new(study),
        }
    }

    /// The full-contact model of a study.
    pub fn full_model(study: &Study) -> FullModel {
        let sector = load_sector_model(study).unwrap();
        FullModel::build(study, &sector, &FullSettings::default()).unwrap()
    }

    /// Peak on a full model under a scenario of `case`; no pattern means the tuned wheel.
    pub fn peak(
        full: &FullModel,
        case: &Case,
        pattern: Option<&Pattern>,
        contact: ContactCondition,
        harmonics: &[u32],
    ) -> ReferencePeak {
        let scenario: Scenario = case.scenario(contact);
        let settings = full.settings(harmonics).unwrap();
        let row = FullRow {
            scenario: &scenario,
            pattern: None,
            settings: &settings,
            tuned_hz: None,
            expected_hz: None,
        };
        let tuned = full.peak(row);
        if pattern.is_none() {
            return tuned;
        }
        full.peak(FullRow {
            pattern,
            tuned_hz: tuned.frequency_hz,
            ..row
        })
    }
}

/// Amplitude and frequency of a peak, none where there is none.
type Place = Option<(f64, f64)>;

/// Relative differences of amplitude and frequency; not a number where a peak is missing.
#[derive(Debug, Clone, Copy)]
struct Difference {
    amplitude: f64,
    frequency: f64,
}

impl Difference {
    fn between(own: Place, other: Place) -> Self {
        let (amplitude, frequency) = match (own, other) {
            (Some(own), Some(other)) => (own.0 / other.0 - 1.0, own.1 / other.1 - 1.0),
            _ => (f64::NAN, f64::NAN),
        };
        Self {
            amplitude,
            frequency,
        }
    }

    fn cells(self) -> [String; 2] {
        if self.amplitude.is_nan() {
            return ["-".to_owned(), "-".to_owned()];
        }
        [
            signed_percent(self.amplitude),
            format!("{:+.4} %", 100.0 * self.frequency),
        ]
    }
}

/// One wheel under one contact condition with one harmonic set.
struct Compared {
    wheel: &'static str,
    pattern: String,
    contact: ContactCondition,
    harmonics: String,
    separates: bool,
    full_to_reference: Option<Difference>,
    fast_to_reference: Option<Difference>,
    fast_to_full: Difference,
    /// Amplitude of the full model at the frequency stored in the reference, over the stored one, less 1.
    there: f64,
}

impl Compared {
    /// The two models alone.
    fn of_models(
        wheel: &'static str,
        set: &[u32],
        id: Option<u32>,
        contact: ContactCondition,
        fast: Place,
        full: &ReferencePeak,
    ) -> Self {
        Self {
            wheel,
            pattern: id.map_or_else(|| "tuned".to_owned(), |id| id.to_string()),
            contact,
            harmonics: set_name(set),
            separates: full.shares.is_some_and(|shares| shares.separated > 0.0),
            full_to_reference: None,
            fast_to_reference: None,
            fast_to_full: Difference::between(fast, place(full)),
            there: f64::NAN,
        }
    }

    /// Whether the full model meets the reference within what its makers trust it to; on a flat peak
    /// the amplitude at the stored frequency stands for the frequency.
    fn meets_the_reference(&self) -> Option<bool> {
        let (within, within_hz) = match self.contact {
            ContactCondition::Full { .. } if self.harmonics.starts_with('0') => (1e-2, 5e-4),
            ContactCondition::Full { .. } => (1e-3, 2e-4),
            _ => (5e-4, 5e-5),
        };
        self.full_to_reference.map(|difference| {
            difference.amplitude.abs() <= within
                && (difference.frequency.abs() <= within_hz || self.there.abs() <= within)
        })
    }

    fn cells(&self) -> Vec<String> {
        let dash = || ["-".to_owned(), "-".to_owned()];
        let mut cells = vec![
            self.wheel.to_owned(),
            self.pattern.clone(),
            condition(self.contact),
            self.harmonics.clone(),
            if self.separates { "yes" } else { "no" }.to_owned(),
        ];
        cells.extend(self.full_to_reference.map_or_else(dash, Difference::cells));
        cells.extend(self.fast_to_reference.map_or_else(dash, Difference::cells));
        cells.extend(self.fast_to_full.cells());
        cells
    }
}

fn condition(contact: ContactCondition) -> String {
    contact
        .normal_load_n()
        .map_or_else(|| contact.name().to_owned(), |load| format!("{load} N"))
}

pub fn section() -> Section {
    let groups: Vec<(Wheel, &[u32])> = [WHEEL8, WHEEL24]
        .into_iter()
        .flat_map(|wheel| SETS.map(|set| (wheel, set)))
        .collect();
    let mut rows: Vec<Compared> = groups
        .par_iter()
        .with_max_len(1)
        .flat_map_iter(|&(wheel, set)| of_references(wheel, set))
        .collect();
    rows.extend(of_the_default_model());
    let header = [
        "wheel",
        "pattern",
        "contact",
        "harmonics",
        "separates",
        "full - reference: amplitude",
        "frequency",
        "fast - reference: amplitude",
        "frequency",
        "fast - full: amplitude",
        "frequency",
    ];
    let cells: Vec<Vec<String>> = rows.iter().map(Compared::cells).collect();
    Section {
        compared: format!(
            "Peaks of {} rows. *Reference*: rows of tests/data by a Craig-Bampton and harmonic balance code written independently, every contact \
             dof kept, 512 samples, 25 fixed-interface modes, the same harmonics; trusted by its makers to 0.1 % in amplitude and 0.02 % in frequency \
             (linear rows 0.05 and 0.005 %, rows with harmonic 0 1 and 0.05 %). Fast path: default settings. `default` is the wheel of studies/quickstart.toml \
             at default settings, for which there are no reference rows. Not here for its cost: the separating mistuned wheel24 \
             (`the_fast_path_at_default_settings_meets_the_full_model_on_wheel24`).",
            rows.len()
        ),
        body: table(&header, &cells),
        verdicts: verdicts(&rows),
    }
}

fn verdicts(rows: &[Compared]) -> Vec<Verdict> {
    let errors = |separates: bool, of: fn(&Difference) -> f64| {
        rows.iter()
            .filter(move |row| row.separates == separates)
            .map(move |row| of(&row.fast_to_full).abs())
    };
    let to_reference = rows.iter().filter_map(|row| {
        let load = row.contact.normal_load_n();
        Some(row.fast_to_reference?.amplitude.abs()).filter(|_| load.is_some())
    });
    vec![
        Verdict::share(
            "full-model-to-reference",
            "full model within the tolerances of the reference rows",
            rows.iter().filter_map(Compared::meets_the_reference),
            1.0,
        ),
        Verdict::at_most(
            "amplitude",
            "fast path against full model, amplitude, no separation",
            errors(false, |difference| difference.amplitude),
            3e-3,
        ),
        Verdict::at_most(
            "frequency",
            "fast path against full model, frequency, no separation",
            errors(false, |difference| difference.frequency),
            2e-4,
        ),
        Verdict::at_most(
            "amplitude-with-separation",
            "fast path against full model, amplitude, with separation",
            errors(true, |difference| difference.amplitude),
            1e-2,
        ),
        Verdict::at_most(
            "amplitude-to-reference",
            "fast path against the reference rows under friction, amplitude",
            to_reference,
            1e-2,
        ),
    ]
}

/// Harmonic sets of the reference.
const SETS: [&[u32]; 7] = [
    &[1],
    &[1, 3],
    &[1, 2, 3],
    &[1, 3, 5],
    &[1, 3, 5, 7],
    &[0, 1, 2, 3],
    &[0, 1, 2, 3, 4, 5],
];

/// All rows of the reference with one harmonic set.
fn of_references(wheel: Wheel, set: &[u32]) -> Vec<Compared> {
    let name = set_name(set);
    let reference = Table::read(&package(&format!(
        "tests/data/{}/reference/peaks.csv",
        wheel.name
    )));
    let rows: Vec<Row<'_>> = reference
        .rows()
        .filter(|row| row.text("harmonics") == name)
        .collect();
    if rows.is_empty() {
        return Vec::new();
    }
    // The study is that of the loads compared: an automatic basis is chosen for them.
    let mut conditions: Vec<String> = Vec::new();
    for row in &rows {
        let contact = solved_for(*row).1;
        let load = contact.normal_load_n();
        let text = load.map_or_else(|| format!("{:?}", contact.name()), |load| load.to_string());
        if !conditions.contains(&text) {
            conditions.push(text);
        }
    }
    let both = Both::new(wheel.default_study(&conditions.join(", "), set));
    rows.par_iter()
        .with_max_len(1)
        .map(|row| compare_row(&both, wheel.name, set, *row))
        .collect()
}

fn compare_row(both: &Both, wheel: &'static str, set: &[u32], row: Row<'_>) -> Compared {
    let (id, contact) = solved_for(row);
    let pattern = id.map(|id| both.fast.pattern(id, None));
    let full = Both::peak(&both.full, &both.fast, pattern.as_ref(), contact, set);
    let (amplitude, hz) = (row.number("amplitude"), row.number("frequency_hz"));
    let settings = both.full.settings(set).unwrap();
    let scenario = both.fast.scenario(contact);
    let there = both
        .full
        .curve(&scenario, pattern.as_ref(), &settings, &[hz])
        .iter()
        .map(|point| point.amplitude_m.unwrap_or(f64::NAN))
        .fold(0.0, f64::max);
    let fast = fast_place(both, pattern.as_ref(), contact);
    let reference = Some((amplitude, hz));
    Compared {
        full_to_reference: Some(Difference::between(place(&full), reference)),
        fast_to_reference: Some(Difference::between(fast, reference)),
        there: there / amplitude - 1.0,
        ..Compared::of_models(wheel, set, id, contact, fast, &full)
    }
}

fn place(peak: &ReferencePeak) -> Place {
    Some((peak.amplitude_m?, peak.frequency_hz?))
}

fn fast_place(both: &Both, pattern: Option<&Pattern>, contact: ContactCondition) -> Place {
    let tuned = both.fast.tuned(contact);
    let Some(pattern) = pattern else {
        return Some((tuned.amplitude_m?, tuned.frequency_hz?));
    };
    let row = both.fast.row(pattern, contact, &tuned);
    Some((row.peak_amplitude_m?, row.peak_frequency_hz?))
}

/// The built-in wheel, tuned and with patterns of 3 %.
fn of_the_default_model() -> Vec<Compared> {
    const LOADS_N: [f64; 5] = [160.0, 320.0, 480.0, 1600.0, 4000.0];
    const MISTUNED: [(u32, f64); 3] = [(0, 320.0), (1, 480.0), (2, 1600.0)];
    let mut all = Vec::new();
    for set in [&[1][..], &[1, 3]] {
        let both = Both::new(default_model(&LOADS_N, Some(set)));
        let tuned = LOADS_N.map(|load| (None, load));
        let mistuned = MISTUNED.map(|(id, load)| (Some(id), load));
        let rows: Vec<(Option<u32>, f64)> = tuned.into_iter().chain(mistuned).collect();
        all.extend(
            rows.par_iter()
                .with_max_len(1)
                .map(|&(id, normal_load_n)| {
                    let pattern = id.map(|id| both.fast.pattern(id, Some(0.03)));
                    let contact = ContactCondition::Full { normal_load_n };
                    let full = Both::peak(&both.full, &both.fast, pattern.as_ref(), contact, set);
                    let fast = fast_place(&both, pattern.as_ref(), contact);
                    Compared::of_models("default", set, id, contact, fast, &full)
                })
                .collect::<Vec<_>>(),
        );
    }
    all
}
