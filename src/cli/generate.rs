//! `generate`: the specialised source, to a file or to stdout.

use std::fs::File;
use std::io::{Read as _, Write as _};
use std::path::Path;
use std::time::Instant;

use linkwear::files::write_whole;
use linkwear_codegen::compile::FunctionCount;
use linkwear_codegen::tape::Operations;
use serde_json::{Value, json};

use super::answer::Answer;
use super::arguments::GenerateArguments;
use super::equations::operations;
use super::failure::Failure;
use super::input::{check_output, load};
use super::table::{count, duration, plural, table};

pub fn run(arguments: &GenerateArguments) -> Result<Answer, Failure> {
    let out = arguments.out.as_deref();
    check_output(&arguments.input.file, out.filter(|_| !arguments.check))?;
    let start = Instant::now();
    let (compiled, warnings) = load(&arguments.input)?;
    let source = compiled.rust_source();
    let seconds = start.elapsed().as_secs_f64();
    match (out, arguments.check) {
        (Some(out), true) => compare(out, &source)?,
        (Some(out), false) => write_whole(out, |file| file.write_all(source.as_bytes()))?,
        (None, _) => {}
    }
    let functions = compiled.operations();
    let statements: usize = functions.iter().map(|function| function.statements).sum();
    let mut total = Operations::default();
    functions.iter().for_each(|function| total += function.operations);
    let mut json = json!({
        "name": compiled.mechanism.name,
        "operations": operations(&total), "functions": functions.len(),
        "statements": statements, "seconds": seconds,
        "entry_points": functions.iter().map(entry).collect::<Vec<_>>(),
        "warnings": warnings,
    });
    let Some(out) = out else {
        json["source"] = source.clone().into();
        return Ok(Answer { text: source, json });
    };
    let rows: Vec<_> = functions.iter().map(row).collect();
    let text = format!(
        "{}: {}, {} in {}\n\n{}",
        out.display(),
        if arguments.check { "up to date" } else { "written" },
        plural(statements as u64, "statement", "statements"),
        duration(seconds),
        table(&["function", "operations", "statements", "parts"], &rows)
    );
    Ok(Answer { text, json })
}

fn entry(function: &FunctionCount) -> Value {
    json!({
        "name": function.name, "operations": operations(&function.operations),
        "statements": function.statements, "parts": function.parts,
    })
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
