//! What numbers of a mechanism vary with its parameters. In: a file, its parameters. Out: the motion as a tape in which the numbers
//! that vary are inputs, and how fast they vary. Never knows what is done with it.
//!
//! All that is prepared before a run, from masses to modes of flexible bodies and constants of contact laws, is plain numbers in the
//! tapes. Of these, differences over a short step give the derivatives, to [`STEP`]² of them; through the motion they are carried
//! exactly.

use linkwear_codegen::model::Parameter;
use linkwear_codegen::tape::{Number, Operand, Recorder, Tape};
use linkwear_codegen::{Compiled, Options, SourceFile, compile};
use linkwear_runtime::life::JointLife;
use linkwear_runtime::{
    CONTACT_MOTION, Description, DynamicsSource, Entry, Evaluate, RevolutionSettings, StepPlan, TOTALS,
};

use super::error::SensitivityError;

/// Step of a parameter, as a part of it. Curvature leaves its square, rounding 1e-16 over it.
const STEP: f64 = 1e-4;

/// How far from its value a parameter is for its form, as a part of it: no further than what [`STEP`] leaves open.
const BESIDE: f64 = STEP * STEP;

/// Numbers per joint with clearance that a motion wants besides parameters and state: how far it is worn [m], whether it touches,
/// the speed at which its gap closed [m/s].
pub(super) const MEMORY: usize = 3;
/// Numbers per joint with clearance behind the rates of a state: powers of wear integral [W] and depth [m/s], penetration [m] and
/// its rate [m/s].
pub(super) const ANSWER: usize = 4;

/// A mechanism at one value of its parameters.
pub(super) struct Variant {
    pub compiled: Compiled,
    /// Rates of a state, and what contacts are like; see [`MEMORY`] and [`ANSWER`].
    pub motion: Tape,
    /// Loops, as [`Entry::Closure`] has them.
    pub closure: Tape,
    /// Length of a turn [s].
    pub turn: f64,
    /// The wearing joints.
    pub joints: Vec<JointLife>,
}

/// A parameter by which something is differentiated.
#[derive(Clone, Debug, PartialEq)]
pub struct Varying {
    /// Its name.
    pub name: String,
    /// Its value, SI.
    pub value: f64,
    /// Its unit, SI.
    pub unit: String,
}

/// The same, and the mechanism on both sides.
pub(super) struct Sides {
    pub of: Varying,
    /// As the file has it: a number and its unit.
    written: (f64, String),
    /// Step to each side, SI.
    pub step: f64,
    pub sides: [Variant; 2],
}

impl Sides {
    /// A derivative from the values on both sides.
    pub(super) fn slope(&self, of: impl Fn(&Variant) -> f64) -> f64 {
        (of(&self.sides[1]) - of(&self.sides[0])) / (2.0 * self.step)
    }

    /// What sets the parameter to a multiple of its value; nothing if that is zero.
    pub(super) fn at(&self, factor: f64) -> Option<(String, String)> {
        let (number, unit) = &self.written;
        (*number != 0.0).then(|| set(&self.of.name, factor * number, unit))
    }
}

/// What sets a parameter.
fn set(name: &str, number: f64, unit: &str) -> (String, String) {
    let text = if unit.is_empty() { format!("{number:?}") } else { format!("{number:?} {unit}") };
    (name.to_owned(), text)
}

impl Variant {
    /// Of a file with these options.
    pub(super) fn new(source: &SourceFile, options: &Options) -> Result<Self, SensitivityError> {
        let compiled = compile(source, options).map_err(SensitivityError::Mechanism)?;
        let description = compiled.description();
        check(description)?;
        let (sizes, parameters) = (compiled.sizes(), compiled.parameters());
        let plan = StepPlan::new(description, sizes)?;
        let system = compiled.interpreter();
        let settings = RevolutionSettings::default();
        let mut source = DynamicsSource::new(system.on_numbers(), description, &parameters, settings)?;
        let turn = source.seconds_per_revolution()?.ok_or(SensitivityError::UnevenTurns)?;
        let joints = source.joints()?;
        if joints.is_empty() {
            return Err(SensitivityError::NothingWears);
        }
        let motion = motion(compiled.tapes(), &plan).constants_first();
        let closure = compiled.tapes()[Entry::Closure as usize].clone().constants_first();
        drop(source);
        Ok(Self { motion, closure, turn, joints, compiled })
    }

    /// What sets a parameter beside its value, the how-many-th that is set so. Each goes by another part of itself: two of one value
    /// would stay equal. Nothing if it is a formula, or zero, beside which a mechanism is another one.
    pub(super) fn beside(parameter: &Parameter, place: usize) -> Option<(String, String)> {
        let (number, unit) = parameter.written.as_ref().filter(|(number, _)| *number != 0.0)?;
        Some(set(&parameter.name, number * (1.0 + BESIDE * (place + 1) as f64), unit))
    }

    /// Takes over the form of the equations of another, whose numbers are as good as its own.
    pub(super) fn take_form(&mut self, other: Self) {
        (self.motion, self.closure) = (other.motion, other.closure);
    }

    /// By how much longer than by physics the mean path of every wearing joint takes, beta over alpha.
    pub(super) fn slower(&self) -> Vec<f64> {
        let wears = self.compiled.description().contacts.iter().filter_map(|contact| contact.wear.as_ref());
        wears.map(|wear| wear.scatter.map_or(1.0, |rates| rates.beta / rates.alpha)).collect()
    }

    /// Whether a journal wears beside its bush.
    pub(super) fn has_worn_journals(&self) -> bool {
        self.joints.iter().any(|joint| joint.journal_bins.is_some())
    }

    /// Both sides of a parameter.
    pub(super) fn sides(
        &self,
        source: &SourceFile,
        options: &Options,
        parameter: &Parameter,
    ) -> Result<Sides, SensitivityError> {
        let name = || parameter.name.clone();
        let Some((number, unit)) = &parameter.written else {
            return Err(SensitivityError::Formula { parameter: name() });
        };
        let own = if *number == 0.0 { STEP } else { STEP * number.abs() };
        let at = |number: f64| {
            let mut options = options.clone();
            options.overrides.push(set(&parameter.name, number, unit));
            let known = |error| SensitivityError::At { parameter: name(), error: Box::new(error) };
            let variant = Self::new(source, &options).map_err(known)?;
            let found = variant.compiled.mechanism.parameters.iter().find(|one| one.name == parameter.name);
            let value = found.map_or(f64::NAN, |one| one.value);
            let tapes = [(&variant.motion, &self.motion), (&variant.closure, &self.closure)];
            if !tapes.iter().all(|(one, other)| one.has_form_of(other)) {
                return Err(SensitivityError::OtherForm { parameter: name() });
            }
            Ok((variant, value))
        };
        let ((below, from), (above, to)) = (at(number - own)?, at(number + own)?);
        let of = Varying { name: name(), value: parameter.value, unit: parameter.dimension.si_unit() };
        Ok(Sides { of, written: (*number, unit.clone()), step: 0.5 * (to - from), sides: [below, above] })
    }
}

/// Refuses what a turn is not differentiated with.
fn check(description: &Description) -> Result<(), SensitivityError> {
    if !description.missions.is_empty() {
        return Err(SensitivityError::Mission);
    }
    if description.acts_at_samples() {
        return Err(SensitivityError::Samples);
    }
    let profile =
        description.contacts.iter().find(|contact| contact.wear.is_some_and(|wear| wear.keeps_profile()));
    if let Some(contact) = profile {
        return Err(SensitivityError::Profile { joint: contact.joint.to_string() });
    }
    Ok(())
}

/// The rates of a state with the laws of contact inside, stiffness by the clearance included.
fn motion(tapes: &[Tape], plan: &StepPlan) -> Tape {
    let recorder = Recorder::default();
    let state = plan.sizes().input(Entry::Contacts);
    let count = state + MEMORY * plan.joints().len();
    let inputs: Vec<Number<'_>> = (0..count as u32).map(|index| recorder.input(index)).collect();
    let (state, memory) = inputs.split_at(state);
    let evaluate: Evaluate<'_, Number<'_>> = &|entry, input| recorder.run(&tapes[entry as usize], input);
    let moved = evaluate(Entry::Contacts, state);
    let each = plan.joints().iter().zip(moved.chunks_exact(CONTACT_MOTION)).zip(memory.chunks_exact(MEMORY));
    let memory = each.flat_map(|((joint, moved), memory)| {
        let stiffness = joint.stiffness(moved[CONTACT_MOTION - 1] + memory[0]);
        [memory[0], stiffness, memory[1], memory[2]]
    });
    let question = [state.to_vec(), memory.collect()].concat();
    let answer = plan.derivative(evaluate, &question);
    let sizes = plan.sizes();
    let (equations, laws) = answer.split_at(sizes.output(Entry::Derivative));
    let (totals, contacts) = laws.split_at(TOTALS * sizes.contacts);
    let each = totals.chunks_exact(TOTALS).zip(contacts.chunks_exact(StepPlan::CONTACT_ANSWER));
    let [depth, rate] = StepPlan::PENETRATION;
    let laws = each.flat_map(|(totals, contact)| [totals[0], totals[1], contact[depth], contact[rate]]);
    let rates = equations[..sizes.coordinates + sizes.speeds].iter().copied();
    let outputs: Vec<Operand> = rates.chain(laws).map(Recorder::operand).collect();
    recorder.finish("motion", count, &outputs)
}
