//! `generate`: the specialised source, to a file or to stdout.

use std::fs;
use std::io::Write as _;
use std::path::Path;
use std::time::Instant;

use serde_json::json;

use super::arguments::{Format, GenerateArguments};
use super::equations::operations;
use super::failure::Failure;
use super::file::{print, refuse_same, write_whole};
use super::input::load;
use super::table::{count, duration, plural, table};

/// Answers `generate`.
pub fn run(arguments: &GenerateArguments, format: Format) -> Result<(), Failure> {
    if let Some(out) = &arguments.out {
        refuse_same(&arguments.input.file, out)?;
    }
    let start = Instant::now();
    let loaded = load(&arguments.input)?;
    let text = loaded.compiled.rust_source();
    let seconds = start.elapsed().as_secs_f64();
    match (&arguments.out, arguments.check) {
        (Some(out), true) => compare(out, &text)?,
        (Some(out), false) => write_whole(out, |file| file.write_all(text.as_bytes()))?,
        (None, _) => {}
    }
    let functions = loaded.compiled.operations();
    let statements: usize = functions.iter().map(|function| function.statements).sum();
    let total: linkwear_codegen::tape::Operations = sum(&functions);
    match (format, &arguments.out) {
        (Format::Text, None) => print(&text.trim_end()),
        (Format::Text, Some(out)) => {
            let rows: Vec<Vec<String>> = functions
                .iter()
                .map(|function| {
                    let cells =
                        [function.operations.total, function.statements as u64, function.parts as u64]
                            .map(count);
                    [vec![function.name.clone()], cells.to_vec()].concat()
                })
                .collect();
            let verb = if arguments.check { "up to date" } else { "written" };
            let table = table(&["function", "operations", "statements", "parts"], &rows);
            print(&format!(
                "{}: {verb}, {} in {}\n\n{}",
                out.display(),
                plural(statements as u64, "statement", "statements"),
                duration(seconds),
                table.trim_end()
            ))
        }
        (Format::Json, out) => {
            let entries: Vec<_> = functions
                .iter()
                .map(|function| {
                    json!({
                        "name": function.name, "operations": operations(&function.operations),
                        "statements": function.statements, "parts": function.parts,
                    })
                })
                .collect();
            let mut answer = json!({
                "name": loaded.compiled.mechanism.name,
                "operations": operations(&total), "functions": functions.len(),
                "statements": statements, "seconds": seconds, "entry_points": entries,
                "warnings": loaded.warnings(),
            });
            if out.is_none() {
                answer["source"] = text.into();
            }
            print(&answer)
        }
    }
}

fn sum(functions: &[linkwear_codegen::compile::FunctionCount]) -> linkwear_codegen::tape::Operations {
    functions.iter().fold(Default::default(), |mut total, function| {
        total += function.operations;
        total
    })
}

fn compare(path: &Path, text: &str) -> Result<(), Failure> {
    let old = fs::read_to_string(path).map_err(|error| Failure::Read(path.to_path_buf(), error))?;
    if old == text {
        return Ok(());
    }
    let same = old.lines().zip(text.lines()).take_while(|(a, b)| a == b).count();
    Err(Failure::Stale { file: path.to_path_buf(), line: same + 1 })
}
