//! Response curves of one wheel with those of its linear limits and of the tuned wheel.

use super::{Figure, FigureName};
use crate::report::plot::{Axis, Frame, LegendEntry, Mark, SIDES, Scale, Svg, TOP, legend};
use crate::report::words::{LengthUnit, share_words, short_load_with_unit};
use crate::report::{GroupReport, ResponseCurve, StudyReport, WheelCurves, WheelReport, setting};

/// Lower end of the vertical axis.
const BOTTOM: f64 = 330.0;
/// Height of the drawing.
const HEIGHT: f64 = 382.0;
/// Decades below the largest amplitude that are shown.
const SHOWN: f64 = 300.0;

/// The figure of the median or of the worst wheel.
pub(super) fn of_wheel(
    report: &StudyReport,
    group: &GroupReport,
    wheels: &WheelReport,
    name: FigureName,
) -> Option<Figure> {
    let (which, class, wheel) = match name {
        FigureName::MedianResponse => ("median", "median", &wheels.median),
        _ => ("worst", "extreme", &wheels.worst),
    };
    let units = LengthUnit::of_summary(&report.summary);
    let metres = units.metres();
    let limits = [&wheel.stuck, &wheel.slide];
    let curves = || {
        [Some(&wheel.full), Some(&wheels.tuned)]
            .into_iter()
            .chain(limits.map(Option::as_ref))
            .flatten()
    };
    let values = || curves().flat_map(|curve| curve.amplitude_m.iter().flatten());
    let high = values().copied().fold(wheel.peak_amplitude_m, f64::max);
    let low = values().copied().fold(high, f64::min).max(high / SHOWN);
    let frequencies = &wheel.full.frequency_hz;
    let y_title = format!("largest amplitude, {} (log.)", units.name());
    let frame = Frame {
        x: Axis {
            scale: Scale::Linear,
            low: *frequencies.first()?,
            high: *frequencies.last()?,
            ends: SIDES,
        },
        y: Axis {
            scale: Scale::Logarithmic,
            low: 0.8 * low / metres,
            high: 1.25 * high / metres,
            ends: (BOTTOM, TOP),
        },
        x_title: "excitation frequency, Hz",
        y_title: &y_title,
    };
    let mut svg = Svg::default();
    frame.draw(&mut svg);
    frame.x_ticks(&mut svg, 6);
    let mut draw = |class: &str, curve: &ResponseCurve| {
        for stretch in stretches(&frame, curve, metres) {
            svg.polyline(class, &stretch);
        }
    };
    for (limit, class) in limits.into_iter().zip(["curve stuck", "curve slide"]) {
        if let Some(limit) = limit {
            draw(class, limit);
        }
    }
    draw("curve tuned", &wheels.tuned);
    draw(&format!("curve {class}"), &wheel.full);
    let at = frame.at(wheel.peak_frequency_hz, wheel.peak_amplitude_m / metres);
    let words = format!(
        "delivered peak: {} at {:.2} Hz, blade {}",
        units.length(wheel.peak_amplitude_m),
        wheel.peak_frequency_hz,
        wheel.peak_blade
    );
    Mark::Diamond.draw(&mut svg, class, at, &words);
    let mut entries = vec![
        LegendEntry::Line(class, Some(Mark::Diamond), "wheel and its delivered peak"),
        LegendEntry::Line("tuned", None, "tuned"),
    ];
    if wheel.stuck.is_some() {
        entries.push(LegendEntry::Line("stuck", None, "stuck"));
        entries.push(LegendEntry::Line("slide", None, "slide"));
    }
    legend(&mut svg, &entries);
    let scenario = &report.summary.scenarios[wheels.scenario];
    Some(Figure {
        name,
        title: format!(
            "Response of the {which} wheel (pattern {}) at load {}",
            wheel.pattern,
            short_load_with_unit(scenario.contact, scenario.normal_load_n)
        ),
        setting: setting(group),
        caption: caption(wheel, units),
        height: HEIGHT,
        body: svg.into_body(),
    })
}

/// The points of a curve within the frame, cut where there is no solution.
fn stretches(frame: &Frame<'_>, curve: &ResponseCurve, metres: f64) -> Vec<Vec<(f64, f64)>> {
    let mut stretches = vec![Vec::new()];
    for (&hz, amplitude) in curve.frequency_hz.iter().zip(&curve.amplitude_m) {
        let shown = amplitude
            .map(|amplitude| amplitude / metres)
            .filter(|amplitude| *amplitude >= frame.y.low)
            .filter(|_| (frame.x.low..=frame.x.high).contains(&hz));
        match (shown, stretches.last_mut()) {
            (Some(amplitude), Some(last)) => last.push(frame.at(hz, amplitude)),
            _ => stretches.push(Vec::new()),
        }
    }
    stretches
}

fn caption(wheel: &WheelCurves, units: LengthUnit) -> String {
    let factor = wheel
        .amplification_factor
        .map_or_else(String::new, |factor| {
            format!(", amplification factor {factor:.3}")
        });
    let error = wheel.stated_error.map_or_else(String::new, |error| {
        format!(", stated error {}", share_words(error))
    });
    let lost = wheel
        .full
        .amplitude_m
        .iter()
        .filter(|amplitude| amplitude.is_none())
        .count();
    let lost = if lost == 0 {
        String::new()
    } else {
        format!(
            " {lost} of {} frequencies have no solution and are left out.",
            wheel.full.amplitude_m.len()
        )
    };
    let limits = if wheel.stuck.is_some() {
        " stuck and slide: the same wheel with welded and with frictionless contact."
    } else {
        ""
    };
    format!(
        "Largest amplitude of any blade, harmonics {}, solved again for this figure. Delivered peak: {} at {:.2} Hz, \
         blade {}{factor}{error}.{limits}{lost}",
        wheel.harmonics,
        units.length(wheel.peak_amplitude_m),
        wheel.peak_frequency_hz,
        wheel.peak_blade,
    )
}
