//! `fmu`: a unit of FMI 3.0 of a mechanism.

use std::io::Write as _;
use std::time::Instant;

use crate::files::write_whole;
use crate::fmu;

use super::answer::Answer;
use super::answer::equations::FmuAnswer;
use super::arguments::FmuArguments;
use super::failure::Failure;
use super::input::{check_output, load};
use super::table::duration;

pub fn run(arguments: &FmuArguments) -> Result<Answer, Failure> {
    let out = &arguments.out;
    check_output(&[&arguments.input.file], Some(out), arguments.replace)?;
    let start = Instant::now();
    let (compiled, warnings) = load(&arguments.input)?;
    let bytes = fmu::unit(&compiled).map_err(|error| Failure::usage(error, "see docs/fmi.md"))?;
    write_whole(out, |file| file.write_all(&bytes))?;
    let seconds = start.elapsed().as_secs_f64();
    let text =
        format!("{}: written, {} kB in {}", out.display(), bytes.len().div_ceil(1000), duration(seconds));
    let name = &compiled.mechanism.name;
    let told = FmuAnswer { name, file: out.display().to_string(), bytes: bytes.len(), seconds, warnings };
    Ok(Answer::new(text, told, None))
}
