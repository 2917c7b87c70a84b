//! What accuracy costs: the error of each measured setting against its operations.

use super::{Figure, FigureName};
use crate::population::table::MeasuredSetting;
use crate::report::StudyReport;
use crate::report::plot::{Axis, Frame, LegendEntry, Mark, SIDES, Scale, Svg, TOP, legend};
use crate::report::words::share_words;

/// Lower end of the vertical axis.
const BOTTOM: f64 = 260.0;
/// Height of the drawing.
const HEIGHT: f64 = 312.0;

/// All settings, those on the front joined; none without a measured ladder.
pub(super) fn by_cost(report: &StudyReport) -> Option<Figure> {
    let ladder = report.accuracy_ladder.as_ref()?;
    let placed: Vec<(f64, f64, &MeasuredSetting)> = ladder
        .settings
        .iter()
        .filter_map(|setting| {
            let error = setting
                .amplitude_error_p95_upper
                .filter(|bound| bound.is_finite())
                .or(setting.amplitude_error_p95)?;
            let operations = setting.operations?;
            let drawn = error > 0.0 && error.is_finite() && operations > 0.0;
            drawn.then_some((operations, 100.0 * error, setting))
        })
        .collect();
    let axis = |value: fn(&(f64, f64, &MeasuredSetting)) -> f64, ends| {
        let values = || placed.iter().map(value);
        Axis {
            scale: Scale::Logarithmic,
            low: 0.7 * values().fold(f64::INFINITY, f64::min),
            high: 1.4 * values().fold(0.0, f64::max),
            ends,
        }
    };
    if placed.is_empty() {
        return None;
    }
    let frame = Frame {
        x: axis(|place| place.0, SIDES),
        y: axis(|place| place.1, (BOTTOM, TOP)),
        x_title: "operations per row (log.)",
        y_title: "error of the amplitude, % (log.)",
    };
    let mut svg = Svg::default();
    frame.draw(&mut svg);
    frame.x_ticks(&mut svg, 5);
    let mut front: Vec<(f64, f64)> = placed
        .iter()
        .filter(|place| place.2.on_front)
        .map(|&(operations, error, _)| frame.at(operations, error))
        .collect();
    front.sort_by(|a, b| a.0.total_cmp(&b.0));
    svg.polyline("curve high", &front);
    for &(operations, error, setting) in &placed {
        let (mark, class) = match (setting.on_front, setting.role.as_str()) {
            (true, _) => (Mark::Square, "high"),
            (false, "base") => (Mark::Diamond, "extreme"),
            _ => (Mark::Circle, "median"),
        };
        let words = format!(
            "{}, harmonics {}, {} samples: error {}, {operations:.2e} operations",
            setting.basis,
            setting.harmonics,
            setting.samples_per_period,
            share_words(error / 100.0)
        );
        mark.draw(&mut svg, class, frame.at(operations, error), &words);
    }
    legend(
        &mut svg,
        &[
            LegendEntry::Line("high", Some(Mark::Square), "nothing cheaper is as accurate"),
            LegendEntry::Line("median", Some(Mark::Circle), "other settings"),
        ],
    );
    let other = if ladder.study_digest == report.summary.study_digest {
        ""
    } else {
        " Measured on another state of this study."
    };
    Some(Figure {
        name: FigureName::Accuracy,
        title: "What accuracy costs".to_owned(),
        setting: format!("{} settings", placed.len()),
        caption: format!(
            "Settings measured on a sample of rows: upper bound of the error that 95 % of the amplitudes \
             keep (that of the sample where it is too small for a bound), against floating-point operations of a row.{other}"
        ),
        height: HEIGHT,
        body: svg.into_body(),
    })
}
