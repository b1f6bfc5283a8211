//! Derivatives along a direction, by dual numbers through equations and laws of contact. In: a state, a direction. Out: how
//! derivatives of states and columns change along it. Never takes differences.

use linkwear_runtime::channels;
use linkwear_runtime::clearance_joint::{Clearances, Response};
use linkwear_runtime::contact::{ImpactMemory, Support};
use linkwear_runtime::{CONTACT_MOTION, CONTACT_WRENCH, Dual, Entry, Scalar, SimulationState, Sizes, System};

use crate::loaded::Loaded;
use crate::variables::Variable;

type D = Dual<f64>;
/// What a contact answers, the offset of its journal, and how far that has turned.
type Answer = (Response<D>, [D; 3], D);

/// Storage to differentiate with.
pub struct Sensitivity {
    sizes: Sizes,
    workspace: Vec<D>,
    /// Laws of the joints with clearance.
    clearances: Clearances,
    /// Index among kept rows of every row.
    kept: Vec<Option<usize>>,
    /// Columns that contacts add: joint, and the ending of the name.
    contact_columns: Vec<(usize, String)>,
}

/// What changes along a direction.
pub struct Changes {
    derivatives: Vec<f64>,
    outputs: Vec<f64>,
    indicators: Vec<f64>,
}

impl Changes {
    /// The change of a variable, if it is one that changes with others.
    pub fn of(&self, variable: Variable) -> Option<f64> {
        match variable {
            Variable::Derivative(index) => self.derivatives.get(index).copied(),
            Variable::Output(index) => self.outputs.get(index).copied(),
            Variable::Indicator(index) => self.indicators.get(index).copied(),
            _ => None,
        }
    }
}

impl Sensitivity {
    /// For a unit.
    pub fn new(loaded: &Loaded) -> Self {
        let description = loaded.unit.program.description();
        let sizes = System::<D>::sizes(&loaded.interpreter);
        let added = channels(description).into_iter().skip(sizes.channels);
        let column = |name: &str| {
            let (joint, ending) = name.rsplit_once('.')?;
            let joint = description.contacts.iter().position(|info| info.joint == joint)?;
            Some((joint, ending.to_owned()))
        };
        Self {
            workspace: vec![Dual::new(0.0, 0.0); sizes.workspace],
            clearances: Clearances::of(description).unwrap_or_default(),
            kept: description.rows.iter().map(|row| row.kept).collect(),
            contact_columns: added.filter_map(|channel| column(&channel.name)).collect(),
            sizes,
        }
    }

    /// Changes at a state along a direction of states, parameters and time.
    ///
    /// # Errors
    /// If a known is none of these, or a bearing is worn by angle.
    pub fn along(
        &mut self,
        loaded: &Loaded,
        at: &SimulationState,
        knowns: &[Variable],
        seed: &[f64],
    ) -> Result<Changes, String> {
        let sizes = self.sizes;
        let states = sizes.coordinates + sizes.speeds;
        let zero = |value: &f64| Dual::new(*value, 0.0);
        // Parameters, time, coordinates, speeds.
        let mut input: Vec<D> = at.parameters.iter().map(zero).collect();
        input.push(Dual::new(at.t, 0.0));
        input.extend(at.memory.iter().take(states).map(zero));
        for (known, seed) in knowns.iter().zip(seed) {
            let place = match known {
                Variable::Parameter(index) => *index,
                Variable::Time => sizes.parameters,
                Variable::State(index) => sizes.parameters + 1 + index,
                _ => return Err("a known is no state, parameter or time".to_owned()),
            };
            input[place].derivative += seed;
        }
        let ask = |entry: Entry, input: &[D], workspace: &mut [D]| {
            let mut output = vec![Dual::new(0.0, 0.0); sizes.output(entry)];
            loaded.interpreter.evaluate(entry, input, &mut output, workspace);
            output
        };
        let contacts = ask(Entry::Contacts, &input, &mut self.workspace);
        let responses = self.responses(loaded, at, &contacts)?;
        let wrenches: Vec<D> = responses.iter().flat_map(|(response, ..)| response.wrench).collect();
        debug_assert_eq!(wrenches.len(), CONTACT_WRENCH * sizes.contacts);
        let question: Vec<D> = [&input[..], &wrenches, &contacts].concat();
        let answer = ask(Entry::Derivative, &question, &mut self.workspace);
        let (rates, answer) = answer.split_at(sizes.coordinates);
        let (accelerations, answer) = answer.split_at(sizes.speeds);
        let (multipliers, answer) = answer.split_at(sizes.rows);
        let drives = &answer[..sizes.drivers];
        let of_row = |kept: &Option<usize>| kept.map_or(Dual::new(0.0, 0.0), |kept| multipliers[kept]);
        let multipliers: Vec<D> = self.kept.iter().map(of_row).collect();
        let question = [&input[..], accelerations, &multipliers, drives, &wrenches].concat();
        let columns = ask(Entry::Observe, &question, &mut self.workspace);
        let change = |value: &D| value.derivative;
        let mut outputs: Vec<f64> = columns.iter().map(change).collect();
        outputs.extend(self.contact_columns.iter().map(|(joint, ending)| {
            let (response, offset, turned) = &responses[*joint];
            change(&match ending.as_str() {
                "x" => offset[0],
                "y" => offset[1],
                "z" => offset[2],
                "gap" => -response.penetration,
                "Fn" => response.normal_force,
                "vt" => response.sliding_speed,
                "journal_angle" => offset[1].atan2(offset[0]) - *turned,
                _ => offset[1].atan2(offset[0]),
            })
        }));
        Ok(Changes {
            derivatives: rates.iter().chain(accelerations).map(change).collect(),
            outputs,
            indicators: responses.iter().map(|(response, ..)| response.penetration.derivative).collect(),
        })
    }

    /// What the laws answer to the motions of journals, with the offsets.
    fn responses(
        &self,
        loaded: &Loaded,
        at: &SimulationState,
        contacts: &[D],
    ) -> Result<Vec<Answer>, String> {
        let description = loaded.unit.program.description();
        let joints = self.clearances.joints().iter().zip(&*description.contacts).zip(&at.joints);
        let (motions, _) = contacts.as_chunks::<CONTACT_MOTION>();
        let respond = |(((joint, info), state), motion): (((&_, _), _), &[D; CONTACT_MOTION])| {
            let joint: &linkwear_runtime::clearance_joint::Clearance = joint;
            let info: &linkwear_runtime::ContactInfo = info;
            let state: &linkwear_runtime::clearance_joint::ClearanceState = state;
            if state.profile.is_some() || state.journal.is_some() {
                return Err(format!("joint {} is worn by angle: it has no derivatives", info.joint));
            }
            let clearance = motion[CONTACT_MOTION - 1] + D::constant(state.worn);
            let stiffness = info.stiffness.value(D::constant(info.journal_radius), clearance);
            let memory = ImpactMemory {
                touching: D::constant(state.memory.touching),
                closing_speed: D::constant(state.memory.closing_speed),
            };
            let round = |offset| Support::round(offset, clearance);
            let response = joint.respond(motion, round, (clearance, stiffness), &memory);
            Ok((response, joint.offset(motion), joint.turned(motion)))
        };
        joints.zip(motions).map(respond).collect()
    }
}
