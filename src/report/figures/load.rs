//! A quantity against the damper normal load: percentiles with bounds, tuned wheel, linear limits.

use std::fmt::Write;

use super::drawn_load::{DRAWN, Load, scaled};
use super::load_axis::LoadAxis;
use super::{Figure, FigureName};
use crate::report::plot::{
    Axis, Frame, LegendEntry, Mark, SIDES, Scale, Svg, TOP, legend, nice_top,
};
use crate::report::study_report::within;
use crate::report::words::{LengthUnit, load_words, percent_words};
use crate::report::{GroupReport, LoadChoice, ScenarioSummary, StudyReport, setting};

/// Lower end of the vertical axis.
const BOTTOM: f64 = 330.0;
/// Height of the drawing.
const HEIGHT: f64 = 382.0;
/// Height of the strip above the plot whose pointers name the lowest load.
const STRIP: f64 = 15.0;
/// Ratio of the largest to the smallest value from which on an axis is logarithmic.
const LOGARITHMIC_FROM: f64 = 4.0;
/// Share of the largest value below which the smallest one makes an axis begin at zero.
const FROM_ZERO: f64 = 0.4;
/// An axis from `bottom` to `top` that shows `values`, all positive.
fn value_axis(values: &[f64], bottom: f64, top: f64) -> Axis {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(0.0, f64::max);
    let ends = (bottom, top);
    if low > 0.0 && high > LOGARITHMIC_FROM * low {
        return Axis {
            scale: Scale::Logarithmic,
            low: 0.8 * low,
            high: 1.25 * high,
            ends,
        };
    }
    if low < FROM_ZERO * high || high <= low {
        return Axis {
            scale: Scale::Linear,
            low: 0.0,
            high: nice_top(high, 5),
            ends,
        };
    }
    let margin = 0.08 * (high - low);
    Axis {
        scale: Scale::Linear,
        low: low - margin,
        high: high + margin,
        ends,
    }
}

/// The figure of the peak amplitude or of the amplification factor.
pub(super) fn by_load(
    report: &StudyReport,
    group: &GroupReport,
    name: FigureName,
) -> Option<Figure> {
    let loads: Vec<&ScenarioSummary> = group
        .scenarios
        .iter()
        .map(|&scenario| &report.summary.scenarios[scenario])
        .collect();
    let units = LengthUnit::of_summary(&report.summary);
    // Without a choice by the amplitude there is nothing to point at; a pointer at that of the median alone would be
    // read as the load to design for.
    let choice = { group.choices.iter() }.find(|choice| choice.lowest.is_some());
    let amplitude = name == FigureName::Amplitude;
    let pointed = choice.filter(|choice| amplitude && choice.is_of_a_design());
    let lowest = lowest_of(group, pointed).filter(|_| amplitude);
    let drawn = if amplitude {
        amplitudes(group, &loads, pointed, units.metres())
    } else {
        { loads.iter() }
            .map(|load| Load {
                percentiles: load.amplification_factor.percentiles.clone(),
                ..Load::new(load)
            })
            .collect()
    };
    let values: Vec<f64> = drawn.iter().flat_map(Load::values).collect();
    if values.is_empty() {
        return None;
    }
    let x = LoadAxis::new(&loads);
    let y_title = if amplitude {
        format!("peak blade amplitude, {}", units.name())
    } else {
        "amplification factor".to_owned()
    };
    let strip = if lowest.is_some() { STRIP } else { 0.0 };
    let y = value_axis(&values, BOTTOM + strip, TOP + strip);
    let y_title = match y.scale {
        Scale::Logarithmic => format!("{y_title} (log.)"),
        _ => y_title,
    };
    let frame = Frame {
        x: Axis {
            scale: Scale::Linear,
            low: SIDES.0,
            high: SIDES.1,
            ends: SIDES,
        },
        y,
        x_title: x.title(),
        y_title: &y_title,
    };
    let mut svg = Svg::default();
    frame.draw(&mut svg);
    x.ticks(&mut svg, &frame, &loads);
    let could = could_be_lowest(group, pointed);
    if let Some((scenario, words)) = &lowest {
        point_at(&mut svg, &frame, &x, &loads, (*scenario, words), &could);
    }
    curves(&mut svg, &frame, &x, &drawn);
    let beside = pointed.map_or(0.0, |choice| aside(&x, &drawn, choice.percent as u32));
    for load in &drawn {
        if let Some(bounds) = load.with_error {
            let at = { load.worst_wheel() }.map_or_else(
                || x.at(load.scenario) + beside,
                |place| x.at_wheel(load.scenario, place, load.wheels.len()),
            );
            frame.bound(&mut svg, "doubt", at, bounds);
        }
    }
    points(&mut svg, &frame, &x, &drawn);
    let mut entries = entries(&drawn);
    if let Some((_, words)) = &lowest {
        entries.push(LegendEntry::Point("lowest", Mark::Pointer, words));
    }
    if lowest.is_some() && !could.is_empty() {
        entries.push(LegendEntry::Point("could", Mark::Pointer, "may be as low"));
    }
    legend(&mut svg, &entries);
    let what = if amplitude {
        "Peak amplitude"
    } else {
        "Amplification factor"
    };
    Some(Figure {
        name,
        title: format!("{what} against damper normal load"),
        setting: setting(group),
        caption: caption(
            pointed.map(|choice| (choice, !could.is_empty())),
            report.summary.patterns,
            &drawn,
            amplitude.then_some(units),
        ),
        height: HEIGHT + strip,
        body: svg.into_body(),
    })
}

/// The loads with their peak amplitudes in units of `scale`, m.
fn amplitudes<'a>(
    group: &GroupReport,
    loads: &[&'a ScenarioSummary],
    pointed: Option<&LoadChoice>,
    scale: f64,
) -> Vec<Load<'a>> {
    let open = with_numerical_error(group, pointed);
    let of_load = |load: &&'a ScenarioSummary| Load {
        scenario: load,
        tuned: load.tuned_amplitude_m.map(|tuned| tuned / scale),
        percentiles: { load.peak_amplitude_m.percentiles.iter() }
            .map(|found| scaled(found, scale))
            .collect(),
        wheels: { group.measured.iter() }
            .filter(|wheel| wheel.scenario == load.scenario)
            .filter_map(|wheel| Some((wheel.pattern, wheel.peak_amplitude_m? / scale)))
            .collect(),
        with_error: { open.iter() }
            .find(|(scenario, _)| *scenario == load.scenario)
            .map(|(_, (low, high))| (low / scale, high / scale)),
    };
    loads.iter().map(of_load).collect()
}

/// How far the mark of a percentile stands from the place of its load: those that are drawn are centred on it, the
/// highest last.
fn aside(x: &LoadAxis, drawn: &[Load<'_>], percent: u32) -> f64 {
    let shown = DRAWN.iter().rev().map(|&(percent, ..)| percent);
    let shown: Vec<u32> = shown
        .filter(|&percent| drawn.iter().any(|load| load.value(percent).is_some()))
        .collect();
    let place = shown.iter().take_while(|&&own| own < percent).count();
    x.aside * (place as f64 - 0.5 * (shown.len().max(1) - 1) as f64)
}

/// The scenario that is pointed at, and why: by the percentile of a choice, or by the worst of a few measured wheels.
fn lowest_of(group: &GroupReport, choice: Option<&LoadChoice>) -> Option<(usize, String)> {
    let of_choice = choice.and_then(|own| {
        let words = format!("lowest P{}", percent_words(own.percent));
        Some((own.lowest?, words))
    });
    let of_wheels = || {
        let (wheel, _) = group.smallest_worst_peak()?;
        Some((wheel.scenario, "smallest worst peak".to_owned()))
    };
    of_choice.or_else(of_wheels)
}

/// The other scenarios that could be the lowest: by the comparison of a choice, or by the errors of a few measured wheels.
fn could_be_lowest(group: &GroupReport, choice: Option<&LoadChoice>) -> Vec<usize> {
    let of_wheels = || {
        group
            .loads_left_open()
            .into_iter()
            .map(|own| own.0)
            .collect()
    };
    choice.map_or_else(of_wheels, |choice| could_be_as_low(group, choice))
}

/// Scenarios that have not the lowest percentile of the sample and could be as low, by statistics or by numerical error.
fn could_be_as_low(group: &GroupReport, choice: &LoadChoice) -> Vec<usize> {
    let compared = choice.best.iter().flat_map(|best| &best.loads);
    let could = compared.filter(|own| own.could_be_best);
    let could = could.map(|own| own.scenario.scenario);
    let could = could.filter(|own| choice.lowest != Some(*own));
    let hidden = { choice.lowest }.map(|lowest| group.hidden_by_error(choice, lowest));
    could.chain(hidden.into_iter().flatten()).collect()
}

/// Where numerical error leaves it open which load is the lowest: these loads, and between which values what they are chosen by
/// lies with it, m.
fn with_numerical_error(
    group: &GroupReport,
    choice: Option<&LoadChoice>,
) -> Vec<(usize, (f64, f64))> {
    let Some((choice, lowest)) = choice.and_then(|choice| Some((choice, choice.lowest?))) else {
        let open = group.loads_left_open();
        let lowest = group.smallest_worst_peak().filter(|_| !open.is_empty());
        let lowest = lowest.map(|(wheel, peak)| (wheel.scenario, peak));
        return lowest
            .into_iter()
            .chain(open)
            .filter_map(|(scenario, peak)| {
                let (low, high) = within(peak, group.largest_stated_error(scenario)?);
                Some((scenario, (low, high?)))
            })
            .collect();
    };
    let hidden = group.hidden_by_error(choice, lowest);
    let lowest = Some(lowest).filter(|_| !hidden.is_empty());
    { lowest.into_iter().chain(hidden) }
        .filter_map(|scenario| {
            let error = group.error_of(scenario, choice.percent)?.1;
            Some((scenario, error.interval_with_error()?))
        })
        .collect()
}

/// Pointers above the plot at the load that is the lowest in this sample, and at those that could be: they have no
/// width, which would look like an interval of the load.
fn point_at(
    svg: &mut Svg,
    frame: &Frame<'_>,
    x: &LoadAxis,
    loads: &[&ScenarioSummary],
    (lowest, words): (usize, &str),
    could: &[usize],
) {
    let (bottom, top) = frame.y.ends;
    for load in loads {
        let at = x.at(load);
        let name = load_words(load.contact, load.normal_load_n);
        if lowest == load.scenario {
            svg.line("aim", (at, top), (at, bottom));
            let words = format!("{words}: {name}");
            Mark::Pointer.draw(svg, "lowest", (at, top - 7.0), &words);
        } else if could.contains(&load.scenario) {
            let words = format!("may be as low: {name}");
            Mark::Pointer.draw(svg, "could", (at, top - 7.0), &words);
        }
    }
}

/// Band and lines through the loads in newtons.
fn curves(svg: &mut Svg, frame: &Frame<'_>, x: &LoadAxis, drawn: &[Load<'_>]) {
    let mut newtons: Vec<&Load<'_>> = drawn
        .iter()
        .filter(|load| load.scenario.normal_load_n.is_some())
        .collect();
    newtons.sort_by(|a, b| x.at(a.scenario).total_cmp(&x.at(b.scenario)));
    let line = |value: &dyn Fn(&Load<'_>) -> Option<f64>| -> Vec<(f64, f64)> {
        newtons
            .iter()
            .filter_map(|load| Some((x.at(load.scenario), frame.y.at(value(load)?))))
            .collect()
    };
    let mut band = line(&|load| load.value(95));
    let lower = line(&|load| load.value(5));
    if band.len() == lower.len() {
        band.extend(lower.into_iter().rev());
        svg.polygon("band", &band);
    }
    for limit in drawn
        .iter()
        .filter(|load| load.scenario.normal_load_n.is_none())
    {
        let at = x.at(limit.scenario);
        if let (Some(low), Some(high)) = (limit.value(5), limit.value(95)) {
            let (low, high) = (frame.y.at(low), frame.y.at(high));
            svg.rectangle("band", (at - 16.0, low), (at + 16.0, high), "");
        }
        if let Some(tuned) = limit.tuned {
            let y = frame.y.at(tuned);
            svg.line("curve limit", (SIDES.0, y), (SIDES.1, y));
        }
    }
    svg.polyline("curve tuned", &line(&|load| load.tuned));
    // Through the places of the loads, not of the marks beside them: lines set aside would cross on a slope.
    for (percent, class, _) in DRAWN.iter().rev() {
        svg.polyline(
            &format!("curve {class}"),
            &line(&|load| load.value(*percent)),
        );
    }
}

/// Marks with their bounds.
fn points(svg: &mut Svg, frame: &Frame<'_>, x: &LoadAxis, drawn: &[Load<'_>]) {
    for load in drawn {
        let at = x.at(load.scenario);
        let name = load_words(load.scenario.contact, load.scenario.normal_load_n);
        if let Some(tuned) = load.tuned {
            let words = format!("tuned, {name}: {tuned:.4}");
            Mark::Triangle.draw(svg, "tuned", (at, frame.y.at(tuned)), &words);
        }
        for (place, (wheel, peak)) in load.wheels.iter().enumerate() {
            let at = x.at_wheel(load.scenario, place, load.wheels.len());
            let words = format!("wheel {wheel}, {name}: {peak:.4}");
            Mark::Circle.draw(svg, "quiet", (at, frame.y.at(*peak)), &words);
        }
        let mut bars = Vec::new();
        for (percent, class, mark) in DRAWN.iter().rev() {
            let Some(found) = load.percentile(*percent) else {
                continue;
            };
            let Some(value) = found.value else { continue };
            let at = at + aside(x, drawn, *percent);
            let bounds = found.lower.zip(found.upper);
            let shown =
                bounds.map_or_else(String::new, |(low, high)| format!(" [{low:.4}, {high:.4}]"));
            let words = format!("P{percent}, {name}: {value:.4}{shown}");
            mark.draw(svg, class, (at, frame.y.at(value)), &words);
            bars.extend(bounds.map(|bounds| (class, at, bounds)));
        }
        // Above all marks of the load, which would hide a bound narrower than them or that of a mark beside.
        for (class, at, bounds) in bars {
            frame.bound(svg, class, at, bounds);
        }
    }
}

fn entries(drawn: &[Load<'_>]) -> Vec<LegendEntry<'static>> {
    let mut entries: Vec<LegendEntry<'static>> = DRAWN
        .iter()
        .zip(["P99", "P95", "P50"])
        .filter(|((percent, ..), _)| drawn.iter().any(|load| load.value(*percent).is_some()))
        .map(|((_, class, mark), name)| LegendEntry::Line(class, Some(*mark), name))
        .collect();
    let any =
        |value: &dyn Fn(&Load<'_>) -> Option<f64>| drawn.iter().any(|load| value(load).is_some());
    if any(&|load| load.value(5)) {
        entries.push(LegendEntry::Area("band", "P5 to P95"));
    }
    if any(&|load| load.tuned) {
        entries.push(LegendEntry::Line("tuned", Some(Mark::Triangle), "tuned"));
    }
    if drawn.iter().any(|load| !load.wheels.is_empty()) {
        let words = "wheel of the file (computed)";
        entries.push(LegendEntry::Point("quiet", Mark::Circle, words));
    }
    if any(&|load| {
        let limit = load.scenario.normal_load_n.is_none();
        load.tuned.filter(|_| limit)
    }) {
        entries.push(LegendEntry::Line("limit", None, "tuned, linear"));
    }
    if drawn.iter().any(|load| load.with_error.is_some()) {
        entries.push(LegendEntry::Line("doubt", None, "with numerical error"));
    }
    entries
}

/// Which dotted line is that of which limit: the value of each.
fn tuned_limits(loads: &[&ScenarioSummary], units: LengthUnit) -> String {
    let limits = loads.iter().filter(|load| load.normal_load_n.is_none());
    let named: Vec<String> = limits
        .filter_map(|load| {
            let tuned = units.number(load.tuned_amplitude_m?);
            Some(format!("{} {tuned}", load.contact))
        })
        .collect();
    if named.is_empty() {
        String::new()
    } else {
        format!(" ({} {})", named.join(", "), units.name())
    }
}

/// What the figure shows; with a choice, whether other loads may be as low.
fn caption(
    choice: Option<(&LoadChoice, bool)>,
    patterns: u64,
    drawn: &[Load<'_>],
    amplitudes: Option<LengthUnit>,
) -> String {
    let loads: Vec<&ScenarioSummary> = drawn.iter().map(|load| load.scenario).collect();
    let loads = &loads[..];
    let shows = |(percent, ..): &(u32, &str, Mark)| {
        let mut loads = drawn.iter();
        loads.any(|load| load.value(*percent).is_some())
    };
    let measured = drawn.iter().any(|load| !load.wheels.is_empty());
    let error = if drawn.iter().any(|load| load.with_error.is_some()) {
        "dashed bars: with numerical error, which leaves the load open"
    } else {
        "numerical error is not drawn"
    };
    let mut words = if DRAWN.iter().any(shows) {
        format!(
            "Percentiles over {patterns} patterns with distribution-free 95 % bounds, side by side at each load; {error}."
        )
    } else if measured {
        format!(
            "Each wheel of mistuning.file, side by side at each load; too few for a percentile. Pointer above: the smallest worst peak as \
             computed; {error}."
        )
    } else {
        "No percentile has a value; the tuned wheel is drawn alone.".to_owned()
    };
    let in_newtons = loads.iter().filter(|load| load.normal_load_n.is_some());
    if in_newtons.count() > 1 {
        words
            .push_str(" Only loads with marks were studied; the lines between them guide the eye.");
    }
    let mut limits: Vec<&str> = Vec::new();
    for (name, meaning) in [
        ("slide", "slide (friction gone)"),
        ("stuck", "stuck (contact welded)"),
        ("free", "free (no contact springs)"),
    ] {
        if loads.iter().any(|load| load.contact == name) {
            limits.push(meaning);
        }
    }
    // Writing to a String cannot fail.
    if !limits.is_empty() {
        // Linear limits alone need no break.
        let newtons = loads.iter().any(|load| load.normal_load_n.is_some());
        let one = limits.len() == 1;
        let head = match (newtons, one) {
            (true, true) => "Beside the break, a linear solution",
            (true, false) => "Beside the breaks, linear solutions",
            (false, true) => "A linear solution",
            (false, false) => "Linear solutions",
        };
        let _ = write!(words, " {head}: {}", limits.join(", "));
        if let Some(units) = amplitudes {
            let whose = if one {
                "its tuned peak"
            } else {
                "their tuned peaks"
            };
            let _ = write!(words, "; dotted: {whose}{}", tuned_limits(loads, units));
        }
        words.push('.');
    }
    if amplitudes.is_none() {
        words.push_str(
            " The factor refers to the tuned wheel of the same load, so that a lower factor over a higher tuned peak \
             is no improvement.",
        );
        return words;
    }
    if let Some((choice, others)) = choice {
        let percent = percent_words(choice.percent);
        let _ = write!(words, " Pointer above: the load with the lowest P{percent}");
        words.push_str(if others {
            " as computed; hollow: those that may be as low, by statistics (95 % confidence) or numerical error."
        } else {
            "."
        });
    }
    words
}
