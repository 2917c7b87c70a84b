//! Every relative link of the documentation leads to a file that is there, and to a heading that it has.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Folders that hold no pages of the project.
const LEFT_OUT: [&str; 3] = ["target", ".git", "results"];

fn is_page(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending == "md")
}

/// Every page in Markdown, but for results that are not kept.
pub fn pages(root: &Path) -> Vec<PathBuf> {
    let mut found = vec![root.join("results/README.md")];
    let mut folders = vec![root.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            if path.is_dir() {
                if !LEFT_OUT.contains(&name.as_str()) {
                    folders.push(path);
                }
            } else if is_page(&path) {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// The lines of a page outside of blocks of code.
fn prose(page: &str) -> impl Iterator<Item = &str> {
    let mut code = false;
    page.lines().filter(move |line| {
        let fence = line.trim_start().starts_with("```");
        code ^= fence;
        !code && !fence && !line.starts_with("    ")
    })
}

/// Targets of links and images.
fn links(page: &str) -> Vec<String> {
    let mut found = Vec::new();
    for line in prose(page) {
        // Odd parts stand between backticks.
        let outside = line.split('`').step_by(2).collect::<Vec<_>>().join("`");
        for part in outside.split("](").skip(1) {
            found.extend(part.split(')').next().map(str::to_owned));
        }
    }
    found
}

/// The anchors that a browser of the repository makes of the headings.
fn anchors(page: &str) -> BTreeSet<String> {
    prose(page)
        .filter_map(|line| {
            line.trim_start_matches('#')
                .strip_prefix(' ')
                .filter(|_| line.starts_with('#'))
        })
        .map(|heading| {
            let kept = heading.to_lowercase();
            let kept = kept
                .trim()
                .chars()
                .filter(|letter| letter.is_alphanumeric() || [' ', '-', '_'].contains(letter));
            kept.map(|letter| if letter == ' ' { '-' } else { letter })
                .collect()
        })
        .collect()
}

/// What is wrong with a link of the page at `path`; none if it leads somewhere, or out of the repository.
fn broken(path: &Path, page: &str, link: &str) -> Option<String> {
    if link.contains("://") || link.starts_with("mailto:") {
        return None;
    }
    let (file, anchor) = link
        .split_once('#')
        .map_or((link, None), |(file, anchor)| (file, Some(anchor)));
    let target = if file.is_empty() {
        path.to_owned()
    } else {
        path.parent().unwrap().join(file)
    };
    if !target.exists() {
        return Some("no such file".to_owned());
    }
    let anchor = anchor?;
    let text = if file.is_empty() {
        page.to_owned()
    } else {
        std::fs::read_to_string(&target).ok()?
    };
    (!anchors(&text).contains(anchor)).then(|| "no such heading".to_owned())
}

#[test]
fn every_link_of_the_documentation_leads_somewhere() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut count = 0;
    let mut violations = Vec::new();
    for path in pages(root) {
        let page = std::fs::read_to_string(&path).unwrap();
        for link in links(&page) {
            count += 1;
            if let Some(what) = broken(&path, &page, &link) {
                violations.push(format!("{}: {link}: {what}", path.display()));
            }
        }
    }
    assert!(violations.is_empty(), "{}", violations.join("\n"));
    assert!(count > 60, "only {count} links were found");
}

#[test]
fn a_broken_link_is_found() {
    let page = "# One heading, two\n\nSee [a](#one-heading-two), `[c](nowhere)`.\n";
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("README.md");
    assert_eq!(links(page), ["#one-heading-two"]);
    assert_eq!(broken(&path, page, "#one-heading-two"), None);
    for bad in ["#two", "nowhere.md", "docs/report.md#nothing"] {
        assert!(broken(&path, page, bad).is_some(), "{bad}");
    }
}

#[test]
fn every_page_of_docs_stands_in_its_index_and_on_the_site() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    let named_by = |page: &str| -> BTreeSet<String> {
        let text = std::fs::read_to_string(docs.join(page)).unwrap();
        links(&text).into_iter().collect()
    };
    let (index, summary) = (named_by("README.md"), named_by("SUMMARY.md"));
    for entry in std::fs::read_dir(&docs).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if is_page(&path) && !["README.md", "SUMMARY.md"].contains(&name.as_str()) {
            assert!(index.contains(&name), "{name} is not in docs/README.md");
            assert!(summary.contains(&name), "{name} is not in docs/SUMMARY.md");
        }
    }
}

/// Figures of a page come from a program of the repository; this holds the words by which pages owned up to others.
#[test]
fn no_page_says_that_the_program_of_its_figures_was_not_kept() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut found = Vec::new();
    for path in pages(root) {
        let text = std::fs::read_to_string(&path).unwrap();
        let lines = (1..).zip(text.lines());
        let owning_up = lines.filter(|(_, line)| line.contains("not kept"));
        found.extend(owning_up.map(|(number, _)| format!("{}:{number}", path.display())));
    }
    assert!(found.is_empty(), "{found:#?}");
}
