//! The pages have short sentences: at most twenty words in the mean of each page.

use std::path::Path;

use super::complain;

/// Most words of a sentence, in the mean of a page.
const MOST_WORDS: f64 = 20.0;

/// The running text of a page: paragraphs and items of lists, without code, tables, headings and comments.
fn paragraphs(page: &str) -> Vec<String> {
    let mut found = vec![String::new()];
    let mut in_code = false;
    for line in page.lines() {
        let text = line.trim().trim_start_matches("> ");
        let fence = text.starts_with("```");
        in_code ^= fence;
        let begun = found.last().is_some_and(|last| !last.is_empty());
        let is_code = in_code || fence || line.starts_with("    ") && !begun;
        let is_text = !["#", "|", "<!--"].iter().any(|mark| text.starts_with(mark));
        let item = item(text);
        if (is_code || !is_text || text.is_empty() || item.is_some()) && begun {
            found.push(String::new());
        }
        if !is_code && is_text && !text.is_empty() {
            let last = found.last_mut().expect("one at least");
            *last += item.unwrap_or(text);
            last.push(' ');
        }
    }
    found.retain(|paragraph| !paragraph.is_empty());
    found
}

/// What an item of a list says; none for other lines.
fn item(text: &str) -> Option<&str> {
    let numbered = || {
        let (number, rest) = text.split_once(". ")?;
        let digits = !number.is_empty() && number.chars().all(|letter| letter.is_ascii_digit());
        digits.then_some(rest)
    };
    ["- ", "* "]
        .iter()
        .find_map(|mark| text.strip_prefix(mark))
        .or_else(numbered)
}

/// A paragraph with a word in the place of code in backticks, and without targets of links.
fn without_code(paragraph: &str) -> String {
    let parts = paragraph.split('`').enumerate();
    let plain: String = parts
        .map(|(place, part)| if place % 2 == 0 { part } else { "code" })
        .collect();
    let mut text = String::new();
    for (place, part) in plain.split("](").enumerate() {
        let rest = part.split_once(')').map_or("", |(_, rest)| rest);
        text += if place == 0 { part } else { rest };
    }
    text
}

/// Words of every sentence. A sentence ends with a full stop, question or exclamation mark before a capital, a digit or code.
fn words_of_sentences(page: &str) -> Vec<usize> {
    let mut counts = Vec::new();
    for paragraph in paragraphs(page) {
        let text = without_code(&paragraph);
        let words: Vec<&str> = text.split_whitespace().collect();
        let mut count = 0;
        for (place, word) in words.iter().enumerate() {
            count += usize::from(word.contains(char::is_alphanumeric));
            let closed = word.trim_end_matches(['*', '_', ')', '"', ']']);
            let stops = closed.ends_with(['.', '?', '!']);
            let begins = words.get(place + 1).is_none_or(|next| {
                let next = next.trim_start_matches(['*', '_', '(', '"', '[', '!']);
                let first = next.chars().next();
                first.is_none_or(|letter| letter.is_uppercase() || letter.is_ascii_digit())
                    || next.starts_with("code")
            });
            if begins && (stops || place + 1 == words.len()) {
                counts.extend((count > 0).then_some(count));
                count = 0;
            }
        }
    }
    counts
}

fn mean(page: &str) -> f64 {
    let counts = words_of_sentences(page);
    counts.iter().sum::<usize>() as f64 / counts.len().max(1) as f64
}

/// README.md, CONTRIBUTING.md, python/README.md and every page of `docs`. `BLISK_SHOW_SENTENCES=1` with `--nocapture` prints the means.
#[test]
fn sentences_of_a_page_have_at_most_twenty_words_in_the_mean() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut paths: Vec<_> = ["README.md", "CONTRIBUTING.md", "python/README.md"]
        .map(|page| root.join(page))
        .into();
    let entries = std::fs::read_dir(root.join("docs")).expect("docs");
    paths.extend(entries.map(|entry| entry.expect("an entry").path()));
    paths.retain(|path| path.extension().is_some_and(|ending| ending == "md"));
    paths.sort();
    assert!(paths.len() > 20, "{paths:?}");
    let means: Vec<(String, f64)> = paths
        .iter()
        .map(|path| {
            let name = path.file_name().expect("a name").to_string_lossy();
            let page = std::fs::read_to_string(path).expect("a page");
            (name.into_owned(), mean(&page))
        })
        .collect();
    if std::env::var_os("BLISK_SHOW_SENTENCES").is_some() {
        complain("words of a sentence in the mean", &said(&means, 0.0));
    }
    complain(
        "pages with long sentences in the mean",
        &said(&means, MOST_WORDS),
    );
}

fn said(means: &[(String, f64)], more_than: f64) -> Vec<String> {
    let long = means.iter().filter(|(_, mean)| *mean > more_than);
    long.map(|(name, mean)| format!("{name}: {mean:.1} words"))
        .collect()
}

#[test]
fn words_of_sentences_are_counted() {
    let page = "# A heading of five words\n\nOne two `x = 1. Y` four. Five six\nseven, i.e. eight: 9 (10).\n\n\
                | no | sentence |\n\n    no code either\n\n```sh\nnor here\n```\n\n- An item. Another [one](a.md).\n1. Third\n   item?\n";
    assert_eq!(words_of_sentences(page), [4, 7, 2, 2, 2]);
    let long = "word ".repeat(30) + "end.\n";
    assert!(mean(&long) > MOST_WORDS);
    assert!(mean(&(long + "\nShort one.")) < MOST_WORDS);
}
