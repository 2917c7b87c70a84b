//! Sections, verdicts and tables of the report, and the files that they are written to.

use std::any::Any;
use std::fmt::Write;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::super::support::package;
pub use super::bars::Verdict;
use super::bars::{
    Kind, Open, REPORT, VERDICTS, Verdicts, headline, known_and_open, problems, problems_of_folder,
};
use super::identity::Identity;

/// A section of the report.
#[derive(Clone, Copy)]
pub struct Entry {
    /// By which it is asked for, and with which the names of its verdicts begin.
    pub name: &'static str,
    pub title: &'static str,
    pub compute: fn() -> Section,
}

/// What was compared, the tables, and what follows from the numbers.
#[derive(Serialize, Deserialize)]
pub struct Section {
    /// What was compared with what, with the sizes of the samples.
    pub compared: String,
    /// Tables and remarks in Markdown.
    pub body: String,
    pub verdicts: Vec<Verdict>,
}

impl Section {
    fn markdown(&self) -> String {
        let line = |own: &Verdict| format!("- **{}**, `{}`: {}\n", own.word(), own.id, own.text);
        let verdicts: String = self.verdicts.iter().map(line).collect();
        format!("{}\n\n{}\n{verdicts}", self.compared, self.body)
    }
}

impl Verdict {
    /// The worst of some errors, given as shares, against a bar; an error that is not a number misses it.
    pub fn at_most(id: &str, what: &str, errors: impl IntoIterator<Item = f64>, bar: f64) -> Self {
        let (worst, count) = worst(errors);
        Self {
            id: id.to_owned(),
            kind: Kind::Bar,
            text: format!(
                "{what}: {} at worst of {count}, bar {}",
                percent(worst),
                percent(bar)
            ),
            met: count > 0 && worst <= bar,
            figure: Some(worst),
            bar: Some(bar),
        }
    }

    /// How many of some rows do what is wanted of at least a share of them; the figure is the share that does not.
    pub fn share(id: &str, what: &str, rows: impl IntoIterator<Item = bool>, bar: f64) -> Self {
        let rows: Vec<bool> = rows.into_iter().collect();
        let within = rows.iter().filter(|&&within| within).count();
        Self {
            id: id.to_owned(),
            kind: Kind::Bar,
            text: format!(
                "{what}: {within} of {}, bar {:.0} %",
                rows.len(),
                100.0 * bar
            ),
            met: !rows.is_empty() && within as f64 >= bar * rows.len() as f64,
            figure: Some((rows.len() - within) as f64 / rows.len() as f64),
            bar: Some(1.0 - bar),
        }
    }

    pub fn claim(id: &str, text: String, confirmed: bool) -> Self {
        Self {
            id: id.to_owned(),
            kind: Kind::Claim,
            text,
            met: confirmed,
            figure: None,
            bar: None,
        }
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

/// A length in µm, or a dash.
pub fn micrometres(metres: Option<f64>) -> String {
    metres.map_or_else(|| "-".to_owned(), |metres| format!("{:.2}", 1e6 * metres))
}

/// A harmonic set as in the tables of results.
pub fn set_name(harmonics: &[u32]) -> String {
    let names: Vec<String> = harmonics.iter().map(u32::to_string).collect();
    names.join("-")
}

/// Computes the sections that `wanted` names, all if it is none, as many at once as there are threads. A section is kept
/// under the digest of the sources, so that a run that was cut short goes on. All of them together are written as the
/// report; some of them are printed and nothing is written. Returns what does not pass.
pub fn make_report(entries: &[Entry], wanted: Option<&str>) -> Vec<String> {
    let identity = Identity::now();
    let names: Vec<&str> = entries.iter().map(|entry| entry.name).collect();
    let wanted: Vec<&str> = wanted.map_or_else(|| names.clone(), |list| list.split(',').collect());
    for name in &wanted {
        assert!(names.contains(name), "{name:?} is none of {names:?}");
    }
    let kept = Path::new(env!("CARGO_TARGET_TMPDIR"))
        .join("validation")
        .join(&identity.sources);
    std::fs::create_dir_all(&kept).unwrap();
    let computed: Vec<(&Entry, Result<Section, String>)> = entries
        .par_iter()
        .with_max_len(1)
        .filter(|entry| wanted.contains(&entry.name))
        .map(|entry| {
            let section = computed(entry, kept.join(format!("{}.toml", entry.name)));
            let text = section.as_ref().map(Section::markdown);
            println!(
                "{}: {}",
                entry.name,
                text.unwrap_or_else(|reason| format!("NOT COMPUTED: {reason}"))
            );
            (entry, section)
        })
        .collect();
    let mut sections = Vec::new();
    let mut failed = Vec::new();
    for (entry, section) in computed {
        match section {
            Ok(section) => sections.push((entry, section)),
            Err(reason) => failed.push(format!("{}: not computed: {reason}", entry.name)),
        }
    }
    if !failed.is_empty() {
        return failed;
    }
    let verdicts: Vec<Verdict> = sections
        .iter()
        .flat_map(|(_, section)| section.verdicts.clone())
        .collect();
    let folder = package("results/validation");
    let open = Open::read(&folder);
    if sections.len() == entries.len() {
        write(&folder, &identity, &sections, &verdicts, &open);
        return problems_of_folder(&folder, &package("results/README.md"));
    }
    // Of some sections: the bars listed of others have no verdict here.
    let of_these = |id: &str| {
        wanted
            .iter()
            .any(|name| id.starts_with(&format!("{name}/")))
    };
    let open = Open {
        bars: open
            .bars
            .into_iter()
            .filter(|bar| of_these(&bar.id))
            .collect(),
        known: Vec::new(),
    };
    problems(&verdicts, &open)
}

/// A section, read where it was computed from the same sources already; or why it could not be computed.
fn computed(entry: &Entry, kept: PathBuf) -> Result<Section, String> {
    if let Ok(text) = std::fs::read_to_string(&kept) {
        return Ok(toml::from_str(&text).unwrap());
    }
    let found = catch_unwind(AssertUnwindSafe(entry.compute));
    let mut section = found.map_err(|panic| reason(&*panic))?;
    for verdict in &mut section.verdicts {
        verdict.id = format!("{}/{}", entry.name, verdict.id);
    }
    std::fs::write(kept, toml::to_string(&section).unwrap()).unwrap();
    Ok(section)
}

/// What a panic says.
fn reason(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().cloned();
    text.or_else(|| panic.downcast_ref::<&str>().map(|&text| text.to_owned()))
        .unwrap_or_default()
        .replace('\n', " ")
}

fn write(
    folder: &Path,
    identity: &Identity,
    sections: &[(&Entry, Section)],
    verdicts: &[Verdict],
    open: &Open,
) {
    let mut report = format!(
        "{}\n\n{} What it solves is in [studies/validation](../../studies/validation/README.md).\n\n{HOW_TO_READ}\n## Summary\n\n\
         | name | verdict | by the numbers |\n| --- | --- | --- |\n",
        headline(verdicts, open),
        identity.line()
    );
    for own in verdicts {
        report += &own.row();
    }
    write!(report, "\n## Known and open\n\n{}", known_and_open(open)).unwrap();
    for (entry, section) in sections {
        write!(report, "\n## {}\n\n{}", entry.title, section.markdown()).unwrap();
    }
    std::fs::write(folder.join(REPORT), report).unwrap();
    let stored = Verdicts {
        identity: identity.clone(),
        verdicts: verdicts.to_vec(),
    };
    std::fs::write(folder.join(VERDICTS), toml::to_string(&stored).unwrap()).unwrap();
    super::quickstart::write_page(identity, sections);
}

const HOW_TO_READ: &str = "\
## How to read it

Every number and every verdict is computed by that command from one build. Only the section of what is known and open is typed. A
verdict sets the worst number of a table against a bar that was fixed beforehand. A claim is one about ring dampers, not about this program, and may be
refuted. The command ends with exit code 1 while a bar is not met that is not listed as open.

Amplitude is the largest over blades and frequency of the fundamental harmonic. It is in µm for an excitation of 1 N per sector, if nothing else is said. Differences are relative. *Fast path* is the
solver that a study is run with. *Full model* has every contact dof of the Craig-Bampton model, 512 samples and another solver
(docs/formulation.md, section 9). \"Default settings\" are those of a study that sets nothing under `[reduction]` and `[solver]`, but for the
harmonics where a set is named. The bounds of a sample say what was seen in it, no more.

Limits: three wheels are of solid elements (8, 24 and 24 blades, about 1000 dofs per sector) and one is of lumped masses. All are linear elastic, without
rotation. The excitation has engine order 3 but for the section on nodal diameters. Where no number is given, one or a few patterns are mistuned. The
full model shares the sector matrices, their Craig-Bampton reduction and the law of a contact pair with the fast path. Of the references
only the rows of `tests/data`, CalculiX and the oracles come from other programs. No measured engine is among them.
";
