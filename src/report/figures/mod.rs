//! The figures of a report, each drawn from its numbers.

mod bodies;
mod campbell;
mod distribution;
mod drawn_load;
mod figure;
mod ladder;
mod load;
mod load_axis;
mod response;
mod sector;
mod uncertainty;
mod wheel;

pub(super) use bodies::{body_word, friction_words};
pub use campbell::{DiagramRange, diagram_of_model};
pub use figure::{FIGURES, Figure, FigureName};

use super::{GroupReport, ShownModel, StudyReport, Wheels};

/// The figure `name` of a group; none where the report has no numbers for it.
#[must_use]
pub fn figure(report: &StudyReport, group: &GroupReport, name: FigureName) -> Option<Figure> {
    let wheels = match &group.wheels {
        Wheels::Solved(wheels) => Some(&**wheels),
        Wheels::NotSolved { .. } => None,
    };
    match name {
        FigureName::Amplitude | FigureName::AmplificationFactor => {
            load::by_load(report, group, name)
        }
        FigureName::Uncertainty => uncertainty::by_load(report, group),
        FigureName::Accuracy => ladder::by_cost(report),
        FigureName::AmplitudeDistribution | FigureName::AmplificationFactorDistribution => {
            distribution::of_load(report, group, name)
        }
        FigureName::MedianResponse | FigureName::WorstResponse => {
            response::of_wheel(report, group, wheels?, name)
        }
        FigureName::WorstBlades => wheel::blades(report, group, wheels?),
        FigureName::Contact => wheel::contact(group, wheels?),
        FigureName::Sector => sector::of_model(report),
        FigureName::Campbell => campbell::over_speed(report),
        FigureName::Safe => campbell::over_nodal_diameter(report),
    }
}

/// Why a report has nothing to draw in the figure `name`, where that is known.
#[must_use]
pub fn missing<'a>(
    report: &'a StudyReport,
    group: &'a GroupReport,
    name: FigureName,
) -> Option<&'a str> {
    match (&group.wheels, &report.model) {
        (Wheels::NotSolved { reason }, _) if name.is_of_wheels() => Some(reason),
        (_, ShownModel::NotShown { reason }) if name.is_of_model() => Some(reason),
        _ if name == FigureName::Accuracy => Some(
            "the folder has no tradeoff.parquet, which `blisk tradeoff` writes, and the study has no [accuracy]",
        ),
        _ => None,
    }
}
