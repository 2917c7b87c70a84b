//! Words that mean one thing in one place and another elsewhere, or that no key is named by, and those of the glossary.

use super::glossary::{glossary, known_warnings};

/// A word with its meaning.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Term {
    /// The word, with where it stands.
    pub word: &'static str,
    /// What it means there.
    pub meaning: &'static str,
}

const fn term(word: &'static str, meaning: &'static str) -> Term {
    Term { word, meaning }
}

/// Words of tables, options and texts.
const TERMS: &[Term] = &[
    term(
        "full (column contact)",
        "friction by the contact law under a normal load, as opposed to the linear solutions stuck, slide and free; \
         nothing is said about the model",
    ),
    term(
        "full (option --fidelity, --reference)",
        "the model with every contact degree of freedom and no reduction basis, as opposed to the reduced one; \
         nothing is said about friction",
    ),
    term(
        "stuck (contact, load)",
        "linear solution, a limit of friction: every contact pair is welded by its contact springs; the limit of a large normal load",
    ),
    term(
        "slide (contact, load)",
        "linear solution, a limit of friction: contact pairs slide without friction and stay closed; the limit of small friction, not of a small normal load where pairs open. \
         Its share of slipping pairs is no result and shown as -",
    ),
    term(
        "free (contact, load)",
        "linear solution: no contact springs at all, as if there were no damper",
    ),
    term(
        "normal load N",
        "static force that presses the two sides of the contact together on one sector; the wheel has it once per sector",
    ),
    term(
        "slip (summary), slipping_fraction (tables)",
        "share of the contact pairs that slip at any instant of a period, at the peak, mean over the wheels",
    ),
    term(
        "peak, at Hz (summary)",
        "frequency of the peak of the tuned wheel",
    ),
    term(
        "peak amplitude",
        "the largest amplitude of any blade at any frequency near the resonance, at the first observed node",
    ),
    term(
        "percentile P50, P95, P99",
        "50, 95, 99 % of such wheels have a lower value",
    ),
    term(
        "bounds, 95 % interval",
        "the percentile of all such wheels lies in it with 95 % confidence, whatever its law; failed rows are taken \
         as infinitely low and high. The summary has it in brackets",
    ),
    term(
        "status: ok, failed (summary)",
        "rows with a result, and rows without one; a failed row is counted and never dropped, and its column status \
         says how its solution ended",
    ),
    term(
        "separation: separated (summary)",
        "share of the wheels of which at least one contact pair has no normal load at some instant, at the peak",
    ),
    term(
        "not estimable, not settled, -",
        "not estimable: too few patterns for an interval of this percentile; not settled: neither stability nor \
         instability was shown; -: no number",
    ),
    term(
        "stated error, numerical error",
        "bound on the relative error of a row by its harmonics, samples, basis and peak search; not of the model that \
         was given",
    ),
    term(
        "warning (summary)",
        "what a reader of the numbers must know, and what can be done about it; the page docs/results.md has a table \
         of all warnings",
    ),
    term(
        "optimum, lowest P95 amplitude (summary)",
        "the normal load with the lowest percentile among those studied; enclosed if a lower and a higher load were \
         studied. The command optimum searches between them",
    ),
    term(
        "bar (validation report)",
        "limit, fixed beforehand, that a figure must keep",
    ),
    term(
        "verdict (validation report)",
        "outcome of setting a figure against a bar (met or not), or against a claim about dampers (confirmed, refuted or \
         open)",
    ),
];

/// The words above, and those of the glossary that they do not say more of.
fn all_terms() -> impl Iterator<Item = Term> {
    let is_other = |term: &Term| {
        let of_term = |own: &Term| own.word.split([',', ':', '(']).next().map(str::trim);
        !{ TERMS.iter() }.any(|own| of_term(own) == Some(term.word))
    };
    let of_glossary = glossary().map(|(word, meaning)| term(word, meaning));
    { TERMS.iter().copied() }.chain(of_glossary.filter(is_other))
}

/// The terms that every one of `words` occurs in, in any case of letters; all for no words. Those that are named by
/// them come before those that mention them.
#[must_use]
pub fn terms_about(words: &str) -> Vec<Term> {
    let mut found: Vec<Term> = all_terms()
        .filter(|term| mentions(&[term.word, term.meaning], words))
        .collect();
    found.sort_by_key(|term| !mentions(&[term.word], words));
    found
}

/// The warnings that have all of these words, as they are printed: numbers, and names of one letter, are those of a study.
#[must_use]
pub fn warnings_about(words: &str) -> Vec<Term> {
    let of_study =
        |word: &&str| word.len() < 2 || word.contains(|letter: char| letter.is_ascii_digit());
    let words: Vec<&str> = words
        .split(|letter: char| letter.is_whitespace() || ",;:.".contains(letter))
        .filter(|word| !of_study(word))
        .collect();
    let words = words.join(" ");
    if words.is_empty() {
        return Vec::new();
    }
    { known_warnings() }
        .filter(|(own, _)| mentions(&[own], &words))
        .map(|(own, meaning)| term(own, meaning))
        .collect()
}

/// The name of every term, without where it stands.
pub fn names_of_terms() -> impl Iterator<Item = &'static str> {
    all_terms().filter_map(|term| term.word.split([',', ':', '(']).next().map(str::trim))
}

/// The term of this word.
#[must_use]
pub fn term_of(word: &str) -> Option<Term> {
    all_terms().find(|term| term.word == word)
}

/// Whether the texts together have every one of `words`, in any case of letters.
pub(crate) fn mentions(texts: &[&str], words: &str) -> bool {
    let text = texts.join(" ").to_lowercase();
    let spaced = text.replace('_', " ");
    words
        .to_lowercase()
        .split_whitespace()
        .all(|word| text.contains(word) || spaced.contains(word))
}
