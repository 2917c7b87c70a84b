//! The glossary: its terms are those of the other pages, and it has the terms that `blisk explain` knows.

use std::path::Path;

use super::complain;
use super::links::pages;

/// Pages that make no use of a term: the glossary itself, what the sources say of themselves, what has changed.
const LEFT_OUT: [&str; 3] = ["glossary.md", "map.md", "CHANGELOG.md"];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The first cells of the rows of the tables of a page, but for headings and rules.
fn terms(page: &str) -> Vec<String> {
    let rows = page.lines().filter_map(|line| line.strip_prefix("| "));
    let cells = rows.filter_map(|row| row.split(" | ").next());
    cells
        .filter(|cell| !cell.starts_with("---") && *cell != "term")
        .map(str::to_owned)
        .collect()
}

fn glossary() -> Vec<String> {
    let page = std::fs::read_to_string(root().join("docs/glossary.md"));
    let terms = terms(&page.expect("docs/glossary.md"));
    assert!(terms.len() > 40, "{terms:?}");
    terms
}

#[test]
fn every_term_of_the_glossary_is_one_of_another_page() {
    let is_other = |path: &&std::path::PathBuf| {
        let name = path.file_name().map(|name| name.to_string_lossy());
        name.is_some_and(|name| !LEFT_OUT.contains(&name.as_ref()))
    };
    let texts: Vec<String> = pages(root())
        .iter()
        .filter(is_other)
        .map(|path| {
            std::fs::read_to_string(path)
                .expect("a page")
                .to_lowercase()
        })
        .map(|text| text.split_whitespace().collect::<Vec<_>>().join(" "))
        .collect();
    let unknown = |term: &String| !texts.iter().any(|text| text.contains(&term.to_lowercase()));
    let unused: Vec<String> = glossary().into_iter().filter(unknown).collect();
    complain("terms of docs/glossary.md that no other page has", &unused);
}

#[test]
fn a_term_has_one_meaning() {
    let terms = glossary();
    let twice = |(place, term): &(usize, &String)| terms[..*place].contains(term);
    let twice = terms.iter().enumerate().filter(twice);
    let twice: Vec<String> = twice.map(|(_, term)| term.clone()).collect();
    complain("terms that docs/glossary.md defines twice", &twice);
}

#[test]
fn the_glossary_has_the_terms_that_explain_knows() {
    let terms = glossary();
    // `stuck (contact, load)` says where the word stands.
    let missing = |word: &&str| !terms.iter().any(|term| word.starts_with(term.as_str()));
    let known = blisk::input::terms_about("");
    let words = known.iter().map(|term| term.word);
    let missing: Vec<String> = words.filter(missing).map(str::to_owned).collect();
    complain(
        "terms of `blisk explain` that docs/glossary.md lacks",
        &missing,
    );
}

#[test]
fn terms_are_the_first_cells_of_rows() {
    let page = "| term | meaning |\n| --- | --- |\n| tuned wheel | All blades alike. |\n\nText.\n";
    assert_eq!(terms(page), ["tuned wheel"]);
}
