//! `explain`: what a code means, with an example and its cure. Codes of mechanism files are explained beside their list, in the
//! generator; those of the command line in `commands.rs`.

mod commands;

use linkwear_codegen::diagnostic::{Code, Explanation, Severity, nearest};

use super::answer::Answer;
use super::answer::explain::{BesideAnswer, ExplainAnswer};
use super::failure::Failure;
use commands::COMMANDS;

pub fn run(asked: &str) -> Result<Answer, Failure> {
    let code = bare(asked);
    let known = Code::ALL.iter().copied().find(|known| known.as_str().eq_ignore_ascii_case(code));
    let told = known.and_then(of_file).or_else(|| of_command_line(code));
    let told = told.ok_or_else(|| unknown(code))?;
    Ok(Answer::new(text(&told), told, None))
}

/// As it stands in a message: `error[E0204]:` is E0204.
fn bare(asked: &str) -> &str {
    let inside = asked.split_once('[').map_or(asked, |(_, rest)| rest);
    inside.split(']').next().unwrap_or_default().trim()
}

fn of_file(code: Code) -> Option<ExplainAnswer> {
    let explanation = code.explanation()?;
    let (wrong, right) = (explanation.wrong, explanation.right);
    Some(ExplainAnswer {
        code: code.as_str(),
        severity: if code.severity() == Severity::Error { "error" } else { "warning" },
        title: code.title(),
        text: explanation.text,
        wrong,
        right,
        wrong_file: Some(explanation.file(wrong)),
        right_file: Some(explanation.file(right)),
        beside: beside([wrong, right]),
    })
}

fn of_command_line(code: &str) -> Option<ExplainAnswer> {
    let known = COMMANDS.iter().find(|known| known.code.eq_ignore_ascii_case(code))?;
    Some(ExplainAnswer {
        code: known.code,
        severity: if known.code.starts_with('C') { "error" } else { "warning" },
        title: known.title,
        text: known.text,
        wrong: known.wrong,
        right: known.right,
        wrong_file: None,
        right_file: None,
        beside: Vec::new(),
    })
}

/// Each once, in the order in which they are named.
fn beside(examples: [&str; 2]) -> Vec<BesideAnswer> {
    let mut files: Vec<BesideAnswer> = Vec::new();
    for (name, text) in examples.into_iter().flat_map(Explanation::beside) {
        if !files.iter().any(|known| known.name == name) {
            files.push(BesideAnswer { name, text });
        }
    }
    files
}

fn unknown(code: &str) -> Failure {
    let codes = Code::ALL.iter().map(|code| code.as_str()).chain(COMMANDS.iter().map(|known| known.code));
    let help = match nearest(&code.to_uppercase(), codes) {
        Some(near) => format!("did you mean `{near}`?"),
        None => "codes stand in brackets in messages, as E0204 in `error[E0204]`".to_owned(),
    };
    Failure::usage(format!("there is no code `{code}`"), help)
}

fn text(told: &ExplainAnswer) -> String {
    let ExplainAnswer { code, title, text, wrong, right, beside, .. } = told;
    let indented = |lines: &str| -> String {
        lines.lines().map(|line| format!("  {line}\n").replace("  \n", "\n")).collect()
    };
    let text = folded(text);
    let beside: String =
        beside.iter().map(|file| format!("\n{}:\n{}", file.name, indented(file.text))).collect();
    format!("{code}: {title}\n\n{text}\nWrong:\n{}\nRight:\n{}{beside}", indented(wrong), indented(right))
}

/// Lines of a paragraph, no longer than a terminal is wide.
fn folded(text: &str) -> String {
    const WIDTH: usize = 100;
    let mut lines = String::new();
    let mut length = 0;
    for word in text.split(' ') {
        let letters = word.chars().count();
        if length > 0 && length + letters >= WIDTH {
            lines.push('\n');
            length = 0;
        } else if length > 0 {
            lines.push(' ');
            length += 1;
        }
        lines.push_str(word);
        length += letters;
    }
    lines.push('\n');
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_found_as_messages_write_them() {
        for asked in ["E0204", "e0204", "error[E0204]", "error[E0204]:"] {
            assert!(run(asked).is_ok(), "{asked}");
        }
        assert!(run("c0008").is_ok() && run("life").is_ok());
    }

    #[test]
    fn every_code_that_the_command_line_says_is_explained() {
        let sources = [include_str!("failure.rs"), include_str!("../study/run.rs")];
        let said = sources.iter().flat_map(|source| source.split('"').skip(1).step_by(2));
        let said = said.filter(|text| {
            text.len() == 5 && text.starts_with('C') && text[1..].bytes().all(|byte| byte.is_ascii_digit())
        });
        let mut count = 0;
        for code in said {
            assert!(of_command_line(code).is_some(), "{code}");
            count += 1;
        }
        assert!(count > 15, "{count}");
    }

    #[test]
    fn paragraphs_are_no_wider_than_a_terminal() {
        let text = folded("word ".repeat(50).trim());
        assert!(text.lines().all(|line| line.len() < 100) && text.lines().count() == 3, "{text}");
    }
}
