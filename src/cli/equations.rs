//! `equations`: what was derived, for people to read.

use linkwear_codegen::render::OutputInfo;
use serde_json::json;

use super::answer::Answer;
use super::answer::equations::{EquationsAnswer, OutputAnswer};
use super::arguments::EquationsArguments;
use super::failure::Failure;
use super::input::load;

pub fn run(arguments: &EquationsArguments) -> Result<Answer, Failure> {
    let (compiled, warnings) = load(&arguments.input)?;
    let (outputs, only) = (compiled.outputs(), &arguments.only);
    if let Some(name) = only.iter().find(|name| !outputs.iter().any(|output| is_meant(output, name))) {
        let known = names(&outputs);
        return Err(Failure::unknown_name("output or function", name, &known, &known));
    }
    let text = compiled.equations_text(only, arguments.notation);
    let mass_left_out = compiled.mass_is_left_out();
    let meant =
        outputs.iter().filter(|output| only.is_empty() || only.iter().any(|name| is_meant(output, name)));
    let told = EquationsAnswer {
        name: &compiled.mechanism.name,
        outputs: meant.map(entry).collect(),
        text: &text,
        mass_left_out,
        warnings,
    };
    let json = json!(told);
    Ok(Answer::new(text, json, None))
}

fn entry(output: &OutputInfo) -> OutputAnswer<'_> {
    OutputAnswer {
        name: &output.name,
        function: &output.function,
        rows: output.rows,
        cols: output.cols,
        operations: (&output.operations).into(),
        operations_unshared: (&output.operations_unshared).into(),
    }
}

/// A name means an output, an output of a function (`closure.phi_q`), or all outputs of a function.
fn is_meant(output: &OutputInfo, name: &str) -> bool {
    output.name == name || output.function == name || format!("{}.{}", output.function, output.name) == name
}

fn names(outputs: &[OutputInfo]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for name in outputs.iter().flat_map(|output| [&output.function, &output.name]) {
        if !names.contains(name) {
            names.push(name.clone());
        }
    }
    names
}
