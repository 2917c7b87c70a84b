//! The worst wheel at its peak: amplitudes and deviations of its blades, and its contact.

use std::fmt::Write;

use super::{Figure, FigureName};
use crate::report::plot::{
    Anchor, Axis, Frame, LegendEntry, SIDES, Scale, Svg, TOP, legend, nice_top,
};
use crate::report::words::{LengthUnit, share_words};
use crate::report::{GroupReport, PairReport, StudyReport, WheelReport, WheelStateReport, setting};

/// Lower ends of the panels of amplitudes and deviations, and upper end of the second.
const AMPLITUDES: f64 = 210.0;
const DEVIATIONS: (f64, f64) = (350.0, 232.0);
/// Height of the largest and of one row of the map of contact pairs.
const MAP: (f64, f64) = (260.0, 22.0);
/// Share of the width of a blade that its bar fills.
const BAR: f64 = 0.72;

/// Amplitudes above, deviations below, blade by blade.
pub(super) fn blades(
    report: &StudyReport,
    group: &GroupReport,
    wheels: &WheelReport,
) -> Option<Figure> {
    let state = wheels.state.as_ref()?;
    let units = LengthUnit::of_summary(&report.summary);
    let amplitudes: Vec<f64> = state
        .amplitude_m
        .iter()
        .map(|amplitude| amplitude / units.metres())
        .collect();
    let tuned = report.summary.scenarios[wheels.scenario]
        .tuned_amplitude_m
        .map(|tuned| tuned / units.metres());
    let largest = amplitudes
        .iter()
        .copied()
        .fold(tuned.unwrap_or(0.0), f64::max);
    let deviation = state
        .deviation
        .iter()
        .fold(0.0_f64, |largest, deviation| largest.max(deviation.abs()));
    let x = blade_axis(amplitudes.len());
    let y_title = format!("amplitude, {}", units.name());
    let upper = Frame {
        x,
        y: Axis {
            scale: Scale::Linear,
            low: 0.0,
            high: nice_top(largest, 4),
            ends: (AMPLITUDES, TOP),
        },
        x_title: "",
        y_title: &y_title,
    };
    let limit = nice_top(100.0 * deviation, 2);
    let lower = Frame {
        x,
        y: Axis {
            scale: Scale::Linear,
            low: -limit,
            high: limit,
            ends: DEVIATIONS,
        },
        x_title: "blade",
        y_title: "deviation, %",
    };
    let mut svg = Svg::default();
    upper.draw(&mut svg);
    lower.draw(&mut svg);
    let half = 0.5 * BAR;
    let peak = wheels.worst.peak_blade as usize;
    for (blade, &amplitude) in amplitudes.iter().enumerate() {
        let (left, right) = sides(&x, blade, half);
        let words = format!("blade {blade}: {amplitude:.4} {}", units.name());
        let class = if blade == peak { "bar peak" } else { "bar" };
        let (bottom, top) = (upper.y.at(0.0), upper.y.at(amplitude));
        svg.rectangle(class, (left, bottom), (right, top), &words);
    }
    for (blade, &value) in state.deviation.iter().enumerate() {
        let (left, right) = sides(&x, blade, half);
        let words = format!("blade {blade}: {:+.3} %", 100.0 * value);
        let class = if blade == peak { "bar peak" } else { "bar up" };
        let (zero, end) = (lower.y.at(0.0), lower.y.at(100.0 * value));
        svg.rectangle(class, (left, zero), (right, end), &words);
    }
    svg.line(
        "axis",
        (SIDES.0, lower.y.at(0.0)),
        (SIDES.1, lower.y.at(0.0)),
    );
    blade_ticks(&mut svg, &lower, amplitudes.len());
    let mut entries = vec![
        LegendEntry::Area("bar", "blades"),
        LegendEntry::Area("bar peak", "blade of the peak"),
    ];
    if let Some(tuned) = tuned {
        let y = upper.y.at(tuned);
        svg.line("curve tuned", (SIDES.0, y), (SIDES.1, y));
        entries.push(LegendEntry::Line("tuned", None, "tuned peak"));
    }
    legend(&mut svg, &entries);
    let mode = state
        .deviation_mode
        .map_or_else(String::new, |mode| format!(" of blade-alone mode {mode}"));
    Some(Figure {
        name: FigureName::WorstBlades,
        title: format!(
            "Blades of the worst wheel (pattern {}) at its peak, {:.2} Hz",
            wheels.worst.pattern, wheels.worst.peak_frequency_hz
        ),
        setting: setting(group),
        caption: format!(
            "Amplitude of every blade at the frequency of the peak, and below the relative deviation of its stiffness{mode}."
        ),
        height: DEVIATIONS.0 + 52.0,
        body: svg.into_body(),
    })
}

/// Sectors from left to right, the contact pairs of a sector from top to bottom.
pub(super) fn contact(group: &GroupReport, wheels: &WheelReport) -> Option<Figure> {
    let state = wheels
        .state
        .as_ref()
        .filter(|state| !state.contact.is_empty())?;
    let rows = state.pairs_per_sector;
    let sectors = state.contact.len() / rows;
    let row_height = (MAP.0 / rows as f64).min(MAP.1);
    let bottom = TOP + row_height * rows as f64;
    let x = blade_axis(sectors);
    let frame = Frame {
        x,
        y: Axis {
            scale: Scale::Linear,
            low: 0.0,
            high: 1.0,
            ends: (bottom, TOP),
        },
        x_title: "sector",
        y_title: "",
    };
    let mut svg = Svg::default();
    svg.rectangle("panel", (SIDES.0, TOP), (SIDES.1, bottom), "");
    for (place, pair) in state.contact.iter().enumerate() {
        let (sector, row) = (place / rows, place % rows);
        let (left, right) = sides(&x, sector, 0.5);
        let top = TOP + row_height * row as f64;
        let words = format!("sector {sector}, pair {row}: {}", in_words(pair));
        let class = format!("cell {}", class(pair));
        svg.rectangle(&class, (left, top), (right, top + row_height), &words);
    }
    let every = (14.0 / row_height).ceil() as usize;
    for row in (0..rows).step_by(every) {
        let y = TOP + row_height * (row as f64 + 0.5) + 4.5;
        svg.text("quiet", (SIDES.0 - 8.0, y), Anchor::End, &row.to_string());
    }
    svg.upright("", (15.0, f64::midpoint(TOP, bottom)), "contact pair");
    let middle = f64::midpoint(SIDES.0, SIDES.1);
    svg.text("", (middle, bottom + 42.0), Anchor::Middle, "sector");
    blade_ticks(&mut svg, &frame, sectors);
    legend(
        &mut svg,
        &[
            LegendEntry::Area("cell stick", "stick"),
            LegendEntry::Area("cell slip0", "slip, up to 25 %"),
            LegendEntry::Area("cell slip1", "50 %"),
            LegendEntry::Area("cell slip2", "75 %"),
            LegendEntry::Area("cell slip3", "100 %"),
            LegendEntry::Area("cell separation", "separation"),
        ],
    );
    Some(Figure {
        name: FigureName::Contact,
        title: format!(
            "Contact of the worst wheel (pattern {}) at its peak",
            wheels.worst.pattern
        ),
        setting: setting(group),
        caption: shares(state),
        height: bottom + 52.0,
        body: svg.into_body(),
    })
}

fn blade_axis(blades: usize) -> Axis {
    Axis {
        scale: Scale::Linear,
        low: -0.5,
        high: blades as f64 - 0.5,
        ends: SIDES,
    }
}

/// Left and right end of `half` a width on either side of a blade.
fn sides(x: &Axis, blade: usize, half: f64) -> (f64, f64) {
    (x.at(blade as f64 - half), x.at(blade as f64 + half))
}

fn blade_ticks(svg: &mut Svg, frame: &Frame<'_>, blades: usize) {
    let every = blades.div_ceil(13).max(1);
    for blade in (0..blades).step_by(every) {
        let x = frame.x.at(blade as f64);
        svg.text(
            "quiet",
            (x, frame.y.ends.0 + 20.0),
            Anchor::Middle,
            &blade.to_string(),
        );
    }
}

fn class(pair: &PairReport) -> String {
    match (pair.state, pair.slipping_share) {
        ("slip", Some(share)) => {
            let quarter = ((4.0 * share).ceil() - 1.0).clamp(0.0, 3.0);
            format!("slip{quarter:.0}")
        }
        ("slip", None) => "slip3".to_owned(),
        (state, _) => state.to_owned(),
    }
}

fn in_words(pair: &PairReport) -> String {
    let mut words = pair.state.to_owned();
    if let Some(share) = pair.slipping_share.filter(|share| *share > 0.0) {
        // Writing to a String cannot fail.
        let _ = write!(words, ", slips {} of the period", share_words(share));
    }
    if pair.separated_share > 0.0 {
        let share = share_words(pair.separated_share);
        let _ = write!(words, ", open {share} of the period");
    }
    words
}

fn shares(state: &WheelStateReport) -> String {
    let count = |name: &str| {
        state
            .contact
            .iter()
            .filter(|pair| pair.state == name)
            .count()
    };
    let all = state.contact.len();
    let slipping: Option<Vec<f64>> = state
        .contact
        .iter()
        .map(|pair| pair.slipping_share)
        .collect();
    let mean = slipping.map_or_else(String::new, |shares| {
        let mean = shares.iter().sum::<f64>() / all as f64;
        format!(
            " A pair slips for {} of the period on average.",
            share_words(mean)
        )
    });
    format!(
        "Of {all} pairs {} stick throughout the period, {} slip at some instant, {} open at some instant. Shade of slip: \
         share of the period in which the pair slips.{mean}",
        count("stick"),
        count("slip"),
        count("separation"),
    )
}
