//! From arguments to a compiled mechanism, and its warnings to stderr.

use std::fs;

use linkwear_codegen::{Closure, Compiled, Diagnostics, Options, SourceFile, compile};
use serde_json::Value;

use super::arguments::{ClosureName, Input};
use super::failure::{Failure, entries};

/// A mechanism that was read and compiled.
pub struct Loaded {
    /// The text of the file.
    pub source: SourceFile,
    /// With overrides and closure as asked.
    pub compiled: Compiled,
    warnings: Diagnostics,
}

/// Reads and compiles; prints warnings.
pub fn load(input: &Input) -> Result<Loaded, Failure> {
    load_as(input, false)
}

/// As [`load`]; `rigid` takes flexible bodies as rigid.
pub fn load_as(input: &Input, rigid: bool) -> Result<Loaded, Failure> {
    let text = fs::read_to_string(&input.file).map_err(|error| Failure::Read(input.file.clone(), error))?;
    let source = SourceFile { name: input.file.display().to_string(), text };
    let closure = input.closure.map(|name| match name {
        ClosureName::Joint => Closure::Joint,
        ClosureName::Log => Closure::Log,
    });
    let options = Options { closure, overrides: input.overrides.clone(), rigid };
    let compiled = compile(&source, &options).map_err(Failure::Mechanism)?;
    let warnings = Diagnostics::from_list(compiled.warnings.clone()).located(&source);
    if !warnings.is_empty() {
        eprintln!("{warnings}");
    }
    Ok(Loaded { source, compiled, warnings })
}

impl Loaded {
    /// Warnings in the shape of the errors of a failure.
    pub fn warnings(&self) -> Vec<Value> {
        entries(&self.warnings)
    }

    /// Names of the overridden parameters that are folded into the code, so that it must be made anew.
    pub fn folded_overrides(&self, input: &Input) -> Vec<String> {
        let parameters = &self.compiled.mechanism.parameters;
        let folded = |name: &str| parameters.iter().any(|known| known.name == name && !known.tunable);
        input.overrides.iter().map(|(name, _)| name).filter(|name| folded(name)).cloned().collect()
    }
}
