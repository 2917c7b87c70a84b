//! How sure a percentile is: width of its statistical interval and of its numerical bounds, by load.

use super::load_axis::LoadAxis;
use super::{Figure, FigureName};
use crate::report::plot::{Axis, Frame, LegendEntry, Mark, SIDES, Scale, Svg, TOP, legend};
use crate::report::words::{load_words, percent_words, share_words};
use crate::report::{GroupReport, PercentileError, ScenarioSummary, StudyReport, setting};

/// Lower end of the vertical axis.
const BOTTOM: f64 = 260.0;
/// Height of the drawing.
const HEIGHT: f64 = 312.0;
/// Half of the distance between both widths of a load.
const APART: f64 = 4.5;
/// Smallest width that is told from none.
const LEAST: f64 = 1e-6;

/// A width over the value.
type Width = fn(&PercentileError) -> Option<f64>;

/// Both widths for the highest percentile that has a value, over all loads.
pub(super) fn by_load(report: &StudyReport, group: &GroupReport) -> Option<Figure> {
    let choice = group
        .choices
        .iter()
        .find(|choice| choice.lowest.is_some())?;
    let of_scenario = |place: usize| -> Option<&PercentileError> {
        let percentiles = &group.errors[place].percentiles;
        percentiles
            .iter()
            .find(|error| error.percentile.percent.total_cmp(&choice.percent).is_eq())
    };
    let loads: Vec<&ScenarioSummary> = group
        .scenarios
        .iter()
        .map(|&scenario| &report.summary.scenarios[scenario])
        .collect();
    let widths: [(&str, Mark, f64, Width); 2] = [
        (
            "pick",
            Mark::Square,
            -APART,
            PercentileError::statistical_width,
        ),
        (
            "quiet",
            Mark::Circle,
            APART,
            PercentileError::numerical_width,
        ),
    ];
    let width =
        |width: Width, place: usize| width(of_scenario(place)?).filter(|width| *width > LEAST);
    let all: Vec<f64> = widths
        .iter()
        .flat_map(|(_, _, _, of)| (0..loads.len()).filter_map(|place| width(*of, place)))
        .map(|width| 100.0 * width)
        .collect();
    let high = all.iter().copied().fold(0.0, f64::max);
    let low = all.iter().copied().fold(high, f64::min);
    if all.is_empty() {
        return None;
    }
    let x = LoadAxis::new(&loads);
    let percent = percent_words(choice.percent);
    let y_title = format!("width, % of the P{percent} (log.)");
    let frame = Frame {
        x: Axis {
            scale: Scale::Linear,
            low: SIDES.0,
            high: SIDES.1,
            ends: SIDES,
        },
        y: Axis {
            scale: Scale::Logarithmic,
            low: 0.6 * low,
            high: 1.7 * high,
            ends: (BOTTOM, TOP),
        },
        x_title: x.title(),
        y_title: &y_title,
    };
    let mut svg = Svg::default();
    frame.draw(&mut svg);
    x.ticks(&mut svg, &frame, &loads);
    for (class, mark, aside, of) in widths {
        for (place, load) in loads.iter().enumerate() {
            if let Some(width) = width(of, place) {
                let name = load_words(load.contact, load.normal_load_n);
                let words = format!("{name}: {}", share_words(width));
                let at = (x.at(load) + aside, frame.y.at(100.0 * width));
                svg.line(&format!("stem {class}"), (at.0, BOTTOM), at);
                mark.draw(&mut svg, class, at, &words);
            }
        }
    }
    legend(
        &mut svg,
        &[
            LegendEntry::Line("pick", Some(Mark::Square), "statistical interval, 95 %"),
            LegendEntry::Line("quiet", Some(Mark::Circle), "numerical bounds"),
        ],
    );
    Some(Figure {
        name: FigureName::Uncertainty,
        title: format!(
            "Statistical and numerical uncertainty of the P{percent} of the peak amplitude"
        ),
        setting: setting(group),
        caption: format!(
            "Statistical: 95 % interval of the P{percent}, from the number of patterns. Numerical: what the P{percent} \
             could move between if every row were wrong by all that it states, all upwards or all downwards. Both as a \
             share of the P{percent}."
        ),
        height: HEIGHT,
        body: svg.into_body(),
    })
}
