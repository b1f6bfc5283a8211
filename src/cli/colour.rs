//! Whether messages are in colours, and the colours of those that are no diagnostics of a file. In: the environment. Out: a choice,
//! text with the marks that terminals obey. Never knows what is said.

use std::env;
use std::ffi::{OsStr, OsString};
use std::io::{IsTerminal as _, stderr};

/// Bold red, bold, and back.
const ERROR: &str = "\u{1b}[1;31m";
const STRONG: &str = "\u{1b}[1m";
const PLAIN: &str = "\u{1b}[0m";

/// Whether what is written to stderr shall have colours: on terminals, but by `NO_COLOR` (no-color.org) never, and by
/// `CLICOLOR_FORCE` always.
pub fn wanted() -> bool {
    let [none, force, term] = ["NO_COLOR", "CLICOLOR_FORCE", "TERM"].map(env::var_os);
    decided(stderr().is_terminal(), [none, force, term])
}

fn decided(is_terminal: bool, [none, force, term]: [Option<OsString>; 3]) -> bool {
    let is_set = |value: &Option<OsString>| value.as_deref().is_some_and(|value| !value.is_empty());
    if is_set(&none) {
        return false;
    }
    if is_set(&force) && force.as_deref() != Some(OsStr::new("0")) {
        return true;
    }
    is_terminal && term.as_deref() != Some(OsStr::new("dumb"))
}

/// A message `error[C0001]: what`, in colours.
pub fn painted(text: &str) -> String {
    let (first, rest) = text.split_once('\n').map_or((text, ""), |(first, rest)| (first, rest));
    let Some((code, message)) = first.split_once(": ") else { return text.to_owned() };
    let line = if rest.is_empty() { "" } else { "\n" };
    format!("{ERROR}{code}{PLAIN}{STRONG}: {message}{PLAIN}{line}{rest}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_for_terminals_unless_the_environment_says_otherwise() {
        let given = |text: &str| Some(OsString::from(text));
        assert!(decided(true, [None, None, given("xterm")]));
        assert!(decided(true, [given(""), None, None]), "an empty NO_COLOR says nothing");
        assert!(!decided(true, [None, None, given("dumb")]));
        assert!(!decided(false, [None, None, None]));
        assert!(decided(false, [None, given("1"), None]));
        assert!(!decided(false, [None, given("0"), None]));
        for terminal in [true, false] {
            assert!(!decided(terminal, [given("1"), given("1"), None]));
        }
    }

    #[test]
    fn the_code_and_the_message_stand_out() {
        assert_eq!(
            painted("error[C0001]: no: such\n  = help: x"),
            "\u{1b}[1;31merror[C0001]\u{1b}[0m\u{1b}[1m: no: such\u{1b}[0m\n  = help: x"
        );
    }
}
