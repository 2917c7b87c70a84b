//! The axis of the damper normal load, on which linear limits stand beside the loads in newtons.

use crate::report::ScenarioSummary;
use crate::report::plot::{Axis, Frame, SIDES, Scale, Svg};
use crate::report::words::short_load_words;

/// Width of the place of a linear limit beside the axis of loads.
const SLOT: f64 = 48.0;
/// Distance from the end of the axis to the loads beside a linear limit, and to the break between them, in slots.
const LIMIT: f64 = 2.0;
const GAP_AT: f64 = 1.25;
/// Half the width of a break of the axis.
const GAP: f64 = 4.5;
/// Distance between the marks of a load, and the share of the distance of two loads that it is at most.
const ASIDE: (f64, f64) = (6.0, 0.25);
/// Distance between the wheels of a load, beyond which the bar of one does not reach the mark of the next; how far apart the
/// first and the last are at most, and which share of the distance of two loads.
const WHEELS: (f64, f64, f64) = (10.0, 44.0, 0.7);
/// Half the width of a letter of a name on a narrow page, where letters are large, and on a wide one.
const HALF_LETTER: [f64; 2] = [6.6, 4.7];

/// Places of the loads of a group: `slide` and `free` on the left, `stuck` on the right, the loads in
/// newtons between them.
pub(super) struct LoadAxis {
    axis: Axis,
    /// Whether there is one load alone, which then stands in the middle.
    alone: bool,
    /// Distance between the marks of a load, which would hide each other at one place.
    pub(super) aside: f64,
    /// How far apart the first and the last of the wheels of a load are at most.
    spread: f64,
    /// Where the axis is broken between a linear limit and the loads in newtons.
    gaps: [Option<f64>; 2],
}

impl LoadAxis {
    pub(super) fn new(loads: &[&ScenarioSummary]) -> Self {
        let newtons: Vec<f64> = loads.iter().filter_map(|load| load.normal_load_n).collect();
        let low = newtons.iter().copied().fold(f64::INFINITY, f64::min);
        let high = newtons.iter().copied().fold(0.0, f64::max);
        let scale = if low > 0.0 && low < high {
            Scale::Logarithmic
        } else {
            Scale::Linear
        };
        let has = |names: &[&str]| loads.iter().any(|load| names.contains(&load.contact));
        let left = SIDES.0
            + if has(&["slide", "free"]) {
                LIMIT * SLOT
            } else {
                0.5 * SLOT
            };
        let right = SIDES.1
            - if has(&["stuck"]) {
                LIMIT * SLOT
            } else {
                0.5 * SLOT
            };
        let gap = |there: bool, at: f64| (there && !newtons.is_empty()).then_some(at);
        let gaps = [
            gap(has(&["slide", "free"]), SIDES.0 + GAP_AT * SLOT),
            gap(has(&["stuck"]), SIDES.1 - GAP_AT * SLOT),
        ];
        let mut places = Self {
            alone: loads.len() == 1,
            aside: ASIDE.0,
            spread: WHEELS.1,
            gaps,
            axis: Axis {
                scale,
                low,
                high,
                ends: (left, right),
            },
        };
        let mut taken: Vec<f64> = loads.iter().map(|load| places.at(load)).collect();
        taken.sort_unstable_by(f64::total_cmp);
        let distances = taken.windows(2).map(|two| two[1] - two[0]);
        let closest = distances.filter(|distance| *distance > 0.0);
        let closest = closest.fold(f64::INFINITY, f64::min);
        places.aside = places.aside.min(ASIDE.1 * closest);
        places.spread = places.spread.min(WHEELS.2 * closest);
        places
    }

    /// Where the wheel at `place` among the `count` wheels of a load stands: side by side in the order of the file.
    pub(super) fn at_wheel(&self, load: &ScenarioSummary, place: usize, count: usize) -> f64 {
        let between = (count.max(2) - 1) as f64;
        let step = WHEELS.0.min(self.spread / between);
        self.at(load) + step * (place as f64 - 0.5 * (count.max(1) - 1) as f64)
    }

    pub(super) fn title(&self) -> &'static str {
        match self.axis.scale {
            Scale::Logarithmic => "damper normal load per sector, N (logarithmic)",
            _ => "damper normal load per sector, N",
        }
    }

    /// Place of a load.
    pub(super) fn at(&self, load: &ScenarioSummary) -> f64 {
        match (load.contact, load.normal_load_n) {
            _ if self.alone => f64::midpoint(SIDES.0, SIDES.1),
            ("stuck", _) => SIDES.1 - 0.5 * SLOT,
            ("free", _) | (_, None) => SIDES.0 + 0.5 * SLOT,
            (_, Some(newtons)) => self.axis.at(newtons),
        }
    }

    /// Breaks of the axis, and a tick per load. Names that would touch on a narrow page are left out there; a name that
    /// would touch anywhere is left out with its tick.
    pub(super) fn ticks(&self, svg: &mut Svg, frame: &Frame<'_>, loads: &[&ScenarioSummary]) {
        let (bottom, top) = frame.y.ends;
        for at in self.gaps.into_iter().flatten() {
            let (left, right) = (at - GAP, at + GAP);
            svg.rectangle("gap", (left, top - 1.0), (right, bottom + 1.0), "");
            for end in [left, right] {
                svg.line("axis", (end - 3.0, bottom + 5.0), (end + 3.0, bottom - 5.0));
            }
        }
        // Limits first, since no scale tells what they are.
        let mut ordered: Vec<&&ScenarioSummary> = loads.iter().collect();
        ordered.sort_by(|a, b| {
            let newtons = |load: &ScenarioSummary| load.normal_load_n.is_some();
            let limits_first = newtons(a).cmp(&newtons(b));
            limits_first.then(self.at(a).total_cmp(&self.at(b)))
        });
        let name = |load: &ScenarioSummary| short_load_words(load.contact, load.normal_load_n);
        let mut named: Vec<(f64, f64)> = Vec::new();
        for (half_letter, class) in HALF_LETTER.into_iter().zip(["", "squeezed"]) {
            for load in &ordered {
                let (x, name) = (self.at(load), name(load));
                let letters = name.chars().count() as f64;
                let touches =
                    |&(other, own): &(f64, f64)| (x - other).abs() < half_letter * (letters + own);
                if !named.iter().any(touches) {
                    named.push((x, letters));
                    frame.x_tick_of(svg, class, x, &name);
                }
            }
        }
        let (bottom, top) = frame.y.ends;
        for x in ordered.into_iter().map(|load| self.at(load)) {
            svg.line("grid", (x, top), (x, bottom));
        }
    }
}
