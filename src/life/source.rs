//! The one source of wear that makes the table or the mean path: what its journal knows is not measured again.
//! In: the equations, a journal. Out: measurements, the same bits either way. Never knows what they are for.

use linkwear_runtime::life::{JointWear, WearSource};
use linkwear_runtime::wear::ContactMeasure;
use linkwear_runtime::{DynamicsSource, RunError, RunWarning, Steadiness, TurnState};

use super::journal::{LifeJournal, Measurement};
use super::steady::{Steady, TurnErrors};

/// Revolutions of a system, kept.
pub(super) struct KeptSource<'a> {
    source: DynamicsSource<'a>,
    journal: Option<&'a LifeJournal>,
    /// Wear [m] and steadiness of the joints at each measurement until now.
    seen: Vec<(Vec<f64>, Vec<Steadiness>)>,
}

impl<'a> KeptSource<'a> {
    pub fn new(source: DynamicsSource<'a>, journal: Option<&'a LifeJournal>) -> Self {
        Self { source, journal, seen: Vec::new() }
    }

    /// What was doubtful until now.
    pub fn warnings(&self) -> &[RunWarning] {
        self.source.warnings()
    }

    /// How far off the life of a joint may be because turns were not steady.
    pub fn turn_errors(&self, joint: usize) -> TurnErrors {
        let one = |(wear, steadiness): &(Vec<f64>, Vec<Steadiness>)| Steady {
            worn: wear[joint],
            turns: steadiness[joint],
        };
        TurnErrors::of(self.seen.iter().map(one).collect())
    }
}

impl WearSource for KeptSource<'_> {
    type State = Option<TurnState>;
    type Error = RunError;

    fn measure(
        &mut self,
        joints: &[JointWear],
        state: &mut Self::State,
    ) -> Result<Vec<ContactMeasure>, RunError> {
        let wear: Vec<f64> = joints.iter().map(|joint| joint.wear).collect();
        if let Some(known) = self.journal.and_then(|journal| journal.measurement(self.seen.len(), &wear)) {
            self.source.known(&known.warnings);
            state.clone_from(&known.state);
            self.seen.push((wear, known.steadiness.clone()));
            return Ok(known.measured.clone());
        }
        let measured = self.source.measure(joints, state)?;
        let steadiness = self.source.steadiness().to_vec();
        self.seen.push((wear.clone(), steadiness.clone()));
        if let Some(journal) = self.journal {
            journal.keep_measurement(Measurement {
                wear,
                measured: measured.clone(),
                steadiness,
                state: state.clone(),
                warnings: self.source.warnings().to_vec(),
            });
        }
        Ok(measured)
    }
}
