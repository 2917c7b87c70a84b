//! The frame of a plot: panel, grid, ticks, titles of the axes, legend.

use super::{Anchor, Axis, Svg};

/// Width of all plots, user units.
pub(in crate::report) const WIDTH: f64 = 560.0;
/// Left and right end of the horizontal axis of a plot.
pub(in crate::report) const SIDES: (f64, f64) = (70.0, 546.0);
/// Upper end of the vertical axis; above it stands the legend.
pub(in crate::report) const TOP: f64 = 48.0;
/// Length of a tick.
const TICK: f64 = 4.0;
/// Where a legend begins, below the title of the figure.
const LEGEND_LEFT: f64 = 14.0;
/// Distance of a legend from the plot.
const LEGEND_ABOVE: f64 = 12.0;

/// What a legend takes, about, for letters of one size.
struct LegendSize {
    /// Attributes of its group.
    attributes: &'static str,
    /// Width of an entry without its letters, and of a letter.
    entry: (f64, f64),
    /// Height of a line.
    line: f64,
}

/// A legend is drawn for both sizes of its letters; a style sheet shows that of the page.
const LEGENDS: [LegendSize; 2] = [
    LegendSize {
        attributes: "class=\"wide\"",
        entry: (46.0, 6.6),
        line: 21.0,
    },
    // Programs without that style sheet show no narrow page.
    LegendSize {
        attributes: "class=\"narrow\" display=\"none\"",
        entry: (44.0, 10.8),
        line: 23.0,
    },
];
/// Half the width of the caps of a bound: they reach beyond its mark.
const CAP: f64 = 5.5;

/// What stands at a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::report) enum Mark {
    Circle,
    Square,
    Diamond,
    Triangle,
    /// A triangle on its point, which points at what is below.
    Pointer,
}

impl Mark {
    /// Draws the mark with the classes `mark` and `class`.
    pub(in crate::report) fn draw(self, svg: &mut Svg, class: &str, at: (f64, f64), words: &str) {
        const R: f64 = 4.0;
        let class = format!("mark {class}");
        let (x, y) = at;
        let shape: &[(f64, f64)] = match self {
            Self::Circle => return svg.circle(&class, at, R, words),
            Self::Square => &[(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)],
            Self::Diamond => &[(0.0, -1.3), (1.3, 0.0), (0.0, 1.3), (-1.3, 0.0)],
            Self::Triangle => &[(0.0, -1.2), (1.15, 0.9), (-1.15, 0.9)],
            Self::Pointer => &[(-1.5, -1.2), (1.5, -1.2), (0.0, 1.3)],
        };
        let points: Vec<(f64, f64)> = shape
            .iter()
            .map(|(dx, dy)| (x + 0.92 * R * dx, y + 0.92 * R * dy))
            .collect();
        svg.shape(&class, &points, words);
    }
}

/// An entry of a legend.
#[derive(Debug, Clone, Copy)]
pub(in crate::report) enum LegendEntry<'a> {
    /// A line of the classes `curve` and this, with a mark.
    Line(&'a str, Option<Mark>, &'a str),
    /// A mark of this class alone.
    Point(&'a str, Mark, &'a str),
    /// An area of this class.
    Area(&'a str, &'a str),
}

/// Axes of a plot.
#[derive(Debug, Clone, Copy)]
pub(in crate::report) struct Frame<'a> {
    pub(in crate::report) x: Axis,
    pub(in crate::report) y: Axis,
    pub(in crate::report) x_title: &'a str,
    pub(in crate::report) y_title: &'a str,
}

impl Frame<'_> {
    /// Panel, horizontal grid and titles.
    pub(in crate::report) fn draw(&self, svg: &mut Svg) {
        let (left, right) = self.x.ends;
        let (bottom, top) = self.y.ends;
        svg.rectangle("panel", (left, top), (right, bottom), "");
        for (value, name) in self.y.ticks(5) {
            let y = self.y.at(value);
            svg.line("grid", (left, y), (right, y));
            svg.text("quiet", (left - 8.0, y + 4.5), Anchor::End, &name);
        }
        svg.line("axis", (left, bottom), (right, bottom));
        let middle = f64::midpoint(left, right);
        svg.text("", (middle, bottom + 42.0), Anchor::Middle, self.x_title);
        svg.upright("", (15.0, f64::midpoint(top, bottom)), self.y_title);
    }

    /// Ticks of the horizontal axis, with vertical grid.
    pub(in crate::report) fn x_ticks(&self, svg: &mut Svg, count: u32) {
        for (value, name) in self.x.ticks(count) {
            self.x_tick(svg, self.x.at(value), &name);
        }
    }

    /// One tick of the horizontal axis at the place `x`.
    pub(in crate::report) fn x_tick(&self, svg: &mut Svg, x: f64, name: &str) {
        let (bottom, top) = self.y.ends;
        svg.line("grid", (x, top), (x, bottom));
        self.x_tick_of(svg, "", x, name);
    }

    /// One tick of the horizontal axis with its name and without grid, both also of the class `class`.
    pub(in crate::report) fn x_tick_of(&self, svg: &mut Svg, class: &str, x: f64, name: &str) {
        let bottom = self.y.ends.0;
        let of = |own: &str| format!("{own} {class}").trim_end().to_owned();
        svg.line(&of("axis"), (x, bottom), (x, bottom + TICK));
        svg.text(&of("quiet"), (x, bottom + 20.0), Anchor::Middle, name);
    }

    /// Place of a point.
    pub(in crate::report) fn at(&self, x: f64, y: f64) -> (f64, f64) {
        (self.x.at(x), self.y.at(y))
    }

    /// A vertical bound with caps at the place `x`.
    pub(in crate::report) fn bound(&self, svg: &mut Svg, class: &str, x: f64, ends: (f64, f64)) {
        let (low, high) = (self.y.at(ends.0), self.y.at(ends.1));
        let class = format!("bound {class}");
        svg.line(&class, (x, low), (x, high));
        for y in [low, high] {
            svg.line(&class, (x - CAP, y), (x + CAP, y));
        }
    }
}

/// Entries from left to right in lines above the plot, the last of which is next to it.
pub(in crate::report) fn legend(svg: &mut Svg, entries: &[LegendEntry<'_>]) {
    for size in LEGENDS {
        let mut drawn = Svg::default();
        let lines = legend_lines(entries, size.entry);
        for (place, line) in lines.iter().rev().enumerate() {
            let y = TOP - LEGEND_ABOVE - size.line * place as f64;
            for &(x, entry) in line {
                legend_entry(&mut drawn, (x, y), entry);
            }
        }
        svg.group(size.attributes, &drawn);
    }
}

/// The entries of each line of a legend with their places; `space` and `letter` are widths.
fn legend_lines<'a, 'b>(
    entries: &'a [LegendEntry<'b>],
    (space, letter): (f64, f64),
) -> Vec<Vec<(f64, &'a LegendEntry<'b>)>> {
    let mut lines: Vec<Vec<(f64, &LegendEntry<'_>)>> = vec![Vec::new()];
    let mut x = LEGEND_LEFT;
    for entry in entries {
        let (LegendEntry::Line(_, _, words)
        | LegendEntry::Point(_, _, words)
        | LegendEntry::Area(_, words)) = entry;
        let width = space + letter * words.chars().count() as f64;
        if x + width > WIDTH + 10.0 && x > LEGEND_LEFT {
            x = LEGEND_LEFT;
            lines.push(Vec::new());
        }
        if let Some(line) = lines.last_mut() {
            line.push((x, entry));
        }
        x += width;
    }
    lines
}

fn legend_entry(svg: &mut Svg, (x, y): (f64, f64), entry: &LegendEntry<'_>) {
    let words = match entry {
        LegendEntry::Line(class, mark, words) => {
            svg.line(&format!("curve {class}"), (x, y - 4.0), (x + 24.0, y - 4.0));
            if let Some(mark) = mark {
                mark.draw(svg, class, (x + 12.0, y - 4.0), "");
            }
            words
        }
        LegendEntry::Point(class, mark, words) => {
            mark.draw(svg, class, (x + 12.0, y - 4.0), "");
            words
        }
        LegendEntry::Area(class, words) => {
            let class = format!("{class} swatch");
            svg.rectangle(&class, (x, y - 10.0), (x + 24.0, y + 1.0), "");
            words
        }
    };
    svg.text("small", (x + 30.0, y), Anchor::Start, words);
}
