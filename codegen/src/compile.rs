//! The whole pipeline, in order: parse, resolve, derive, analyse, derive again without redundant rows, lower.
//! In: a source file. Out: [`Compiled`]. Never knows how a stage works.

use linkwear_runtime::{Description, Sizes};

use crate::backend::interp::Interpreted;
use crate::derive::{self, Equations, Purpose};
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::{self, Closure, Mechanism, Topology};
use crate::preflight::{self, Analysis};
use crate::source::SourceFile;
use crate::spec;
use crate::tape::{self, Tape};

/// What a caller may change without touching the file.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Overrides the file's closure.
    pub closure: Option<Closure>,
    /// Parameter values by name, with units in the text.
    pub overrides: Vec<(String, String)>,
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

/// Compiles a file.
///
/// # Errors
/// All that is wrong with the file, in one go.
pub fn compile(source: &SourceFile, options: &Options) -> Result<Compiled, Diagnostics> {
    let spec = spec::parse(source)?;
    let (mut mechanism, warnings) = model::resolve(&spec, &options.overrides)?;
    if let Some(closure) = options.closure {
        mechanism.closure = closure;
    }
    let topology = model::topology::spanning_tree(&mechanism, source)?;
    let (analysis, keep) = analyse(source, &mechanism, &topology)?;
    let derived = derive::derive(&mechanism, &topology, Some(&keep), Purpose::Everything);
    let tapes = tape::lower(&derived.equations);
    Ok(Compiled {
        source: source.clone(),
        mechanism,
        topology,
        analysis,
        warnings,
        equations: derived.equations,
        tapes,
        description: derived.description,
        sizes: derived.sizes,
    })
}

fn analyse(
    source: &SourceFile,
    mechanism: &Mechanism,
    topology: &Topology,
) -> Result<(Analysis, Vec<bool>), Diagnostics> {
    let derived = derive::derive(mechanism, topology, None, Purpose::Analysis);
    let tapes = tape::lower(&derived.equations);
    let description = derived.description;
    let interpreter = Interpreted::new(tapes, derived.sizes, description.clone());
    let parameters: Vec<f64> = description.parameters.iter().map(|parameter| parameter.default).collect();
    preflight::analyse(source, mechanism, topology, &description, &interpreter, &parameters)
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
        Interpreted::new(self.tapes.clone(), self.sizes, self.description.clone())
    }
}
