//! `completions` and `man`: for packagers, from the same definitions as the command line itself.

use clap::CommandFactory;
use serde_json::json;

use super::arguments::{Arguments, Format};
use super::failure::Failure;
use super::file::print;

/// Answers `completions`.
pub fn completions(shell: clap_complete::Shell, format: Format) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Arguments::command(), "linkwear", &mut script);
    show(&script, format)
}

/// Answers `man`.
pub fn manual(format: Format) -> Result<(), Failure> {
    let mut page = Vec::new();
    clap_mangen::Man::new(Arguments::command())
        .render(&mut page)
        .map_err(|error| Failure::Write("stdout".into(), error))?;
    show(&page, format)
}

fn show(text: &[u8], format: Format) -> Result<(), Failure> {
    let text = String::from_utf8_lossy(text);
    match format {
        Format::Text => print(&text.trim_end()),
        Format::Json => print(&json!({ "text": text })),
    }
}
