//! `equations`: what was derived, for people to read.

use linkwear_codegen::render::{OutputInfo, TextFormat};
use linkwear_codegen::tape::Operations;
use serde_json::{Value, json};

use super::arguments::{EquationsArguments, Format, Notation};
use super::failure::Failure;
use super::file::print;
use super::input::load;

/// Answers `equations`.
pub fn run(arguments: &EquationsArguments, format: Format) -> Result<(), Failure> {
    let loaded = load(&arguments.input)?;
    let outputs = loaded.compiled.outputs();
    for name in &arguments.only {
        if !outputs.iter().any(|output| is_meant(output, name)) {
            return Err(Failure::UnknownName { name: name.clone(), known: names(&outputs) });
        }
    }
    let notation = match arguments.notation {
        Notation::Text => TextFormat::Text,
        Notation::Markdown => TextFormat::Markdown,
        Notation::Latex => TextFormat::Latex,
    };
    let text = loaded.compiled.equations_text(&arguments.only, notation);
    match format {
        Format::Text => print(&text.trim_end()),
        Format::Json => {
            let meant = |output: &&OutputInfo| {
                arguments.only.is_empty() || arguments.only.iter().any(|name| is_meant(output, name))
            };
            let outputs: Vec<Value> = outputs.iter().filter(meant).map(entry).collect();
            print(&json!({
                "name": loaded.compiled.mechanism.name, "outputs": outputs, "text": text,
                "warnings": loaded.warnings(),
            }))
        }
    }
}

fn entry(output: &OutputInfo) -> Value {
    json!({
        "name": output.name, "function": output.function, "rows": output.rows, "cols": output.cols,
        "operations": operations(&output.operations),
        "operations_unshared": operations(&output.operations_unshared),
    })
}

/// Operation counts as every command writes them.
pub fn operations(count: &Operations) -> Value {
    json!({
        "mul": count.mul, "add": count.add, "div": count.div, "sqrt": count.sqrt,
        "sincos": count.sincos, "total": count.total,
    })
}

/// A name means an output, an output of a function (`closure.phi_q`), or all outputs of a function.
fn is_meant(output: &OutputInfo, name: &str) -> bool {
    output.name == name || output.function == name || format!("{}.{}", output.function, output.name) == name
}

fn names(outputs: &[OutputInfo]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for output in outputs {
        for name in [&output.function, &output.name] {
            if !names.contains(name) {
                names.push(name.clone());
            }
        }
    }
    names
}
