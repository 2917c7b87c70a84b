//! SVG elements written one after the other; colours come from classes alone.

use std::fmt::Write;

use crate::report::visible;

/// Which part of a text stands at its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::report) enum Anchor {
    Start,
    Middle,
    End,
}

impl Anchor {
    fn name(self) -> &'static str {
        match self {
            Self::Start => "start",
            Self::Middle => "middle",
            Self::End => "end",
        }
    }
}

/// The elements of a drawing.
#[derive(Debug, Clone, Default)]
pub(in crate::report) struct Svg {
    body: String,
}

impl Svg {
    pub(in crate::report) fn into_body(self) -> String {
        self.body
    }

    fn element(&mut self, line: std::fmt::Arguments<'_>) {
        // Writing to a String cannot fail.
        let _ = self.body.write_fmt(line);
        self.body.push('\n');
    }

    /// Elements that share attributes.
    pub(in crate::report) fn group(&mut self, attributes: &str, inside: &Self) {
        self.element(format_args!("<g {attributes}>"));
        self.body.push_str(&inside.body);
        self.element(format_args!("</g>"));
    }

    pub(in crate::report) fn line(&mut self, class: &str, from: (f64, f64), to: (f64, f64)) {
        self.element(format_args!(
            r#"<line class="{class}" x1="{}" y1="{}" x2="{}" y2="{}"/>"#,
            px(from.0),
            px(from.1),
            px(to.0),
            px(to.1)
        ));
    }

    /// A line through points; nothing for fewer than two.
    pub(in crate::report) fn polyline(&mut self, class: &str, points: &[(f64, f64)]) {
        if points.len() > 1 {
            self.element(format_args!(
                r#"<polyline class="{class}" points="{}"/>"#,
                places(points)
            ));
        }
    }

    pub(in crate::report) fn polygon(&mut self, class: &str, points: &[(f64, f64)]) {
        if points.len() > 2 {
            self.element(format_args!(
                r#"<polygon class="{class}" points="{}"/>"#,
                places(points)
            ));
        }
    }

    /// A rectangle between two corners, with what is shown where a pointer rests on it.
    pub(in crate::report) fn rectangle(
        &mut self,
        class: &str,
        from: (f64, f64),
        to: (f64, f64),
        words: &str,
    ) {
        let (x, y) = (from.0.min(to.0), from.1.min(to.1));
        let (width, height) = ((to.0 - from.0).abs(), (to.1 - from.1).abs());
        self.element(format_args!(
            r#"<rect class="{class}" x="{}" y="{}" width="{}" height="{}">{}</rect>"#,
            px(x),
            px(y),
            px(width),
            px(height),
            hint(words)
        ));
    }

    pub(in crate::report) fn circle(
        &mut self,
        class: &str,
        at: (f64, f64),
        radius: f64,
        words: &str,
    ) {
        self.element(format_args!(
            r#"<circle class="{class}" cx="{}" cy="{}" r="{}">{}</circle>"#,
            px(at.0),
            px(at.1),
            px(radius),
            hint(words)
        ));
    }

    /// A closed shape with what is shown where a pointer rests on it.
    pub(in crate::report) fn shape(&mut self, class: &str, points: &[(f64, f64)], words: &str) {
        self.element(format_args!(
            r#"<polygon class="{class}" points="{}">{}</polygon>"#,
            places(points),
            hint(words)
        ));
    }

    pub(in crate::report) fn text(
        &mut self,
        class: &str,
        at: (f64, f64),
        anchor: Anchor,
        words: &str,
    ) {
        self.element(format_args!(
            r#"<text class="{class}" x="{}" y="{}" text-anchor="{}">{}</text>"#,
            px(at.0),
            px(at.1),
            anchor.name(),
            escaped(words)
        ));
    }

    /// A text that reads upwards.
    pub(in crate::report) fn upright(&mut self, class: &str, at: (f64, f64), words: &str) {
        self.element(format_args!(
            r#"<text class="{class}" text-anchor="middle" transform="translate({} {}) rotate(-90)">{}</text>"#,
            px(at.0),
            px(at.1),
            escaped(words)
        ));
    }
}

fn hint(words: &str) -> String {
    if words.is_empty() {
        String::new()
    } else {
        format!("<title>{}</title>", escaped(words))
    }
}

fn places(points: &[(f64, f64)]) -> String {
    let written: Vec<String> = points
        .iter()
        .map(|&(x, y)| format!("{},{}", px(x), px(y)))
        .collect();
    written.join(" ")
}

/// A length in user units with two decimals at most.
fn px(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" {
        "0".to_owned()
    } else {
        text.to_owned()
    }
}

/// `text` as it stands in HTML and SVG, whose XML has no place for control characters.
pub(in crate::report) fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in visible(text).chars() {
        match character {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            other => escaped.push(other),
        }
    }
    escaped
}
