//! Campbell and SAFE diagram of the tuned wheel: where the engine orders of a study meet its natural frequencies.

use std::fmt::Write;

use super::{Figure, FigureName};
use crate::model::cyclic::nodal_diameter_of;
use crate::report::plot::{
    Anchor, Axis, Frame, LegendEntry, Mark, SIDES, Scale, Svg, TOP, legend, nice_top,
};
use crate::report::words::short_load_with_unit;
use crate::report::{CampbellMode, CampbellReport, ScenarioSummary, StudyReport};

/// Lower end of the vertical axis.
const BOTTOM: f64 = 330.0;
/// Height of the drawing.
const HEIGHT: f64 = 444.0;
/// Left end of the note, distance of its first line from the axis, and of its lines, user units. A line of 56 letters fits on a narrow
/// page too.
const NOTE: (f64, f64, f64) = (14.0, 64.0, 20.0);
/// Pieces of the line of a mode whose frequency follows the speed.
const PIECES: u32 = 60;
/// Where a diagram without a tuned peak ends.
const THIRD_MODE: &str = "above all third modes";
/// The frequencies shown, over the highest tuned peak.
const SHOWN: f64 = 1.6;
/// The speeds shown, over the highest at which an engine order meets a tuned peak.
const SPEEDS: f64 = 1.25;
/// Modes of a nodal diameter whose frequencies are shown where there is no tuned peak.
const WITHOUT_PEAK: usize = 3;
/// Folds of the line of an engine order at most; a wheel that hardly turns has no line.
const MOST_FOLDS: f64 = 50.0;
/// Least distance of two names, user units.
const APART: f64 = 13.0;
/// Nodal diameters with a name at most.
const NAMED: usize = 13;

/// What a diagram shows beside natural frequencies.
struct Diagram<'a> {
    model: &'a CampbellReport,
    orders: Vec<u32>,
    /// Where engine orders meet something, with words, the speed in rpm, and the frequency in Hz.
    met: Vec<(String, f64, f64)>,
    /// What stands at these places.
    met_words: &'static str,
    /// Engine orders with the speed of their line over nodal diameter, rpm, and what they meet there.
    lines: Vec<(u32, f64, String)>,
    top_hz: f64,
    /// Highest speed; none without one.
    top_rpm: Option<f64>,
    /// Why it ends where it does.
    ends: &'static str,
}

/// How far the axes of a diagram of a model alone reach.
#[derive(Debug, Clone, Copy, Default)]
pub struct DiagramRange {
    /// Highest frequency, Hz; none: that of the third mode of all nodal diameters.
    pub top_hz: Option<f64>,
    /// Highest speed, rpm; none: a quarter above the highest at which an engine order meets a first mode.
    pub top_rpm: Option<f64>,
}

/// The Campbell or SAFE diagram of a model without results, with `engine_orders`; none where there is nothing to draw, and for other figures.
#[must_use]
pub fn diagram_of_model(
    model: &CampbellReport,
    engine_orders: &[u32],
    range: DiagramRange,
    name: FigureName,
) -> Option<Figure> {
    let diagram = Diagram::of_model(model, engine_orders, range)?;
    match name {
        FigureName::Campbell => diagram.over_speed(),
        FigureName::Safe => Some(diagram.over_nodal_diameter()),
        _ => None,
    }
}

/// Natural frequency over speed with the engine orders as lines; none without a speed at which one meets a peak.
pub(super) fn over_speed(report: &StudyReport) -> Option<Figure> {
    Diagram::of_results(report)?.over_speed()
}

/// SAFE diagram: natural frequency over nodal diameter, with what an engine order excites at one speed.
pub(super) fn over_nodal_diameter(report: &StudyReport) -> Option<Figure> {
    Some(Diagram::of_results(report)?.over_nodal_diameter())
}

impl<'a> Diagram<'a> {
    fn of_results(report: &'a StudyReport) -> Option<Self> {
        let model = &report.model.section()?.campbell;
        let peaks = peaks(report);
        let speeds = peaks.iter().map(|(_, speed, _)| *speed);
        let met = peaks.iter().map(|(scenario, speed_rpm, hz)| {
            let load = short_load_with_unit(scenario.contact, scenario.normal_load_n);
            let words = format!("load {load}, engine order {}", scenario.engine_order);
            (words, *speed_rpm, *hz)
        });
        let lines = shown_peaks(report).into_iter().map(|(order, speed_rpm)| {
            let met = "the tuned peak at the chosen load".to_owned();
            (order, speed_rpm, met)
        });
        let peak_hz = { report.summary.scenarios.iter() }
            .filter_map(|own| own.tuned_frequency_hz)
            .reduce(f64::max);
        Some(Self {
            top_hz: upper_end(peak_hz.map(|hz| SHOWN * hz).or_else(|| lowest_modes(model)))?,
            top_rpm: speeds.reduce(f64::max).map(|rpm| SPEEDS * rpm),
            ends: if peak_hz.is_some() {
                "about 1.6 times the highest tuned peak"
            } else {
                THIRD_MODE
            },
            orders: orders(report),
            met: met.collect(),
            met_words: "peaks of the tuned wheel under each load, at the speed of its engine order",
            lines: lines.collect(),
            model,
        })
    }

    fn of_model(
        model: &'a CampbellReport,
        engine_orders: &[u32],
        range: DiagramRange,
    ) -> Option<Self> {
        let mut orders: Vec<u32> = engine_orders.to_vec();
        orders.retain(|&order| order > 0);
        orders.sort_unstable();
        orders.dedup();
        let crossings = || model.crossings.iter();
        let first_modes = crossings().filter(|crossing| crossing.mode == 1);
        let speeds = first_modes.map(|crossing| crossing.speed_rpm);
        let met = crossings().map(|crossing| {
            let words = format!(
                "engine order {}, nodal diameter {}, mode {}, {}",
                crossing.engine_order, crossing.nodal_diameter, crossing.mode, crossing.contact
            );
            (words, crossing.speed_rpm, crossing.frequency_hz)
        });
        let lines = orders.iter().filter_map(|&order| {
            let own = crossings().filter(|crossing| crossing.engine_order == order);
            let first = own.min_by_key(|crossing| (crossing.mode, crossing.contact != "stuck"))?;
            let met = format!("mode {}, {}", first.mode, first.contact);
            Some((order, first.speed_rpm, met))
        });
        Some(Self {
            top_hz: match range.top_hz {
                Some(hz) => hz,
                None => upper_end(lowest_modes(model))?,
            },
            top_rpm: range
                .top_rpm
                .or_else(|| speeds.reduce(f64::max).map(|rpm| SPEEDS * rpm)),
            ends: match range.top_hz {
                Some(_) => "as asked for",
                None => THIRD_MODE,
            },
            met: met.collect(),
            met_words: "where an engine order meets a mode that it excites",
            lines: lines.collect(),
            orders,
            model,
        })
    }

    /// Natural frequency over speed with the engine orders as lines; none without a speed.
    fn over_speed(&self) -> Option<Figure> {
        let (model, top_hz) = (self.model, self.top_hz);
        let top_rpm = self.top_rpm.filter(|rpm| rpm.is_finite())?;
        let frame = Frame {
            // Room for the half of the last name.
            x: axis(top_rpm, (SIDES.0, SIDES.1 - 12.0)),
            y: axis(top_hz, (BOTTOM, TOP)),
            x_title: "speed, rpm",
            y_title: "frequency, Hz",
        };
        let mut svg = Svg::default();
        frame.draw(&mut svg);
        frame.x_ticks(&mut svg, 6);
        self.modes_over_speed(&mut svg, &frame, top_rpm);
        for &order in &self.orders {
            let per_rpm = f64::from(order) / 60.0;
            let end_rpm = top_rpm.min(top_hz / per_rpm);
            let end = frame.at(end_rpm, per_rpm * end_rpm);
            svg.polyline("curve median", &[frame.at(0.0, 0.0), end]);
            let name = format!("EO {order}");
            let y = (end.1 - 2.0).max(TOP + 12.0);
            svg.text("small strong", (end.0 - 12.0, y), Anchor::End, &name);
        }
        let is_inside = |met: &&(String, f64, f64)| met.1 <= top_rpm && met.2 <= top_hz;
        for (words, speed_rpm, hz) in self.met.iter().filter(is_inside) {
            let words = format!("{words}: {hz:.2} Hz at {speed_rpm:.0} rpm");
            Mark::Diamond.draw(&mut svg, "pick", frame.at(*speed_rpm, *hz), &words);
        }
        let mut entries = contact_entries(model, false);
        entries.push(LegendEntry::Line("median", None, "engine order"));
        legend(&mut svg, &entries);
        self.note(&mut svg, "--plot");
        let over_speed = if model.speed_rpm.len() > 1 {
            "Their squares are linear in the square of the speed between the models that were given."
        } else {
            "They are horizontal because the study has one model for every speed: without centrifugal stiffening and without spin \
             softening. The command blisk campbell with --at takes models at several speeds."
        };
        Some(Figure {
            name: FigureName::Campbell,
            title: "Campbell diagram: frequencies of the tuned wheel over speed".to_owned(),
            setting: setting(model),
            caption: format!(
                "Lines across: natural frequencies of the nodal diameters that the engine orders excite. {over_speed} Diamonds: \
                 {}.{}",
                self.met_words,
                contact_words(model)
            ),
            height: HEIGHT,
            body: svg.into_body(),
        })
    }

    /// The modes of the nodal diameters that the engine orders excite, with their names.
    fn modes_over_speed(&self, svg: &mut Svg, frame: &Frame<'_>, top_rpm: f64) {
        let model = self.model;
        let excited: Vec<usize> = { self.orders.iter() }
            .map(|&order| nodal_diameter_of(1, order, model.sectors).index)
            .collect();
        let mut named: Vec<f64> = Vec::new();
        let mut modes: Vec<&CampbellMode> = shown(model, self.top_hz)
            .filter(|mode| excited.contains(&mode.nodal_diameter))
            .collect();
        // A name stands above the highest of lines that lie close together.
        modes.sort_by(|a, b| b.frequency_hz[0].total_cmp(&a.frequency_hz[0]));
        let pieces = if model.speed_rpm.len() > 1 { PIECES } else { 1 };
        for mode in modes {
            let points = (0..=pieces).map(|piece| {
                let speed_rpm = top_rpm * f64::from(piece) / f64::from(pieces);
                (speed_rpm, model.frequency_at(mode, speed_rpm))
            });
            let inside = points.filter(|(_, hz)| (0.0..=self.top_hz).contains(hz));
            let points: Vec<(f64, f64)> = inside.map(|(rpm, hz)| frame.at(rpm, hz)).collect();
            svg.polyline(&format!("curve {}", drawn(mode.contact).line), &points);
            let Some(&(_, y)) = points.first() else {
                continue;
            };
            let y = y - 4.0;
            if named.iter().all(|other| (other - y).abs() >= APART) {
                named.push(y);
                let words = format!("ND {}, mode {}", mode.nodal_diameter, mode.mode);
                svg.text("small quiet", (SIDES.0 + 5.0, y), Anchor::Start, &words);
            }
        }
    }

    /// SAFE diagram: natural frequency over nodal diameter, with what an engine order excites at one speed.
    fn over_nodal_diameter(&self) -> Figure {
        let (model, top_hz) = (self.model, self.top_hz);
        let half = model.sectors as f64 / 2.0;
        let frame = Frame {
            x: axis(half, (SIDES.0 + 12.0, SIDES.1 - 12.0)),
            y: axis(top_hz, (BOTTOM, TOP)),
            x_title: "nodal diameter",
            y_title: "frequency, Hz",
        };
        let mut svg = Svg::default();
        frame.draw(&mut svg);
        let step = (model.sectors / 2).div_ceil(NAMED).max(1);
        for nodal_diameter in (0..=model.sectors / 2).step_by(step) {
            let x = frame.x.at(nodal_diameter as f64);
            frame.x_tick(&mut svg, x, &nodal_diameter.to_string());
        }
        let mut told = String::new();
        for (order, speed_rpm, met) in &self.lines {
            svg.polyline(
                "curve median",
                &impulse(&frame, *speed_rpm, model.sectors, top_hz),
            );
            // Writing to a String cannot fail.
            let _ = write!(
                told,
                " Line of engine order {order}: {speed_rpm:.0} rpm, where it meets {met}."
            );
        }
        for mode in shown(model, top_hz) {
            let drawn = drawn(mode.contact);
            let hz = mode.frequency_hz[0];
            let words = format!(
                "nodal diameter {}, mode {}, {}: {hz:.2} Hz",
                mode.nodal_diameter, mode.mode, mode.contact
            );
            let (x, y) = frame.at(mode.nodal_diameter as f64, hz);
            let at = (x + drawn.beside, y);
            drawn.mark.draw(&mut svg, drawn.point, at, &words);
        }
        self.names_at_lines(&mut svg, &frame);
        let mut entries = contact_entries(model, true);
        entries.push(LegendEntry::Line(
            "median",
            None,
            "engine orders at one speed",
        ));
        legend(&mut svg, &entries);
        self.note(&mut svg, "--plot-safe");
        Figure {
            name: FigureName::Safe,
            title: "SAFE diagram: frequencies of the tuned wheel over nodal diameter".to_owned(),
            setting: setting(model),
            caption: format!(
                "Points: natural frequencies. The line is speed times engine order over the nodal diameter that it excites; \
                 beyond N/2 it is folded back, as {} blades cannot tell an order from one that differs by their number. An \
                 order excites a mode where the line passes its point at that order's nodal diameter.{told}{}",
                model.sectors,
                contact_words(model)
            ),
            height: HEIGHT,
            body: svg.into_body(),
        }
    }

    /// What the engine orders meet at the speed of their lines.
    fn names_at_lines(&self, svg: &mut Svg, frame: &Frame<'_>) {
        let half = self.model.sectors as f64 / 2.0;
        for (order, speed_rpm, _) in &self.lines {
            let at = nodal_diameter_of(1, *order, self.model.sectors).index as f64;
            let hz = f64::from(*order) * speed_rpm / 60.0;
            if hz > self.top_hz {
                continue;
            }
            let (x, y) = frame.at(at, hz);
            let words = format!("engine order {order} at {speed_rpm:.0} rpm: {hz:.2} Hz");
            Mark::Diamond.draw(svg, "pick", (x, y), &words);
            // The line comes from the lower left, so that there is room above it on that side.
            let (x, anchor) = if at < 0.2 * half {
                (x + 12.0, Anchor::Start)
            } else {
                (x - 12.0, Anchor::End)
            };
            svg.text("small strong", (x, y - 7.0), anchor, &format!("EO {order}"));
        }
    }

    /// Where the frequencies end, why, and how to see more; `option` draws this diagram from a study.
    fn note(&self, svg: &mut Svg, option: &str) {
        let modes = { self.model.modes.iter() }.map(|mode| mode.mode).max();
        let lines = [
            format!("Ends at {} Hz, {}.", self.top_hz, self.ends),
            format!(
                "Modes 1 to {}. For more: blisk campbell STUDY.toml with",
                modes.unwrap_or(0)
            ),
            format!("{option} FILE.svg --top-hz HZ --modes N."),
        ];
        let (left, below, apart) = NOTE;
        for (place, line) in lines.iter().enumerate() {
            let y = BOTTOM + below + apart * place as f64;
            svg.text("small quiet", (left, y), Anchor::Start, line);
        }
    }
}

/// Frequencies of the orders at one speed, folded at half the number of sectors.
fn impulse(frame: &Frame<'_>, speed_rpm: f64, sectors: usize, top_hz: f64) -> Vec<(f64, f64)> {
    let per_order = speed_rpm / 60.0;
    let half = sectors as f64 / 2.0;
    let last = top_hz / per_order;
    let folds = (last / half).floor();
    let is_drawn = folds <= MOST_FOLDS;
    if !is_drawn {
        return Vec::new();
    }
    let folds = folds as u32;
    let folded = |order: f64| {
        let rest = order.rem_euclid(2.0 * half);
        rest.min(2.0 * half - rest)
    };
    (0..=folds)
        .map(|fold| f64::from(fold) * half)
        .chain([last])
        .map(|order| frame.at(folded(order), per_order * order))
        .collect()
}

/// An axis from nought.
fn axis(top: f64, ends: (f64, f64)) -> Axis {
    Axis {
        scale: Scale::Linear,
        low: 0.0,
        high: top,
        ends,
    }
}

/// Upper end of an axis that shows `hz`.
fn upper_end(hz: Option<f64>) -> Option<f64> {
    let top = nice_top(hz?, 5);
    (top > 0.0 && top.is_finite()).then_some(top)
}

/// The highest of the first modes of all nodal diameters, Hz.
fn lowest_modes(model: &CampbellReport) -> Option<f64> {
    let modes = model.modes.iter().filter(|mode| mode.mode <= WITHOUT_PEAK);
    modes.map(|mode| mode.frequency_hz[0]).reduce(f64::max)
}

/// Modes that the axis has room for; rotation may soften others to nothing.
fn shown(model: &CampbellReport, top_hz: f64) -> impl Iterator<Item = &CampbellMode> {
    model
        .modes
        .iter()
        .filter(move |mode| (0.0..=top_hz).contains(&mode.frequency_hz[0]))
}

/// Engine orders of the study that turn with the wheel.
fn orders(report: &StudyReport) -> Vec<u32> {
    let mut orders: Vec<u32> = { report.groups.iter() }
        .map(|group| group.engine_order)
        .filter(|&order| order > 0)
        .collect();
    orders.sort_unstable();
    orders.dedup();
    orders
}

/// Tuned peaks with the speed of their engine order, rpm, and their frequency, Hz.
fn peaks(report: &StudyReport) -> Vec<(&ScenarioSummary, f64, f64)> {
    let scenarios = report.summary.scenarios.iter();
    scenarios
        .filter_map(|own| Some((own, own.crossing_rpm()?, own.tuned_frequency_hz?)))
        .collect()
}

/// Engine orders with the speed at which each meets the tuned peak of the chosen load, rpm.
fn shown_peaks(report: &StudyReport) -> Vec<(u32, f64)> {
    let crossing = |order: u32| {
        let group = { report.groups.iter() }.find(|group| group.engine_order == order)?;
        let speed_rpm = report.summary.scenarios[group.shown].crossing_rpm()?;
        Some((order, speed_rpm))
    };
    orders(report).into_iter().filter_map(crossing).collect()
}

/// How the frequencies of a contact condition are drawn.
struct Drawn {
    /// Class of their lines over speed.
    line: &'static str,
    /// Class of their points over nodal diameter.
    point: &'static str,
    mark: Mark,
    /// How far beside their nodal diameter they stand, so that no point hides another, user units.
    beside: f64,
}

fn drawn(contact: &str) -> Drawn {
    let (line, point, mark, beside) = match contact {
        "stuck" => ("stuck", "median", Mark::Circle, -4.5),
        "slide" => ("slide", "extreme", Mark::Square, 4.5),
        _ => ("quiet", "median", Mark::Circle, 0.0),
    };
    Drawn {
        line,
        point,
        mark,
        beside,
    }
}

/// Entries of the contact conditions, as points or as lines.
fn contact_entries(model: &CampbellReport, are_points: bool) -> Vec<LegendEntry<'static>> {
    let mut entries = Vec::new();
    for contact in ["stuck", "slide", "free"] {
        if model.modes.iter().any(|mode| mode.contact == contact) {
            let drawn = drawn(contact);
            entries.push(if are_points {
                LegendEntry::Point(drawn.point, drawn.mark, contact)
            } else {
                LegendEntry::Line(drawn.line, None, contact)
            });
        }
    }
    entries
}

fn contact_words(model: &CampbellReport) -> &'static str {
    if model.modes.iter().any(|mode| mode.contact == "stuck") {
        " stuck and slide: welded and frictionless contact; with friction a peak lies near or between them."
    } else {
        ""
    }
}

fn setting(model: &CampbellReport) -> String {
    format!("model {}, {} sectors", model.model, model.sectors)
}
