//! The face of the crate and the page that shows it.

/// The example of the crate's documentation, as its reader sees it.
fn doctest() -> String {
    let (_, rest) = include_str!("../../src/lib.rs")
        .split_once("//! ```\n")
        .unwrap();
    let (block, _) = rest.split_once("//! ```\n").unwrap();
    let mut shown = String::new();
    for line in block.lines().map(|line| line.trim_start_matches("//!")) {
        if !line.starts_with(" # ") {
            shown += line.strip_prefix(' ').unwrap_or(line);
            shown.push('\n');
        }
    }
    shown
}

#[test]
fn the_page_shows_the_example_that_the_documentation_of_the_crate_runs() {
    let page = include_str!("../../docs/library.md");
    let block = doctest();
    assert!(block.lines().count() >= 18, "{block}");
    assert!(
        page.contains(&format!("```rust\n{block}```\n")),
        "docs/library.md lacks\n{block}"
    );
}

/// Names that a `pub use` of the crate's root offers, by the text of `lib.rs`.
fn names(root: &str) -> Vec<&str> {
    let (root, _) = root.split_once("\n/// Parts of a [`SectorModel`]").unwrap();
    let uses = root.split("\npub use ").skip(1);
    let mut names = Vec::new();
    for text in uses {
        let (path, _) = text.split_once(';').unwrap();
        let listed = path
            .split_once('{')
            .map(|(_, inside)| inside.trim_end_matches('}'));
        let last = path.rsplit("::").next().unwrap_or(path);
        for name in listed.unwrap_or(last).split(',') {
            let name = name.rsplit(" as ").next().unwrap_or(name).trim();
            if !name.is_empty() {
                names.push(name);
            }
        }
    }
    names
}

#[test]
fn the_page_has_every_name_of_the_face_and_all_else_is_hidden() {
    let root = include_str!("../../src/lib.rs");
    let page = include_str!("../../docs/library.md");
    let names = names(root);
    assert!(
        (20..=30).contains(&names.len()),
        "{} names: {names:?}",
        names.len()
    );
    for name in ["Problem", "Engine", "lumped_sector", "run"] {
        assert!(names.contains(&name), "{name} is not seen among {names:?}");
    }
    let shown = |name: &&str| {
        let ends = |c: char| c != '_' && !c.is_alphanumeric();
        page.split(ends).any(|word| word == *name)
    };
    let lacking: Vec<&&str> = names.iter().filter(|name| !shown(name)).collect();
    assert!(lacking.is_empty(), "docs/library.md lacks {lacking:?}");
    let (modules, _) = root.split_once("// The face").unwrap();
    let (_, modules) = modules.split_once("\n#[cfg(feature").unwrap();
    let lines: Vec<&str> = modules.lines().collect();
    let open = lines
        .windows(2)
        .filter(|pair| pair[1].starts_with("pub mod"));
    let open: Vec<_> = open.filter(|pair| pair[0] != "#[doc(hidden)]").collect();
    assert!(open.is_empty(), "not hidden: {open:?}");
}
