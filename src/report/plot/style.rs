//! One style of all plots: what the page and a plot by itself look like, from the same tables.
//!
//! Hues are those of Okabe & Ito (2008), which readers with any colour vision tell apart; lines also
//! differ by their dashes and marks by their shape, for print without colour.

use std::fmt::Write;

/// Colours: name, in light, in dark.
const COLOURS: [(&str, &str, &str); 16] = [
    ("paper", "#ffffff", "#15191f"),
    ("panel", "#f6f8fa", "#1c222a"),
    ("ink", "#1b2733", "#e8ecf1"),
    ("quiet", "#566573", "#9fadbb"),
    ("grid", "#dfe5ea", "#434e5b"),
    ("median", "#0072b2", "#56b4e9"),
    ("band", "#566573", "#d5e0ea"),
    ("high", "#d55e00", "#ff8a3d"),
    ("extreme", "#8f2d6b", "#e58fc4"),
    ("tuned", "#1b2733", "#e8ecf1"),
    ("stick", "#0072b2", "#3d8fc4"),
    ("slip", "#e69f00", "#f0b429"),
    ("open", "#8f2d6b", "#d979b4"),
    ("good", "#1a7f4b", "#4cc38a"),
    ("look", "#a08600", "#e3c341"),
    ("bad", "#a4161a", "#ff6b6b"),
];

/// Rules of the classes of a plot; `$name` stands for a colour.
const RULES: &[(&str, &str)] = &[
    (
        "text",
        "fill:$ink;stroke:none;font-size:13px;font-family:system-ui,-apple-system,'Segoe UI',Roboto,'Helvetica Neue',Arial,sans-serif",
    ),
    ("text.quiet", "fill:$quiet"),
    ("text.small", "font-size:11.5px"),
    ("text.strong", "font-weight:600"),
    (".grid", "stroke:$grid;stroke-width:1;fill:none"),
    (".axis", "stroke:$quiet;stroke-width:1;fill:none"),
    (".panel", "fill:$panel;stroke:none"),
    (".band", "fill:$band;fill-opacity:.22;stroke:none"),
    (
        ".curve",
        "fill:none;stroke-width:2;stroke-linejoin:round;stroke-linecap:round",
    ),
    (".curve.median", "stroke:$median"),
    (".curve.high", "stroke:$high"),
    (".curve.extreme", "stroke:$extreme"),
    (
        ".curve.tuned",
        "stroke:$tuned;stroke-dasharray:6 4;stroke-width:1.6",
    ),
    (".curve.quiet", "stroke:$quiet;stroke-width:1.4"),
    (
        ".curve.stuck",
        "stroke:$quiet;stroke-width:1.4;stroke-dasharray:7 4",
    ),
    (
        ".curve.slide",
        "stroke:$quiet;stroke-width:2;stroke-dasharray:.1 4.5",
    ),
    (
        ".curve.limit",
        "stroke:$quiet;stroke-width:2.8;stroke-dasharray:.1 7.5",
    ),
    (
        ".curve.doubt",
        "stroke:$look;stroke-width:2.2;stroke-dasharray:5 3",
    ),
    (".curve.touch", "stroke:$slip;stroke-width:3"),
    (".curve.pick", "stroke:$ink"),
    (".bound", "fill:none;stroke-width:1.6"),
    (".bound.median", "stroke:$median"),
    (".bound.high", "stroke:$high"),
    (".bound.extreme", "stroke:$extreme"),
    (".bound.pick", "stroke:$ink"),
    (
        ".bound.doubt",
        "stroke:$look;stroke-width:2.2;stroke-dasharray:5 3",
    ),
    (".stem", "fill:none;stroke-width:3.5;stroke-opacity:.45"),
    (".stem.pick", "stroke:$ink"),
    (".stem.quiet", "stroke:$quiet"),
    (".mark", "stroke:$paper;stroke-width:1.2"),
    (".mark.median", "fill:$median"),
    (".mark.high", "fill:$high"),
    (".mark.extreme", "fill:$extreme"),
    (".mark.tuned", "fill:$paper;stroke:$tuned;stroke-width:1.5"),
    (".mark.pick", "fill:$ink"),
    (".mark.quiet", "fill:$quiet"),
    (".mark.hollow", "fill:$paper;stroke-width:1.6"),
    (".mark.hollow.median", "stroke:$median"),
    (".mark.hollow.high", "stroke:$high"),
    (".mark.hollow.extreme", "stroke:$extreme"),
    // Both pointers are of one size: an outline of the paper would make the filled one smaller.
    (".mark.lowest", "fill:$ink;stroke:$ink;stroke-width:1.5"),
    (".mark.could", "fill:$paper;stroke:$ink;stroke-width:1.5"),
    (".aim", "stroke:$ink;stroke-width:1;stroke-opacity:.55"),
    (".gap", "fill:$paper;stroke:none"),
    (".bar", "fill:$median;fill-opacity:.75;stroke:none"),
    (".bar.peak", "fill:$ink;fill-opacity:1"),
    (".bar.up", "fill:$quiet;fill-opacity:.65"),
    (".bar.down", "fill:$quiet;fill-opacity:.65"),
    (".cell", "stroke:$paper;stroke-width:1"),
    (".cell.stick", "fill:$stick"),
    (".cell.slip0", "fill:$slip;fill-opacity:.3"),
    (".cell.slip1", "fill:$slip;fill-opacity:.55"),
    (".cell.slip2", "fill:$slip;fill-opacity:.8"),
    (".cell.slip3", "fill:$slip"),
    (".cell.separation", "fill:$open"),
    (
        ".mesh",
        "fill:none;stroke:$quiet;stroke-width:.6;stroke-opacity:.55",
    ),
    (".node", "fill:$quiet;stroke:none"),
    (".node.ring", "fill:$median"),
    (".node.damper", "fill:$good"),
    (".touch", "fill:$slip;stroke:$ink;stroke-width:.8"),
    // An area of a legend, which may be faint by itself.
    (".swatch", "stroke:$quiet;stroke-width:1"),
];

/// Rules for narrow pages, where a drawing is scaled down.
const NARROW: &str = "@media (max-width:600px){svg.plot text{font-size:19px}svg.plot text.small{font-size:18px}svg.plot text.quiet{font-size:18px}svg.plot g.wide,svg.plot .squeezed{display:none}svg.plot g.narrow{display:inline}}";

/// Style sheet of the page: colours as variables for light, dark and print, and the classes of the plots.
pub(in crate::report) fn page_style() -> String {
    let (mut light, mut dark, mut rules) = (String::new(), String::new(), String::new());
    // Writing to a String cannot fail.
    for (name, in_light, in_dark) in COLOURS {
        let _ = write!(light, "--{name}:{in_light};");
        let _ = write!(dark, "--{name}:{in_dark};");
    }
    for (selector, rule) in RULES {
        let _ = writeln!(rules, "svg.plot {selector}{{{}}}", variables_in(rule));
    }
    format!(
        ":root{{color-scheme:light dark;{light}}}\n\
         @media screen and (prefers-color-scheme:dark){{:root{{{dark}}}}}\n\
         {rules}{NARROW}\n"
    )
}

/// Style sheet of a plot by itself, with its colours written out: not every program that shows SVG knows
/// variables.
pub(in crate::report) fn standalone_style() -> String {
    let mut rules = String::new();
    for (selector, rule) in RULES {
        let _ = writeln!(rules, "{selector}{{{}}}", light_in(rule));
    }
    rules
}

/// `rule` with its colours as variables of the page.
fn variables_in(rule: &str) -> String {
    replaced(rule, |name, _| format!("var(--{name})"))
}

/// `rule` with its colours in light.
fn light_in(rule: &str) -> String {
    replaced(rule, |_, light| light.to_owned())
}

fn replaced(rule: &str, colour: impl Fn(&str, &str) -> String) -> String {
    COLOURS
        .iter()
        .fold(rule.to_owned(), |rule, (name, light, _)| {
            rule.replace(&format!("${name}"), &colour(name, light))
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_colour_of_a_rule_is_in_the_table() {
        for style in [page_style(), standalone_style()] {
            assert!(!style.contains('$'), "{style}");
        }
        assert!(!standalone_style().contains("var("));
    }

    /// Contrast of WCAG 2.1 between what is read and what it stands on.
    #[test]
    fn text_and_lines_stand_out_in_light_and_dark() {
        let luminance = |colour: &str| {
            let channel = |at: usize| {
                let value = u8::from_str_radix(&colour[at..at + 2], 16).expect("two digits");
                let c = f64::from(value) / 255.0;
                if c <= 0.03928 {
                    c / 12.92
                } else {
                    ((c + 0.055) / 1.055).powf(2.4)
                }
            };
            0.2126 * channel(1) + 0.7152 * channel(3) + 0.0722 * channel(5)
        };
        let contrast = |a: &str, b: &str| {
            let (a, b) = (luminance(a), luminance(b));
            (a.max(b) + 0.05) / (a.min(b) + 0.05)
        };
        let of = |name: &str| {
            COLOURS
                .iter()
                .find(|(own, ..)| *own == name)
                .expect("a colour")
        };
        for (name, least) in [
            ("ink", 7.0),
            ("quiet", 4.5),
            ("median", 3.0),
            ("high", 3.0),
            ("extreme", 3.0),
            ("good", 3.0),
            ("look", 3.0),
            ("bad", 3.0),
        ] {
            let (_, own_light, own_dark) = of(name);
            // Answers, figures and tables of code stand on panels.
            for (_, light, dark) in [of("paper"), of("panel")] {
                assert!(contrast(light, own_light) >= least, "{name} in light");
                assert!(contrast(dark, own_dark) >= least, "{name} in dark");
            }
        }
    }
}
