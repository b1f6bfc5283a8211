//! Where pages and pictures may be written. In: paths, text. Out: files. Never knows what is in them.

use std::fs::File;
use std::io::{Read as _, Write as _};
use std::path::Path;

use super::failure::Failure;
use super::input::check_output;
use crate::files::{WriteError, write_whole};

/// Refuses, before the work, to replace what linkwear did not make.
pub fn may_write(input: &Path, out: &Path, force: bool) -> Result<(), Failure> {
    let is_stream = check_output(input, Some(out))?;
    let is_foreign = || out.is_file() && !is_own(out);
    if !is_stream && !force && is_foreign() {
        return Err(WriteError::Exists(out.to_path_buf()).into());
    }
    Ok(())
}

/// Whether linkwear made a page or a picture, by how it begins.
fn is_own(file: &Path) -> bool {
    let mut head = Vec::new();
    let read = File::open(file).and_then(|file| file.take(600).read_to_end(&mut head));
    let text = String::from_utf8_lossy(&head);
    read.is_ok() && (head.is_empty() || text.contains("\"linkwear ") || text.contains("<!-- linkwear "))
}

/// Refuses, before the work, a place where no charts may be written.
pub fn check_plot(input: &Path, plot: Option<&Path>) -> Result<(), Failure> {
    plot.map_or(Ok(()), |plot| may_write(input, plot, false))
}

/// Writes charts where they are asked for.
pub fn write_plot(plot: Option<&Path>, picture: impl FnOnce() -> String) -> Result<(), Failure> {
    let Some(plot) = plot else { return Ok(()) };
    Ok(write_whole(plot, |file| file.write_all(picture().as_bytes()))?)
}
