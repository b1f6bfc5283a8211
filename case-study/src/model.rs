//! The mechanisms that the study runs: the shipped case study and its variants. In: shipped mechanisms, their
//! files. Out: [`Model`], equations with a description. Never knows lives, figures or what is done with a run.
//!
//! Variants are made as any user makes them: by the options of the generator, by editing the text of a file, and by
//! changing the laws of contact and wear in a description, which the equations do not know.

use linkwear::backend::{Backend, Equations};
use linkwear::mechanism::{LoadError, Mechanism};
use linkwear::mechanisms;
use linkwear_codegen::{Compiled, Options, SourceFile, compile};
use linkwear_runtime::life::{JointWear, WearSource};
use linkwear_runtime::wear::{Area, ContactMeasure, Measure};
use linkwear_runtime::{DynamicsSource, Integrator, RevolutionSettings, RunError, TurnState, Watch};

use super::error::StudyError;
use super::options::INTERPRETED;
use super::progress::Progress;

/// The file of the case study.
pub(super) const TEXT: &str = include_str!("../../mechanisms/rssr.toml");
/// The joint that wears.
pub(super) const JOINT: &str = "R1";

/// A mechanism to run.
pub(super) struct Model {
    pub mechanism: Mechanism,
}

/// The case study, understood by the generator.
pub(super) fn compiled() -> Result<Compiled, StudyError> {
    Ok(compile(&source(TEXT.to_owned()), &Options::default()).map_err(LoadError::Mechanism)?)
}

fn source(text: String) -> SourceFile {
    SourceFile { name: "mechanisms/rssr.toml".into(), text }
}

impl Model {
    /// The case study as it is shipped: flexible coupler, clearance at R1.
    pub fn flexible() -> Self {
        let equations = Equations::compiled(|| Box::new(mechanisms::rssr::Mechanism::default()));
        Self { mechanism: Mechanism::new(mechanisms::rssr::description().clone(), equations) }
    }

    /// The same with ideal joints.
    pub fn ideal() -> Self {
        let equations = Equations::compiled(|| Box::new(mechanisms::rssr_flexible::Mechanism::default()));
        Self { mechanism: Mechanism::new(mechanisms::rssr_flexible::description().clone(), equations) }
    }

    /// The case study with a rigid coupler.
    pub fn rigid() -> Result<Self, StudyError> {
        Self::interpreted(TEXT.to_owned(), &Options { rigid: true, ..Options::default() })
    }

    fn interpreted(text: String, options: &Options) -> Result<Self, StudyError> {
        Ok(Self { mechanism: Mechanism::compile(&source(text), options, Backend::Interpreter)? })
    }

    /// The case study with these frequencies of its coupler [Hz], each in both planes.
    pub fn with_frequencies(frequencies: [f64; 3]) -> Result<Self, StudyError> {
        let expected = "damping = \"zeta\" }";
        let listed: Vec<String> =
            frequencies.iter().flat_map(|f| [format!("\"{f} Hz\""), format!("\"{f} Hz\"")]).collect();
        let given = format!("damping = \"zeta\", frequencies = [{}] }}", listed.join(", "));
        let text = TEXT.replace(expected, &given);
        if text == TEXT {
            Err(StudyError::Text { expected })
        } else {
            Self::interpreted(text, &Options::default())
        }
    }

    /// With wear over another contact area, and depth kept at so many bearing angles.
    pub fn wearing(mut self, area: Area, bins: usize) -> Self {
        for contact in self.mechanism.description.contacts.to_mut() {
            if let Some(wear) = &mut contact.wear {
                (wear.area, wear.profile, wear.bins, wear.measure) =
                    (area, true, bins, Some(Measure::Maximum));
            }
        }
        self
    }

    /// Cost of a turn, roughly, in turns of the compiled flexible mechanism: what progress is counted in.
    pub fn cost(&self) -> f64 {
        if self.mechanism.backend() == "compiled" { 1.0 } else { INTERPRETED }
    }

    /// Runs `action` with revolutions of this mechanism, each of which counts as progress.
    pub fn measuring<T>(
        &self,
        settings: RevolutionSettings,
        progress: &Progress<'_>,
        action: impl FnOnce(&mut Watched<'_>) -> Result<T, StudyError>,
    ) -> Result<T, StudyError> {
        let system = self.mechanism.system();
        let stop = |_| progress.go_on();
        let inner =
            DynamicsSource::new(&*system, &self.mechanism.description, &self.mechanism.parameters, settings)?;
        let turns = f64::from(settings.settle + settings.average.max(1));
        let step = if let Integrator::Rk4 { step } = settings.integrator { 2e-5 / step } else { 1.0 };
        let cost = turns * step * self.cost();
        action(&mut Watched { inner: inner.watched_by(Watch::new(&stop)), progress, cost })
    }
}

/// Revolutions that tell how far they are.
pub(super) struct Watched<'a> {
    pub inner: DynamicsSource<'a>,
    progress: &'a Progress<'a>,
    cost: f64,
}

impl WearSource for Watched<'_> {
    type State = Option<TurnState>;
    type Error = RunError;

    fn measure(
        &mut self,
        joints: &[JointWear],
        state: &mut Self::State,
    ) -> Result<Vec<ContactMeasure>, Self::Error> {
        let measured = self.inner.measure(joints, state);
        self.progress.done(self.cost);
        measured
    }
}
