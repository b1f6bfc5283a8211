//! A mechanism ready to run. In: a file, or a mechanism compiled into the program. Out: [`Mechanism`].
//! Never knows what is done with it.

use std::io;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

use linkwear_codegen::input::read_text;
use linkwear_codegen::tape::ShortTapes;
use linkwear_codegen::{Closure, Compiled, Diagnostics, Options, SourceFile, compile, limits};
use linkwear_native::{NativeBundle, Refusal};
use linkwear_runtime::{Description, SampledSignals, StepPlan, System};
use serde_json::{Map, Value, json};
use thiserror::Error;

use crate::backend::{Backend, BackendError, Equations, Lanes};
use crate::checksum::sha256;
use crate::files::folder_of;
use crate::journal::{Identity, VERSION};
use crate::mechanisms::SHIPPED;
use crate::provenance::Provenance;

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
///
/// ```
/// use linkwear::mechanism::Mechanism;
/// use linkwear_runtime::{Settings, Span, Watch, simulate};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let file = std::env::temp_dir().join(format!("linkwear-mechanism-{}.toml", std::process::id()));
/// # std::fs::write(&file, r#"
/// # spec = 1
/// # name = "swing"
/// # gravity = ["0 m/s^2", "0 m/s^2", "-9.81 m/s^2"]
/// # [points]
/// # O = ["0 m", "0 m", "0 m"]
/// # E = ["1 m", "0 m", "0 m"]
/// # [bodies]
/// # bar = { rod = ["O", "E"], radius = "10 mm", density = "7850 kg/m^3" }
/// # [joints]
/// # R1 = { revolute = ["ground", "bar"], at = "O", axis = [0, -1, 0] }
/// # "#)?;
/// // A bar of 2.466 kg that is let go from the horizontal.
/// let mechanism = Mechanism::read(&file)?;
/// # std::fs::remove_file(&file)?;
/// let settings = Settings { span: Span::Time(1.0), ..Settings::default() };
/// let (system, description) = (mechanism.system(), &mechanism.description);
/// let run = simulate(&*system, description, &mechanism.parameters, &settings, Watch::NONE)?;
/// // At its lowest point the bearing carries 5/2 of the weight.
/// let peak = run.range("R1.Fz")?.high.value;
/// assert!((peak - 2.5 * 2.466_150_233 * 9.81).abs() < 1e-2, "{peak}");
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct Mechanism {
    /// Names, units, columns, laws of contact and wear. The equations do not know these laws: changed here, they are
    /// changed.
    pub description: Description,
    /// Values of the parameters in SI, in the order of the description.
    pub parameters: Vec<f64>,
    /// Remarks on the file, with their places.
    pub warnings: Diagnostics,
    origin: Origin,
    equations: Equations,
}

/// What equations are from, where they were compiled from a file.
#[derive(Clone, Debug, Default)]
struct Origin {
    /// Hash of the file.
    file: String,
    /// How it was compiled, as far as that is not the default.
    options: Map<String, Value>,
    /// The text of the file; empty where a program compiled it in.
    text: Arc<str>,
    /// Where the file is, and the files that it names.
    place: PathBuf,
    attached: Vec<PathBuf>,
    /// Their tapes: making and hashing them all takes longer than writing the machine code of most runs, and few ask.
    tapes: Option<Arc<ShortTapes>>,
}

impl Mechanism {
    /// From a file, on the fastest back end that there is: see [`Backend::Auto`].
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
        Ok(Self::of(&compiled, options, backend)?)
    }

    /// Of what was compiled with these options, on a back end.
    ///
    /// # Errors
    /// If the back end cannot run it.
    pub fn of(compiled: &Compiled, options: &Options, backend: Backend) -> Result<Self, BackendError> {
        let equations = Equations::choose(compiled, options, backend)?;
        let warnings = located_warnings(compiled);
        let tapes = Some(Arc::clone(compiled.tapes_when_asked()));
        let source = &compiled.source;
        let origin = Origin {
            file: compiled.sha256(),
            options: told(options),
            text: source.text.as_str().into(),
            place: PathBuf::from(&source.name),
            attached: compiled.mechanism.attached.clone(),
            tapes,
        };
        Ok(Self { warnings, origin, ..Self::new(compiled.description().clone(), equations) })
    }

    /// A shipped mechanism by its name; none if there is no such.
    pub fn shipped(name: &str) -> Option<Self> {
        let shipped = SHIPPED.iter().find(|shipped| shipped.name == name)?;
        let mechanism = Self::new((shipped.description)().clone(), Equations::compiled(shipped.system));
        let origin = Origin { file: shipped.source_sha256.to_owned(), ..Origin::default() };
        Some(Self { origin, ..mechanism })
    }

    /// A mechanism that a program compiled in, every parameter at its default.
    pub fn new(description: Description, equations: Equations) -> Self {
        let parameters = description.parameters.iter().map(|parameter| parameter.default).collect();
        let (warnings, origin) = (Diagnostics::default(), Origin::default());
        Self { description, parameters, warnings, origin, equations }
    }

    /// All that decides its numbers, in words that a difference is told by. Back ends agree in every bit.
    pub(crate) fn identity(&self) -> Identity {
        let Origin { file, tapes, .. } = &self.origin;
        let tapes = tapes.as_ref().map(|tapes| sha256(&tapes.all())).unwrap_or_default();
        let parameters = self.description.parameters.iter().zip(&self.parameters);
        let parameters = parameters.map(|(known, value)| (format!("parameter {}", known.name), json!(value)));
        let mut entries = Identity::new();
        entries.insert(VERSION.to_owned(), json!(env!("CARGO_PKG_VERSION")));
        entries.insert("the hash of the file".to_owned(), json!(file));
        entries.extend(parameters);
        entries.insert("the hash of the equations".to_owned(), json!(tapes));
        entries.insert("the hash of the laws and names".to_owned(), json!(sha256(&self.description)));
        entries
    }

    /// Its file as [`MECHANISM`], and the files that it names below its folder, by their places from there: what compiles to it again.
    /// Nothing of a mechanism that a program compiled in.
    pub(crate) fn sources(&self) -> Vec<(String, String)> {
        let Origin { text, place, attached, .. } = &self.origin;
        let folder = folder_of(place);
        let named = |path: &PathBuf| {
            let name = path.strip_prefix(folder).ok().filter(|name| is_below(name))?;
            Some((name.to_str()?.to_owned(), read_text(path, limits::DATA_BYTES).ok()?))
        };
        let own = (!text.is_empty()).then(|| (MECHANISM.to_owned(), text.to_string()));
        own.into_iter().chain(attached.iter().filter_map(named)).collect()
    }

    /// What a result is of that it gives with a seed and options, SI.
    pub fn provenance(&self, seed: Option<u64>, options: Value) -> Provenance {
        let mut provenance = Provenance::new(self.origin.file.clone(), seed, options);
        provenance.options.extend(self.origin.options.clone());
        let parameters = self.description.parameters.iter().zip(&self.parameters);
        provenance.parameters =
            parameters.map(|(known, value)| (known.name.to_string(), json!(value))).collect();
        provenance
    }

    /// Names of the parameters that its options set, as `--set` does.
    pub fn given(&self) -> impl Iterator<Item = &str> {
        let set = self.origin.options.get(SET).and_then(Value::as_object);
        set.into_iter().flat_map(|set| set.keys().map(String::as_str))
    }

    /// An input that its options set and that has samples, too, which count: its value would change nothing.
    pub(crate) fn given_over_time(&self, signals: &SampledSignals) -> Option<&str> {
        let inputs = || self.description.input_infos().enumerate();
        let connects =
            |name: &str| inputs().any(|(at, (info, _))| info.name == *name && signals.connects(at));
        self.given().find(|name| connects(name))
    }

    /// Its equations, for one thread.
    pub fn system(&self) -> Box<dyn System<f64>> {
        self.equations.system()
    }

    /// Its equations for trajectories side by side; none but of machine code.
    pub(crate) fn lanes(&self) -> Option<Lanes> {
        let (tapes, plan) = self.steps()?;
        Lanes::new(tapes, &plan)
    }

    /// Its equations for whole steps of one trajectory; none but of machine code.
    pub(crate) fn whole_steps(&self) -> Option<NativeBundle<1>> {
        let (tapes, plan) = self.steps()?;
        NativeBundle::new(tapes, &plan).ok()
    }

    fn steps(&self) -> Option<(&ShortTapes, StepPlan)> {
        let tapes = self.origin.tapes.as_ref().filter(|_| self.equations.is_native())?;
        Some((tapes, StepPlan::new(&self.description, self.equations.system().sizes()).ok()?))
    }

    /// What runs them: `compiled`, `native` or `interpreter`.
    pub fn backend(&self) -> &'static str {
        self.equations.name()
    }

    /// Why they are interpreted although machine code would have been taken; none if nothing was refused.
    pub const fn refusal(&self) -> Option<&Refusal> {
        self.equations.refusal()
    }
}

/// What results call the parameters that options set.
const SET: &str = "set";

/// What a mechanism's file is called beside a result.
pub(crate) const MECHANISM: &str = "mechanism.toml";

/// Whether a path leads down and nowhere else.
pub(crate) fn is_below(path: &Path) -> bool {
    path.components().all(|part| matches!(part, Component::Normal(_)))
}

/// Options of a compilation as results tell them.
pub fn told(options: &Options) -> Map<String, Value> {
    let Options { closure, overrides, rigid, .. } = options;
    let set = || overrides.iter().map(|(name, value)| (name.clone(), json!(value))).collect::<Map<_, _>>();
    let closure = closure.map(|closure| match closure {
        Closure::Joint => "joint",
        Closure::Log => "log",
    });
    let entries = [
        ("closure", closure.map(Value::from)),
        ("rigid", rigid.then_some(Value::Bool(true))),
        (SET, (!overrides.is_empty()).then(|| Value::Object(set()))),
    ];
    entries.into_iter().filter_map(|(name, value)| Some((name.to_owned(), value?))).collect()
}

/// The text of a mechanism's file.
///
/// # Errors
/// [`LoadError::Read`].
pub fn read_source(file: &Path) -> Result<SourceFile, LoadError> {
    let name = file.display().to_string();
    let text = read_text(file, limits::FILE_BYTES);
    text.map(|text| SourceFile { name, text })
        .map_err(|error| LoadError::Read { file: file.to_path_buf(), error })
}

/// Remarks on a compiled file, with their places in its text.
pub fn located_warnings(mechanism: &Compiled) -> Diagnostics {
    mechanism.located_warnings()
}
