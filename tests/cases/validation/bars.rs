//! Verdicts as they are stored, the bars known not to be met, and what keeps a check from passing.

use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::identity::Identity;

/// The verdicts of a report, beside it.
pub const VERDICTS: &str = "verdicts.toml";
/// The bars that are known not to be met, and what else is known and open; written by hand.
pub const OPEN_BARS: &str = "open_bars.toml";
/// The report.
pub const REPORT: &str = "report.md";
/// Share by which a figure may exceed the one listed before it counts as worse: listed ones are rounded.
const ROUNDING: f64 = 1e-3;

/// What a verdict is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// The program against a stated bar, which it has to meet.
    Bar,
    /// A claim about ring dampers, which these models confirm or refute.
    Claim,
}

/// A judgement computed from the numbers of a section.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Verdict {
    /// Name that stays the same: that of the section, a slash, that of the bar.
    pub id: String,
    /// What it is about.
    pub kind: Kind,
    /// Whether the bar is met, or the claim confirmed.
    pub met: bool,
    /// What is judged; the lower, the better. A claim has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub figure: Option<f64>,
    /// Highest figure that meets the bar.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bar: Option<f64>,
    /// The line of the report.
    pub text: String,
}

impl Verdict {
    pub fn word(&self) -> &'static str {
        match (self.kind, self.met) {
            (Kind::Bar, true) => "bar met",
            (Kind::Bar, false) => "BAR NOT MET",
            (Kind::Claim, true) => "claim confirmed",
            (Kind::Claim, false) => "claim refuted",
        }
    }

    /// Its row of the summary.
    pub fn row(&self) -> String {
        format!("| `{}` | **{}** | {} |\n", self.id, self.word(), self.text)
    }

    fn is_missed(&self) -> bool {
        self.kind == Kind::Bar && !self.met
    }
}

/// The verdicts of one report.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Verdicts {
    /// What was built, and when the report was made.
    pub identity: Identity,
    #[serde(rename = "verdict")]
    pub verdicts: Vec<Verdict>,
}

/// A bar that is known not to be met.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OpenBar {
    pub id: String,
    /// The figure it has today, which may fall but not rise.
    pub figure: f64,
    /// The issue that clears it.
    pub issue: u32,
    pub why: String,
    /// A long test that fails for it, which `.ci/long` judges; none: it is a bar of this report.
    #[serde(default)]
    pub test: Option<String>,
}

/// What is known and open and is no bar of the report.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Known {
    pub id: String,
    /// The issue that clears it.
    pub issue: u32,
    pub what: String,
    /// How it was measured.
    pub measured: String,
}

/// What is listed by hand.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Open {
    #[serde(default, rename = "bar")]
    pub bars: Vec<OpenBar>,
    #[serde(default)]
    pub known: Vec<Known>,
}

impl Open {
    pub fn read(folder: &Path) -> Self {
        let path = folder.join(OPEN_BARS);
        let text = std::fs::read_to_string(&path).unwrap();
        toml::from_str(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    }
}

/// The first line of a report.
pub fn headline(verdicts: &[Verdict], open: &Open) -> String {
    let bars = verdicts.iter().filter(|own| own.kind == Kind::Bar).count();
    let missed = verdicts.iter().filter(|own| own.is_missed()).count();
    format!(
        "# Validation report: {missed} of {bars} bars not met, {} listed as open, {} more findings known and open",
        open.bars.len(),
        open.known.len()
    )
}

/// Why the verdicts do not pass: bars that are not met and not listed, listed ones that are met, that became worse
/// or that do not exist. Empty if they pass.
pub fn problems(verdicts: &[Verdict], open: &Open) -> Vec<String> {
    let mut found = Vec::new();
    let mut ids = BTreeSet::new();
    for own in verdicts {
        if !ids.insert(own.id.as_str()) {
            found.push(format!("{}: two verdicts have this name", own.id));
        }
    }
    let mut listed = BTreeSet::new();
    for bar in &open.bars {
        if !listed.insert(bar.id.as_str()) {
            found.push(format!("{}: listed twice in {OPEN_BARS}", bar.id));
        }
        if bar.test.is_some() {
            continue;
        }
        let Some(own) = verdicts.iter().find(|own| own.id == bar.id) else {
            found.push(format!("{}: listed in {OPEN_BARS}, but no verdict", bar.id));
            continue;
        };
        if !own.is_missed() {
            found.push(format!(
                "{}: met; its entry in {OPEN_BARS} has to go",
                bar.id
            ));
            continue;
        }
        // A figure that is not a number is worse than any.
        let highest = bar.figure * (1.0 + ROUNDING);
        if !own.figure.is_some_and(|figure| figure <= highest) {
            found.push(format!(
                "{}: worse than listed in {OPEN_BARS}: {:?} for {}",
                bar.id, own.figure, bar.figure
            ));
        }
    }
    for own in verdicts.iter().filter(|own| own.is_missed()) {
        if !listed.contains(own.id.as_str()) {
            found.push(format!(
                "{}: not met and not listed in {OPEN_BARS}: {}",
                own.id, own.text
            ));
        }
    }
    found
}

/// Why a folder with a report, its verdicts and the open bars does not pass; `readme` is the page with the table of
/// the quickstart, made by the same command.
pub fn problems_of_folder(folder: &Path, readme: &Path) -> Vec<String> {
    let read = |path: &Path| {
        std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    };
    let stored: Verdicts = toml::from_str(&read(&folder.join(VERDICTS))).unwrap();
    let open = Open::read(folder);
    let report = read(&folder.join(REPORT));
    let mut found = problems(&stored.verdicts, &open);
    let first = report.lines().next().unwrap_or_default();
    let expected = headline(&stored.verdicts, &open);
    if first != expected {
        found.push(format!(
            "{REPORT}: its first line is not {expected:?}; make the report anew"
        ));
    }
    for own in &stored.verdicts {
        if !report.contains(&own.row()) {
            found.push(format!("{REPORT}: it lacks the verdict {}", own.id));
        }
    }
    let judged = report
        .lines()
        .filter(|line| line.starts_with("| `"))
        .count();
    let rows = stored.verdicts.len() + open.bars.len() + open.known.len();
    if judged != rows {
        found.push(format!("{REPORT}: {judged} judged lines, {rows} stored"));
    }
    let made = stored.identity.line();
    for (name, text) in [
        (REPORT.to_owned(), report),
        (readme.display().to_string(), read(readme)),
    ] {
        if !text.contains(&made) {
            found.push(format!("{name}: not made with the verdicts: {made}"));
        }
    }
    found
}

/// The tables of what is known and open.
pub fn known_and_open(open: &Open) -> String {
    let mut text = format!(
        "Bars that are not met today, from `{OPEN_BARS}`: a check fails when one of them is met, when its figure rises, and when a bar misses that is not \
         among them.\n\n| bar | figure | issue | why |\n| --- | --- | --- | --- |\n"
    );
    for bar in &open.bars {
        writeln!(
            text,
            "| `{}` | {} | {} | {} |",
            bar.id, bar.figure, bar.issue, bar.why
        )
        .unwrap();
    }
    text += "\nFindings that no bar of this report holds yet. Their figures were measured by the way named, not by the command of this report.\n\n\
             | finding | issue | what | measured |\n| --- | --- | --- | --- |\n";
    for known in &open.known {
        writeln!(
            text,
            "| `{}` | {} | {} | {} |",
            known.id, known.issue, known.what, known.measured
        )
        .unwrap();
    }
    text
}

#[cfg(test)]
mod tests {
    use super::super::super::support::package;
    use super::*;

    fn bar(id: &str, figure: f64, bar: f64) -> Verdict {
        Verdict {
            id: id.to_owned(),
            kind: Kind::Bar,
            met: figure <= bar,
            figure: Some(figure),
            bar: Some(bar),
            text: format!("{figure} for {bar}"),
        }
    }

    fn claim(id: &str, met: bool) -> Verdict {
        Verdict {
            id: id.to_owned(),
            kind: Kind::Claim,
            met,
            figure: None,
            bar: None,
            text: "a claim".to_owned(),
        }
    }

    fn open(listed: &[(&str, f64)]) -> Open {
        Open {
            bars: listed
                .iter()
                .map(|&(id, figure)| OpenBar {
                    id: id.to_owned(),
                    figure,
                    issue: 22,
                    why: "a reason".to_owned(),
                    test: None,
                })
                .collect(),
            known: Vec::new(),
        }
    }

    /// One problem that names the bar and says this.
    fn assert_problem(found: &[String], id: &str, says: &str) {
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(
            found[0].contains(id) && found[0].contains(says),
            "{found:?}"
        );
    }

    #[test]
    fn listed_bars_and_refuted_claims_pass() {
        let verdicts = [
            bar("a/met", 0.1, 0.2),
            bar("a/missed", 0.31, 0.2),
            claim("a/refuted", false),
        ];
        assert!(problems(&verdicts, &open(&[("a/missed", 0.31)])).is_empty());
        // One that became better, without being met, passes too.
        assert!(problems(&verdicts, &open(&[("a/missed", 0.5)])).is_empty());
    }

    #[test]
    fn a_missed_bar_that_is_not_listed_does_not_pass() {
        let found = problems(&[bar("a/missed", 0.3, 0.2)], &open(&[]));
        assert_problem(&found, "a/missed", "not listed");
        let found = problems(&[bar("a/missed", f64::INFINITY, 0.2)], &open(&[]));
        assert_problem(&found, "a/missed", "not listed");
    }

    #[test]
    fn a_listed_bar_that_is_met_does_not_pass() {
        let found = problems(&[bar("a/met", 0.1, 0.2)], &open(&[("a/met", 0.3)]));
        assert_problem(&found, "a/met", "has to go");
    }

    #[test]
    fn a_listed_bar_that_became_worse_does_not_pass() {
        let listed = open(&[("a/missed", 0.3)]);
        for figure in [0.301, 0.5, f64::INFINITY, f64::NAN] {
            let found = problems(&[bar("a/missed", figure, 0.2)], &listed);
            assert_problem(&found, "a/missed", "worse");
        }
    }

    #[test]
    fn a_listed_bar_without_verdict_and_names_given_twice_do_not_pass() {
        assert_problem(
            &problems(&[], &open(&[("a/gone", 0.3)])),
            "a/gone",
            "no verdict",
        );
        let twice = [bar("a/met", 0.1, 0.2), bar("a/met", 0.1, 0.2)];
        assert_problem(&problems(&twice, &open(&[])), "a/met", "two verdicts");
    }

    /// The stored report with its bars; `.ci/run` thus fails by this test.
    #[test]
    fn the_stored_report_holds_every_bar_that_is_not_listed_as_open() {
        let found = problems_of_folder(
            &package("results/validation"),
            &package("results/README.md"),
        );
        assert!(found.is_empty(), "{}", found.join("\n"));
    }

    /// The stored report with one bar missed on purpose: the check of a folder sees it.
    #[test]
    fn a_bar_missed_on_purpose_in_the_stored_report_is_seen() {
        let folder = tempfile::tempdir().unwrap();
        let copied = |name: &str| {
            std::fs::copy(
                package("results/validation").join(name),
                folder.path().join(name),
            )
            .unwrap();
        };
        [VERDICTS, OPEN_BARS, REPORT].into_iter().for_each(copied);
        let readme = package("results/README.md");
        assert!(problems_of_folder(folder.path(), &readme).is_empty());
        let path = folder.path().join(VERDICTS);
        let mut stored: Verdicts =
            toml::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap();
        let met = stored
            .verdicts
            .iter_mut()
            .find(|own| own.kind == Kind::Bar && own.met)
            .unwrap();
        met.met = false;
        met.figure = met.bar.map(|bar| 2.0 * bar + 1.0);
        let id = met.id.clone();
        std::fs::write(&path, toml::to_string(&stored).unwrap()).unwrap();
        let found = problems_of_folder(folder.path(), &readme);
        let named = |says: &str| {
            found
                .iter()
                .any(|one| one.contains(&id) && one.contains(says))
        };
        assert!(named("not listed"), "{found:?}");
        // The text of the report no longer says what is stored, either.
        assert!(named("lacks the verdict"), "{found:?}");
    }
}
