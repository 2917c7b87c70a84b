//! Sections, verdicts and tables of the report, and the file that they are written to.

use std::fmt::Write;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::Mutex;

use rayon::prelude::*;

use super::super::support::package;

/// A section: what was compared, the tables, and what follows from the numbers.
pub struct Section {
    pub title: &'static str,
    /// What was compared with what, with the sizes of the samples.
    pub compared: String,
    /// Tables and remarks in Markdown.
    pub body: String,
    pub verdicts: Vec<Verdict>,
}

impl Section {
    pub fn markdown(&self) -> String {
        let Self {
            title,
            compared,
            body,
            verdicts,
        } = self;
        let verdicts: String = verdicts.iter().map(Verdict::line).collect();
        format!("## {title}\n\n{compared}\n\n{body}\n{verdicts}")
    }
}

/// A judgement computed from the numbers of a section.
pub struct Verdict {
    pub kind: Kind,
    pub text: String,
    pub met: bool,
}

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
        format!("- **{}**: {}\n", self.word(), self.text)
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

/// A section by its name.
pub type Entry = (&'static str, fn() -> Section);

/// Name, and the section or why there is none.
type Done = (&'static str, Result<Section, String>);

/// Computes the sections, as many at once as there are threads, and writes the report anew whenever
/// one is done, so that a run that is cut short leaves what it has. Returns the names of those that
/// could not be computed.
pub fn write_report(sections: &[Entry]) -> Vec<&'static str> {
    let folder = package("results/validation");
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("report.md");
    let done: Mutex<Vec<Option<Done>>> = Mutex::new(sections.iter().map(|_| None).collect());
    sections
        .par_iter()
        .with_max_len(1)
        .enumerate()
        .for_each(|(place, &(name, section))| {
            let section = catch_unwind(AssertUnwindSafe(section)).map_err(|panic| {
                let text = panic.downcast_ref::<String>().cloned();
                text.or_else(|| panic.downcast_ref::<&str>().map(|&text| text.to_owned()))
                    .unwrap_or_default()
            });
            if let Ok(section) = &section {
                println!("{}", section.markdown());
            }
            let mut done = done.lock().unwrap();
            done[place] = Some((name, section));
            write(&path, sections, &done);
        });
    let done = done.into_inner().unwrap();
    let failed = done
        .iter()
        .flatten()
        .filter(|(_, section)| section.is_err());
    failed.map(|(name, _)| *name).collect()
}

fn write(path: &Path, sections: &[Entry], done: &[Option<Done>]) {
    let mut report = format!(
        "# Validation report\n\nblisk {}. Made by `cargo test --release --test cases -- --ignored --nocapture \
         the_validation_report` ([studies/validation](../../studies/validation/README.md)).\n\n{HOW_TO_READ}\n## Summary\n\n\
         | section | verdict | by the numbers |\n| --- | --- | --- |\n",
        env!("CARGO_PKG_VERSION")
    );
    let mut body = String::new();
    for ((name, _), done) in sections.iter().zip(done) {
        match done {
            None => writeln!(body, "\n## {name}\n\nNot computed yet.").unwrap(),
            Some((_, Err(reason))) => {
                writeln!(report, "| {name} | **NOT COMPUTED** | |").unwrap();
                writeln!(body, "\n## {name}\n\nNot computed: {reason}").unwrap();
            }
            Some((_, Ok(section))) => {
                for verdict in &section.verdicts {
                    let (word, text) = (verdict.word(), &verdict.text);
                    writeln!(report, "| {} | **{word}** | {text} |", section.title).unwrap();
                }
                write!(body, "\n{}", section.markdown()).unwrap();
            }
        }
    }
    std::fs::write(path, report + &body).unwrap();
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
