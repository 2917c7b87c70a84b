//! `blisk report` and `blisk plot`: a finished study made for looking.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::PossibleValuesParser;

use super::exit::Failure;
use super::{ExitStatus, output};
use crate::campaign::{ReportRequest, report};
use crate::population::monte_carlo::LoadCaseName;
use crate::population::table::write_atomically;
use crate::report::{
    Answer, FIGURES, GroupReport, StudyReport, Wheels, answers, figure, html_report, missing,
    setting,
};
use crate::settings::ReducedEngineSource;

/// Arguments of `blisk report`.
#[derive(Debug, Args)]
pub struct ReportArguments {
    /// The results folder.
    results: PathBuf,
    /// The HTML file to write [default: DIR/report.html].
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Leave out the response curves, for which wheels are solved again.
    #[arg(long)]
    no_curves: bool,
    /// Where the inputs lie now: beside this study file [default: that of the last run].
    #[arg(long, value_name = "FILE")]
    study: Option<PathBuf>,
    /// Print the numbers of the report as JSON, and write a file only where --out says so.
    #[arg(long)]
    json: bool,
}

/// Arguments of `blisk plot`.
#[derive(Debug, Args)]
pub struct PlotArguments {
    /// The results folder.
    results: PathBuf,
    /// The figure.
    #[arg(value_name = "FIGURE", value_parser = PossibleValuesParser::new(FIGURES.map(|(_, name, about)| {
        clap::builder::PossibleValue::new(name).help(about)
    })))]
    figure: String,
    /// The SVG file to write [default: FIGURE.svg].
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Load case, where the study has several.
    #[arg(long, value_name = "NAME")]
    load_case: Option<String>,
    /// Engine order, where the study lists several.
    #[arg(long, value_name = "EO")]
    engine_order: Option<u32>,
    /// Standard deviation, where the study lists several.
    #[arg(long, value_name = "S")]
    standard_deviation: Option<f64>,
    /// Where the inputs lie now: beside this study file [default: that of the last run].
    #[arg(long, value_name = "FILE")]
    study: Option<PathBuf>,
}

pub(super) fn command(arguments: &ReportArguments) -> Result<ExitStatus, Failure> {
    let found = report(
        &ReportRequest {
            results: arguments.results.clone(),
            study_file: arguments.study.clone(),
            curves: !arguments.no_curves,
            model: true,
        },
        &ReducedEngineSource,
    )?;
    for group in &found.groups {
        if let (Wheels::NotSolved { reason }, false) = (&group.wheels, arguments.no_curves) {
            output::message(&format!("no response curves: {reason}"));
        }
    }
    let out = match (&arguments.out, arguments.json) {
        (Some(out), _) => Some(out.clone()),
        (None, false) => Some(arguments.results.join("report.html")),
        (None, true) => None,
    };
    if let Some(out) = &out {
        write_atomically(out, html_report(&found).as_bytes())?;
    }
    if arguments.json {
        output::json_only(&found)?;
    } else if let Some(out) = &out {
        let warnings = found.warnings_in_words();
        let warnings: Vec<String> = { warnings.iter() }
            .map(|warning| format!("warning: {warning}\n"))
            .collect();
        let between = if warnings.is_empty() { "" } else { "\n" };
        output::text(&format!(
            "{}{}{between}wrote {}",
            in_words(&found),
            warnings.concat(),
            out.display()
        ))?;
    }
    Ok(ExitStatus::Done)
}

pub(super) fn plot(arguments: &PlotArguments) -> Result<ExitStatus, Failure> {
    let name = FIGURES
        .iter()
        .find(|(_, name, _)| *name == arguments.figure)
        .map(|(name, ..)| *name)
        .ok_or_else(|| Failure::usage(format!("there is no figure {}", arguments.figure)))?;
    let out = arguments
        .out
        .clone()
        .unwrap_or_else(|| PathBuf::from(format!("{}.svg", arguments.figure)));
    ends_in_svg("--out", &out)?;
    let found = report(
        &ReportRequest {
            results: arguments.results.clone(),
            study_file: arguments.study.clone(),
            curves: name.is_of_wheels(),
            model: name.is_of_model(),
        },
        &ReducedEngineSource,
    )?;
    let group = chosen(&found, arguments)?;
    let Some(drawn) = figure(&found, group, name) else {
        let reason = missing(&found, group, name);
        let reason = reason.map_or_else(String::new, |reason| format!(": {reason}"));
        return Err(Failure::usage(format!(
            "these results have nothing to draw in {}{reason}",
            arguments.figure
        )));
    };
    write_atomically(&out, drawn.standalone().as_bytes())?;
    output::text(&format!(
        "wrote {}: {}, {}",
        out.display(),
        drawn.title,
        drawn.setting
    ))?;
    Ok(ExitStatus::Done)
}

/// Refuses another file than one for a drawing.
pub(super) fn ends_in_svg(option: &str, path: &Path) -> Result<(), Failure> {
    let ending = path.extension();
    if ending.is_some_and(|found| found.eq_ignore_ascii_case("svg")) {
        return Ok(());
    }
    Err(Failure::usage(format!(
        "{option} {}: accepted: a file name ending in .svg; other programs make other formats of it \
         (rsvg-convert, Inkscape, a browser)",
        path.display()
    )))
}

/// The group that the arguments name, or the only one.
fn chosen<'a>(
    found: &'a StudyReport,
    arguments: &PlotArguments,
) -> Result<&'a GroupReport, Failure> {
    let fits = |group: &&GroupReport| {
        let order = arguments.engine_order;
        let deviation = arguments.standard_deviation;
        let case = group.load_case.as_ref().map(LoadCaseName::as_str);
        (arguments.load_case.is_none() || arguments.load_case.as_deref() == case)
            && order.is_none_or(|order| order == group.engine_order)
            && deviation.is_none_or(|deviation| Some(deviation) == group.standard_deviation)
    };
    let fitting: Vec<&GroupReport> = found.groups.iter().filter(fits).collect();
    if let [only] = fitting[..] {
        return Ok(only);
    }
    let choices: Vec<String> = found
        .groups
        .iter()
        .map(|group| {
            let case = group.load_case;
            let case = case.map_or_else(String::new, |name| format!("--load-case {name} "));
            let deviation = group.standard_deviation;
            let deviation =
                deviation.map_or_else(String::new, |s| format!(" --standard-deviation {s}"));
            format!("{case}--engine-order {}{deviation}", group.engine_order)
        })
        .collect();
    Err(Failure::usage(format!(
        "the study has several load cases, engine orders or standard deviations, or not this one; accepted: {}",
        choices.join("; ")
    )))
}

/// The opening answers as text, and what the rows are held to.
fn in_words(found: &StudyReport) -> String {
    let mut text = String::new();
    for group in &found.groups {
        if found.groups.len() > 1 {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "{}\n", setting(group));
        }
        for Answer {
            question,
            verdict,
            reasons,
        } in answers(found, group)
        {
            // Writing to a String cannot fail.
            let _ = write!(text, "{question}\n  {verdict}\n");
            for reason in reasons {
                let _ = writeln!(text, "  {reason}");
            }
            text.push('\n');
        }
    }
    text + &found.summary.held_to()
}
