//! The study of the README, run by the program, and the page `results/README.md` with its table.

use std::process::Command;

use blisk::campaign::{ReplayRequest, StoredStudy, replay, summarise};
use blisk::population::statistics::Percentile;
use blisk::report::{ScenarioSummary, StudySummary};
use blisk::settings::{FullSettings, ReducedEngineSource};
use rayon::prelude::*;

use super::super::support::package;
use super::bars::{Kind, Verdict};
use super::identity::Identity;
use super::report::{Entry, Section, micrometres, percent, signed_percent, table};

/// By which the section is found again for the page.
pub const NAME: &str = "quickstart";
const STUDY: &str = "studies/quickstart.toml";
/// Load and patterns whose deviations in harmonics other than 1 matter most among the first thirty.
const HARD_LOAD_N: f64 = 1600.0;
const HARD_PATTERNS: [u32; 3] = [6, 24, 28];

pub fn section() -> Section {
    let folder = tempfile::tempdir().unwrap();
    let results = folder.path().join("quickstart");
    let ended = Command::new(env!("CARGO_BIN_EXE_blisk"))
        .arg("run")
        .arg(package(STUDY))
        .arg("--out")
        .arg(&results)
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&ended.stderr);
    assert!(ended.status.success(), "{text}");
    let summary = summarise(&results).unwrap();
    let stored = StoredStudy::open(&results, Some(&package(STUDY))).unwrap();
    let hard = hard_rows(&stored, &summary);
    let hard_cells: Vec<Vec<String>> = hard.iter().map(HardRow::cells).collect();
    let warnings: Vec<String> = summary
        .warnings
        .iter()
        .map(|warning| format!("- {warning}\n"))
        .collect();
    Section {
        compared: format!(
            "`{STUDY}`, seed {}, {} patterns, harmonics {}, basis {}; {} rows, {} failed. Amplitudes in µm, 95 % bounds in brackets.",
            summary.seed,
            summary.patterns,
            stored.study.resolved()["solver"]["harmonics"],
            summary.basis.name,
            summary.rows.planned(),
            summary.rows.failed()
        ),
        body: format!(
            "{}\nIts warnings ({}):\n\n{}\nRows under {HARD_LOAD_N} N beside the full contact model with the same harmonics, in which the blades deviate in every harmonic. They are \
             those of the first thirty patterns that a small basis with harmonics of the tuned wheel served worst, no random sample:\n\n{}",
            of_loads(&summary),
            warnings.len(),
            warnings.concat(),
            table(
                &["pattern", "peak, µm", "full model, µm", "error", "stated"],
                &hard_cells
            )
        ),
        verdicts: vec![
            Verdict::share("rows", "rows solved", [summary.rows.failed() == 0], 1.0),
            Verdict {
                id: "warnings".to_owned(),
                kind: Kind::Bar,
                met: warnings.is_empty(),
                figure: Some(warnings.len() as f64),
                bar: Some(0.0),
                text: format!(
                    "warnings of the study of the README: {}, bar 0",
                    warnings.len()
                ),
            },
            Verdict::share(
                "stated-error-of-deviations-in-every-harmonic",
                &format!(
                    "patterns {HARD_PATTERNS:?} under {HARD_LOAD_N} N within the stated error of the full contact model"
                ),
                hard.iter().map(HardRow::is_within),
                1.0,
            ),
        ],
    }
}

/// A delivered row beside the full contact model.
struct HardRow {
    pattern: u32,
    peak_m: Option<f64>,
    full_m: Option<f64>,
    stated: Option<f64>,
}

impl HardRow {
    fn error(&self) -> Option<f64> {
        Some(self.peak_m? / self.full_m? - 1.0)
    }

    fn is_within(&self) -> bool {
        let both = self.error().zip(self.stated);
        both.is_some_and(|(error, stated)| error.abs() <= stated)
    }

    fn cells(&self) -> Vec<String> {
        let shown =
            |value: Option<f64>, by: fn(f64) -> String| value.map_or_else(|| "-".to_owned(), by);
        vec![
            self.pattern.to_string(),
            micrometres(self.peak_m),
            micrometres(self.full_m),
            shown(self.error(), signed_percent),
            shown(self.stated, percent),
        ]
    }
}

fn hard_rows(stored: &StoredStudy, summary: &StudySummary) -> Vec<HardRow> {
    let scenario = summary
        .scenarios
        .iter()
        .find(|own| own.normal_load_n == Some(HARD_LOAD_N))
        .expect("the study has this load")
        .scenario;
    HARD_PATTERNS
        .par_iter()
        .with_max_len(1)
        .map(|&pattern| {
            let request = ReplayRequest {
                scenario,
                pattern,
                full: Some(FullSettings::default()),
            };
            let again = replay(stored, &ReducedEngineSource, &request).unwrap();
            assert!(again.identical, "pattern {pattern}");
            HardRow {
                pattern,
                peak_m: again.delivered.peak_amplitude_m,
                full_m: again.full.and_then(|(peak, ..)| peak.amplitude_m),
                stated: again.delivered.stated_error,
            }
        })
        .collect()
}

fn of_loads(summary: &StudySummary) -> String {
    let header = [
        "normal load per sector, N",
        "tuned",
        "at, Hz",
        "P50",
        "P95",
        "amplification P50",
        "amplification P95",
    ];
    let rows: Vec<Vec<String>> = summary.scenarios.iter().map(of_load).collect();
    table(&header, &rows)
}

fn of_load(own: &ScenarioSummary) -> Vec<String> {
    let percentile = |of: &[Percentile], percent: f64| -> Percentile {
        *of.iter()
            .find(|own| own.percent.total_cmp(&percent).is_eq())
            .unwrap()
    };
    let bounded = |own: Percentile, shown: fn(f64) -> String| {
        let shown = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), shown);
        format!(
            "{} [{}, {}]",
            shown(own.value),
            shown(own.lower),
            shown(own.upper)
        )
    };
    let um = |metres: f64| micrometres(Some(metres));
    let factor = |factor: f64| format!("{factor:.3}");
    let (amplitudes, factors) = (
        &own.peak_amplitude_m.percentiles,
        &own.amplification_factor.percentiles,
    );
    vec![
        own.normal_load_n
            .map_or_else(|| own.contact.to_owned(), |load| load.to_string()),
        micrometres(own.tuned_amplitude_m),
        own.tuned_frequency_hz
            .map_or_else(|| "-".to_owned(), |hz| format!("{hz:.2}")),
        bounded(percentile(amplitudes, 50.0), um),
        bounded(percentile(amplitudes, 95.0), um),
        bounded(percentile(factors, 50.0), factor),
        bounded(percentile(factors, 95.0), factor),
    ]
}

/// Writes `results/README.md` with the table of the section.
pub fn write_page(identity: &Identity, sections: &[(&Entry, Section)]) {
    let (_, own) = sections
        .iter()
        .find(|(entry, _)| entry.name == NAME)
        .unwrap();
    let rows = own.body.split("\n\n").next().unwrap().trim_end();
    let page = format!(
        "# Results\n\n`blisk run STUDY` writes to `results/<name>/`; docs/results.md describes the files. Nothing here is kept\n\
         but this page, `validation/` and the table of `optimal-load/`.\n\n## Quickstart\n\n{}\n\n{}\n\n{} It is the command of the [validation report](validation/report.md), \
         which has the warnings of this study and rows of it beside the full contact model.\n",
        own.compared,
        rows.split("\nIts warnings").next().unwrap().trim_end(),
        identity.line()
    );
    std::fs::write(package("results/README.md"), page).unwrap();
}
