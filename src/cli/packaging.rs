//! `completions`, `man` and `schema`: for packagers and editors.

use std::fs;
use std::io::Write as _;
use std::path::Path;

use crate::files::{STDOUT, WriteError, write_whole};
use clap::{Command, CommandFactory};
use clap_mangen::Man;

use super::answer::Answer;
use super::answer::equations::{PagesAnswer, TextAnswer};
use super::arguments::Arguments;
use super::failure::Failure;

pub fn completions(shell: clap_complete::Shell) -> Answer {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Arguments::command(), "linkwear", &mut script);
    answer(&script)
}

/// The page of a subcommand, or of all; with a folder, all pages as files in it.
pub fn manual(subcommand: Option<&str>, folder: Option<&Path>) -> Result<Answer, Failure> {
    let mut root = Arguments::command().disable_help_subcommand(true);
    root.build();
    if let Some(folder) = folder {
        return pages(&root, folder);
    }
    let Some(name) = subcommand else { return Ok(one(&page(&root)?)) };
    let Some(known) = shown(&root).find(|known| known.get_name() == name) else {
        let names: Vec<String> = shown(&root).map(|known| known.get_name().to_owned()).collect();
        return Err(Failure::no_subcommand(name, &names));
    };
    Ok(one(&page(known)?))
}

/// A page on stdout.
fn one(page: &[u8]) -> Answer {
    let text = String::from_utf8_lossy(page).into_owned();
    Answer::new(text.clone(), PagesAnswer { text: Some(text), files: Vec::new() }, None)
}

fn shown(root: &Command) -> impl Iterator<Item = &Command> {
    root.get_subcommands().filter(|known| !known.is_hide_set())
}

fn page(command: &Command) -> Result<Vec<u8>, Failure> {
    let mut page = Vec::new();
    Man::new(command.clone()).render(&mut page).map_err(WriteError::of(Path::new(STDOUT)))?;
    Ok(page)
}

/// `linkwear.1` and `linkwear-SUBCOMMAND.1`.
fn pages(root: &Command, folder: &Path) -> Result<Answer, Failure> {
    fs::create_dir_all(folder).map_err(WriteError::of(folder))?;
    let mut files = Vec::new();
    for command in [root].into_iter().chain(shown(root)) {
        let file = folder.join(Man::new(command.clone()).get_filename());
        let page = page(command)?;
        write_whole(&file, |out| out.write_all(&page))?;
        files.push(file.display().to_string());
    }
    let text = format!("{} pages written to {}", files.len(), folder.display());
    Ok(Answer::new(text, PagesAnswer { text: None, files }, None))
}

fn answer(text: &[u8]) -> Answer {
    let text = String::from_utf8_lossy(text).into_owned();
    Answer::new(text.clone(), TextAnswer { text }, None)
}

/// The answer is JSON whatever the format.
pub fn schema(output: Option<&'static str>) -> Answer {
    let text = output.unwrap_or(include_str!("../../docs/linkwear.schema.json"));
    #[expect(clippy::expect_used, reason = "a test compares the file with what the types give")]
    let json = serde_json::from_str(text).expect("the schema of this program is JSON");
    Answer { text: text.to_owned(), json, disagrees: false }
}
