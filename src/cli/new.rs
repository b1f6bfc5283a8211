//! `new`: a commented file to start from.

use std::io::Write as _;
use std::path::PathBuf;

use crate::files::{WriteError, write_whole};

use super::answer::Answer;
use super::answer::equations::NewAnswer;
use super::arguments::NewArguments;
use super::failure::Failure;

const STARTER: &str = include_str!("starter.toml");

pub fn run(arguments: &NewArguments) -> Result<Answer, Failure> {
    let name = &arguments.name;
    if !is_name(name) {
        let help = "use letters, digits and _, and begin with a letter; the file is NAME.toml here";
        return Err(Failure::usage(format!("`{name}` is no name for a mechanism"), help));
    }
    let path = PathBuf::from(format!("{name}.toml"));
    if path.exists() {
        return Err(WriteError::Exists(path).into());
    }
    let starter = STARTER.replace("starter", name);
    write_whole(&path, |file| file.write_all(starter.as_bytes()))?;
    let shown = path.display();
    let text = format!("{shown} written. Next:\n  linkwear check {shown}\n  linkwear simulate {shown}");
    Ok(Answer::new(text, NewAnswer { file: shown.to_string() }, None))
}

fn is_name(text: &str) -> bool {
    text.starts_with(|first: char| first.is_ascii_alphabetic())
        && text.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_')
}

#[cfg(test)]
mod tests {
    use super::*;
    use linkwear_codegen::{Options, SourceFile, compile};

    #[test]
    fn the_starter_compiles_without_a_warning() {
        let source = SourceFile { name: "starter.toml".to_owned(), text: STARTER.to_owned() };
        let compiled = compile(&source, &Options::default()).unwrap_or_else(|errors| panic!("{errors}"));
        assert!(compiled.warnings.is_empty());
    }

    #[test]
    fn names_are_those_a_file_may_use() {
        assert!(is_name("four_bar2"));
        for bad in ["", "2bars", "four-bar", "../x", "é"] {
            assert!(!is_name(bad), "{bad}");
        }
    }
}
