//! The normal load that keeps the response lowest, of the tuned wheel and of populations.

use blisk::population::monte_carlo::{ResponseRow, TunedReference};
use blisk::population::statistics::SampleStatistics;
use blisk::response::forced_response::ContactCondition;
use blisk::study::Study;
use rayon::prelude::*;

use super::super::support::{Case, package};
use super::models::under;
use super::report::{Section, Verdict, micrometres, table};

/// A wheel, its loads, and the standard deviations of its populations.
struct Population {
    name: &'static str,
    case: Case,
    loads_n: Vec<f64>,
    standard_deviations: [f64; 2],
    patterns: u32,
}

/// P95 with its bounds, of one population under one load.
#[derive(Clone, Copy)]
struct Percentile {
    value: f64,
    lower: Option<f64>,
    upper: Option<f64>,
}

/// What was found of one wheel.
struct Found {
    population: Population,
    tuned: Vec<f64>,
    /// By standard deviation, then load.
    mistuned: Vec<Vec<Percentile>>,
    failed: usize,
}

fn populations() -> [Population; 2] {
    let solved = |file: &str, loads_n: Vec<f64>, standard_deviations, patterns, name| {
        let mut study = Study::read(&package(file)).unwrap();
        study.contacts = under(&loads_n);
        Population {
            name,
            case: Case::new(study),
            loads_n,
            standard_deviations,
            patterns,
        }
    };
    [
        solved(
            "studies/quickstart.toml",
            vec![240.0, 320.0, 400.0, 480.0, 560.0, 640.0, 800.0, 1600.0],
            [0.01, 0.03],
            75,
            "built-in wheel of studies/quickstart.toml, its basis and harmonics",
        ),
        solved(
            "studies/validation/lumped24-population.toml",
            vec![25.0, 40.0, 50.0, 60.0, 75.0, 90.0, 110.0, 150.0],
            [0.01, 0.03],
            75,
            "lumped wheel of studies/validation/lumped24-population.toml",
        ),
    ]
}

pub fn section() -> Section {
    let found: Vec<Found> = populations().into_iter().map(solve).collect();
    let body: Vec<String> = found.iter().map(Found::body).collect();
    Section {
        compared: "Peak of the tuned wheel and 95th percentile of the peaks of a population over the normal load; in brackets the 95 % bounds by order \
                   statistics. The optimum is known to the step of the loads only; loads whose bounds overlap are not told apart by these populations."
            .to_owned(),
        body: body.join("\n"),
        verdicts: found.iter().flat_map(Found::verdicts).collect(),
    }
}

fn solve(population: Population) -> Found {
    let case = &population.case;
    let references: Vec<(ContactCondition, TunedReference)> = under(&population.loads_n)
        .into_par_iter()
        .map(|contact| (contact, case.tuned(contact)))
        .collect();
    let mut failed = 0;
    let mut mistuned = Vec::new();
    for deviation in population.standard_deviations {
        let mut of_deviation = Vec::new();
        for (contact, tuned) in &references {
            let rows: Vec<ResponseRow> = (0..population.patterns)
                .into_par_iter()
                .map(|id| case.row(&case.pattern(id, Some(deviation)), *contact, tuned))
                .collect();
            let peaks: Vec<f64> = rows.iter().filter_map(|row| row.peak_amplitude_m).collect();
            let missing = rows.len() - peaks.len();
            failed += missing;
            let statistics = SampleStatistics::new(peaks, missing as u64);
            let percentile = statistics.percentile(95).unwrap();
            of_deviation.push(Percentile {
                value: percentile.value.unwrap_or(f64::NAN),
                lower: percentile.lower,
                upper: percentile.upper,
            });
        }
        mistuned.push(of_deviation);
    }
    Found {
        tuned: references
            .iter()
            .map(|(_, tuned)| tuned.amplitude_m.unwrap_or(f64::NAN))
            .collect(),
        population,
        mistuned,
        failed,
    }
}

/// Place of the lowest value.
fn lowest(values: &[f64]) -> usize {
    let places = 0..values.len();
    places
        .min_by(|&a, &b| values[a].total_cmp(&values[b]))
        .unwrap()
}

impl Found {
    fn body(&self) -> String {
        let mut header = vec![
            "normal load per sector, N".to_owned(),
            "tuned, µm".to_owned(),
        ];
        let deviations = self.population.standard_deviations;
        header.extend(deviations.map(|deviation| format!("P95 at {} %, µm", 100.0 * deviation)));
        let rows: Vec<Vec<String>> = (0..self.tuned.len())
            .map(|at| {
                let mut row = vec![
                    format!("{}", self.population.loads_n[at]),
                    micrometres(Some(self.tuned[at])),
                ];
                row.extend(self.mistuned.iter().map(|column| column[at].shown()));
                row
            })
            .collect();
        let header: Vec<&str> = header.iter().map(String::as_str).collect();
        format!(
            "{}, {} patterns for each standard deviation of the blade stiffness, {} of {} rows failed:\n\n{}",
            self.population.name,
            self.population.patterns,
            self.failed,
            self.population.patterns as usize * self.tuned.len() * deviations.len(),
            table(&header, &rows)
        )
    }

    fn verdicts(&self) -> Vec<Verdict> {
        let loads = &self.population.loads_n;
        let tuned = lowest(&self.tuned);
        let mut places = vec![("tuned".to_owned(), tuned)];
        let deviations = self.population.standard_deviations;
        for (deviation, column) in deviations.iter().zip(&self.mistuned) {
            let values: Vec<f64> = column.iter().map(|percentile| percentile.value).collect();
            places.push((format!("P95 at {} %", 100.0 * deviation), lowest(&values)));
        }
        let last = loads.len() - 1;
        let list: Vec<String> = places
            .iter()
            .map(|(name, at)| format!("{name} {} N", loads[*at]))
            .collect();
        let wheel = self.population.name.split(" of ").next().unwrap();
        let id = |what: &str| format!("{}-{what}", wheel.replace(' ', "-"));
        let apart = deviations
            .iter()
            .zip(&self.mistuned)
            .filter(|(_, column)| is_told_apart(column, tuned))
            .map(|(deviation, _)| format!("{} %", 100.0 * deviation));
        let apart: Vec<String> = apart.collect();
        let same = places.iter().all(|(_, at)| *at == tuned);
        vec![
            Verdict::share(
                &id("rows"),
                &format!("{wheel}: rows solved"),
                [self.failed == 0],
                1.0,
            ),
            Verdict::claim(
                &id("interior"),
                format!(
                    "{wheel}: an optimal load between the ends of the loads ({})",
                    list.join(", ")
                ),
                places.iter().all(|(_, at)| *at > 0 && *at < last),
            ),
            Verdict::claim(
                &id("same-load"),
                format!(
                    "{wheel}: the same load is optimal for the tuned wheel and both populations (bounds of the tuned optimum and the lowest P95 apart: {})",
                    if apart.is_empty() {
                        "nowhere".to_owned()
                    } else {
                        apart.join(", ")
                    }
                ),
                same,
            ),
        ]
    }
}

/// Whether the percentile at the load optimal for the tuned wheel is above the lowest by more than
/// their bounds.
fn is_told_apart(column: &[Percentile], tuned: usize) -> bool {
    let values: Vec<f64> = column.iter().map(|percentile| percentile.value).collect();
    let best = column[lowest(&values)];
    let bounds = column[tuned].lower.zip(best.upper);
    bounds.is_some_and(|(at_tuned, at_best)| at_tuned > at_best)
}

impl Percentile {
    fn shown(self) -> String {
        let [value, lower, upper] = [Some(self.value), self.lower, self.upper].map(micrometres);
        format!("{value} [{lower}, {upper}]")
    }
}
