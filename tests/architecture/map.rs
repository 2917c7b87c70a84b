//! The page `docs/map.md` is the one that the sources make: every folder and file under `src/` with its first sentence.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::path::Path;

use super::paths::Source;
use super::rooms::ROOMS;
use super::{WINGS, complain, source_files};

const INTRODUCTION: &str = "\
# Map of the sources

Every folder and file under `src/`, with the first sentence of the file. The page is made from the sources:

    BLISK_WRITE_MAP=1 cargo test --release --locked --test architecture map

The same test without the variable fails when the page is not what the sources make.

What a newcomer has to do to add a law, a column, a key or a command stands in [CONTRIBUTING.md](../CONTRIBUTING.md).

## Two ways to a row

Rows are solved on the receptances of the tuned wheel by default. A basis of system modes is the other way: the study asks for it, or what it
asks for is not ready on receptances. Both share the search, the contact laws and the statistics.

| question | on tuned receptances | on a basis |
| --- | --- | --- |
| what solves a row? | [receptance_rows.rs](../src/population/monte_carlo/receptance_rows.rs) | [basis_rows.rs](../src/population/monte_carlo/basis_rows.rs) |
| where is mistuning applied? | [elimination.rs](../src/response/receptance/elimination.rs) | [wheel_basis.rs](../src/response/mistuning/wheel_basis.rs) |
| what is the equation? | [contact_equation.rs](../src/response/receptance/contact_equation.rs) | [system.rs](../src/response/harmonic_balance/equation/system.rs) |
| what is the preconditioner, or the Jacobian? | [preconditioner.rs](../src/response/receptance/preconditioner.rs) | [jacobian.rs](../src/response/harmonic_balance/equation/jacobian.rs) |
| what decides that a solve has converged? | [contact_iteration.rs](../src/response/receptance/contact_iteration.rs) (`Judge`) | [newton_verdict.rs](../src/response/harmonic_balance/solver/newton_verdict.rs); in a search also [newton_iteration.rs](../src/response/harmonic_balance/solver/newton_iteration.rs) |
| what is tried where it does not? | [attempts_on_receptances.rs](../src/response/receptance/attempts_on_receptances.rs), then [load_case_solvers.rs](../src/population/monte_carlo/load_case_solvers.rs) | [attempts_on_basis.rs](../src/response/forced_response/attempts_on_basis.rs) |
| which harmonics does a study take that says none? | [reduced_study.rs](../src/settings/reduced_study.rs) (`reduced_on_receptances`), then [harmonics_on_receptances.rs](../src/settings/harmonics_on_receptances.rs) | [harmonics_on_basis.rs](../src/settings/harmonics_on_basis.rs) |
| how is the peak found? | [corrected_peak.rs](../src/response/forced_response/corrected_peak.rs) | [peak.rs](../src/response/forced_response/peak.rs) |
| which errors are measured? | [receptance_errors.rs](../src/response/forced_response/receptance_errors.rs) | [a_posteriori.rs](../src/response/forced_response/a_posteriori.rs) |
| which rows are already solved when an interrupted run continues? | [parts.rs](../src/population/table/parts.rs) | the same |
| where is a wrong value of a key refused, and where is the message made? | [check.rs](../src/study/checks/check.rs), then [finding.rs](../src/input/finding.rs) | the same |

## Order

A folder at the top level imports only from those below it in this picture. A folder inside of one imports, within it, only from
those to its left.
";

/// A source file by its place under `src/`.
struct Room<'a> {
    folder: String,
    file: String,
    source: &'a Source,
}

impl<'a> Room<'a> {
    fn of(source: &'a Source) -> Self {
        let name = source.name.replace('\\', "/");
        let (_, inside) = name.rsplit_once("/src/").expect("a file under src/");
        let (folder, file) = inside.rsplit_once('/').unwrap_or(("", inside));
        Self {
            folder: folder.to_owned(),
            file: file.to_owned(),
            source,
        }
    }
}

/// The first sentence of the comment at the head of a source.
fn head(text: &str) -> String {
    let lines = text.lines().map_while(|line| line.strip_prefix("//! "));
    let paragraph = lines.collect::<Vec<_>>().join(" ");
    let mut depth = 0_i32;
    let mut end = paragraph.len();
    for (at, letter) in paragraph.char_indices() {
        match letter {
            '(' => depth += 1,
            ')' => depth -= 1,
            '.' if depth == 0 && paragraph[at + 1..].starts_with(' ') => {
                end = at + 1;
                break;
            }
            _ => {}
        }
    }
    without_links(&paragraph[..end])
}

/// Links of the documentation of Rust lead nowhere on a page: the words that are linked remain.
fn without_links(text: &str) -> String {
    let mut words = String::new();
    let mut rest = text;
    while let Some((before, link)) = rest.split_once("](") {
        words += before;
        words.push(']');
        rest = link.split_once(')').map_or("", |(_, after)| after);
    }
    words += rest;
    words.replace("[`", "`").replace("`]", "`")
}

/// Whether a source is that of its folder: `mod.rs`, or `lib.rs` of the topmost.
fn is_head(room: &Room) -> bool {
    ["mod.rs", "lib.rs"].contains(&room.file.as_str())
}

/// The folder in which what `path` names stands, with what a folder offers by `pub use` taken to where it stands.
fn folder_of(heads: &BTreeMap<String, &Source>, path: &[String]) -> Option<String> {
    let longest = (1..=path.len()).rev();
    let folder = |length: usize| path[..length].join("/");
    let length = { longest }.find(|&length| heads.contains_key(&folder(length)))?;
    let own = folder(length);
    let Some(item) = path.get(length) else {
        return Some(own);
    };
    // What stands in a file of this folder needs no further look.
    let offers = |offered: &&Vec<String>| {
        offered.len() > length + 1
            && offered[..length] == path[..length]
            && offered.last() == Some(item)
            && heads.contains_key(&offered[..=length].join("/"))
    };
    let offered = heads[&own].paths.iter().find(offers);
    offered.map_or(Some(own), |offered| folder_of(heads, offered))
}

/// Place of a folder in the order of wings and rooms; what is inside of a room comes after it.
fn place(folder: &str) -> (usize, usize, String) {
    let mut steps = folder.split('/');
    let wing = steps.next().unwrap_or_default();
    let found = WINGS.iter().position(|(name, _)| *name == wing);
    let room = steps.next().map_or(0, |room| {
        let rooms = found.map_or(&[][..], |found| WINGS[found].1);
        let place = rooms.iter().position(|name| *name == room);
        1 + place.unwrap_or(rooms.len())
    });
    (found.map_or(0, |found| found + 1), room, folder.to_owned())
}

/// The wings from the last to the first, each with its rooms, and the folders whose own files stand before their rooms.
fn order() -> String {
    let mut text = String::from("\n```text\n");
    for (wing, rooms) in WINGS.iter().rev() {
        let line = format!("{wing:<12}{}", rooms.join("  "));
        text += line.trim_end();
        text.push('\n');
    }
    text += "```\n\nIn these folders the files that stand in no folder inside come first, then:\n\n```text\n";
    for (folder, rooms) in ROOMS {
        let _ = writeln!(text, "{:<28}{}", folder.join("/"), rooms.join("  "));
    }
    text + "```\n"
}

/// The whole page.
fn page(files: &[Source]) -> String {
    let rooms: Vec<Room> = files.iter().map(Room::of).collect();
    let heads = rooms.iter().filter(|room| is_head(room));
    let heads: BTreeMap<String, &Source> = heads
        .map(|room| (room.folder.clone(), room.source))
        .collect();
    let mut folders: BTreeMap<&str, Vec<&Room>> = BTreeMap::new();
    for room in &rooms {
        folders.entry(&room.folder).or_default().push(room);
    }
    let mut folders: Vec<(&str, Vec<&Room>)> = folders.into_iter().collect();
    folders.sort_by_key(|(folder, _)| place(folder));

    let mut text = INTRODUCTION.to_owned() + &order();
    text +=
        "\n## Folders\n\n| folder | files | holds | imports from |\n| --- | ---: | --- | --- |\n";
    for (folder, rooms) in &folders {
        let named = rooms.iter().flat_map(|room| &room.source.paths);
        let named: BTreeSet<String> = named.filter_map(|path| folder_of(&heads, path)).collect();
        let mut named: Vec<String> = { named.into_iter() }
            .filter(|name| name != folder)
            .collect();
        named.sort_by_key(|name| place(name));
        let named: Vec<String> = named.iter().map(|name| format!("`{name}`")).collect();
        let holds = heads
            .get(*folder)
            .map_or(String::new(), |own| head(&own.text));
        let (name, anchor) = (title(folder), title(folder).replace('/', ""));
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "| [{name}](#{anchor}) | {} | {} | {} |",
            rooms.len(),
            holds.replace('|', "\\|"),
            named.join(", ")
        );
    }
    for (folder, rooms) in &folders {
        let _ = writeln!(text, "\n## {}\n", title(folder));
        for room in rooms {
            let path = format!("../{}/{}", title(folder), room.file);
            let _ = writeln!(
                text,
                "- [{}]({path}): {}",
                room.file,
                head(&room.source.text)
            );
        }
    }
    text
}

fn title(folder: &str) -> String {
    format!("src/{folder}").trim_end_matches('/').to_owned()
}

#[test]
fn the_map_is_that_of_the_sources() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/map.md");
    let wanted = page(&source_files());
    if std::env::var_os("BLISK_WRITE_MAP").is_some() {
        std::fs::write(&path, &wanted).expect("docs/map.md can be written");
    }
    let found = std::fs::read_to_string(&path).unwrap_or_default();
    let lines = |text: &str| text.lines().map(str::to_owned).collect::<BTreeSet<_>>();
    let (has, needs) = (lines(&found), lines(&wanted));
    let lacks = needs.difference(&has).map(|line| format!("lacks: {line}"));
    let stale = has.difference(&needs).map(|line| format!("stale: {line}"));
    let differences: Vec<String> = lacks.chain(stale).collect();
    let rule = "docs/map.md is not that of the sources; BLISK_WRITE_MAP=1 writes it";
    complain(rule, &differences);
    assert!(found == wanted, "{rule}: the order of its lines");
}

#[test]
fn a_head_is_one_sentence_without_links() {
    let sentence = |text: &str| head(text);
    assert_eq!(sentence("//! One thing. And more.\n"), "One thing.");
    assert_eq!(
        sentence(
            "//! By a paper (J. Appl. Mech. 56(1)), see\n//! [`Other`](super::Other). More.\n//!\n//! Else.\n"
        ),
        "By a paper (J. Appl. Mech. 56(1)), see `Other`."
    );
    assert_eq!(
        sentence("//! `/proc` of version 2.5 says so.\n"),
        "`/proc` of version 2.5 says so."
    );
}

#[test]
fn a_folder_is_that_of_what_is_offered() {
    let source =
        |name: &str, module: &[&str], text: &str| Source::new(Path::new(name), module, text);
    let files = [
        source(
            "/src/a/mod.rs",
            &["a"],
            "//! A.\npub mod b;\npub use b::One;\n",
        ),
        source("/src/a/b/mod.rs", &["a", "b"], "//! B.\n"),
        source("/src/c/mod.rs", &["c"], "//! C.\nuse crate::a::One;\n"),
    ];
    let text = page(&files);
    assert!(
        text.contains("| [src/c](#srcc) | 1 | C. | `a/b` |"),
        "{text}"
    );
}
