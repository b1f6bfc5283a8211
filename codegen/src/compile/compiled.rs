//! A mechanism, understood, and what can be asked of it.
//! In: what the stages made. Out: [`Compiled`]. Never knows in which order they ran.

use std::sync::Arc;

use linkwear_runtime::clearance_joint::Clearances;
use linkwear_runtime::{Description, Entry, Sizes, System, motion_sizes};

use crate::backend::Start;
use crate::backend::c::{self, CFiles, CInput};
use crate::backend::interp::Interpreted;
use crate::backend::rust::{EmitInput, emit};
use crate::derive::Equations;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::{Closure, Mechanism, Topology};
use crate::preflight::{self, Analysis, Assemblies};
use crate::render::{self, OutputInfo, TextFormat};
use crate::source::SourceFile;
use crate::tape::{self, AtHand, Lowered, Operations, PART_LIMIT, ShortTapes, Tape, Tapes};

/// A mechanism, understood: equations, tapes and all that is known about it.
#[derive(Clone, Debug)]
pub struct Compiled {
    /// The file it came from.
    pub source: SourceFile,
    /// The mechanism.
    pub mechanism: Arc<Mechanism>,
    /// The closure that the file asks for, whatever [`crate::Options::closure`] made of it.
    pub closure_in_file: Closure,
    /// Spanning tree and cuts.
    pub topology: Arc<Topology>,
    /// Freedoms and redundancies.
    pub analysis: Analysis,
    /// Remarks that do not stop the compilation.
    pub warnings: Vec<Diagnostic>,
    /// Symbolic equations.
    pub equations: Arc<Equations>,
    /// One tape per function: half of the work on a large mechanism, which a check does not need.
    pub(super) tapes: Arc<ShortTapes>,
    /// Of the same as the derivation made them what looks have asked for that came before.
    pub(super) lowered: Lowered,
    pub(super) description: Description,
    /// Without what tapes hold between two calls.
    pub(super) sizes: Sizes,
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

impl Compiled {
    /// SHA-256 of the file and those that it includes, in hexadecimal.
    pub fn sha256(&self) -> String {
        self.mechanism.sources.whole().sha256()
    }

    /// The warnings with their places.
    pub fn located_warnings(&self) -> Diagnostics {
        Diagnostics::from_list(self.warnings.clone()).located_in(&self.mechanism.sources)
    }

    /// One tape per function, in as few operations as are found.
    pub fn tapes(&self) -> &[Tape] {
        self.tapes.all()
    }

    /// The same, each made when it is first asked for: most runs ask for half of them.
    pub fn tapes_when_asked(&self) -> &Arc<ShortTapes> {
        &self.tapes
    }

    /// Whether the mass matrix is left out of `equations_of_motion`, as it is of long mechanisms: zeros stand in its place.
    pub fn mass_is_left_out(&self) -> bool {
        self.equations.mass_is_left_out()
    }

    /// Names, units, rows and channels.
    pub fn description(&self) -> &Description {
        &self.description
    }

    /// Values of the tunable parameters, overrides included.
    pub fn parameters(&self) -> Vec<f64> {
        self.description.parameters.iter().map(|parameter| parameter.default).collect()
    }

    /// Lengths of inputs and outputs; each back end has a workspace of its own.
    pub fn sizes(&self) -> Sizes {
        self.sizes.with_held(self.tapes.tape(Entry::Contacts).map_or(0, Tape::output_len))
    }

    /// The same before any tape is made: without what contacts hand to the derivative.
    pub const fn sizes_without_held(&self) -> Sizes {
        self.sizes
    }

    /// The mechanism as a runtime system, without a compiler.
    pub fn interpreter(&self) -> Interpreted {
        Interpreted::new(self.tapes(), self.sizes(), self.description.clone())
    }

    /// The same for a look at a state or two: by tapes as the derivation made them, and of those that it asks for alone, unless
    /// shorter ones are there already. To shorten them takes longer than such a look. Values differ by rounding.
    pub fn interpreter_at_hand(&self) -> Box<dyn System<f64> + '_> {
        match self.tapes.known() {
            Some(_) => Box::new(self.interpreter()),
            None => Box::new(AtHand::new(&self.equations, &self.lowered, self.sizes)),
        }
    }

    /// How else the loops could close at the start.
    pub fn assemblies(&self) -> Assemblies {
        if !preflight::are_looked_for(self.sizes) {
            return Assemblies::default();
        }
        preflight::assemblies(&self.description, &*self.interpreter_at_hand())
    }

    /// Operations, statements and parts of every entry point.
    pub fn operations(&self) -> Vec<FunctionCount> {
        self.tapes()
            .iter()
            .map(|tape| FunctionCount {
                name: tape.name.clone(),
                operations: tape.operations(),
                statements: tape.statements.len(),
                parts: tape::split(tape, PART_LIMIT).parts.len(),
            })
            .collect()
    }

    /// All outputs with their costs before and after sharing.
    pub fn outputs(&self) -> Vec<OutputInfo> {
        render::outputs(&self.equations, self.tapes())
    }

    /// The equations for people; all outputs if `only` is empty.
    pub fn equations_text(&self, only: &[String], format: TextFormat) -> String {
        render::render(&self.equations, self.tapes(), only, format)
    }

    /// The specialised source, for inclusion as the contents of a module.
    pub fn rust_source(&self) -> String {
        self.rust_source_for("::linkwear_runtime")
    }

    /// As [`Compiled::rust_source`], with another path to the runtime crate.
    pub fn rust_source_for(&self, runtime_path: &str) -> String {
        self.rust(runtime_path, None)
    }

    /// As [`Compiled::rust_source_for`], with a consistent start as a static, `START`.
    ///
    /// # Errors
    /// If a run could not start.
    pub fn rust_source_with_start(&self, runtime_path: &str) -> Result<String, Diagnostics> {
        let start = self.start()?;
        Ok(self.rust(runtime_path, Some(&start)))
    }

    /// Where a run starts at t = 0, with the parameters as they are.
    ///
    /// # Errors
    /// If it could not.
    pub fn start(&self) -> Result<Start, Diagnostics> {
        let (source, system) = (self.mechanism.sources.whole(), self.interpreter());
        let assembled = preflight::assembled(source, &self.mechanism, &self.description, &system);
        let (mut evaluator, start) =
            assembled.map_err(|errors| errors.located_in(&self.mechanism.sources))?;
        let sizes = motion_sizes(&mut evaluator, 0.0, &start);
        Ok(Start { state: [start.q, start.v].concat(), sizes })
    }

    fn rust(&self, runtime_path: &str, start: Option<&Start>) -> String {
        emit(&EmitInput {
            source_name: self.file_name(),
            source_sha256: &self.sha256(),
            tapes: self.tapes(),
            description: &self.description,
            sizes: self.sizes(),
            start,
            runtime_path,
        })
    }

    /// Begin of every name in [`Self::c_files`].
    pub fn c_prefix(&self) -> String {
        c::prefix(&self.description.name)
    }

    /// Source and header of C99; `header_name` is the name of the header's file, as the source includes it.
    pub fn c_files(&self, header_name: &str) -> CFiles {
        self.as_c(header_name, c::emit)
    }

    /// A source of C99 beside them that has all columns of a run, and `more` behind it: see [`c::emit_outputs`].
    pub fn c_outputs(&self, header_name: &str, more: &str) -> String {
        self.as_c(header_name, |input| c::emit_outputs(input, more))
    }

    /// A crate with an interface of C: where each file lies in its folder, what is in it.
    pub fn c_crate(&self) -> Vec<(String, String)> {
        self.as_c("", |input| c::emit_crate(input, self.rust_source()))
    }

    fn as_c<R>(&self, header_name: &str, emit: impl FnOnce(&CInput<'_>) -> R) -> R {
        let clearances = Clearances::of(&self.description).unwrap_or_default();
        let start = self.start().ok();
        emit(&CInput {
            source_name: self.file_name(),
            source_sha256: &self.sha256(),
            header_name,
            tapes: self.tapes(),
            description: &self.description,
            sizes: self.sizes(),
            joints: clearances.joints(),
            start: start.as_ref(),
        })
    }

    /// The source's name without its folders: the same bytes from wherever it is named.
    fn file_name(&self) -> &str {
        self.source.name.rsplit(['/', '\\']).find(|part| !part.is_empty()).unwrap_or_default()
    }
}
