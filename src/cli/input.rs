//! Input: arguments to a compiled mechanism, its warnings to stderr; fits.

use std::path::Path;

use crate::files::{WriteError, check_target, folder_of};
use crate::mechanism::{Mechanism, located_warnings, read_source};
use crate::remark::remark;
use crate::table::is_stdout;
use linkwear_codegen::input::{Reach, read_text};
use linkwear_codegen::{Compiled, Diagnostics, Options, SourceFile, compile, limits};
use linkwear_gamma::FitFile;
use serde_json::{Value, json};

use super::colour;
use super::failure::{Failure, entries};
use super::options::{EquationsChoice, Input, Replace};
use super::own_file::is_own;

/// Reads and compiles, with overrides and closure as asked; prints warnings, and returns them as machines read them.
pub fn load(input: &Input) -> Result<(Compiled, Vec<Value>), Failure> {
    let (compiled, warnings) = compiled(input, &read_source(&input.file)?)?;
    print_warnings(&warnings);
    Ok((compiled, entries(&warnings)))
}

/// Compiles, with overrides and closure as asked.
pub fn compiled(input: &Input, source: &SourceFile) -> Result<(Compiled, Diagnostics), Failure> {
    let compiled = compile(source, &options(input, false))?;
    let warnings = located_warnings(&compiled);
    Ok((compiled, warnings))
}

/// Reads, compiles and chooses a back end; prints warnings.
pub fn load_mechanism(input: &Input, equations: EquationsChoice) -> Result<Mechanism, Failure> {
    let mechanism = of_source(input, &read_source(&input.file)?, equations)?;
    print_remarks(&mechanism);
    Ok(mechanism)
}

/// Of a text.
pub fn of_source(
    input: &Input,
    source: &SourceFile,
    EquationsChoice { backend, rigid }: EquationsChoice,
) -> Result<Mechanism, Failure> {
    Ok(Mechanism::compile(source, &options(input, rigid), backend)?)
}

/// What there is to say of a file and of what runs it.
pub fn print_remarks(mechanism: &Mechanism) {
    print_warnings(&mechanism.warnings);
    if let Some(refusal) = mechanism.refusal() {
        remark(&format_args!(
            "note: the equations are interpreted, several times slower, with the same results: {refusal}"
        ));
    }
}

pub fn options(input: &Input, rigid: bool) -> Options {
    let reach = if input.allow_outside_data { Reach::Anywhere } else { Reach::Below };
    Options { closure: input.closure, overrides: input.overrides.clone(), rigid, reach, ..Options::default() }
}

fn print_warnings(warnings: &Diagnostics) {
    if !warnings.is_empty() {
        if colour::wanted() {
            remark(&warnings.in_colours());
        } else {
            remark(warnings);
        }
    }
}

/// Refuses, before the work, what cannot be written, to write over what is read, and to replace what linkwear did not make unless
/// that is wanted. True if the output is a stream.
pub fn check_output(read: &[&Path], output: Option<&Path>, replace: Replace) -> Result<bool, Failure> {
    let Some(output) = output else { return Ok(false) };
    if is_stdout(output) {
        return Ok(true);
    }
    if cfg!(not(feature = "parquet")) && output.extension().is_some_and(|end| end == "parquet") {
        let help = "give a name that ends in .csv, or build it with the feature `parquet`";
        return Err(Failure::usage("--out: this program was built without Parquet", help));
    }
    if read.iter().any(|input| is_same(input, output)) {
        return Err(WriteError::Exists(output.to_path_buf()).into());
    }
    check_replaced(output, replace)
}

/// Whether two paths are of one file, which need not be there yet.
pub fn is_same(a: &Path, b: &Path) -> bool {
    let place = |path: &Path| {
        path.canonicalize().or_else(|_| {
            folder_of(path).canonicalize().map(|folder| folder.join(path.file_name().unwrap_or_default()))
        })
    };
    matches!((place(a), place(b)), (Ok(a), Ok(b)) if a == b)
}

/// Refuses what cannot be written, and to replace what linkwear did not make. True for a stream.
pub fn check_replaced(output: &Path, replace: Replace) -> Result<bool, Failure> {
    let is_stream = check_target(output)?;
    if is_stream || replace.force || !output.exists() || is_own(output) {
        Ok(is_stream)
    } else {
        Err(Failure::foreign(output))
    }
}

/// Reads the result of a fit back.
pub fn read_fit(file: &Path) -> Result<FitFile, Failure> {
    FitFile::parse(&read_text(file, limits::DATA_BYTES).map_err(Failure::read(file))?)
        .map_err(Failure::fit(file))
}

/// Values of covariates, as provenance tells them.
pub fn covariates(values: &[(String, f64)]) -> Value {
    values.iter().map(|(name, value)| (name.clone(), json!(value))).collect()
}
