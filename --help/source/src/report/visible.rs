//! Text out of files made safe to show: a terminal or browser is given no orders by it.

use std::borrow::Cow;

/// Whether a terminal or browser may take a character for an order: control characters but ends of lines and
/// tabs, and characters that turn the direction of writing or show nothing.
#[must_use]
pub fn is_order(character: char) -> bool {
    match character {
        '\n' | '\t' => false,
        '\u{ad}'
        | '\u{61c}'
        | '\u{200b}'..='\u{200f}'
        | '\u{2028}'..='\u{202e}'
        | '\u{2060}'..='\u{2069}'
        | '\u{feff}' => true,
        other => other.is_control(),
    }
}

/// `text` with such characters as `\u{1b}` and the like.
#[must_use]
pub fn visible(text: &str) -> Cow<'_, str> {
    with_orders_escaped(text, |character, escaped| {
        escaped.extend(character.escape_unicode());
    })
}

/// `text` with what `escape` makes of every such character.
#[must_use]
pub fn with_orders_escaped(text: &str, escape: impl Fn(char, &mut String)) -> Cow<'_, str> {
    if !text.contains(is_order) {
        return Cow::Borrowed(text);
    }
    let mut escaped = String::with_capacity(text.len() + 16);
    for character in text.chars() {
        if is_order(character) {
            escape(character, &mut escaped);
        } else {
            escaped.push(character);
        }
    }
    Cow::Owned(escaped)
}

#[cfg(test)]
mod tests {
    use super::visible;

    #[test]
    fn orders_to_a_terminal_become_visible_and_everything_else_stays() {
        let plain = "a\tb\n24 blades, 3 µm – 95 %";
        assert_eq!(visible(plain), plain);
        assert_eq!(
            visible("\u{1b}[2J\r\u{9b}31m\u{7f}\u{202e}\u{61c}\u{2060}\u{ad}"),
            "\\u{1b}[2J\\u{d}\\u{9b}31m\\u{7f}\\u{202e}\\u{61c}\\u{2060}\\u{ad}"
        );
    }
}
