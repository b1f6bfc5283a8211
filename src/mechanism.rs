//! A mechanism ready to run. In: a file, or a mechanism compiled into the program. Out: [`Mechanism`].
//! Never knows what is done with it.

use std::path::{Path, PathBuf};
use std::{fs, io};

use linkwear_codegen::{Compiled, Diagnostics, Options, SourceFile, compile};
use linkwear_runtime::{Description, System};
use thiserror::Error;

use crate::backend::{Backend, BackendError, Equations};
use crate::mechanisms::SHIPPED;

/// A mechanism that cannot be run.
#[derive(Debug, Error)]
pub enum LoadError {
    /// Its file cannot be read.
    #[error("cannot read `{}`: {error}", .file.display())]
    Read {
        /// The file.
        file: PathBuf,
        /// Why.
        error: io::Error,
    },
    /// Its file is wrong.
    #[error("{0}")]
    Mechanism(Diagnostics),
    /// The back end asked for cannot run it.
    #[error(transparent)]
    Backend(#[from] BackendError),
}

/// Equations with all that is known about them.
#[derive(Debug)]
pub struct Mechanism {
    /// Names, units, columns, laws of contact and wear. The equations do not know these laws: changed here, they are
    /// changed.
    pub description: Description,
    /// Values of the parameters in SI, in the order of the description.
    pub parameters: Vec<f64>,
    /// Remarks on the file, with their places.
    pub warnings: Diagnostics,
    equations: Equations,
}

impl Mechanism {
    /// From a file: compiled code if it is a shipped mechanism, byte for byte, else interpreted.
    ///
    /// # Errors
    /// [`LoadError::Read`], [`LoadError::Mechanism`].
    pub fn read(file: impl AsRef<Path>) -> Result<Self, LoadError> {
        Self::compile(&read_source(file.as_ref())?, &Options::default(), Backend::Auto)
    }

    /// From the text of a file, with options, on a back end.
    ///
    /// # Errors
    /// [`LoadError::Mechanism`], [`LoadError::Backend`].
    pub fn compile(source: &SourceFile, options: &Options, backend: Backend) -> Result<Self, LoadError> {
        let compiled = compile(source, options).map_err(LoadError::Mechanism)?;
        let equations = Equations::choose(&compiled, options, backend)?;
        let warnings = located_warnings(&compiled);
        Ok(Self { warnings, ..Self::new(compiled.description().clone(), equations) })
    }

    /// A shipped mechanism by its name; none if there is no such.
    pub fn shipped(name: &str) -> Option<Self> {
        let shipped = SHIPPED.iter().find(|shipped| shipped.name == name)?;
        Some(Self::new((shipped.description)().clone(), Equations::compiled(shipped.system)))
    }

    /// A mechanism that a program compiled in, every parameter at its default.
    pub fn new(description: Description, equations: Equations) -> Self {
        let parameters = description.parameters.iter().map(|parameter| parameter.default).collect();
        Self { description, parameters, warnings: Diagnostics::default(), equations }
    }

    /// Its equations, for one thread.
    pub fn system(&self) -> Box<dyn System<f64>> {
        self.equations.system()
    }

    /// What runs them: `compiled` or `interpreter`.
    pub fn backend(&self) -> &'static str {
        self.equations.name()
    }
}

/// The text of a mechanism's file.
///
/// # Errors
/// [`LoadError::Read`].
pub fn read_source(file: &Path) -> Result<SourceFile, LoadError> {
    let name = file.display().to_string();
    let text = fs::read_to_string(file);
    text.map(|text| SourceFile { name, text })
        .map_err(|error| LoadError::Read { file: file.to_path_buf(), error })
}

/// Remarks on a compiled file, with their places in its text.
pub fn located_warnings(mechanism: &Compiled) -> Diagnostics {
    Diagnostics::from_list(mechanism.warnings.clone()).located(&mechanism.source)
}
