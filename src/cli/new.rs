//! `new`: a commented file to start from.

use std::io::Write as _;
use std::path::PathBuf;

use serde_json::json;

use super::arguments::{Format, NewArguments};
use super::failure::Failure;
use super::file::{print, write_whole};

const STARTER: &str = include_str!("starter.toml");

/// Answers `new`.
pub fn run(arguments: &NewArguments, format: Format) -> Result<(), Failure> {
    if !is_name(&arguments.name) {
        return Err(Failure::Usage {
            message: format!("`{}` is no name for a mechanism", arguments.name),
            help: "use letters, digits and _, and begin with a letter; the file is NAME.toml here".to_owned(),
        });
    }
    let path = PathBuf::from(format!("{}.toml", arguments.name));
    if path.exists() {
        return Err(Failure::Exists(path));
    }
    let text = STARTER.replace("starter", &arguments.name);
    write_whole(&path, |file| file.write_all(text.as_bytes()))?;
    let shown = path.display();
    match format {
        Format::Json => print(&json!({ "file": shown.to_string() })),
        Format::Text => {
            print(&format!("{shown} written. Next:\n  linkwear check {shown}\n  linkwear simulate {shown}"))
        }
    }
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
