//! Texts, numbers and comments as C writes them. In: values. Out: text.

use super::super::comment::one_line;

/// A number as its shortest literal that reads back to the same bits.
pub fn number(value: f64) -> String {
    if value.is_nan() {
        "(double)NAN".to_owned()
    } else if value.is_infinite() {
        if value > 0.0 { "HUGE_VAL" } else { "-HUGE_VAL" }.to_owned()
    } else {
        format!("{value:?}")
    }
}

/// User text for a comment: one line, nothing that begins or ends one.
pub fn comment(text: &str) -> String {
    one_line(text).replace("*/", "* /").replace("/*", "/ *").replace("??", "? ?").replace('\\', "/")
}

/// A literal of a text, whatever is in it.
pub fn literal(text: &str) -> String {
    let mut quoted = String::from("\"");
    for byte in text.bytes() {
        match byte {
            // A question mark could begin a trigraph.
            b'"' | b'\\' | b'?' => quoted.extend(['\\', char::from(byte)]),
            b' '..=b'~' => quoted.push(char::from(byte)),
            _ => quoted.push_str(&format!("\\{byte:03o}")),
        }
    }
    quoted + "\""
}

/// Lines as a comment before what they are about.
pub fn block(lines: &[String]) -> String {
    let lines: Vec<String> =
        lines.iter().map(|line| format!(" * {}", comment(line)).trim_end().to_owned()).collect();
    format!("/*\n{}\n */\n", lines.join("\n"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_that_a_user_writes_leaves_its_literal_or_comment() {
        assert_eq!(literal("a\"b\\\n?\u{e9}"), "\"a\\\"b\\\\\\012\\?\\303\\251\"");
        assert_eq!(comment("a */ b /* c\nd \\"), "a * / b / * c d /");
    }

    #[test]
    fn numbers_read_back_to_their_bits() {
        assert_eq!([1.0, -0.0, 1e-320, 1e22].map(number), ["1.0", "-0.0", "1e-320", "1e22"]);
    }
}
