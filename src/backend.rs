//! Which back end runs the equations of a mechanism. In: a compiled mechanism, what is asked for.
//! Out: [`Equations`], or why there are none. Never knows what they are used for.

use std::fmt;
use std::sync::Arc;

use linkwear_codegen::tape::ShortTapes;
use linkwear_codegen::{Compiled, Options};
use linkwear_native::{Native, NativeBundle, Refusal};
use linkwear_runtime::{StepPlan, System, WideBundle};
use thiserror::Error;

use crate::mechanisms::{SHIPPED, Shipped};

/// What runs the equations.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Backend {
    /// Machine code written now. Where that is refused: compiled if the file is a shipped mechanism, byte for byte, with no
    /// generation-time parameter set; else the interpreter.
    ///
    /// Machine code comes first because it has what this processor has: of the shipped mechanisms, all but the pendulum take
    /// 0.73 to 0.95 times as long for a derivative as code that was compiled for any processor (`linkwear cost`), and writing
    /// it takes two milliseconds.
    #[default]
    Auto,
    /// Equations that were compiled into this program.
    Compiled,
    /// Machine code of any mechanism, written from its tapes when it is read.
    Native,
    /// Runs the tapes of any mechanism, operation by operation.
    Interpreter,
}

/// The back end that was asked for cannot run the mechanism.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum BackendError {
    /// There is no compiled code for what was asked for.
    #[error("{reason}")]
    Compiled {
        /// Why.
        reason: String,
    },
    /// There is no machine code.
    #[error(transparent)]
    Native(#[from] Refusal),
}

/// Machine code for trajectories side by side, as many as this processor has lanes.
pub(crate) enum Lanes {
    /// Eight.
    Eight(NativeBundle<8>),
    /// Four.
    Four(NativeBundle<4>),
}

impl Lanes {
    /// Of a mechanism; none where there is no code for it here.
    pub(crate) fn new(tapes: &ShortTapes, plan: &StepPlan) -> Option<Self> {
        let eight = NativeBundle::new(tapes, plan).map(Self::Eight);
        eight.or_else(|_| NativeBundle::new(tapes, plan).map(Self::Four)).ok()
    }

    /// How many there are.
    pub(crate) fn count(&self) -> usize {
        match self {
            Self::Eight(_) => 8,
            Self::Four(_) => 4,
        }
    }

    /// For who runs turns in them.
    pub(crate) fn wide(&self) -> WideBundle<'_> {
        match self {
            Self::Eight(bundle) => WideBundle::Eight(bundle),
            Self::Four(bundle) => WideBundle::Four(bundle),
        }
    }
}

/// How machine code that was written when the mechanism was read is called.
const NATIVE: &str = "native";

type Make = dyn Fn() -> Box<dyn System<f64>> + Send + Sync;

/// Equations on a back end; every thread makes a system of its own.
#[derive(Clone)]
pub struct Equations {
    name: &'static str,
    make: Arc<Make>,
    refusal: Option<Refusal>,
}

impl fmt::Debug for Equations {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Equations").field("name", &self.name).finish_non_exhaustive()
    }
}

impl Equations {
    /// Of a mechanism that a program compiled in, `|| Box::new(my_mechanism::Mechanism::default())`.
    pub fn compiled(make: impl Fn() -> Box<dyn System<f64>> + Send + Sync + 'static) -> Self {
        Self { name: "compiled", make: Arc::new(make), refusal: None }
    }

    /// By interpreting the tapes.
    pub fn interpreted(mechanism: &Compiled) -> Self {
        let system = mechanism.interpreter();
        Self { name: "interpreter", make: Arc::new(move || system.clone().boxed()), refusal: None }
    }

    /// As machine code, written now.
    ///
    /// # Errors
    /// If this processor or this system cannot run it.
    pub fn native(mechanism: &Compiled) -> Result<Self, Refusal> {
        let (tapes, sizes) = (mechanism.tapes_when_asked().clone(), mechanism.sizes_without_held());
        let system = Native::when_asked(tapes, sizes, mechanism.description())?;
        Ok(Self { name: NATIVE, make: Arc::new(move || Box::new(system.clone())), refusal: None })
    }

    /// Of a mechanism, compiled with these options, on the back end that is asked for.
    ///
    /// # Errors
    /// If compiled code is asked for and there is none for exactly this mechanism, or machine code and none can be run.
    pub fn choose(mechanism: &Compiled, options: &Options, backend: Backend) -> Result<Self, BackendError> {
        match backend {
            Backend::Interpreter => Ok(Self::interpreted(mechanism)),
            Backend::Native => Ok(Self::native(mechanism)?),
            Backend::Compiled => compiled_in(mechanism, options)
                .map(|shipped| Self::compiled(shipped.system))
                .map_err(|reason| BackendError::Compiled { reason }),
            Backend::Auto => Ok(Self::native(mechanism)
                .unwrap_or_else(|refusal| Self::without_native(mechanism, options, refusal))),
        }
    }

    /// The fastest where machine code is refused.
    fn without_native(mechanism: &Compiled, options: &Options, refusal: Refusal) -> Self {
        match compiled_in(mechanism, options) {
            Ok(shipped) => Self::compiled(shipped.system),
            Err(_) => Self { refusal: Some(refusal), ..Self::interpreted(mechanism) },
        }
    }

    /// `compiled`, `native` or `interpreter`.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// Whether they are machine code that was written when the mechanism was read.
    pub(crate) fn is_native(&self) -> bool {
        self.name == NATIVE
    }

    /// Why they are interpreted although machine code would have been taken; none if nothing was refused.
    pub const fn refusal(&self) -> Option<&Refusal> {
        self.refusal.as_ref()
    }

    /// The equations, for one thread.
    pub fn system(&self) -> Box<dyn System<f64>> {
        (self.make)()
    }
}

/// The shipped mechanism that is exactly what was asked for, or why there is none.
fn compiled_in(mechanism: &Compiled, options: &Options) -> Result<&'static Shipped, String> {
    if options.rigid && mechanism.mechanism.bodies.iter().any(|body| body.flexible.is_some()) {
        return Err("it is compiled with its flexible bodies".to_owned());
    }
    if options.pictured {
        return Err("it is compiled without columns of where its bodies are".to_owned());
    }
    let hash = mechanism.sha256();
    let shipped = SHIPPED
        .iter()
        .find(|shipped| shipped.source_sha256 == hash)
        .ok_or("the file is not a shipped mechanism, byte for byte")?;
    let parameters = &mechanism.mechanism.parameters;
    let is_folded = |name: &str| parameters.iter().any(|known| known.name == name && !known.tunable);
    let folded = options.overrides.iter().map(|(name, _)| name.as_str()).filter(|name| is_folded(name));
    let folded: Vec<&str> = folded.collect();
    if !folded.is_empty() {
        return Err(format!("{} is folded into the compiled code", folded.join(", ")));
    }
    if mechanism.mechanism.closure != mechanism.closure_in_file {
        return Err("it is compiled with another closure".to_owned());
    }
    Ok(shipped)
}
