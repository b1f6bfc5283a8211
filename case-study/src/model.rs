//! The mechanisms that the study runs: the shipped case study and its variants. In: shipped mechanisms, their
//! files. Out: mechanisms ready to run, and their turns. Never knows lives, figures or what is done with a run.
//!
//! Variants are made as any user makes them: by the options of the generator and by editing the text of a file.

use linkwear::backend::Backend;
use linkwear::mechanism::{LoadError, Mechanism};
use linkwear_codegen::{Compiled, Options, SourceFile, compile};
use linkwear_runtime::{Integrator, Run, RunError, Settings, Span, simulate};

use super::error::StudyError;
use super::workers::Workers;

/// The file of the case study.
const TEXT: &str = include_str!("../../mechanisms/rssr.toml");
/// The joint that wears.
pub(super) const JOINT: &str = "R1";

/// A model of the mechanism.
#[derive(Clone, Copy)]
pub(super) enum Model {
    /// The case study as it is shipped: flexible coupler, clearance at R1.
    Flexible,
    /// The same with ideal joints.
    Ideal,
    /// The case study with a rigid coupler.
    Rigid,
    /// The case study with these frequencies of its coupler [Hz], each in both planes.
    WithFrequencies([f64; 3]),
}

/// The case study, understood by the generator.
pub(super) fn compiled() -> Result<Compiled, StudyError> {
    Ok(compile(&source(TEXT.to_owned()), &Options::default()).map_err(LoadError::Mechanism)?)
}

fn source(text: String) -> SourceFile {
    SourceFile { name: "mechanisms/rssr.toml".into(), text }
}

impl Model {
    pub fn mechanism(self) -> Result<Mechanism, StudyError> {
        let shipped = |name: &str| {
            let missing = || StudyError::Missing { kind: "shipped mechanism", name: name.into() };
            Mechanism::shipped(name).ok_or_else(missing)
        };
        let interpreted = |text: String, options: &Options| {
            Ok(Mechanism::compile(&source(text), options, Backend::Interpreter)?)
        };
        match self {
            Self::Flexible => shipped("rssr"),
            Self::Ideal => shipped("rssr_flexible"),
            Self::Rigid => interpreted(TEXT.to_owned(), &Options { rigid: true, ..Options::default() }),
            Self::WithFrequencies(frequencies) => {
                let expected = "damping = \"zeta\" }";
                let twice: Vec<String> = frequencies.map(|f| format!("\"{f} Hz\", \"{f} Hz\"")).to_vec();
                let given = format!("damping = \"zeta\", frequencies = [{}] }}", twice.join(", "));
                let text = TEXT.replace(expected, &given);
                let missing = StudyError::Missing { kind: "text", name: expected.into() };
                if text == TEXT { Err(missing) } else { interpreted(text, &Options::default()) }
            }
        }
    }

    /// Cost of a turn, roughly, in turns of the compiled flexible mechanism: what progress is counted in.
    pub fn cost(self) -> f64 {
        match self {
            Self::Flexible | Self::Ideal => 1.0,
            Self::Rigid | Self::WithFrequencies(_) => 4.0,
        }
    }

    /// A turn as a run, after so many turns to settle, with steps and samples as told.
    pub fn turn(
        self,
        settle: u32,
        step: f64,
        samples: usize,
        workers: &Workers<'_>,
    ) -> Result<Run, StudyError> {
        let mechanism = self.mechanism()?;
        let system = mechanism.system();
        let settings = Settings {
            settle: Span::Turns(f64::from(settle)),
            ..Settings::new(Integrator::Rk4 { step }, Span::Turns(1.0), samples)
        };
        let run = workers.piece(self.cost() * f64::from(settle + 1), |watch| {
            simulate(&*system, &mechanism.description, &mechanism.parameters, &settings, watch)
        })?;
        match run.stopped {
            Some(RunError::Interrupted { .. }) => Err(StudyError::Interrupted),
            Some(error) => Err(error.into()),
            None => Ok(run),
        }
    }
}
