//! The terms of `docs/glossary.md` and the warnings of `docs/results.md`, in plain text.

use std::sync::LazyLock;

/// Words and meanings of the page, in its order.
static WRITTEN: LazyLock<Vec<(String, String)>> =
    LazyLock::new(|| terms(include_str!("../../docs/glossary.md")));

/// The terms of the page, each with its meaning.
pub(super) fn glossary() -> impl Iterator<Item = (&'static str, &'static str)> {
    let written: &'static [(String, String)] = &WRITTEN;
    { written.iter() }.map(|(word, meaning)| (word.as_str(), meaning.as_str()))
}

/// The terms of a page's tables: term, meaning, unit, where it is defined.
fn terms(page: &str) -> Vec<(String, String)> {
    let term = |[word, meaning, unit]: [&str; 3]| {
        let unit = match unit {
            "" | "1" | "as the value" | "as the figure" => String::new(),
            unit => format!(" Unit: {unit}."),
        };
        (word.to_owned(), plain(&format!("{meaning}{unit}")))
    };
    rows(page.lines(), "term").map(term).collect()
}

/// The first three cells of every row of the tables among `lines` but their heads, which begin with `head`.
fn rows<'a>(
    lines: impl Iterator<Item = &'a str>,
    head: &str,
) -> impl Iterator<Item = [&'a str; 3]> {
    let cells = lines.filter_map(|line| {
        let mut cells = line.strip_prefix('|')?.split('|').map(str::trim);
        Some([cells.next()?, cells.next()?, cells.next()?])
    });
    cells.filter(move |[first, ..]| *first != head && !first.starts_with("---"))
}

/// Warnings of the page on results, each with what it means and what to do.
static WARNINGS: LazyLock<Vec<(String, String)>> =
    LazyLock::new(|| warnings(include_str!("../../docs/results.md")));

/// The warnings of the page, each with what it means and what to do.
pub(super) fn known_warnings() -> impl Iterator<Item = (&'static str, &'static str)> {
    let written: &'static [(String, String)] = &WARNINGS;
    { written.iter() }.map(|(words, meaning)| (words.as_str(), meaning.as_str()))
}

/// The rows of the table below the heading of the warnings: warning, meaning, what to do.
fn warnings(page: &str) -> Vec<(String, String)> {
    let below = { page.lines() }.skip_while(|line| *line != "## Warnings");
    let below = below.skip(1).take_while(|line| !line.starts_with("## "));
    let warning = |[words, meaning, to_do]: [&str; 3]| {
        (
            plain(words),
            plain(&format!("{meaning}. What to do: {to_do}")),
        )
    };
    rows(below, "warning").map(warning).collect()
}

/// Markdown as plain text: no marks of code, and a link as the file it leads to.
#[must_use]
pub fn plain(words: &str) -> String {
    let mut parts = words.split(['[', ']']);
    let mut plain = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        // `[file](file)` comes as `file` and `(file)...`.
        match part.strip_prefix('(').and_then(|rest| rest.split_once(')')) {
            Some((_, rest)) => plain.push_str(rest),
            None => plain.push_str(part),
        }
    }
    plain.replace('`', "")
}

#[cfg(test)]
mod tests {
    use super::{glossary, known_warnings, terms, warnings};

    #[test]
    fn rows_of_tables_are_terms() {
        let page = "# Page\n\n| term | meaning | unit | defined in |\n| --- | --- | --- | --- |\n\
                    | a wheel | As `b` in [c](d.md). | Hz | [e](e.md) |\n\nText | more.\n";
        let term = ("a wheel".to_owned(), "As b in c. Unit: Hz.".to_owned());
        assert_eq!(terms(page), [term]);
        assert!(glossary().count() > 40);
    }

    #[test]
    fn rows_below_the_heading_of_warnings_are_warnings() {
        let page = "# Page\n\n| a | b | c |\n\n## Warnings\n\n| warning | meaning | what to do |\n| --- | --- | --- |\n\
                    | rows `fail` | no result | see [c](d.md) |\n\n## Next\n\n| e | f | g |\n";
        let row = (
            "rows fail".to_owned(),
            "no result. What to do: see c".to_owned(),
        );
        assert_eq!(warnings(page), [row]);
        assert!(known_warnings().count() > 8);
    }
}
