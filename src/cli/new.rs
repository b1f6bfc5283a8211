//! `new`: a commented file to start from, and the commands to go on with.

use std::io::Write as _;
use std::path::PathBuf;

use crate::files::{WriteError, write_whole};

use super::answer::Answer;
use super::answer::equations::NewAnswer;
use super::arguments::NewArguments;
use super::failure::Failure;
use super::table::table;

/// What to ask next, in this order: the question, what else stands on its line for a mechanism of this name, what it tells.
const NEXT: [(&str, &str, &str); if cfg!(feature = "page") { 5 } else { 3 }] = {
    const CHECK: (&str, &str, &str) = ("check", "", "what it is, and what is wrong with it");
    const SIMULATE: (&str, &str, &str) = ("simulate", "", "one turn: motion, forces, energies");
    const LIFE: (&str, &str, &str) = ("life", "", "how long what wears lasts");
    #[cfg(feature = "page")]
    let next = [
        CHECK,
        ("view", " -o NAME_moving.html", "look at it in a browser"),
        SIMULATE,
        LIFE,
        ("report", " -o NAME.html", "all of it on one page"),
    ];
    #[cfg(not(feature = "page"))]
    let next = [CHECK, SIMULATE, LIFE];
    next
};

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
    let starter = arguments.starter.text().replace("starter", name);
    write_whole(&path, |file| file.write_all(starter.as_bytes()))?;
    let shown = path.display();
    let next: Vec<String> = NEXT
        .iter()
        .map(|(question, rest, _)| format!("linkwear {question} {shown}{}", rest.replace("NAME", name)))
        .collect();
    let lines: Vec<Vec<String>> =
        next.iter().zip(NEXT).map(|(line, (.., tells))| vec![line.clone(), tells.to_owned()]).collect();
    let text = format!("{shown} written. Next:\n{}", table(&["", ""], &lines));
    Ok(Answer::new(text.trim_end().to_owned(), NewAnswer { file: shown.to_string(), next }, None))
}

fn is_name(text: &str) -> bool {
    text.starts_with(|first: char| first.is_ascii_alphabetic())
        && text.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_')
}

#[cfg(test)]
mod tests {
    use super::super::starters::Starter;
    use super::*;
    use clap::ValueEnum;
    use linkwear_codegen::{Options, SourceFile, compile};

    #[test]
    fn every_starter_compiles_without_a_warning_and_wears() {
        for starter in Starter::value_variants() {
            let source = SourceFile { name: "starter.toml".to_owned(), text: starter.text().to_owned() };
            let compiled = compile(&source, &Options::default()).unwrap_or_else(|errors| panic!("{errors}"));
            assert!(compiled.warnings.is_empty(), "{starter:?}: {:?}", compiled.warnings);
            assert!(
                compiled.description().contacts.iter().any(|contact| contact.wear.is_some()),
                "{starter:?}"
            );
        }
    }

    #[test]
    fn names_are_those_a_file_may_use() {
        assert!(is_name("four_bar2"));
        for bad in ["", "2bars", "four-bar", "../x", "é"] {
            assert!(!is_name(bad), "{bad}");
        }
    }
}
