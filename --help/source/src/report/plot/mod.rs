//! Plots as SVG: axes, marks and styles, readable in light and dark and in print.

mod axis;
mod frame;
mod style;
mod svg;

pub(super) use axis::{Axis, Scale, nice_top};
pub(super) use frame::{Frame, LegendEntry, Mark, SIDES, TOP, WIDTH, legend};
pub(super) use style::{page_style, standalone_style};
pub(super) use svg::{Anchor, Svg, escaped};
