//! A picture of the sector: its bodies, where they touch, where it is excited and observed.

use std::collections::BTreeSet;

use super::bodies::body_word;
use super::{Figure, FigureName};
use crate::model::sector::Body;
use crate::report::plot::{Anchor, LegendEntry, Mark, Svg, TOP, WIDTH, legend};
use crate::report::{ContactPlace, ModelSection, SectorPicture, StudyReport};

/// Lower end of the views.
const BOTTOM: f64 = 352.0;
/// Height of the drawing.
const HEIGHT: f64 = 404.0;
/// Margin beside and between the views.
const MARGIN: f64 = 24.0;
/// Largest scale, user units per m, for a sector that is a point.
const LARGEST: f64 = 1e6;
/// Distance below which points of one body are drawn as one, user units.
const FINE: f64 = 1.4;
/// Lengths of the scale, m.
const LENGTHS_M: [f64; 10] = [1e-3, 2e-3, 5e-3, 1e-2, 2e-2, 5e-2, 0.1, 0.2, 0.5, 1.0];

/// Horizontal and vertical place of a position in a view, m.
type View<'a> = &'a dyn Fn([f64; 3]) -> (f64, f64);

/// The sector from the side and along the axis; one of a few masses along the axis alone.
pub(super) fn of_model(report: &StudyReport) -> Option<Figure> {
    let section = report.model.section()?;
    let sector = &section.sector;
    // The sector's middle points upwards.
    let (mut cos, mut sin) = (0.0, 0.0);
    for node in &sector.nodes {
        let [x, y, _] = node.position_m;
        let radius = x.hypot(y).max(f64::MIN_POSITIVE);
        cos += x / radius;
        sin += y / radius;
    }
    let length = f64::hypot(cos, sin).max(f64::MIN_POSITIVE);
    let (cos, sin) = (cos / length, sin / length);
    let from_side = |[x, y, z]: [f64; 3]| (z, x.hypot(y));
    let along_axis = |[x, y, _]: [f64; 3]| (sin * x - cos * y, cos * x + sin * y);
    let views: Vec<(&str, View<'_>)> = if sector.is_of_masses {
        vec![("along the axis", &along_axis)]
    } else {
        vec![
            ("from the side", &from_side),
            ("along the axis", &along_axis),
        ]
    };
    let boxes: Vec<[f64; 4]> = views
        .iter()
        .map(|(_, view)| bounds(sector, *view))
        .collect::<Option<_>>()?;
    // One scale for all views.
    let width: f64 = boxes.iter().map(|own| own[1] - own[0]).sum();
    let height = boxes.iter().map(|own| own[3] - own[2]).fold(0.0, f64::max);
    let room = WIDTH - MARGIN * (views.len() as f64 + 1.0);
    let scale = (room / width).min((BOTTOM - TOP) / height).min(LARGEST);
    let mut left = 0.5 * (WIDTH - scale * width - MARGIN * (views.len() as f64 - 1.0));
    let mut svg = Svg::default();
    for ((name, view), own) in views.iter().zip(&boxes) {
        let bottom = BOTTOM - 0.5 * (BOTTOM - TOP - scale * (own[3] - own[2]));
        let at = |position: [f64; 3]| {
            let (x, y) = view(position);
            (left + scale * (x - own[0]), bottom - scale * (y - own[2]))
        };
        draw(&mut svg, sector, &at);
        let middle = left + 0.5 * scale * (own[1] - own[0]);
        svg.text("small quiet", (middle, BOTTOM + 17.0), Anchor::Middle, name);
        left += scale * (own[1] - own[0]) + MARGIN;
    }
    scale_bar(&mut svg, scale);
    legend(&mut svg, &entries(report, section));
    let echo = &section.echo.model;
    Some(Figure {
        name: FigureName::Sector,
        title: "A sector with its contact".to_owned(),
        setting: format!("model {}, {} sectors", echo.name, echo.sectors),
        caption: caption(section),
        height: HEIGHT,
        body: svg.into_body(),
    })
}

/// Least and largest horizontal, least and largest vertical place of the nodes.
fn bounds(sector: &SectorPicture, view: View<'_>) -> Option<[f64; 4]> {
    let nodes = sector.nodes.iter().map(|node| node.position_m);
    let contacts = sector.contacts.iter();
    let touching = contacts.flat_map(|own| [Some(own.first_m), own.second_m]);
    let places = nodes.chain(touching.flatten()).map(view);
    let bounds = places.fold(
        [
            f64::INFINITY,
            f64::NEG_INFINITY,
            f64::INFINITY,
            f64::NEG_INFINITY,
        ],
        |own, (x, y)| [own[0].min(x), own[1].max(x), own[2].min(y), own[3].max(y)],
    );
    bounds.iter().all(|end| end.is_finite()).then_some(bounds)
}

fn draw(svg: &mut Svg, sector: &SectorPicture, at: &dyn Fn([f64; 3]) -> (f64, f64)) {
    let (line, radius) = if sector.is_of_masses {
        ("curve quiet", 9.0)
    } else {
        ("mesh", 1.1)
    };
    for &(a, b) in &sector.links {
        let ends = [a, b].map(|place| at(sector.nodes[place].position_m));
        if (ends[0].0 - ends[1].0).hypot(ends[0].1 - ends[1].1) > FINE {
            svg.polyline(line, &ends);
        }
    }
    let mut drawn = BTreeSet::new();
    for node in &sector.nodes {
        let (x, y) = at(node.position_m);
        let class = class_of(node.body);
        if drawn.insert((class, (x / FINE).round() as i64, (y / FINE).round() as i64)) {
            svg.circle(class, (x, y), radius, "");
        }
    }
    for pair in &sector.contacts {
        contact(svg, pair, at);
    }
    for (class, places, mark) in [
        ("extreme", &sector.observed_m, Mark::Triangle),
        ("pick", &sector.forced_m, Mark::Diamond),
    ] {
        for &place in places {
            mark.draw(svg, class, at(place), "");
        }
    }
}

/// A pair in contact: a mark where it touches, between its sides, and what joins them where they lie apart.
fn contact(svg: &mut Svg, pair: &ContactPlace, at: &dyn Fn([f64; 3]) -> (f64, f64)) {
    let first = at(pair.first_m);
    let second = pair.second_m.map_or(first, at);
    let middle = (
        f64::midpoint(first.0, second.0),
        f64::midpoint(first.1, second.1),
    );
    if (first.0 - second.0).hypot(first.1 - second.1) > FINE {
        svg.polyline("curve touch", &[first, second]);
    }
    let words = format!("{:.2} % of the contact stiffness", 100.0 * pair.weight);
    svg.circle("touch", middle, 3.2, &words);
}

/// A length to compare with, below the views.
fn scale_bar(svg: &mut Svg, scale: f64) {
    let fitting = LENGTHS_M.iter().rev().find(|&&own| scale * own <= 130.0);
    let Some(&length) = fitting else {
        return;
    };
    let (left, y) = (MARGIN, HEIGHT - 10.0);
    svg.line("axis", (left, y), (left + scale * length, y));
    let words = format!("{} mm", (1e6 * length).round() / 1e3);
    let at = (left + scale * length + 8.0, y + 4.0);
    svg.text("small quiet", at, Anchor::Start, &words);
}

fn class_of(body: Body) -> &'static str {
    match body {
        Body::Blisk => "node",
        Body::Ring => "node ring",
        Body::Damper => "node damper",
    }
}

fn entries(report: &StudyReport, section: &ModelSection) -> Vec<LegendEntry<'static>> {
    let sector = &section.sector;
    let mut entries = Vec::new();
    for body in [Body::Blisk, Body::Ring, Body::Damper] {
        if sector.nodes.iter().any(|node| node.body == body) {
            entries.push(LegendEntry::Area(class_of(body), body_word(report, body)));
        }
    }
    if !sector.contacts.is_empty() {
        entries.push(LegendEntry::Area("touch", "contact"));
    }
    entries.push(LegendEntry::Point("pick", Mark::Diamond, "force"));
    entries.push(LegendEntry::Point("extreme", Mark::Triangle, "observed"));
    entries
}

fn caption(section: &ModelSection) -> String {
    let sector = &section.sector;
    let shape = if sector.is_of_masses {
        "Discs: masses, at places without a meaning; lines: springs, those to the ground left out. The masses of the next \
         sector stand where springs reach them."
    } else {
        "Points: nodes of the sector, those of both cyclic faces included, in one scale; lines: neighbours in the mesh."
    };
    let contacts = match sector.contacts.len() {
        0 => "It has no contact.".to_owned(),
        1 => "It has one contact pair.".to_owned(),
        pairs => format!("It has {pairs} contact pairs."),
    };
    let ground = if sector.contacts.iter().any(|pair| pair.second_m.is_none()) {
        " They press on the ground."
    } else {
        ""
    };
    format!("{shape} {contacts}{ground}")
}
