//! Sections, verdicts and tables of the report, and the file that they are written to.

use std::any::Any;
use std::fmt::Write;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::Mutex;

use rayon::prelude::*;

use super::super::support::package;

/// A section of the report.
#[derive(Clone, Copy)]
pub struct Entry {
    /// By which it is asked for.
    pub name: &'static str,
    pub title: &'static str,
    pub compute: fn() -> Section,
}

/// What was compared, the tables, and what follows from the numbers.
pub struct Section {
    /// What was compared with what, with the sizes of the samples.
    pub compared: String,
    /// Tables and remarks in Markdown.
    pub body: String,
    pub verdicts: Vec<Verdict>,
}

impl Section {
    fn markdown(&self) -> String {
        let verdicts: String = self.verdicts.iter().map(Verdict::line).collect();
        format!("{}\n\n{}\n{verdicts}", self.compared, self.body)
    }
}

/// A judgement computed from the numbers of a section.
pub struct Verdict {
    pub kind: Kind,
    pub text: String,
    pub met: bool,
}

/// How the line of a verdict begins.
const VERDICT: &str = "- **";

/// What a verdict is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// The program against a stated bar.
    Bar,
    /// A claim about ring dampers, which these models confirm or not.
    Claim,
}

impl Verdict {
    /// The worst of some errors, given as shares, against a bar; an error that is not a number misses it.
    pub fn at_most(what: &str, errors: impl IntoIterator<Item = f64>, bar: f64) -> Self {
        let (worst, count) = worst(errors);
        Self {
            kind: Kind::Bar,
            text: format!(
                "{what}: {} at worst of {count}, bar {}",
                percent(worst),
                percent(bar)
            ),
            met: count > 0 && worst <= bar,
        }
    }

    /// How many of some rows do what is wanted of at least a share of them.
    pub fn share(what: &str, rows: impl IntoIterator<Item = bool>, bar: f64) -> Self {
        let rows: Vec<bool> = rows.into_iter().collect();
        let within = rows.iter().filter(|&&within| within).count();
        Self {
            kind: Kind::Bar,
            text: format!(
                "{what}: {within} of {}, bar {:.0} %",
                rows.len(),
                100.0 * bar
            ),
            met: !rows.is_empty() && within as f64 >= bar * rows.len() as f64,
        }
    }

    pub fn claim(text: String, confirmed: bool) -> Self {
        Self {
            kind: Kind::Claim,
            text,
            met: confirmed,
        }
    }

    fn word(&self) -> &'static str {
        match (self.kind, self.met) {
            (Kind::Bar, true) => "bar met",
            (Kind::Bar, false) => "BAR NOT MET",
            (Kind::Claim, true) => "claim confirmed",
            (Kind::Claim, false) => "CLAIM NOT CONFIRMED",
        }
    }

    fn line(&self) -> String {
        format!("{VERDICT}{}**: {}\n", self.word(), self.text)
    }
}

/// The largest and the number of some errors; infinite if one is not a number.
pub fn worst(errors: impl IntoIterator<Item = f64>) -> (f64, usize) {
    errors.into_iter().fold((0.0, 0), |(worst, count), error| {
        let error = if error.is_nan() { f64::INFINITY } else { error };
        (f64::max(worst, error), count + 1)
    })
}

/// A table in Markdown.
pub fn table(header: &[&str], rows: &[Vec<String>]) -> String {
    let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    let names: Vec<String> = header.iter().map(|&name| name.to_owned()).collect();
    let rule = vec!["---".to_owned(); header.len()];
    rows.iter()
        .fold(line(&names) + &line(&rule), |text, row| text + &line(row))
}

/// A share in percent, or as a power of ten where percent would show nothing of it.
pub fn percent(share: f64) -> String {
    if share > 0.0 && share < 5e-6 {
        format!("{share:.1e}")
    } else {
        format!("{:.3} %", 100.0 * share)
    }
}

/// A share in percent with its sign.
pub fn signed_percent(share: f64) -> String {
    format!("{:+.3} %", 100.0 * share)
}

/// A length in um, or a dash.
pub fn micrometres(metres: Option<f64>) -> String {
    metres.map_or_else(|| "-".to_owned(), |metres| format!("{:.2}", 1e6 * metres))
}

/// A harmonic set as in the tables of results.
pub fn set_name(harmonics: &[u32]) -> String {
    let names: Vec<String> = harmonics.iter().map(u32::to_string).collect();
    names.join("-")
}

/// Computes sections, as many at once as there are threads, and writes the report anew whenever one is
/// done, so that a run that is cut short leaves what it has. `wanted` names those to compute, all if it is
/// none; the others are kept as they stand. Returns the names of those that could not be computed.
pub fn write_report(entries: &[Entry], wanted: Option<&str>) -> Vec<&'static str> {
    let names: Vec<&str> = entries.iter().map(|entry| entry.name).collect();
    let wanted: Vec<&str> = wanted.map_or_else(|| names.clone(), |list| list.split(',').collect());
    for name in &wanted {
        assert!(names.contains(name), "{name:?} is none of {names:?}");
    }
    let folder = package("results/validation");
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("report.md");
    let old = std::fs::read_to_string(&path).unwrap_or_default();
    let kept = entries.iter().map(|entry| {
        let text = text_of(&old, entry.title).filter(|_| !wanted.contains(&entry.name));
        text.map_or_else(|| "Not computed yet.\n".to_owned(), str::to_owned)
    });
    let texts: Mutex<Vec<String>> = Mutex::new(kept.collect());
    let failed = entries
        .par_iter()
        .with_max_len(1)
        .enumerate()
        .filter(|(_, entry)| wanted.contains(&entry.name))
        .filter_map(|(place, entry)| {
            let section = catch_unwind(AssertUnwindSafe(entry.compute));
            let text = section.as_ref().map(Section::markdown);
            let mut texts = texts.lock().unwrap();
            texts[place] = text
                .unwrap_or_else(|panic| format!("{VERDICT}NOT COMPUTED**: {}\n", reason(panic)));
            println!("{}: {}", entry.name, texts[place]);
            write(&path, entries, &texts);
            section.is_err().then_some(entry.name)
        });
    failed.collect()
}

/// What a panic says.
fn reason(panic: &Box<dyn Any + Send>) -> String {
    let text = panic.downcast_ref::<String>().cloned();
    text.or_else(|| panic.downcast_ref::<&str>().map(|&text| text.to_owned()))
        .unwrap_or_default()
        .replace('\n', " ")
}

/// The text of a section of a report.
fn text_of<'a>(report: &'a str, title: &str) -> Option<&'a str> {
    let heading = format!("\n## {title}\n\n");
    let start = report.find(&heading)? + heading.len();
    let text = &report[start..];
    Some(text.find("\n## ").map_or(text, |end| &text[..end]))
}

fn write(path: &Path, entries: &[Entry], texts: &[String]) {
    let mut report = format!(
        "# Validation report\n\nblisk {}. Made by `cargo test --release --test cases -- --ignored --nocapture \
         the_validation_report` ([studies/validation](../../studies/validation/README.md)).\n\n{HOW_TO_READ}\n## Summary\n\n\
         | section | verdict | by the numbers |\n| --- | --- | --- |\n",
        env!("CARGO_PKG_VERSION")
    );
    let sections = || entries.iter().zip(texts);
    for (entry, text) in sections() {
        for verdict in text.lines().filter_map(|line| line.strip_prefix(VERDICT)) {
            let (word, text) = verdict.split_once("**: ").unwrap();
            writeln!(report, "| {} | **{word}** | {text} |", entry.title).unwrap();
        }
    }
    for (entry, text) in sections() {
        write!(report, "\n## {}\n\n{text}", entry.title).unwrap();
    }
    std::fs::write(path, report).unwrap();
}

const HOW_TO_READ: &str = "\
## How to read it

Every number and every verdict is computed by that command; none is typed. A verdict sets the worst number of a table against a bar
that was fixed beforehand; a claim is one about ring dampers, not about this program. Amplitude: largest over blades and frequency of
the fundamental harmonic, in um for an excitation of 1 N per sector, if nothing else is said. Differences are relative. *Fast path*: the
reduced model that a study is run on; *full model*: every contact dof of the Craig-Bampton model, 512 samples, another solver
(docs/formulation.md, section 9). \"Default settings\" are those of a study that sets nothing under `[reduction]` and `[solver]`, but for the
harmonics where a set is named. The bounds of a sample say what was seen in it, no more.

Limits: the wheels are three of solid elements (8, 24 and 24 blades, about 1000 dofs per sector) and one of lumped masses, linear elastic, without
rotation; one excitation of engine order 3 but for the section on nodal diameters; one or a few mistuned patterns where no number is given. The
full model shares the sector matrices, their Craig-Bampton reduction and the law of a contact pair with the fast path; of the references
only the rows of `tests/data`, CalculiX and the oracles come from other programs. No measured engine is among them.
";
