//! Texts of others in messages: no longer than they are read, nothing that a terminal obeys.

/// Letters of what stands in quotes.
const QUOTED: usize = 40;
/// Letters of a message.
const MESSAGE: usize = 2_000;
/// Letters of a sentence about the file of somebody else.
const SENTENCE: usize = 300;

/// A text of at most so many letters, control characters written out; `…` tells that there is more.
pub fn cut(text: &str, most: usize) -> String {
    let mut shown = String::new();
    for (at, letter) in text.chars().enumerate() {
        if at == most {
            shown.push('…');
            break;
        }
        if letter.is_control() && letter != '\n' {
            shown.extend(letter.escape_default());
        } else {
            shown.push(letter);
        }
    }
    shown
}

/// A message about the file of who reads it, whose names can be as long as the file.
pub fn bounded(text: &str) -> String {
    cut(text, MESSAGE)
}

/// A sentence about what is not to be shown: of quotes the beginning, and little in all.
pub fn brief(text: &str) -> String {
    let mut shown = String::new();
    let mut rest = text;
    while let Some((start, quote)) = rest.char_indices().find(|(_, letter)| matches!(letter, '`' | '"')) {
        let inside = &rest[start + 1..];
        let end = inside.find(quote).unwrap_or(inside.len());
        shown.push_str(&rest[..=start]);
        shown.push_str(&cut(&inside[..end], QUOTED));
        rest = inside.get(end + 1..).unwrap_or_default();
        shown.push(quote);
    }
    shown.push_str(rest);
    cut(&shown.replace('\n', " "), SENTENCE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quotes_are_cut_and_what_a_terminal_obeys_is_written_out() {
        let secret = "s".repeat(100);
        let shown = brief(&format!("invalid type: string \"{secret}\", expected `a` or `b`"));
        assert_eq!(shown, format!("invalid type: string \"{}…\", expected `a` or `b`", "s".repeat(40)));
        assert_eq!(brief("a `\u{1b}[2J` \"open"), "a `\\u{1b}[2J` \"open\"");
        assert_eq!(brief(&"x".repeat(1000)).chars().count(), 301);
        assert_eq!(cut("µ\nm\t", 2), "µ\n…");
    }
}
