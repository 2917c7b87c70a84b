//! `blisk campbell`: frequencies per nodal diameter, and the speeds at which engine orders cross them.

use std::path::PathBuf;
use std::str::FromStr;

use clap::{ArgGroup, Args};

use super::exit::Failure;
use super::report::ends_in_svg;
use super::{ExitStatus, output};
use crate::campaign::{CampbellRequest, campbell};
use crate::model::sector::bundle;
use crate::population::table::write_atomically;
use crate::report::FigureName;
use crate::study::{PipelineError, Study, load_sector_model};

/// Arguments of the command.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new("diagram").args(["plot", "plot_safe"]).multiple(true))]
pub struct CampbellArguments {
    /// The study file: model, contact stiffness, engine orders.
    study: PathBuf,
    /// Engine orders, one number or FIRST:LAST, several by commas [default: those of the study].
    #[arg(long, value_name = "EO,EO", value_delimiter = ',')]
    engine_orders: Vec<Orders>,
    /// Lowest and highest speed in revolutions per minute [default: all].
    #[arg(long, value_name = "LOW:HIGH")]
    speed_rpm: Option<Speeds>,
    /// The model at a speed, in the place of that of the study: revolutions per minute and a sector bundle.
    /// Given for several speeds, frequencies follow the speed.
    #[arg(long, value_name = "RPM=BUNDLE")]
    at: Vec<ModelAtSpeed>,
    /// Modes per nodal diameter.
    #[arg(long, value_name = "N", default_value = "6", value_parser = clap::value_parser!(u16).range(1..=100))]
    modes: u16,
    /// Write the Campbell diagram, frequency over speed, to this SVG file.
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    /// Write the SAFE diagram, frequency over nodal diameter, to this SVG file.
    #[arg(long, value_name = "FILE")]
    plot_safe: Option<PathBuf>,
    /// Highest frequency of the diagrams, beside --plot or --plot-safe [default: above the third mode of every nodal diameter].
    #[arg(long, value_name = "HZ", requires = "diagram")]
    top_hz: Option<TopHz>,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

/// Engine orders from the first to the last.
#[derive(Debug, Clone, Copy)]
struct Orders(u32, u32);

/// Lowest and highest speed, revolutions per minute.
#[derive(Debug, Clone, Copy)]
struct Speeds([f64; 2]);

/// Upper end of the frequencies of a diagram, Hz.
#[derive(Debug, Clone, Copy)]
struct TopHz(f64);

/// A sector bundle and its speed, revolutions per minute.
#[derive(Debug, Clone)]
struct ModelAtSpeed {
    speed_rpm: f64,
    bundle: PathBuf,
}

impl FromStr for Orders {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (first, last) = text.split_once(':').unwrap_or((text, text));
        match (first.parse::<u32>(), last.parse::<u32>()) {
            (Ok(first), Ok(last)) if 0 < first && first <= last && last <= 10_000 => {
                Ok(Self(first, last))
            }
            _ => Err("accepted: engine orders from 1 to 10000 like 3, 3,6 or 1:12".to_owned()),
        }
    }
}

impl FromStr for Speeds {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let ends = text
            .split_once(':')
            .map(|(low, high)| (low.parse(), high.parse()));
        match ends {
            Some((Ok(low), Ok(high))) if 0.0 <= low && low < high && high <= 1e6 => {
                Ok(Self([low, high]))
            }
            _ => Err(
                "accepted: LOW:HIGH in revolutions per minute, 0 <= LOW < HIGH <= 1e6".to_owned(),
            ),
        }
    }
}

impl FromStr for TopHz {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let hz: Option<f64> = text.parse().ok();
        hz.filter(|hz| (1e-3..=1e9).contains(hz))
            .map(Self)
            .ok_or_else(|| "accepted: a frequency from 1e-3 to 1e9 Hz".to_owned())
    }
}

impl FromStr for ModelAtSpeed {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text
            .split_once('=')
            .map(|(speed, bundle)| (speed.parse(), bundle));
        match parts {
            Some((Ok(speed_rpm), bundle))
                if (0.0..=1e6).contains(&speed_rpm) && !bundle.is_empty() =>
            {
                Ok(Self {
                    speed_rpm,
                    bundle: bundle.into(),
                })
            }
            _ => Err("accepted: RPM=BUNDLE, a speed from 0 to 1e6 and a folder".to_owned()),
        }
    }
}

pub(super) fn command(arguments: &CampbellArguments) -> Result<ExitStatus, Failure> {
    let study = Study::read(&arguments.study)?;
    let mut places: Vec<&ModelAtSpeed> = arguments.at.iter().collect();
    places.sort_by(|a, b| a.speed_rpm.total_cmp(&b.speed_rpm));
    if let Some(pair) = places
        .windows(2)
        .find(|pair| pair[0].speed_rpm.total_cmp(&pair[1].speed_rpm).is_eq())
    {
        return Err(Failure::usage(format!(
            "--at {}={} is a second model at that speed; accepted: one per speed",
            pair[1].speed_rpm,
            pair[1].bundle.display()
        )));
    }
    let models = if places.is_empty() {
        vec![(None, load_sector_model(&study)?)]
    } else {
        places
            .into_iter()
            .map(|at| Ok((Some(at.speed_rpm), bundle::read(&at.bundle)?)))
            .collect::<Result<Vec<_>, PipelineError>>()?
    };
    let orders = arguments.engine_orders.iter();
    let engine_orders: Vec<u32> = orders
        .flat_map(|&Orders(first, last)| first..=last)
        .collect();
    let plots = [
        ("--plot", &arguments.plot, FigureName::Campbell),
        ("--plot-safe", &arguments.plot_safe, FigureName::Safe),
    ];
    let plots = plots.map(|(option, file, name)| Some((option, file.as_deref()?, name)));
    for (option, file, _) in plots.iter().flatten() {
        ends_in_svg(option, file)?;
    }
    let request = CampbellRequest {
        study: &study,
        models: &models,
        engine_orders: &engine_orders,
        modes: usize::from(arguments.modes),
        range_rpm: arguments.speed_rpm.map(|Speeds(range)| range),
    };
    let report = campbell(&request)?;
    for (_, file, name) in plots.into_iter().flatten() {
        let top_hz = arguments.top_hz.map(|TopHz(hz)| hz);
        let drawn = request.diagram(&report, name, top_hz)?;
        write_atomically(file, drawn.standalone().as_bytes())?;
        output::message(&format!("wrote {}: {}", file.display(), drawn.title));
    }
    output::result(arguments.json, &report)?;
    Ok(ExitStatus::Done)
}
