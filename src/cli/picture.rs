//! Where pages and pictures may be written. In: paths, text. Out: files. Never knows what is in them.

use std::io::Write as _;
use std::path::Path;

use super::failure::Failure;
use super::input::{check_output, is_same};
use super::options::Replace;
use crate::files::{check_target, write_whole};
use crate::table::is_stdout;

/// Refuses, before the work, to replace what linkwear did not make.
pub fn may_write(read: &[&Path], out: &Path, replace: Replace) -> Result<(), Failure> {
    if cfg!(not(feature = "png")) && is_png(out) {
        let help = "give a name that ends in .svg, or build it with the feature `png`: cargo build --release --features png";
        return Err(Failure::usage("this program was built without PNG", help));
    }
    check_output(read, Some(out), replace).map(drop)
}

/// Refuses the name of a picture that ends like one of another format; without an ending it is an SVG.
pub fn check_ending(out: &Path) -> Result<(), Failure> {
    let ending = out.extension().map(|end| end.to_string_lossy().to_ascii_lowercase());
    match ending.as_deref() {
        None | Some("svg" | "png") => Ok(()),
        Some(other) => Err(Failure::usage(
            format!("pictures are written as SVG or PNG, not as `.{other}`"),
            "give a name that ends in .svg or .png",
        )),
    }
}

/// Whether a file is to be a PNG.
fn is_png(file: &Path) -> bool {
    file.extension().is_some_and(|end| end.eq_ignore_ascii_case("png"))
}

/// A picture (SVG) in the format that the name of its file asks for.
pub fn drawn(file: &Path, svg: String) -> Result<Vec<u8>, Failure> {
    #[cfg(feature = "png")]
    if is_png(file) {
        let none = |why| {
            Failure::usage(format!("there is no picture to write: {why}"), "give a name that ends in .svg")
        };
        return crate::page::png::png(&svg).map_err(none);
    }
    let _ = file;
    Ok(svg.into_bytes())
}

/// Refuses, before the work, a place where no charts may be written.
pub fn check_plot(read: &[&Path], plot: Option<&Path>, replace: Replace) -> Result<(), Failure> {
    plot.map_or(Ok(()), |plot| {
        check_ending(plot)?;
        may_write(read, plot, replace)
    })
}

/// The same beside a table or a file that is written too: two things are not written to one file.
pub fn check_plot_beside(
    out: Option<&Path>,
    read: &[&Path],
    plot: Option<&Path>,
    replace: Replace,
) -> Result<(), Failure> {
    check_plot(read, plot, replace)?;
    let (Some(out), Some(plot)) = (out, plot) else { return Ok(()) };
    if is_stdout(out) || check_target(out)? || !is_same(out, plot) {
        return Ok(());
    }
    let message = format!("--out and --plot are both `{}`", plot.display());
    Err(Failure::usage(message, "give each a name of its own"))
}

/// Writes charts where they are asked for.
pub fn write_plot(plot: Option<&Path>, picture: impl FnOnce() -> String) -> Result<(), Failure> {
    let Some(plot) = plot else { return Ok(()) };
    let bytes = drawn(plot, picture())?;
    Ok(write_whole(plot, |file| file.write_all(&bytes))?)
}
