//! The mechanisms that the study runs: the shipped case study and its variants. In: files of shipped mechanisms. Out:
//! mechanisms ready to run, and their turns. Never knows lives, figures or what is done with a run.
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
/// The file of the case study with ideal joints.
const IDEAL: &str = include_str!("../../mechanisms/rssr_flexible.toml");
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
    Ok(compile(&source("rssr", TEXT), &Options::default()).map_err(LoadError::Mechanism)?)
}

/// The text of a shipped mechanism, or what was made of it.
fn source(name: &str, text: &str) -> SourceFile {
    SourceFile { name: format!("mechanisms/{name}.toml"), text: text.to_owned() }
}

impl Model {
    pub fn mechanism(self) -> Result<Mechanism, StudyError> {
        let ready =
            |source: SourceFile, options: &Options| Ok(Mechanism::compile(&source, options, Backend::Auto)?);
        match self {
            Self::Flexible => ready(source("rssr", TEXT), &Options::default()),
            Self::Ideal => ready(source("rssr_flexible", IDEAL), &Options::default()),
            Self::Rigid => ready(source("rssr", TEXT), &Options { rigid: true, ..Options::default() }),
            Self::WithFrequencies(frequencies) => {
                let expected = "damping = \"zeta\" }";
                let twice: Vec<String> = frequencies.map(|f| format!("\"{f} Hz\", \"{f} Hz\"")).to_vec();
                let given = format!("damping = \"zeta\", frequencies = [{}] }}", twice.join(", "));
                let text = TEXT.replace(expected, &given);
                let missing = StudyError::Missing { kind: "text", name: expected.into() };
                if text == TEXT { Err(missing) } else { ready(source("rssr", &text), &Options::default()) }
            }
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
        let run = workers.piece(f64::from(settle + 1), |watch| {
            simulate(&*system, &mechanism.description, &mechanism.parameters, &settings, watch)
        })?;
        match run.stopped {
            Some(RunError::Interrupted { .. }) => Err(StudyError::Interrupted),
            Some(error) => Err(error.into()),
            None => Ok(run),
        }
    }
}
