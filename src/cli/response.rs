//! `blisk response`: amplitude of every blade over frequency for one pattern.

use std::path::PathBuf;
use std::str::FromStr;

use clap::Args;
use serde_json::json;

use super::exit::Failure;
use super::fidelity::{Fidelity, FidelityArguments};
use super::{ExitStatus, output};
use crate::campaign::{
    CurveRequest, TracedCurve, full_response_curve, response_curve, traced_response,
};
use crate::population::monte_carlo::LoadCaseName;
use crate::population::table::{CurveFormat, TableHeader, write_curve, write_traced_curve};
use crate::report::LengthUnit;
use crate::response::forced_response::ContactCondition;
use crate::response::friction::Ring;
use crate::response::harmonic_balance::Status;
use crate::settings::ReducedEngineSource;
use crate::study::{Study, StudyDigest};

/// Largest number of frequencies of a curve.
const MAX_FREQUENCIES: usize = 1_000_000;

/// `--pattern`: the tuned wheel or a pattern of the study.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PatternArgument(Option<u32>);

/// `--load`: a normal load or a linear limit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoadArgument(ContactCondition);

/// `--frequencies`: equally spaced, both ends included.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrequencyGrid {
    start_hz: f64,
    stop_hz: f64,
    count: usize,
}

impl FromStr for PatternArgument {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "tuned" => Ok(Self(None)),
            id => id.parse().map(|id| Self(Some(id))).map_err(|_| {
                "accepted: tuned, or the id of a pattern, a whole number from 0".to_owned()
            }),
        }
    }
}

impl FromStr for LoadArgument {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let contact = match text {
            "stuck" => ContactCondition::Stuck,
            "slide" => ContactCondition::Slide,
            "free" => ContactCondition::Free,
            number => number
                .parse()
                .ok()
                .filter(|load: &f64| load.is_finite() && *load >= 0.0)
                .map(|normal_load_n| ContactCondition::Full { normal_load_n })
                .ok_or("accepted: a number of at least 0 in N, stuck, slide or free")?,
        };
        Ok(Self(contact))
    }
}

impl FromStr for FrequencyGrid {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let accepted = format!(
            "accepted: START:STOP:COUNT with 0 < START < STOP in Hz and COUNT from 2 to \
             {MAX_FREQUENCIES}, or START = STOP and COUNT = 1"
        );
        let parts: Vec<&str> = text.split(':').collect();
        let [start, stop, count] = parts.as_slice() else {
            return Err(accepted);
        };
        let (Ok(start_hz), Ok(stop_hz), Ok(count)) = (
            start.parse::<f64>(),
            stop.parse::<f64>(),
            count.parse::<usize>(),
        ) else {
            return Err(accepted);
        };
        let several = start_hz < stop_hz && (2..=MAX_FREQUENCIES).contains(&count);
        let one = start_hz.total_cmp(&stop_hz).is_eq() && count == 1;
        if start_hz > 0.0 && stop_hz.is_finite() && (several || one) {
            Ok(Self {
                start_hz,
                stop_hz,
                count,
            })
        } else {
            Err(accepted)
        }
    }
}

impl FrequencyGrid {
    /// The frequencies, Hz; the first and last are exactly those asked for.
    fn frequencies_hz(&self) -> Vec<f64> {
        let last = self.count - 1;
        (0..self.count)
            .map(|place| {
                if place == last {
                    self.stop_hz
                } else {
                    let step = (self.stop_hz - self.start_hz) / last as f64;
                    self.start_hz + step * place as f64
                }
            })
            .collect()
    }
}

/// Arguments of `blisk response`.
#[derive(Debug, Args)]
pub struct ResponseArguments {
    /// The study file.
    study: PathBuf,
    /// `tuned`, or the id of a pattern of the study.
    #[arg(long, value_name = "tuned|ID")]
    pattern: PatternArgument,
    /// Normal load per sector in N, or a linear limit.
    #[arg(long, value_name = "N|stuck|slide|free")]
    load: LoadArgument,
    /// First and last frequency in Hz, both included, and the number of frequencies.
    #[arg(long, value_name = "START:STOP:COUNT")]
    frequencies: FrequencyGrid,
    /// The file to write: .csv or .parquet.
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// Load case, where the study has several.
    #[arg(long, value_name = "NAME")]
    load_case: Option<String>,
    /// Engine order, where the study lists several.
    #[arg(long, value_name = "EO")]
    engine_order: Option<u32>,
    /// Standard deviation, where the study lists several.
    #[arg(long, value_name = "S")]
    standard_deviation: Option<f64>,
    /// Which model is solved, and how finely.
    #[command(flatten)]
    fidelity: FidelityArguments,
    /// Follow the curve through its folds, upwards and downwards.
    #[arg(long)]
    continuation: bool,
    /// Print what was written as JSON.
    #[arg(long)]
    json: bool,
}

pub(super) fn command(arguments: &ResponseArguments) -> Result<ExitStatus, Failure> {
    let out = &arguments.out;
    let format = CurveFormat::of(out).ok_or_else(|| {
        Failure::usage(format!(
            "--out {}: accepted: a file name ending in .csv or .parquet",
            out.display()
        ))
    })?;
    let study = arguments
        .fidelity
        .applied_to(Study::read(&arguments.study)?)?;
    let frequencies_hz = arguments.frequencies.frequencies_hz();
    let excited = excited(&study, arguments.load_case.as_deref())?;
    let request = CurveRequest {
        pattern: arguments.pattern.0,
        contact: arguments.load.0,
        load_case: excited.name,
        engine_order: engine_order(excited.engine_orders, arguments.engine_order)?,
        standard_deviation: match arguments.pattern.0 {
            None => None,
            Some(_) => standard_deviation(&study, arguments.standard_deviation)?,
        },
        frequencies_hz: &frequencies_hz,
    };
    let header = TableHeader {
        study_digest: StudyDigest::of(&study)?.hex(),
        compression: study.output.compression,
        load_cases: Vec::new(),
    };
    if arguments.continuation {
        return followed(arguments, &study, request, format, &header);
    }
    let points = match arguments.fidelity.full(&study)? {
        None => response_curve(&study, &ReducedEngineSource, request)?,
        Some(settings) => full_response_curve(&study, &settings, request)?,
    };
    write_curve(out, format, &points, &header)?;
    let failed = points
        .iter()
        .filter(|point| point.status != Status::Ok)
        .count();
    let largest = points
        .iter()
        .filter_map(|point| Some((point.amplitude_m?, point)))
        .max_by(|a, b| a.0.total_cmp(&b.0));
    if arguments.json {
        output::json_only(&json!({
            "file": out,
            "rows": points.len(),
            "failed": failed,
            "largest": largest.map(|(_, point)| point),
        }))?;
    } else {
        let largest = largest.map_or_else(String::new, |(amplitude, point)| {
            format!(
                "; largest {} at {} Hz, blade {}",
                LengthUnit::of([amplitude]).precise(amplitude),
                point.frequency_hz,
                point.blade
            )
        });
        output::text(&format!(
            "wrote {} rows to {}, {failed} without value{largest}",
            points.len(),
            out.display()
        ))?;
    }
    Ok(if failed == 0 {
        ExitStatus::Done
    } else {
        ExitStatus::FailureGate
    })
}

/// `--continuation`: the curve followed upwards and downwards.
fn followed(
    arguments: &ResponseArguments,
    study: &Study,
    request: CurveRequest<'_>,
    format: CurveFormat,
    header: &TableHeader,
) -> Result<ExitStatus, Failure> {
    if request.contact.normal_load_n().is_none() {
        return Err(Failure::usage(format!(
            "--continuation with --load {}: a linear response has one branch; accepted: a normal load in N",
            request.contact.name()
        )));
    }
    if arguments.fidelity.fidelity == Fidelity::Full {
        return Err(Failure::usage(
            "--continuation with --fidelity full: a curve is followed on the reduced model; accepted: --fidelity reduced".to_owned(),
        ));
    }
    let ring = study.contact.as_ref().map(|contact| contact.ring);
    if ring == Some(Ring::Creeping) {
        return Err(Failure::usage(
            "--continuation: the curve of a creeping ring is not followed; accepted: contact.ring = \"locked\"".to_owned(),
        ));
    }
    if request.frequencies_hz.len() < 2 {
        return Err(Failure::usage(
            "--continuation needs at least two frequencies".to_owned(),
        ));
    }
    let out = &arguments.out;
    let curve = traced_response(study, &ReducedEngineSource, request)?;
    write_traced_curve(out, format, &curve.points, header)?;
    let complete = curve.status.map(|status| status == Status::Ok);
    if arguments.json {
        output::json_only(&json!({
            "file": out,
            "rows": curve.points.len(),
            "complete": { "up": complete[0], "down": complete[1] },
            "curve": curve,
        }))?;
    } else {
        output::text(&format!(
            "wrote {} rows to {}\n{}",
            curve.points.len(),
            out.display(),
            in_words(&curve)
        ))?;
    }
    Ok(if complete == [true, true] {
        ExitStatus::Done
    } else {
        ExitStatus::FailureGate
    })
}

/// Completeness, folds and agreement of a followed curve, a line each.
fn in_words(curve: &TracedCurve) -> String {
    let ended = |status: Status| match status {
        Status::Ok => "complete".to_owned(),
        status => format!("incomplete ({})", status.name()),
    };
    let mut lines = vec![format!(
        "curve: upwards {}, downwards {}",
        ended(curve.status[0]),
        ended(curve.status[1])
    )];
    let unit = LengthUnit::of(
        curve
            .largest
            .as_ref()
            .and_then(|largest| largest.amplitude_m),
    );
    lines.extend(curve.folds.iter().map(|fold| {
        format!(
            "fold at {} Hz, {} ({})",
            fold.frequency_hz,
            unit.precise(fold.amplitude_m),
            fold.direction.name()
        )
    }));
    lines.extend(
        curve
            .multivalued_hz
            .iter()
            .map(|(low, high)| format!("several solutions from {low} to {high} Hz")),
    );
    lines.push(match (curve.directions_agree, curve.largest_difference) {
        (true, _) => "both directions pass the same solutions".to_owned(),
        (false, Some(difference)) => format!(
            "the directions differ by {difference:.1e} of the largest amplitude: see the column direction"
        ),
        (false, None) => {
            "the directions pass different numbers of solutions: see the column direction".to_owned()
        }
    });
    if let Some(largest) = &curve.largest {
        lines.push(format!(
            "largest {} at {} Hz, blade {}",
            unit.precise(largest.amplitude_m.unwrap_or_default()),
            largest.frequency_hz,
            largest.blade.unwrap_or_default()
        ));
    }
    lines.join("\n")
}

/// A load case with its engine orders; without a name where the study has none.
struct Excited<'a> {
    name: Option<LoadCaseName>,
    engine_orders: &'a [u32],
}

fn excited<'a>(study: &'a Study, asked: Option<&str>) -> Result<Excited<'a>, Failure> {
    let names = || {
        let names: Vec<&str> = study
            .load_cases
            .iter()
            .map(|case| case.name.as_str())
            .collect();
        names.join(", ")
    };
    let case = match (asked, study.load_cases.as_slice()) {
        (None, []) => {
            return Ok(Excited {
                name: None,
                engine_orders: &study.engine_orders,
            });
        }
        (None, [only]) => only,
        (Some(asked), cases) => cases
            .iter()
            .find(|case| case.name.as_str() == asked)
            .ok_or_else(|| {
                Failure::usage(match cases {
                    [] => format!("--load-case {asked}: the study has no excitation.load_case"),
                    _ => format!(
                        "--load-case {asked} is not in the study; accepted: {}",
                        names()
                    ),
                })
            })?,
        (None, _) => {
            return Err(Failure::usage(format!(
                "the study has several load cases; give --load-case, one of {}",
                names()
            )));
        }
    };
    Ok(Excited {
        name: Some(case.name),
        engine_orders: &case.engine_orders,
    })
}

fn engine_order(known: &[u32], asked: Option<u32>) -> Result<u32, Failure> {
    let choices = || {
        known
            .iter()
            .map(u32::to_string)
            .collect::<Vec<_>>()
            .join(", ")
    };
    match (asked, known) {
        (Some(order), orders) if orders.contains(&order) => Ok(order),
        (None, [only]) => Ok(*only),
        (Some(order), _) => Err(Failure::usage(format!(
            "--engine-order {order} is not in the study; accepted: {}",
            choices()
        ))),
        (None, _) => Err(Failure::usage(format!(
            "the study has several engine orders; give --engine-order, one of {}",
            choices()
        ))),
    }
}

fn standard_deviation(study: &Study, asked: Option<f64>) -> Result<Option<f64>, Failure> {
    let choices = || {
        study
            .standard_deviations
            .iter()
            .flatten()
            .map(f64::to_string)
            .collect::<Vec<_>>()
            .join(", ")
    };
    match (asked, study.standard_deviations.as_slice()) {
        (None, [only]) => Ok(*only),
        (Some(asked), known) if known.contains(&Some(asked)) => Ok(Some(asked)),
        (Some(asked), [None]) => Err(Failure::usage(format!(
            "--standard-deviation {asked}: the patterns of this study come from a file and have none"
        ))),
        (Some(asked), _) => Err(Failure::usage(format!(
            "--standard-deviation {asked} is not in the study; accepted: {}",
            choices()
        ))),
        (None, _) => Err(Failure::usage(format!(
            "the study has several standard deviations; give --standard-deviation, one of {}",
            choices()
        ))),
    }
}
