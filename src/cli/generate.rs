//! `generate`: the specialised source of a target, to files or to stdout.

use std::fs::{self, File};
use std::io::{Read as _, Write as _};
use std::path::{Path, PathBuf};
use std::time::Instant;

use crate::files::{WriteError, write_whole};
use linkwear_codegen::Compiled;
use linkwear_codegen::compile::FunctionCount;
use linkwear_codegen::tape::Operations;

use super::answer::Answer;
use super::answer::equations::{FunctionAnswer, GenerateAnswer};
use super::arguments::{GenerateArguments, Target};
use super::failure::Failure;
use super::input::{check_output, load};
use super::options::Replace;
use super::own_file::is_own;
use super::table::{count, duration, plural, table};

/// Told behind the table.
const MASS_LEFT_OUT: &str = "
The mass matrix is left out of equations_of_motion, as of all mechanisms that are as long: zeros stand in its place.
";

pub fn run(arguments: &GenerateArguments) -> Result<Answer, Failure> {
    let out = arguments.out.as_deref();
    let start = Instant::now();
    let (compiled, warnings) = load(&arguments.input)?;
    if arguments.target == Target::C && compiled.description().acts_at_samples() {
        return Err(Failure::samples_in_c(&arguments.input.file));
    }
    let files = files(&compiled, arguments)?;
    if let (Target::CAbi, Some(folder), false) = (arguments.target, out, arguments.check) {
        let source = folder.join("src");
        fs::create_dir_all(&source).map_err(WriteError::of(&source))?;
    }
    let replace = replace(arguments);
    for (path, _) in &files {
        check_output(&[&arguments.input.file], path.as_deref().filter(|_| !arguments.check), replace)?;
    }
    let seconds = start.elapsed().as_secs_f64();
    for (path, text) in &files {
        match (path, arguments.check) {
            (Some(path), true) => compare(path, text)?,
            (Some(path), false) => write_whole(path, |file| file.write_all(text.as_bytes()))?,
            (None, _) => {}
        }
    }
    let functions = compiled.operations();
    let statements: usize = functions.iter().map(|function| function.statements).sum();
    let mut total = Operations::default();
    functions.iter().for_each(|function| total += function.operations);
    let written: Vec<_> = files.iter().filter_map(|(path, _)| path.as_ref()).collect();
    let told = GenerateAnswer {
        name: &compiled.mechanism.name,
        operations: (&total).into(),
        functions: functions.len(),
        statements,
        seconds,
        entry_points: functions.iter().map(entry).collect(),
        mass_left_out: compiled.mass_is_left_out(),
        warnings,
        files: written.iter().map(|path| path.display().to_string()).collect(),
        source: None,
    };
    let (Some(_), [first, ..]) = (out, &written[..]) else {
        let source = files.into_iter().map(|(_, text)| text).collect::<String>();
        let told = GenerateAnswer { source: Some(source.clone()), ..told };
        return Ok(Answer::new(source, told, None));
    };
    let others: String = written[1..].iter().map(|path| format!(", {}", path.display())).collect();
    let rows: Vec<_> = functions.iter().map(row).collect();
    let left_out = if compiled.mass_is_left_out() { MASS_LEFT_OUT } else { "" };
    let text = format!(
        "{}{others}: {}, {} in {}\n\n{}{left_out}",
        first.display(),
        if arguments.check { "up to date" } else { "written" },
        plural(statements as u64, "statement", "statements"),
        duration(seconds),
        table(&["function", "operations", "statements", "parts"], &rows)
    );
    Ok(Answer::new(text, told, None))
}

/// A crate whose mechanism linkwear wrote is its own as a whole.
fn replace(arguments: &GenerateArguments) -> Replace {
    let known = |folder: &Path| {
        let mechanism = folder.join("src/mechanism.rs");
        mechanism.exists() && is_own(&mechanism)
    };
    let is_crate = arguments.target == Target::CAbi && arguments.out.as_deref().is_some_and(known);
    Replace { force: arguments.replace.force || is_crate }
}

/// What is written where; without a place it goes to stdout.
fn files(
    compiled: &Compiled,
    arguments: &GenerateArguments,
) -> Result<Vec<(Option<PathBuf>, String)>, Failure> {
    match (arguments.target, arguments.out.as_deref()) {
        (Target::Rust, out) => {
            let source = if arguments.with_start {
                compiled.rust_source_with_start("::linkwear_runtime")?
            } else {
                compiled.rust_source()
            };
            Ok(vec![(out.map(Path::to_path_buf), source)])
        }
        (Target::C, Some(stem)) => {
            let name = stem.file_name().and_then(|name| name.to_str());
            // The source includes the header by this name, in which C has no escapes.
            let name = name.filter(|name| !name.contains(['"', '\\', '\n', '\r']));
            let name = name.ok_or_else(|| {
                let help = "give a stem such as `rssr`: rssr.c and rssr.h are written";
                Failure::usage("the stem is no name that C can include", help)
            })?;
            let files = compiled.c_files(&format!("{name}.h"));
            let beside = |extension: &str| Some(stem.with_file_name(format!("{name}.{extension}")));
            Ok(vec![(beside("h"), files.header), (beside("c"), files.source)])
        }
        (Target::CAbi, Some(folder)) => {
            let files = compiled.c_crate().into_iter();
            Ok(files.map(|(path, text)| (Some(folder.join(path)), text)).collect())
        }
        (Target::C | Target::CAbi, None) => {
            let help = "give -o STEM for c (STEM.c, STEM.h), -o FOLDER for c-abi";
            Err(Failure::usage("several files have no place on stdout", help))
        }
    }
}

fn entry(function: &FunctionCount) -> FunctionAnswer<'_> {
    let FunctionCount { name, operations, statements, parts } = function;
    FunctionAnswer { name, operations: operations.into(), statements: *statements, parts: *parts }
}

fn row(function: &FunctionCount) -> Vec<String> {
    let counts = [function.operations.total, function.statements as u64, function.parts as u64];
    [function.name.clone()].into_iter().chain(counts.map(count)).collect()
}

fn compare(path: &Path, text: &str) -> Result<(), Failure> {
    let mut old = Vec::new();
    // One byte more than there should be tells enough.
    let read = File::open(path).and_then(|file| file.take(text.len() as u64 + 1).read_to_end(&mut old));
    read.map_err(Failure::read(path))?;
    if old == text.as_bytes() {
        return Ok(());
    }
    let old = String::from_utf8_lossy(&old);
    let same = old.lines().zip(text.lines()).take_while(|(a, b)| a == b).count();
    Err(Failure::stale(path, same + 1))
}
