//! One delivered row solved again: a question of `blisk verify`, and of `replay`, its older name.

use std::fmt::{self, Write};
use std::path::PathBuf;

use clap::Args;
use serde::{Serialize, Serializer};
use serde_json::{Value, json};

use super::exit::Failure;
use super::fidelity::FidelityArguments;
use super::{ExitStatus, output};
use crate::campaign::{Replay, ReplayRequest, StoredStudy, replay};
use crate::population::monte_carlo::{ResponseRow, harmonics_name};
use crate::report::LengthUnit;
use crate::settings::ReducedEngineSource;

/// Arguments of `blisk replay`.
#[derive(Debug, Args)]
pub struct ReplayArguments {
    /// The results folder.
    results: PathBuf,
    /// Scenario, counted from 0.
    #[arg(long, value_name = "I")]
    scenario: usize,
    /// Id of the pattern.
    #[arg(long, value_name = "ID")]
    pattern: u32,
    /// Which model the row is compared with besides.
    #[command(flatten)]
    fidelity: FidelityArguments,
    /// Where the inputs lie now: beside this study file [default: that of the last run].
    #[arg(long, value_name = "FILE")]
    study: Option<PathBuf>,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

pub(super) fn command(arguments: &ReplayArguments) -> Result<ExitStatus, Failure> {
    arguments.fidelity.check_for_one_row()?;
    let stored = StoredStudy::open(&arguments.results, arguments.study.as_deref())?;
    warn_of_other_build(&stored);
    let row = (arguments.scenario, arguments.pattern);
    solved_again(&stored, row, &arguments.fidelity, arguments.json)
}

/// The row of a scenario and a pattern solved again, on the model of the study and on that of `fidelity`.
pub(super) fn solved_again(
    stored: &StoredStudy,
    (scenario, pattern): (usize, u32),
    fidelity: &FidelityArguments,
    json: bool,
) -> Result<ExitStatus, Failure> {
    let request = ReplayRequest {
        scenario,
        pattern,
        full: fidelity.full(&stored.study)?,
    };
    let answer = ReplayAnswer(replay(stored, &ReducedEngineSource, &request)?);
    if json {
        output::json_only(&answer)?;
    } else {
        output::text(&answer)?;
    }
    Ok(if answer.0.identical {
        ExitStatus::Done
    } else {
        ExitStatus::VerificationFailed
    })
}

/// Says so where rows are solved again by another build than the one that solved them.
pub(super) fn warn_of_other_build(stored: &StoredStudy) {
    if let Some(builds) = stored.other_build() {
        output::message(&format!(
            "warning: {builds}; a difference can be one of the builds"
        ));
    }
}

/// A row solved again, as the command tells it.
#[derive(Debug)]
pub struct ReplayAnswer(pub Replay);

impl Serialize for ReplayAnswer {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        as_json(&self.0).serialize(serializer)
    }
}

impl fmt::Display for ReplayAnswer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&as_text(&self.0))
    }
}

fn as_json(replay: &Replay) -> Value {
    let row = |row: &ResponseRow| {
        json!({
            "status": row.status.name(),
            "peak_amplitude_m": row.peak_amplitude_m,
            "peak_frequency_hz": row.peak_frequency_hz,
            "peak_blade": row.peak_blade,
            "amplification_factor": row.amplification_factor,
            "harmonics": row.harmonics,
            "newton_iterations": row.newton_iterations,
        })
    };
    let mut value = json!({
        "scenario": replay.scenario.index,
        "pattern": replay.delivered.pattern,
        "identical": replay.identical,
        "delivered": row(&replay.delivered),
        "replayed": row(&replay.replayed),
    });
    if let (Some((reference, tuned, harmonics)), Some(record)) = (&replay.full, replay.record()) {
        value["full"] = json!({
            "status": reference.status.name(),
            "tuned_status": tuned.status.name(),
            "harmonics": harmonics_name(harmonics),
            "peak_amplitude_m": reference.amplitude_m,
            "peak_frequency_hz": reference.frequency_hz,
            "peak_blade": reference.blade,
            "amplification_factor": record.reference_amplification_factor(),
            "residual": reference.residual,
            "amplitude_error": record.amplitude_error(),
            "frequency_error": record.frequency_error(),
            "amplification_factor_error": record.amplification_factor_error(),
        });
    }
    value
}

fn as_text(replay: &Replay) -> String {
    let mut text = format!(
        "scenario {}, pattern {}: {}\n",
        replay.scenario.index,
        replay.delivered.pattern,
        if replay.identical {
            "bit-identical"
        } else {
            "NOT the same"
        }
    );
    let unit = LengthUnit::of(replay.delivered.peak_amplitude_m);
    let mut line =
        |name: &str, status: &str, amplitude: Option<f64>, hz: Option<f64>, factor: Option<f64>| {
            let number =
                |value: Option<f64>| value.map_or("-".to_owned(), |value| value.to_string());
            // Writing to a String cannot fail.
            let _ = writeln!(
                text,
                "  {name}: {status}, {} at {} Hz, amplification factor {}",
                amplitude.map_or("-".to_owned(), |value| unit.precise(value)),
                number(hz),
                number(factor)
            );
        };
    for (name, row) in [
        ("delivered", &replay.delivered),
        ("replayed", &replay.replayed),
    ] {
        line(
            name,
            row.status.name(),
            row.peak_amplitude_m,
            row.peak_frequency_hz,
            row.amplification_factor,
        );
    }
    if let (Some((reference, _, harmonics)), Some(record)) = (&replay.full, replay.record()) {
        line(
            &format!(
                "full-contact model, harmonics {}",
                harmonics_name(harmonics)
            ),
            reference.status.name(),
            reference.amplitude_m,
            reference.frequency_hz,
            record.reference_amplification_factor(),
        );
        let percent = |error: Option<f64>| {
            error.map_or("-".to_owned(), |error| format!("{:+.4} %", 100.0 * error))
        };
        let _ = writeln!(
            text,
            "  error of amplitude {}, frequency {}, amplification factor {}",
            percent(record.amplitude_error()),
            percent(record.frequency_error()),
            percent(record.amplification_factor_error())
        );
    }
    text
}
