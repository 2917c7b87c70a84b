//! Blocks of TOML that the pages show are accepted in a study, with nothing else changed than what the page says.

use toml::{Table, Value};

use crate::blisk::{GOOD, Place};
use crate::documentation::pages;

/// Pages whose blocks are parts of a study, and how many each has.
const PAGES: [(&str, usize); 4] = [
    ("docs/study-file.md", 6),
    ("docs/reading-results.md", 1),
    ("docs/statistics.md", 1),
    ("docs/sector-bundle.md", 1),
];

/// Blocks of code of a page, fenced as `language` or, for TOML, indented.
fn blocks(page: &str, language: &str) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    let (mut fence, mut open): (Option<&str>, bool) = (None, false);
    for line in page.lines() {
        match (fence, line.strip_prefix("```"), line.strip_prefix("    ")) {
            (None, Some(name), _) => {
                fence = Some(name);
                if name == language {
                    found.push(String::new());
                }
            }
            (Some(_), Some(_), _) => fence = None,
            (Some(name), None, _) if name == language => {
                let block = found.last_mut().expect("an open block");
                block.push_str(line);
                block.push('\n');
            }
            (None, None, Some(code)) if language == "toml" => {
                if !open {
                    found.push(String::new());
                    open = true;
                }
                let block = found.last_mut().expect("an open block");
                block.push_str(code);
                block.push('\n');
                continue;
            }
            // An empty line may stand within an indented block.
            (None, None, None) if line.is_empty() => continue,
            _ => {}
        }
        open = false;
    }
    // Indented are commands and formulas, too.
    found.retain(|block| {
        language != "toml" || ["[", "schema"].iter().any(|start| block.starts_with(start))
    });
    found
}

/// Puts the keys of a block into a study. Masses and measured wheels stand in the place of what there is.
fn put(study: &mut Table, block: Table) {
    for (key, value) in block {
        match (study.get_mut(&key), value) {
            (Some(Value::Table(there)), Value::Table(new))
                if key != "lumped" && !(key == "mistuning" && new.contains_key("file")) =>
            {
                put(there, new);
            }
            (_, value) => {
                study.insert(key, value);
            }
        }
    }
}

fn table<'a>(study: &'a mut Table, name: &str) -> &'a mut Table {
    study[name].as_table_mut().expect("a table")
}

#[test]
fn blocks_of_the_pages_are_accepted_in_a_study() {
    let pages = pages();
    for (name, count) in PAGES {
        let (_, page) = pages.iter().find(|own| own.0 == name).expect(name);
        let blocks = blocks(page, "toml");
        assert_eq!(blocks.len(), count, "{name}: {blocks:#?}");
        for block in blocks {
            let place = Place::new();
            let own: Table = block
                .parse()
                .unwrap_or_else(|error| panic!("{name}: {error}\n{block}"));
            let base = if block.contains("[model.lumped]") {
                GOOD
            } else {
                include_str!("../../studies/quickstart.toml")
            };
            let mut study: Table = base.parse().expect("TOML");
            put(&mut study, own);
            if block.contains("file = \"wheel.csv\"") {
                // The file that the page begins, "and so on, a line for every blade"; what the page says to leave out.
                let begun = self::blocks(page, "text").remove(0);
                let next = begun.lines().count() - 1;
                let rest: Vec<String> = (next..24).map(|own| format!("0,{own},0.01\n")).collect();
                place.write("wheel.csv", &(begun + &rest.concat()));
                for (at, key) in [("study", "patterns"), ("sweep", "standard_deviation")] {
                    let said = format!("`{at}.{key}`");
                    assert!(page.contains(&said), "{name} says nothing of {said}");
                    table(&mut study, at).remove(key);
                }
            }
            if block.contains("source = \"bundle\"") {
                // A whole study of the bundle that the page begins with.
                study = block.parse().expect("TOML");
                let first = [
                    "init --example lumped24 --out lumped24.toml",
                    "model lumped24.toml --export bundle",
                ];
                for command in first {
                    let words: Vec<&str> = command.split(' ').collect();
                    assert_eq!(place.run(&words).code, 0, "{command}");
                }
            }
            if block.contains("forces/cruise.csv") {
                std::fs::create_dir(place.path("forces")).expect("a folder");
                place.write("forces/cruise.csv", "dof,re,im\n0,1.0,0.5\n");
            }
            place.write("study.toml", &study.to_string());
            let ended = place.run(&["check", "study.toml"]);
            assert_eq!(ended.code, 0, "{name}:\n{block}\n{}", ended.stderr);
        }
    }
}

#[test]
fn a_block_with_a_wrong_key_would_be_noticed() {
    let page = "Text:\n\n    [contact]\n    friction = 0.3\n\n    [damping]\n    modal_ratio = 0.1\n\nAnd:\n\n```toml\n[stop]\npercentile = 95\n```\n";
    let found = blocks(page, "toml");
    assert_eq!(found.len(), 2, "{found:#?}");
    let mut study: Table = GOOD.parse().expect("TOML");
    put(&mut study, found[0].parse().expect("TOML"));
    let place = Place::with(&study.to_string());
    let ended = place.run(&["check", "study.toml"]);
    assert_eq!(ended.code, 3, "{}", ended.stdout);
    assert!(
        ended.stderr.contains("contact.friction"),
        "{}",
        ended.stderr
    );
}
