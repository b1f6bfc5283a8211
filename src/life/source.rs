//! The one source of wear that makes the table or the mean path: what its journal knows is not measured again.
//! In: the equations of every segment, a journal. Out: measurements, the same bits either way. Never knows what they are for.

use std::cell::Cell;
use std::rc::Rc;

use linkwear_runtime::life::{
    JointWear, MissionError, MissionSource, SegmentsMeasured, WearSource, one_by_one,
};
use linkwear_runtime::wear::ContactMeasure;
use linkwear_runtime::{DynamicsSource, Orbit, RunError, Steadiness};

use super::journal::{LifeJournal, Measurement};
use super::mission::Duty;
use super::steady::{Steady, TurnErrors};

/// Where the measurements of all segments are kept, in the order that they are made.
pub(super) struct Log<'a> {
    journal: Option<&'a LifeJournal>,
    made: Cell<usize>,
}

impl<'a> Log<'a> {
    pub fn new(journal: Option<&'a LifeJournal>) -> Rc<Self> {
        Rc::new(Self { journal, made: Cell::new(0) })
    }
}

/// Revolutions of a system, kept.
pub(super) struct KeptSource<'a> {
    source: MissionSource<KeptSegment<'a>>,
    /// Wear [m] and steadiness of the joints at each measurement until now.
    seen: Vec<(Vec<f64>, Vec<Steadiness>)>,
}

/// Those of a segment.
struct KeptSegment<'a> {
    source: DynamicsSource<'a>,
    log: Rc<Log<'a>>,
    /// Of the last measurement, or of each of the last ones that were made together.
    steadiness: Vec<Vec<Steadiness>>,
}

impl<'a> KeptSource<'a> {
    pub fn new(duty: &Duty, sources: Vec<DynamicsSource<'a>>, log: &Rc<Log<'a>>) -> Self {
        let kept = |source| KeptSegment { source, log: Rc::clone(log), steadiness: Vec::new() };
        Self { source: duty.compose(sources.into_iter().map(kept).collect()), seen: Vec::new() }
    }

    /// What was doubtful until now.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        for segment in self.source.segments() {
            for warning in segment.source.source.warnings() {
                let is_one = self.source.segments().len() == 1;
                let place = if is_one { String::new() } else { format!("segment `{}`: ", segment.name) };
                warnings.push(format!("{place}{warning}"));
            }
        }
        warnings
    }

    /// What the segments have worn until now; nothing of a single one.
    pub fn measured(&self) -> &[SegmentsMeasured] {
        self.source.measured()
    }

    /// How far off the life of a joint may be because turns were not steady.
    pub fn turn_errors(&self, joint: usize) -> TurnErrors {
        let one = |(wear, steadiness): &(Vec<f64>, Vec<Steadiness>)| Steady {
            worn: wear[joint],
            turns: steadiness[joint],
        };
        TurnErrors::of(self.seen.iter().map(one).collect())
    }

    fn see(&mut self, which: usize, joints: &[JointWear]) {
        let steadiness = (0..joints.len()).filter_map(|joint| self.steadiness(which, joint)).collect();
        self.seen.push((wears(joints), steadiness));
    }

    /// How steady the turns of all segments were, of a joint in one of the last measurements: drifts add, scatter is independent.
    fn steadiness(&self, which: usize, joint: usize) -> Option<Steadiness> {
        let segments = self.source.segments();
        let each = || {
            segments
                .iter()
                .filter_map(|one| Some((one.revolutions, one.source.steadiness.get(which)?.get(joint)?)))
        };
        if let [_] = segments {
            return each().next().map(|(_, alone)| *alone);
        }
        let wear: f64 = each().map(|(share, one)| share * one.wear).sum();
        let part = |of: f64| if of == 0.0 { 0.0 } else { of / wear };
        let drift = each().map(|(share, one)| Some(share * one.wear * one.drift?)).sum::<Option<f64>>();
        let square = |(share, one): (f64, &Steadiness)| Some((share * one.wear * one.scatter?).powi(2));
        let scatter = each().map(square).sum::<Option<f64>>();
        Some(Steadiness { wear, drift: drift.map(part), scatter: scatter.map(|square| part(square.sqrt())) })
    }
}

/// Wear of the joints [m].
fn wears(joints: &[JointWear]) -> Vec<f64> {
    joints.iter().map(|joint| joint.wear).collect()
}

impl WearSource for KeptSource<'_> {
    type State = Vec<Option<Orbit>>;
    type Error = MissionError<RunError>;

    fn measure(
        &mut self,
        joints: &[JointWear],
        state: &mut Self::State,
    ) -> Result<Vec<ContactMeasure>, Self::Error> {
        let measured = self.source.measure(joints, state)?;
        self.see(0, joints);
        Ok(measured)
    }

    fn measure_each(
        &mut self,
        joints: &[Vec<JointWear>],
        states: &mut [Self::State],
    ) -> Result<Vec<Vec<ContactMeasure>>, Self::Error> {
        if self.source.segments().len() > 1 {
            return one_by_one(self, joints, states);
        }
        let each = self.source.measure_each(joints, states)?;
        joints.iter().enumerate().for_each(|(which, joints)| self.see(which, joints));
        Ok(each)
    }
}

impl KeptSegment<'_> {
    /// The next measurement of the log, if the journal has it.
    fn known(&mut self, joints: &[JointWear], state: &mut Option<Orbit>) -> Option<Vec<ContactMeasure>> {
        let made = self.log.made.get();
        let known = self.log.journal?.measurement(made, &wears(joints))?;
        self.source.known(&known.warnings);
        state.clone_from(&known.state);
        self.log.made.set(made + 1);
        self.steadiness.push(known.steadiness.clone());
        Some(known.measured.clone())
    }

    /// Keeps one that was made.
    fn keep(
        &mut self,
        joints: &[JointWear],
        (measured, steadiness): (&[ContactMeasure], &[Steadiness]),
        state: &Option<Orbit>,
    ) {
        self.log.made.set(self.log.made.get() + 1);
        self.steadiness.push(steadiness.to_vec());
        if let Some(journal) = self.log.journal {
            journal.keep_measurement(Measurement {
                wear: wears(joints),
                measured: measured.to_vec(),
                steadiness: steadiness.to_vec(),
                state: state.clone(),
                warnings: self.source.warnings().to_vec(),
            });
        }
    }
}

impl WearSource for KeptSegment<'_> {
    type State = Option<Orbit>;
    type Error = RunError;

    fn measure(
        &mut self,
        joints: &[JointWear],
        state: &mut Self::State,
    ) -> Result<Vec<ContactMeasure>, RunError> {
        self.steadiness.clear();
        if let Some(known) = self.known(joints, state) {
            return Ok(known);
        }
        let measured = self.source.measure(joints, state)?;
        let steadiness = self.source.steadiness().to_vec();
        self.keep(joints, (&measured, &steadiness), state);
        Ok(measured)
    }

    fn measure_each(
        &mut self,
        joints: &[Vec<JointWear>],
        states: &mut [Self::State],
    ) -> Result<Vec<Vec<ContactMeasure>>, RunError> {
        self.steadiness.clear();
        let mut each = Vec::with_capacity(joints.len());
        for (joints, state) in joints.iter().zip(&mut *states) {
            let Some(known) = self.known(joints, state) else { break };
            each.push(known);
        }
        let made = each.len();
        each.extend(self.source.measure_each(&joints[made..], &mut states[made..])?);
        let steadiness = self.source.steadiness_of_each().to_vec();
        for (which, steadiness) in (made..).zip(&steadiness) {
            self.keep(&joints[which], (&each[which], steadiness), &states[which]);
        }
        Ok(each)
    }
}
