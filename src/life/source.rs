//! The one source of wear that makes the table or the mean path: what its journal knows is not measured again.
//! In: the equations, a journal. Out: measurements, the same bits either way. Never knows what they are for.

use linkwear_runtime::life::{JointWear, WearSource};
use linkwear_runtime::wear::ContactMeasure;
use linkwear_runtime::{DynamicsSource, RunError, RunWarning, TurnState};

use super::journal::{Journal, Measurement};

/// Revolutions of a system, kept.
pub(super) struct KeptSource<'a> {
    source: DynamicsSource<'a>,
    journal: Option<&'a Journal>,
    /// Measurements until now.
    count: usize,
}

impl<'a> KeptSource<'a> {
    pub fn new(source: DynamicsSource<'a>, journal: Option<&'a Journal>) -> Self {
        Self { source, journal, count: 0 }
    }

    /// What was doubtful until now.
    pub fn warnings(&self) -> &[RunWarning] {
        self.source.warnings()
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
        let Some(journal) = self.journal else { return self.source.measure(joints, state) };
        let wear: Vec<f64> = joints.iter().map(|joint| joint.wear).collect();
        let index = self.count;
        self.count += 1;
        if let Some(known) = journal.measurement(index, &wear) {
            self.source.known(&known.warnings);
            state.clone_from(&known.state);
            return Ok(known.measured.clone());
        }
        let measured = self.source.measure(joints, state)?;
        journal.keep_measurement(Measurement {
            wear,
            measured: measured.clone(),
            state: state.clone(),
            warnings: self.source.warnings().to_vec(),
        });
        Ok(measured)
    }
}
