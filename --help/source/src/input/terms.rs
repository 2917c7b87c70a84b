//! Words that mean one thing in one place and another elsewhere, or that no key is named by.

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
        "friction by the contact law under a normal load, as opposed to the linear limits stuck, slide and free; \
         nothing is said about the model",
    ),
    term(
        "full (option --fidelity, --reference)",
        "the model with every contact degree of freedom and no reduction basis, as opposed to the reduced one; \
         nothing is said about friction",
    ),
    term(
        "stuck (contact, load)",
        "linear limit: every contact pair is welded by its contact springs; the limit of a large normal load",
    ),
    term(
        "slide (contact, load)",
        "linear limit: contact pairs slide without friction and stay closed; the limit of a small normal load. \
         Its share of slipping pairs is no result and shown as -",
    ),
    term(
        "free (contact, load)",
        "linear limit: no contact springs at all, as if there were no damper",
    ),
    term(
        "normal load N",
        "static force that presses the two sides of the contact together on one sector; the wheel has it once per sector",
    ),
    term(
        "amplification factor",
        "largest amplitude of the mistuned wheel over that of the tuned wheel under the same normal load, engine \
         order and settings",
    ),
    term(
        "slip (summary), slipping_fraction (tables)",
        "share of the contact pairs that slip at any instant of a period, at the peak, mean over the wheels",
    ),
    term(
        "scenario",
        "one load case, engine order, standard deviation and normal load; a row is one wheel under one scenario",
    ),
    term(
        "pattern",
        "one random wheel: the deviations of all its blades; the same in every scenario",
    ),
];

/// The terms that every one of `words` occurs in, in any case of letters; all for no words.
#[must_use]
pub fn terms_about(words: &str) -> Vec<Term> {
    TERMS
        .iter()
        .filter(|term| mentions(&[term.word, term.meaning], words))
        .copied()
        .collect()
}

/// The term of this word.
#[must_use]
pub fn term_of(word: &str) -> Option<Term> {
    TERMS.iter().find(|term| term.word == word).copied()
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
