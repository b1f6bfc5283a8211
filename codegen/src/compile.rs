//! The whole pipeline, in order: parse, resolve, derive, analyse, derive again without redundant rows, lower.
//! In: a source file. Out: [`Compiled`]. Never knows how a stage works.

use linkwear_runtime::{Description, Sizes};

use crate::backend::interp::Interpreted;
use crate::backend::rust::{EmitInput, STATEMENTS_PER_FUNCTION, emit};
use crate::derive::{self, Equations, Purpose};
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::{self, Closure, Mechanism, Overrides, Topology};
use crate::preflight::{self, Analysis, Findings};
use crate::render::{self, OutputInfo, TextFormat};
use crate::source::SourceFile;
use crate::spec;
use crate::tape::{self, Operations, Tape};

/// What a caller may change without touching the file.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Overrides the file's closure.
    pub closure: Option<Closure>,
    /// Parameter values by name, with units in the text.
    pub overrides: Vec<(String, String)>,
    /// Takes flexible bodies as rigid.
    pub rigid: bool,
}

/// A mechanism, understood: equations, tapes and all that is known about it.
#[derive(Clone, Debug)]
pub struct Compiled {
    /// The file it came from.
    pub source: SourceFile,
    /// The mechanism.
    pub mechanism: Mechanism,
    /// Spanning tree and cuts.
    pub topology: Topology,
    /// Freedoms and redundancies.
    pub analysis: Analysis,
    /// Remarks that do not stop the compilation.
    pub warnings: Vec<Diagnostic>,
    /// Symbolic equations.
    pub equations: Equations,
    /// One tape per function.
    pub tapes: Vec<Tape>,
    description: Description,
    sizes: Sizes,
}

/// Cost of one entry point.
#[derive(Clone, Debug, PartialEq)]
pub struct FunctionCount {
    /// Name of the function.
    pub name: String,
    /// Operations.
    pub operations: Operations,
    /// Statements of generated code.
    pub statements: usize,
    /// Functions that the code is split into.
    pub parts: usize,
}

/// Compiles a file.
///
/// # Errors
/// All that is wrong with the file, in one go.
pub fn compile(source: &SourceFile, options: &Options) -> Result<Compiled, Diagnostics> {
    let spec = spec::parse(source)?;
    let overrides = Overrides::from_pairs(&options.overrides);
    let (mut mechanism, mut warnings) = model::resolve(&spec, &overrides)?;
    if let Some(closure) = options.closure {
        mechanism.closure = closure;
    }
    if options.rigid {
        mechanism.freeze();
    }
    let topology = model::topology::spanning_tree(&mechanism).map_err(|errors| errors.located(source))?;
    let Findings { analysis, keep, warnings: remarks } = analyse(source, &mechanism, &topology)?;
    warnings.extend(remarks);
    let derived = derive::derive(&mechanism, &topology, Some(&keep), Purpose::Everything);
    let tapes = tape::lower(&derived.equations);
    let mut compiled = Compiled {
        source: source.clone(),
        mechanism,
        topology,
        analysis,
        warnings,
        equations: derived.equations,
        tapes,
        description: derived.description,
        sizes: derived.sizes,
    };
    let system = compiled.interpreter();
    preflight::check_prescribed(source, &compiled.mechanism, &compiled.description, &system)?;
    let near = preflight::contacts_near_modes(&compiled.mechanism, &compiled.description, &system);
    compiled.warnings.extend(near);
    Ok(compiled)
}

fn analyse(source: &SourceFile, mechanism: &Mechanism, topology: &Topology) -> Result<Findings, Diagnostics> {
    let released = preflight::released(mechanism);
    let derived = derive::derive(&released, topology, None, Purpose::Analysis);
    let tapes = tape::lower(&derived.equations);
    let interpreter = Interpreted::new(&tapes, derived.sizes, derived.description.clone());
    let case = preflight::Case {
        source,
        mechanism,
        topology,
        linkage: &derived.linkage,
        description: &derived.description,
        system: &interpreter,
    };
    preflight::analyse(&case)
}

impl Compiled {
    /// Names, units, rows and channels.
    #[must_use]
    pub fn description(&self) -> &Description {
        &self.description
    }

    /// Values of the tunable parameters, overrides included.
    #[must_use]
    pub fn parameters(&self) -> Vec<f64> {
        self.description.parameters.iter().map(|parameter| parameter.default).collect()
    }

    /// The mechanism as a runtime system, without a compiler.
    #[must_use]
    pub fn interpreter(&self) -> Interpreted {
        Interpreted::new(&self.tapes, self.sizes, self.description.clone())
    }

    /// Operations, statements and parts of every entry point.
    #[must_use]
    pub fn operations(&self) -> Vec<FunctionCount> {
        self.tapes
            .iter()
            .map(|tape| FunctionCount {
                name: tape.name.clone(),
                operations: tape.operations(),
                statements: tape.statements.len(),
                parts: tape::split(tape, STATEMENTS_PER_FUNCTION).parts.len(),
            })
            .collect()
    }

    /// All outputs with their costs before and after sharing.
    #[must_use]
    pub fn outputs(&self) -> Vec<OutputInfo> {
        render::outputs(&self.equations, &self.tapes)
    }

    /// The equations for people; all outputs if `only` is empty.
    #[must_use]
    pub fn equations_text(&self, only: &[String], format: TextFormat) -> String {
        render::render(&self.equations, &self.tapes, only, format)
    }

    /// The specialised source, for inclusion as the contents of a module.
    #[must_use]
    pub fn rust_source(&self) -> String {
        self.rust_source_for("::linkwear_runtime")
    }

    /// As [`Compiled::rust_source`], with another path to the runtime crate.
    #[must_use]
    pub fn rust_source_for(&self, runtime_path: &str) -> String {
        emit(&EmitInput {
            source_name: &self.file_name(),
            source_sha256: &sha256(&self.source.text),
            tapes: &self.tapes,
            description: &self.description,
            sizes: self.sizes,
            runtime_path,
        })
    }

    /// Last two parts of the source's path: enough to find it, nothing about the machine.
    fn file_name(&self) -> String {
        let parts: Vec<&str> = self.source.name.split(['/', '\\']).filter(|part| !part.is_empty()).collect();
        parts[parts.len().saturating_sub(2)..].join("/")
    }
}

/// SHA-256 of a text in hexadecimal.
#[must_use]
pub fn sha256(text: &str) -> String {
    use sha2::Digest as _;
    sha2::Sha256::digest(text.as_bytes()).iter().map(|byte| format!("{byte:02x}")).collect()
}
