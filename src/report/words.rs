//! Words and units of a report: the same in its text, its tables and its figures.

use super::summary_text::{Unit, excitation, four_digits, load, trimmed, unit_of};
use super::{GroupReport, StudySummary};

/// The unit in which amplitudes of a report are shown.
#[derive(Clone, Copy)]
pub(super) struct Quantities {
    unit: Unit,
}

impl Quantities {
    pub(super) fn of(summary: &StudySummary) -> Self {
        Self {
            unit: unit_of(&summary.scenarios),
        }
    }

    /// Metres per unit.
    pub(super) fn metres(self) -> f64 {
        self.unit.metres
    }

    /// Name of the unit.
    pub(super) fn name(self) -> &'static str {
        match self.unit.name {
            "um" => "µm",
            other => other,
        }
    }

    /// An amplitude in m, four digits in the unit.
    pub(super) fn amplitude(self, metres: f64) -> String {
        format!("{} {}", four_digits(metres / self.unit.metres), self.name())
    }

    /// The same without the unit.
    pub(super) fn number(self, metres: f64) -> String {
        four_digits(metres / self.unit.metres)
    }
}

/// A load as written in the study: a number of newtons, or the name of a linear limit.
pub(super) fn load_words(contact: &str, normal_load_n: Option<f64>) -> String {
    load(contact, normal_load_n)
}

/// The same with its unit.
pub(super) fn load_with_unit(contact: &str, normal_load_n: Option<f64>) -> String {
    let words = load_words(contact, normal_load_n);
    if normal_load_n.is_some() {
        format!("{words} N")
    } else {
        words
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

/// Load case, engine order and standard deviation of a group, in words.
#[must_use]
pub fn setting(group: &GroupReport) -> String {
    let excitation = excitation(group.load_case, group.engine_order);
    match group.standard_deviation {
        Some(deviation) => format!(
            "{excitation}, standard deviation {} %",
            trimmed(100.0 * deviation)
        ),
        None => format!("{excitation}, patterns from a file"),
    }
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
