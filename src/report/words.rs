//! Words, units and number formats of everything that people read: texts for a terminal, tables and figures of a report.

use super::{ScenarioSummary, StudySummary};
use crate::population::monte_carlo::{LoadCaseName, TUNED_RECEPTANCES};

/// Units of length, the largest first: name, metres, and the length in m from which on it is taken. Amplitudes
/// of blades are in µm, so that one text does not say mm where another says µm.
const LENGTH_UNITS: [(&str, f64, f64); 4] = [
    ("m", 1.0, 100.0),
    ("mm", 1e-3, 0.1),
    ("µm", 1e-6, 1e-8),
    ("nm", 1e-9, 0.0),
];

/// The unit in which amplitudes are shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LengthUnit {
    name: &'static str,
    metres: f64,
}

impl LengthUnit {
    /// The unit for `lengths_m` by the smallest of them: µm from 0.01 µm to 10 cm, and without any.
    #[must_use]
    pub fn of(lengths_m: impl IntoIterator<Item = f64>) -> Self {
        let smallest = lengths_m.into_iter().reduce(f64::min).unwrap_or(1e-6);
        let fits = |unit: &&(&str, f64, f64)| smallest >= unit.2;
        let last = LENGTH_UNITS[LENGTH_UNITS.len() - 1];
        let (name, metres, _) = *LENGTH_UNITS.iter().find(fits).unwrap_or(&last);
        Self { name, metres }
    }

    /// The unit of the tuned amplitudes and means of a study.
    pub(super) fn of_summary(summary: &StudySummary) -> Self {
        let amplitudes = summary
            .scenarios
            .iter()
            .flat_map(|scenario| [scenario.tuned_amplitude_m, scenario.peak_amplitude_m.mean]);
        Self::of(amplitudes.flatten())
    }

    /// Metres per unit.
    pub(super) fn metres(self) -> f64 {
        self.metres
    }

    /// Name of the unit.
    pub(super) fn name(self) -> &'static str {
        self.name
    }

    /// A length in m, four digits in the unit.
    #[must_use]
    pub fn length(self, metres: f64) -> String {
        format!("{} {}", self.number(metres), self.name)
    }

    /// A length in m, seven digits in the unit, where small differences matter.
    #[must_use]
    pub fn precise(self, metres: f64) -> String {
        format!("{} {}", digits(metres / self.metres, 7), self.name)
    }

    /// A length in m, four digits in the unit, without its name.
    pub(super) fn number(self, metres: f64) -> String {
        four_digits(metres / self.metres)
    }
}

/// `value` with four significant digits, or as a whole number.
pub(super) fn four_digits(value: f64) -> String {
    digits(value, 4)
}

/// Size below which a number is written with an exponent.
const SMALL: f64 = 1e-4;

/// `value` with `count` significant digits, or as a whole number.
fn digits(value: f64, count: i32) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if value.abs() < SMALL {
        let decimals = (count - 1).max(0) as usize;
        return format!("{value:.decimals$e}");
    }
    let before_point = value.abs().log10().floor() as i32;
    let decimals = (count - 1 - before_point).max(0) as usize;
    format!("{value:.decimals$}")
}

/// `value` with at most six decimals and no trailing zeros.
pub(super) fn trimmed(value: f64) -> String {
    let text = format!("{value:.6}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// What rows are solved on: a basis by its name, or the receptances of the tuned wheel, which need none.
pub(crate) fn basis_words(basis: &str) -> String {
    if basis == TUNED_RECEPTANCES {
        "tuned receptances (no reduction basis)".to_owned()
    } else {
        format!("basis {basis}")
    }
}

/// Load case, where there is one, and engine order.
pub(crate) fn excitation(load_case: Option<LoadCaseName>, engine_order: u32) -> String {
    let case = load_case.map_or_else(String::new, |name| format!("load case {name}, "));
    format!("{case}engine order {engine_order}")
}

/// Load case, where there is one, engine order and standard deviation of the blades, or that their patterns are from a
/// file.
pub(super) fn excitation_and_deviation(
    load_case: Option<LoadCaseName>,
    engine_order: u32,
    standard_deviation: Option<f64>,
) -> String {
    let excitation = excitation(load_case, engine_order);
    match standard_deviation {
        Some(deviation) => format!(
            "{excitation}, standard deviation {} %",
            trimmed(100.0 * deviation)
        ),
        None => format!("{excitation}, patterns from a file"),
    }
}

/// A load as written in the study: a number of newtons, or the name of a linear limit.
pub(super) fn load_words(contact: &str, normal_load_n: Option<f64>) -> String {
    normal_load_n.map_or_else(|| contact.to_owned(), |load| load.to_string())
}

/// Letters of a load that is shown as it is written.
const LONGEST_LOAD: usize = 6;

/// A load as written, or with four digits where more are written: those of a rotation have many.
pub(super) fn short_load_words(contact: &str, normal_load_n: Option<f64>) -> String {
    let written = load_words(contact, normal_load_n);
    match normal_load_n {
        Some(newtons) if written.len() > LONGEST_LOAD => trimmed_digits(newtons),
        _ => written,
    }
}

/// A load with its unit: a number of newtons, or the name of a linear limit.
pub(super) fn load_with_unit(contact: &str, normal_load_n: Option<f64>) -> String {
    with_newtons(load_words(contact, normal_load_n), normal_load_n)
}

fn with_newtons(words: String, normal_load_n: Option<f64>) -> String {
    match normal_load_n {
        Some(_) => format!("{words} N"),
        None => words,
    }
}

/// A load with its unit, a number with at most four digits where more are written; or the name of a linear limit.
pub(crate) fn short_load_with_unit(contact: &str, normal_load_n: Option<f64>) -> String {
    with_newtons(short_load_words(contact, normal_load_n), normal_load_n)
}

/// A load with its unit, newtons per sector, since it acts on every sector; or the name of a linear limit.
pub(super) fn load_per_sector(contact: &str, normal_load_n: Option<f64>) -> String {
    let words = load_with_unit(contact, normal_load_n);
    if normal_load_n.is_some() {
        format!("{words} per sector")
    } else {
        words
    }
}

/// The scenarios of these indices by load, engine order and standard deviation; of the last two only what differs
/// within the study.
pub(super) fn scenarios_in_words(summary: &StudySummary, indices: &[usize]) -> String {
    let groups = summary.scenarios.chunk_by(ScenarioSummary::same_group);
    let parts: Vec<String> = groups
        .filter_map(|group| {
            let meant: Vec<&ScenarioSummary> = { group.iter() }
                .filter(|own| indices.contains(&own.scenario))
                .collect();
            let first = meant.first()?;
            let loads = if meant.len() == group.len() && group.len() > 1 {
                "all loads".to_owned()
            } else {
                let loads = { meant.iter() };
                let loads = loads.map(|own| short_load_with_unit(own.contact, own.normal_load_n));
                loads.collect::<Vec<_>>().join(", ")
            };
            let told = told_apart(summary, first).in_full;
            Some(if told.is_empty() {
                loads
            } else {
                format!("{loads} ({told})")
            })
        })
        .collect();
    parts.join("; ")
}

/// What tells a group of scenarios from the others of a study; empty where there is one group alone.
pub(super) struct ToldApart {
    /// With what deviates, for a text of its own.
    pub(super) in_full: String,
    /// Without, for a title.
    pub(super) in_short: String,
}

/// What tells the group of a scenario from the others of the study.
pub(super) fn told_apart(summary: &StudySummary, own: &ScenarioSummary) -> ToldApart {
    let differs = |same: &dyn Fn(&ScenarioSummary) -> bool| !summary.scenarios.iter().all(same);
    let excitations = differs(&|other| {
        other.load_case == own.load_case && other.engine_order == own.engine_order
    });
    let deviations = differs(&|other| other.standard_deviation == own.standard_deviation);
    let deviation = own
        .standard_deviation
        .filter(|_| deviations)
        .map(|deviation| format!("standard deviation {} %", trimmed(100.0 * deviation)));
    let excitation = excitations.then(|| excitation(own.load_case, own.engine_order));
    let with = |deviation: Option<String>| {
        let told: Vec<String> = excitation.clone().into_iter().chain(deviation).collect();
        told.join(", ")
    };
    let of_blades = { deviation.as_ref() }.map(|own| format!("{own} of blade stiffness"));
    ToldApart {
        in_full: with(of_blades),
        in_short: with(deviation),
    }
}

/// How many loads in newtons there are, and which linear solutions, in words. A reader who does not know the wheel reads
/// "limit" as what is allowed.
pub(super) fn loads_and_limits<'a>(
    scenarios: impl IntoIterator<Item = &'a ScenarioSummary>,
) -> String {
    let (mut loads, mut limits) = (0, Vec::new());
    for scenario in scenarios {
        if scenario.normal_load_n.is_some() {
            loads += 1;
        } else {
            limits.push(scenario.contact);
        }
    }
    let counted = |count: usize, word: &str| match count {
        1 => format!("1 {word}"),
        _ => format!("{count} {word}s"),
    };
    let linear = || {
        let counted = counted(limits.len(), "linear solution");
        format!("{counted} ({})", limits.join(", "))
    };
    match (loads, limits.len()) {
        (_, 0) => counted(loads, "load"),
        (0, _) => linear(),
        _ => format!("{} and {}", counted(loads, "load"), linear()),
    }
}

/// A percentile in percent, without needless digits.
pub(super) fn percent_words(percent: f64) -> String {
    trimmed(percent)
}

/// A ratio as percent with two digits that matter.
pub(super) fn share_words(ratio: f64) -> String {
    let percent = 100.0 * ratio;
    if percent == 0.0 {
        return "0 %".to_owned();
    }
    let decimals = (1 - percent.abs().log10().floor() as i32).clamp(0, 4) as usize;
    if percent.abs() < 1e-4 {
        return "below 0.0001 %".to_owned();
    }
    format!("{percent:.decimals$} %")
}

/// A relative change with its sign, like [`share_words`].
pub(super) fn signed_share(change: f64) -> String {
    let sign = if change < 0.0 { "−" } else { "+" };
    format!("{sign}{}", share_words(change.abs()))
}

/// `text` with its units held to their numbers by spaces that do not break.
pub(super) fn tied(text: &str) -> String {
    const UNITS: [&str; 9] = ["%", "N", "MPa", "rpm", "Hz", "m", "mm", "µm", "nm"];
    let mut tied = String::with_capacity(text.len() + 16);
    for word in text.split(' ') {
        if !tied.is_empty() {
            let bare = word.trim_end_matches(['.', ',', ';', ':', ')', ']']);
            let of_number = tied.ends_with(|before: char| before.is_ascii_digit() || before == ']');
            tied.push(if UNITS.contains(&bare) && of_number {
                '\u{a0}'
            } else {
                ' '
            });
        }
        tied.push_str(word);
    }
    tied
}

/// A force in the unit that suits it, four digits without trailing zeros.
pub(super) fn force(newtons: f64) -> String {
    let (scale, unit) = if newtons.abs() < 1e4 {
        (1.0, "N")
    } else if newtons.abs() < 1e7 {
        (1e-3, "kN")
    } else {
        (1e-6, "MN")
    };
    format!("{} {unit}", trimmed_digits(scale * newtons))
}

/// `value` with four significant digits, or as a whole number, without trailing zeros.
fn trimmed_digits(value: f64) -> String {
    let digits = four_digits(value);
    if digits.contains('.') {
        digits
            .trim_end_matches('0')
            .trim_end_matches('.')
            .to_owned()
    } else {
        digits
    }
}

/// A time in the unit that suits it.
pub(crate) fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 1.0 => format!("{s:.3} s"),
        s if s < 120.0 => format!("{s:.1} s"),
        s if s < 7200.0 => format!("{:.1} min", s / 60.0),
        s if s < 172_800.0 => format!("{:.1} h", s / 3600.0),
        s => format!("{:.1} d", s / 86_400.0),
    }
}

/// Columns of a paragraph on a terminal.
const COLUMNS: usize = 80;

/// `text` in lines of at most 80 columns.
pub(super) fn paragraph(text: &str) -> String {
    hanging("", "", text)
}

/// `text` after `head` in lines of at most 80 columns, those after the first behind `margin`.
pub(super) fn hanging(head: &str, margin: &str, text: &str) -> String {
    let mut lines = vec![head.to_owned()];
    let mut used = head.chars().count();
    let mut empty = true;
    for word in text.split_whitespace() {
        let width = word.chars().count();
        let line = lines.len() - 1;
        if empty {
            lines[line].push_str(word);
            used += width;
            empty = false;
        } else if used + 1 + width <= COLUMNS {
            lines[line].push(' ');
            lines[line].push_str(word);
            used += 1 + width;
        } else {
            lines.push(format!("{margin}{word}"));
            used = margin.chars().count() + width;
        }
    }
    lines.join("\n")
}

/// Names with commas, and an `and` before the last.
pub(super) fn listed(names: &[String]) -> String {
    match names {
        [] => String::new(),
        [only] => only.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}
