//! The page of the library shows what the documentation of the crate tests.

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
