//! From arguments to a compiled mechanism, and its warnings to stderr.

use linkwear::backend::Backend;
use linkwear::mechanism::{LoadError, Mechanism, located_warnings, read_source};
use linkwear_codegen::{Closure, Compiled, Diagnostics, Options, compile};
use serde_json::Value;

use super::arguments::{ClosureName, Input};
use super::failure::{Failure, entries};

/// A mechanism that was read and compiled.
pub struct Loaded {
    /// With overrides and closure as asked.
    pub compiled: Compiled,
    warnings: Diagnostics,
}

impl Loaded {
    /// Warnings in the shape of the errors of a failure.
    pub fn warnings(&self) -> Vec<Value> {
        entries(&self.warnings)
    }
}

/// Reads and compiles; prints warnings.
pub fn load(input: &Input) -> Result<Loaded, Failure> {
    let source = read_source(&input.file).map_err(failed)?;
    let compiled = compile(&source, &options(input, false)).map_err(Failure::Mechanism)?;
    let warnings = located_warnings(&compiled);
    print_warnings(&warnings);
    Ok(Loaded { compiled, warnings })
}

/// Reads, compiles and chooses a back end; prints warnings. `rigid` takes flexible bodies as rigid.
pub fn load_mechanism(input: &Input, rigid: bool, backend: Backend) -> Result<Mechanism, Failure> {
    let source = read_source(&input.file).map_err(failed)?;
    let mechanism = Mechanism::compile(&source, &options(input, rigid), backend).map_err(failed)?;
    print_warnings(&mechanism.warnings);
    Ok(mechanism)
}

fn options(input: &Input, rigid: bool) -> Options {
    let closure = input.closure.map(|name| match name {
        ClosureName::Joint => Closure::Joint,
        ClosureName::Log => Closure::Log,
    });
    Options { closure, overrides: input.overrides.clone(), rigid }
}

fn print_warnings(warnings: &Diagnostics) {
    if !warnings.is_empty() {
        eprintln!("{warnings}");
    }
}

fn failed(error: LoadError) -> Failure {
    match error {
        LoadError::Read { file, error } => Failure::Read(file, error),
        LoadError::Mechanism(diagnostics) => Failure::Mechanism(diagnostics),
        LoadError::Backend(error) => Failure::Backend {
            message: format!("--backend compiled: {error}"),
            help: "use --backend auto, or compile the mechanism into a program of yours (README, Embedding)"
                .to_owned(),
        },
    }
}
