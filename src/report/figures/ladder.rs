//! What accuracy costs: the error of each measured setting against its operations.

use super::{Figure, FigureName};
use crate::population::table::{AccuracyLadder, MeasuredSetting};
use crate::report::plot::{Anchor, Axis, Frame, LegendEntry, Mark, SIDES, Scale, Svg, TOP, legend};
use crate::report::words::share_words;
use crate::report::{AccuracyTrials, StudyReport};

/// Lower end of the vertical axis.
const BOTTOM: f64 = 260.0;
/// Height of the drawing.
const HEIGHT: f64 = 312.0;

/// The measured ladder; without one, what `[accuracy]` tried; none without both.
pub(super) fn by_cost(report: &StudyReport) -> Option<Figure> {
    match (&report.accuracy_ladder, &report.accuracy_trials) {
        (Some(ladder), _) => of_ladder(report, ladder),
        (None, Some(trials)) => of_trials(trials),
        (None, None) => None,
    }
}

/// All settings, those on the front joined and numbered.
fn of_ladder(report: &StudyReport, ladder: &AccuracyLadder) -> Option<Figure> {
    let placed: Vec<(f64, f64, &MeasuredSetting)> = ladder
        .settings
        .iter()
        .filter_map(|setting| {
            let error = setting.drawn_error()?;
            let operations = setting.operations?;
            let drawn = error > 0.0 && error.is_finite() && operations > 0.0;
            drawn.then_some((operations, error, setting))
        })
        .collect();
    let points: Vec<(f64, f64)> = placed.iter().map(|place| (place.0, place.1)).collect();
    let frame = frame(&points, None, "error of the amplitude, % (log.)")?;
    let mut svg = Svg::default();
    frame.draw(&mut svg);
    frame.x_ticks(&mut svg, 5);
    let at = |operations: f64, error: f64| frame.at(operations / 1e9, 100.0 * error);
    let mut front: Vec<(f64, f64)> = placed
        .iter()
        .filter(|place| place.2.on_front)
        .map(|&(operations, error, _)| at(operations, error))
        .collect();
    front.sort_by(|a, b| a.0.total_cmp(&b.0));
    svg.polyline("curve pick", &front);
    // Those that matter most are drawn last, over the others.
    let rank = |setting: &MeasuredSetting| (setting.on_front, setting.role == "base");
    let mut drawn: Vec<_> = placed.iter().collect();
    drawn.sort_by_key(|place| rank(place.2));
    let mut numbers: Vec<((f64, f64), String)> = Vec::new();
    for &&(operations, error, setting) in &drawn {
        let (mark, class) = match rank(setting) {
            (true, _) => (Mark::Square, "pick"),
            (false, true) => (Mark::Diamond, "extreme"),
            (false, false) => (Mark::Circle, "median"),
        };
        let (x, y) = at(operations, error);
        let words = format!(
            "{}: {}, harmonics {}, {} samples: error {}, {:.2} Gflop",
            setting.setting,
            setting.basis,
            setting.harmonics,
            setting.samples_per_period,
            share_words(error),
            operations / 1e9
        );
        mark.draw(&mut svg, class, (x, y), &words);
        if setting.on_front {
            number(&mut numbers, (x, y), &setting.setting.to_string());
        }
    }
    draw_numbers(&mut svg, &numbers);
    let mut entries = vec![
        LegendEntry::Line("pick", Some(Mark::Square), "nothing cheaper is as accurate"),
        LegendEntry::Line("median", Some(Mark::Circle), "other settings"),
    ];
    if placed
        .iter()
        .any(|place| !place.2.on_front && place.2.role == "base")
    {
        entries.push(LegendEntry::Line("extreme", Some(Mark::Diamond), "base"));
    }
    legend(&mut svg, &entries);
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
             keep (that of the sample where it is too small for a bound), against floating-point operations of a row. \
             The table of settings has the numbers beside the squares.{other}"
        ),
        height: HEIGHT,
        body: svg.into_body(),
    })
}

/// The settings tried before one was taken, with the error accepted.
fn of_trials(trials: &AccuracyTrials) -> Option<Figure> {
    let placed: Vec<_> = trials
        .tried
        .iter()
        .enumerate()
        .filter_map(|(place, own)| {
            let worst = own.worst.filter(|worst| *worst > 0.0)?;
            Some((place, worst, own))
        })
        .collect();
    let points: Vec<(f64, f64)> = placed.iter().map(|own| (own.2.operations, own.1)).collect();
    let frame = frame(
        &points,
        Some(trials.accepted),
        "largest error of the sample, % (log.)",
    )?;
    let mut svg = Svg::default();
    frame.draw(&mut svg);
    frame.x_ticks(&mut svg, 5);
    let accepted = frame.y.at(100.0 * trials.accepted);
    svg.line("curve tuned", (SIDES.0, accepted), (SIDES.1, accepted));
    let mut numbers = Vec::new();
    for (place, worst, own) in placed {
        let (mark, class) = if own.taken {
            (Mark::Square, "pick")
        } else {
            (Mark::Circle, "median")
        };
        let (x, y) = frame.at(own.operations / 1e9, 100.0 * worst);
        let words = format!(
            "{place}: {}: largest error of {} rows {}, {:.2} Gflop",
            own.setting,
            own.rows,
            share_words(worst),
            own.operations / 1e9
        );
        mark.draw(&mut svg, class, (x, y), &words);
        number(&mut numbers, (x, y), &place.to_string());
    }
    draw_numbers(&mut svg, &numbers);
    legend(
        &mut svg,
        &[
            LegendEntry::Line("pick", Some(Mark::Square), "taken"),
            LegendEntry::Line("median", Some(Mark::Circle), "tried"),
            LegendEntry::Line("tuned", None, "accepted error"),
        ],
    );
    let bound = trials.p95_upper.map_or(String::new(), |bound| {
        format!(
            " At the setting taken 95 % of the amplitudes are within {} with 95 % confidence{}.",
            share_words(bound),
            trials.worst_upper.map_or(String::new(), |worst| format!(
                "; the worst is claimed to be within {}",
                share_words(worst)
            ))
        )
    });
    Some(Figure {
        name: FigureName::Accuracy,
        title: "What was tried for the accepted error".to_owned(),
        setting: format!(
            "{} settings, accepted {}",
            trials.tried.len(),
            share_words(trials.accepted)
        ),
        caption: format!(
            "Settings tried on a sample of {} rows, cheap ones first: largest error against a finer solution, against \
             floating-point operations of a row. One with a row beyond the accepted error was given up there.{bound} \
             The table of settings has the numbers beside the marks.",
            trials.rows
        ),
        height: HEIGHT,
        body: svg.into_body(),
    })
}

/// Adds the number of the setting at a place, to those of a place that is almost the same.
fn number(numbers: &mut Vec<((f64, f64), String)>, at: (f64, f64), setting: &str) {
    const APART: f64 = 12.0;
    let near = |place: &(f64, f64)| (place.0 - at.0).hypot(place.1 - at.1) < APART;
    match numbers.iter_mut().find(|(place, _)| near(place)) {
        Some((_, words)) => *words = format!("{words}, {setting}"),
        None => numbers.push((at, setting.to_owned())),
    }
}

fn draw_numbers(svg: &mut Svg, numbers: &[((f64, f64), String)]) {
    for ((x, y), words) in numbers {
        svg.text("small", (x - 7.0, y + 14.0), Anchor::End, words);
    }
}

/// Axes round points of operations and relative error, and round `accepted`; none without points.
fn frame(
    points: &[(f64, f64)],
    accepted: Option<f64>,
    y_title: &'static str,
) -> Option<Frame<'static>> {
    if points.is_empty() {
        return None;
    }
    let axis = |values: &[f64], ends| Axis {
        scale: Scale::Logarithmic,
        low: 0.6 * values.iter().copied().fold(f64::INFINITY, f64::min),
        high: 1.4 * values.iter().copied().fold(0.0, f64::max),
        ends,
    };
    let operations: Vec<f64> = points.iter().map(|point| point.0 / 1e9).collect();
    let errors = points.iter().map(|point| point.1).chain(accepted);
    let errors: Vec<f64> = errors.map(|error| 100.0 * error).collect();
    Some(Frame {
        x: axis(&operations, SIDES),
        y: axis(&errors, (BOTTOM, TOP)),
        x_title: "operations per row, Gflop (log.)",
        y_title,
    })
}
