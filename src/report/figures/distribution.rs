//! The distribution of a quantity at one load, on an axis that shows its tail.

use super::{Figure, FigureName};
use crate::population::statistics::{FitStatus, Quantity, TailLaw};
use crate::report::plot::{Axis, Frame, LegendEntry, Mark, SIDES, Scale, Svg, TOP, legend};
use crate::report::words::{LengthUnit, short_load_with_unit};
use crate::report::{DistributionReport, GroupReport, ScenarioSummary, StudyReport, setting};

/// Lower end of the vertical axis.
const BOTTOM: f64 = 330.0;
/// Height of the drawing.
const HEIGHT: f64 = 382.0;
/// Range of probabilities shown, wider where the sample is.
const RANGE: (f64, f64) = (0.01, 0.999);
/// Times the spread of the sample that a fitted law may widen the axis by.
const WIDENED: f64 = 0.25;

/// The figure of one quantity at the load that the report shows.
pub(super) fn of_load(
    report: &StudyReport,
    group: &GroupReport,
    name: FigureName,
) -> Option<Figure> {
    let quantity = match name {
        FigureName::AmplitudeDistribution => Quantity::PeakAmplitudeM,
        _ => Quantity::AmplificationFactor,
    };
    let found = group
        .distributions
        .iter()
        .find(|found| found.quantity == quantity)?;
    let scenario = &report.summary.scenarios[group.shown];
    let units = LengthUnit::of_summary(&report.summary);
    let (scale, x_title) = match quantity {
        Quantity::PeakAmplitudeM => (
            units.metres(),
            format!("peak blade amplitude, {}", units.name()),
        ),
        Quantity::AmplificationFactor => (1.0, "amplification factor".to_owned()),
    };
    let (first, last) = (found.points.first()?[0], found.points.last()?[0]);
    let spread = (last - first).max(1e-9 * last);
    let beyond = found
        .law
        .iter()
        .filter(|[_, p]| *p <= RANGE.1)
        .map(|[value, _]| *value)
        .fold(last, f64::max);
    let n = found.points.len() as f64;
    let frame = Frame {
        x: Axis {
            scale: Scale::Linear,
            low: (first - 0.05 * spread) / scale,
            high: (beyond.min(last + WIDENED * spread) + 0.05 * spread) / scale,
            ends: SIDES,
        },
        y: Axis {
            scale: Scale::Gumbel,
            low: RANGE.0.min(0.5 / n),
            high: RANGE.1.max(1.0 - 0.3 / n),
            ends: (BOTTOM, TOP),
        },
        x_title: &x_title,
        y_title: "wheels below, % (Gumbel scale)",
    };
    let mut svg = Svg::default();
    frame.draw(&mut svg);
    frame.x_ticks(&mut svg, 6);
    band(&mut svg, &frame, found, scale);
    let law: Vec<(f64, f64)> = found
        .law
        .iter()
        .filter(|[value, p]| {
            (frame.x.low..=frame.x.high).contains(&(value / scale))
                && (frame.y.low..=frame.y.high).contains(p)
        })
        .map(|&[value, p]| frame.at(value / scale, p))
        .collect();
    svg.polyline("curve tuned", &law);
    svg.polyline("curve median", &steps(&frame, found, scale));
    percentiles(&mut svg, &frame, found, scale);
    let mut entries = vec![
        LegendEntry::Line("median", None, "wheels"),
        LegendEntry::Area("band", "95 % band"),
        LegendEntry::Line("pick", Some(Mark::Square), "percentiles, 95 % bounds"),
    ];
    if !law.is_empty() {
        entries.push(LegendEntry::Line("tuned", None, "extreme value fit"));
    }
    legend(&mut svg, &entries);
    Some(Figure {
        name,
        title: title(quantity, scenario),
        setting: setting(group),
        caption: caption(found),
        height: HEIGHT,
        body: svg.into_body(),
    })
}

/// The band as a stair: between two values it is that of the lower one.
fn band(svg: &mut Svg, frame: &Frame<'_>, found: &DistributionReport, scale: f64) {
    let edge = |which: usize| -> Vec<(f64, f64)> {
        let mut edge = vec![];
        let mut before = if which == 3 {
            found.half_width.unwrap_or(1.0)
        } else {
            0.0
        };
        edge.push(frame.at(frame.x.low, before));
        for point in &found.points {
            edge.push(frame.at(point[0] / scale, before));
            before = point[which];
            edge.push(frame.at(point[0] / scale, before));
        }
        edge.push(frame.at(frame.x.high, before));
        edge
    };
    let mut outline = edge(3);
    outline.extend(edge(2).into_iter().rev());
    svg.polygon("band", &outline);
}

/// The distribution function of the sample as a stair.
fn steps(frame: &Frame<'_>, found: &DistributionReport, scale: f64) -> Vec<(f64, f64)> {
    let mut before = 0.0;
    let mut stair = Vec::with_capacity(2 * found.points.len());
    for &[value, cumulative, _, _] in &found.points {
        stair.push(frame.at(value / scale, before));
        stair.push(frame.at(value / scale, cumulative));
        before = cumulative;
    }
    stair
}

fn percentiles(svg: &mut Svg, frame: &Frame<'_>, found: &DistributionReport, scale: f64) {
    for percentile in &found.percentiles {
        let Some(value) = percentile.value else {
            continue;
        };
        let (x, y) = frame.at(value / scale, percentile.percent / 100.0);
        if let Some((low, high)) = percentile.lower.zip(percentile.upper) {
            let (low, high) = (frame.x.at(low / scale), frame.x.at(high / scale));
            svg.line("bound pick", (low, y), (high, y));
            for end in [low, high] {
                svg.line("bound pick", (end, y - 4.0), (end, y + 4.0));
            }
        }
        let words = format!("P{}: {:.4}", percentile.percent, value / scale);
        Mark::Square.draw(svg, "pick", (x, y), &words);
    }
}

fn title(quantity: Quantity, scenario: &ScenarioSummary) -> String {
    let what = match quantity {
        Quantity::PeakAmplitudeM => "peak amplitude",
        Quantity::AmplificationFactor => "amplification factor",
    };
    format!(
        "Distribution of the {what} at load {}",
        short_load_with_unit(scenario.contact, scenario.normal_load_n)
    )
}

fn caption(found: &DistributionReport) -> String {
    let general = found
        .fits
        .iter()
        .find(|fit| fit.law == TailLaw::GeneralisedExtremeValue);
    let fit = match general {
        Some(fit) if fit.status == FitStatus::Converged => {
            let p = fit
                .p_value
                .map_or_else(String::new, |p| format!(", p = {p:.3}"));
            let verdict = if fit.rejected {
                "which the sample rejects"
            } else {
                "which the sample does not reject"
            };
            format!(
                "Dashed: generalised extreme value law fitted to the sample, {verdict}{p}; a second opinion, no replacement."
            )
        }
        Some(fit) => format!(
            "No extreme value law could be fitted ({}).",
            fit.status.name()
        ),
        None => String::new(),
    };
    format!(
        "Band of Dvoretzky, Kiefer and Wolfowitz for the whole distribution at once; in the tail the bounds of the \
         percentiles are the sharper ones. {fit}"
    )
}
