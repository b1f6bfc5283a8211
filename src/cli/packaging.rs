//! `completions`, `man` and `schema`: for packagers and editors.

use std::path::Path;

use crate::files::WriteError;
use clap::CommandFactory;

use super::answer::Answer;
use super::answer::equations::TextAnswer;
use super::arguments::Arguments;
use super::failure::Failure;

pub fn completions(shell: clap_complete::Shell) -> Answer {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Arguments::command(), "linkwear", &mut script);
    answer(&script)
}

pub fn manual() -> Result<Answer, Failure> {
    let mut page = Vec::new();
    let rendered = clap_mangen::Man::new(Arguments::command()).render(&mut page);
    rendered.map_err(WriteError::of(Path::new("stdout")))?;
    Ok(answer(&page))
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
    Answer { text: text.to_owned(), json }
}
