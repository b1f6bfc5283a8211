//! An entry point at many states at once. In: a compiled mechanism, numbers by quantity. Out: the answers, the same bits as one state
//! after the other; derivatives by dual numbers. Never knows what states are for.

use linkwear_codegen::Compiled;
use linkwear_codegen::tape::Interpreted;
use linkwear_native::{Columns, Native};
use linkwear_runtime::{CONTACT_MOTION, CONTACT_WRENCH, Description, Dual, Entry, Sizes, System};
use thiserror::Error;

/// Numbers that do not fit an entry.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum BatchError {
    /// There are too few or too many quantities.
    #[error("{entry} takes {expected} quantities, and {found} are given")]
    Quantities {
        /// The entry.
        entry: &'static str,
        /// How many it takes.
        expected: usize,
        /// How many there are.
        found: usize,
    },
    /// A quantity has neither one value nor one for each state.
    #[error("quantity {quantity} has {found} values for {states} states")]
    States {
        /// Its place, from 0.
        quantity: usize,
        /// States asked for.
        states: usize,
        /// Values given.
        found: usize,
    },
    /// The room for the answers has another size.
    #[error("the answers are {expected} numbers, and there is room for {found}")]
    Room {
        /// Numbers of all answers.
        expected: usize,
        /// Numbers there is room for.
        found: usize,
    },
    /// Equations of motion of a mechanism that is so long that its mass matrix is left out.
    #[error(
        "the mass matrix is left out of the equations of motion of mechanisms with so many speeds ({speeds})"
    )]
    MassLeftOut {
        /// How many it has.
        speeds: usize,
    },
}

/// A part of the input or output of an entry: what it is called, and the names of its quantities.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Quantities {
    /// `parameters`, `t`, `q`, `v`, ..
    pub group: &'static str,
    /// A name for each.
    pub names: Vec<String>,
}

/// The entry points of a mechanism, for many states.
#[derive(Clone, Debug)]
pub struct Batch {
    way: Way,
    interpreter: Interpreted,
    sizes: Sizes,
    description: Description,
}

/// States that are evaluated together.
#[derive(Clone, Debug)]
enum Way {
    Eight(Columns<8>),
    Four(Columns<4>),
    Alone(Box<Native>),
    Interpreted,
}

impl Batch {
    /// On as many lanes as this processor has; by the interpreter where it has no machine code.
    pub fn new(mechanism: &Compiled) -> Self {
        let (tapes, sizes) = (mechanism.tapes(), mechanism.sizes());
        let way = Columns::new(tapes, sizes).map(Way::Eight);
        let way = way.or_else(|_| Columns::new(tapes, sizes).map(Way::Four));
        let way = way
            .or_else(|_| Native::new(tapes, sizes).map(|native| Way::Alone(Box::new(native))))
            .unwrap_or(Way::Interpreted);
        Self {
            way,
            interpreter: mechanism.interpreter(),
            sizes,
            description: mechanism.description().clone(),
        }
    }

    /// States side by side.
    pub fn lanes(&self) -> usize {
        match self.way {
            Way::Eight(_) => 8,
            Way::Four(_) => 4,
            Way::Alone(_) | Way::Interpreted => 1,
        }
    }

    /// Counts that fix what entries take and give.
    pub fn sizes(&self) -> Sizes {
        self.sizes
    }

    /// Names, units, rows, columns of the mechanism.
    pub fn description(&self) -> &Description {
        &self.description
    }

    /// What an entry takes, in its order.
    pub fn inputs(&self, entry: Entry) -> Vec<Quantities> {
        let (known, sizes) = (&self.description, self.sizes);
        let named = |group, names: Vec<String>| Quantities { group, names };
        let wrenches = || named("wrenches", self.of_contacts(&WRENCH));
        let mut all = vec![
            named("parameters", known.parameters.iter().map(|one| one.name.to_string()).collect()),
            named("t", vec!["t".to_owned()]),
        ];
        let variables = [
            named("q", known.coordinates.iter().map(|one| one.name.to_string()).collect()),
            named("v", known.speeds.iter().map(|one| one.name.to_string()).collect()),
        ];
        match entry {
            Entry::Prescribed | Entry::Start => {}
            Entry::EquationsOfMotion => all.extend([
                named("all_q", numbered("q", sizes.all_coordinates)),
                named("all_v", numbered("v", sizes.all_speeds)),
                wrenches(),
            ]),
            _ => all.extend(variables),
        }
        match entry {
            Entry::ForwardDynamics | Entry::Accelerations => all.push(wrenches()),
            Entry::Rates => all.push(named("drive_forces", self.drivers())),
            Entry::Observe => all.extend([
                named("accelerations", numbered("a", sizes.speeds)),
                named("multipliers", numbered("lambda", sizes.all_rows)),
                named("drive_forces", self.drivers()),
                wrenches(),
            ]),
            Entry::Derivative => {
                all.extend([wrenches(), named("contact_motion", self.of_contacts(&MOTION))]);
                all.push(named("held", numbered("held", sizes.held)));
            }
            _ => {}
        }
        all
    }

    /// What an entry gives, in its order.
    pub fn outputs(&self, entry: Entry) -> Vec<Quantities> {
        let (known, sizes) = (&self.description, self.sizes);
        let named = |group, names: Vec<String>| Quantities { group, names };
        let speeds = |suffix: &str| known.speeds.iter().map(|one| format!("{}{suffix}", one.name)).collect();
        let kept = || numbered("row", sizes.rows);
        let answer = || {
            vec![
                named("accelerations", speeds("'")),
                named("multipliers", numbered("lambda", sizes.rows)),
                named("drive_forces", self.drivers()),
                named("pivots", kept()),
            ]
        };
        let rates =
            || named("q_rates", known.coordinates.iter().map(|one| format!("{}'", one.name)).collect());
        let powers = || named("powers", ["supplied", "dissipated"].map(str::to_owned).to_vec());
        match entry {
            Entry::Prescribed => vec![named("prescribed", numbered("driver", 3 * sizes.drivers))],
            Entry::Start => vec![
                named("q", known.coordinates.iter().map(|one| one.name.to_string()).collect()),
                named("v", known.speeds.iter().map(|one| one.name.to_string()).collect()),
            ],
            Entry::ForwardDynamics => answer(),
            Entry::Accelerations => vec![named("accelerations", speeds("'")), named("pivots", kept())],
            Entry::Rates => vec![rates(), powers()],
            Entry::Closure => vec![
                named("residuals", numbered("row", sizes.all_rows)),
                named("velocity_residuals", kept()),
                named("jacobian", numbered("J", sizes.rows * sizes.speeds)),
            ],
            Entry::Energy => vec![named("energy", ["kinetic", "potential"].map(str::to_owned).to_vec())],
            Entry::Observe => {
                vec![named(
                    "channels",
                    known.channels.iter().map(|one| format!("{} [{}]", one.name, one.unit)).collect(),
                )]
            }
            Entry::EquationsOfMotion => {
                let n = sizes.all_speeds;
                vec![
                    named("mass_triangle", numbered("M", n * (n + 1) / 2)),
                    named("bias_forces", numbered("h", n)),
                    named("constraints", numbered("C", sizes.all_rows * (n + 2))),
                ]
            }
            Entry::Contacts => {
                vec![
                    named("contact_motion", self.of_contacts(&MOTION)),
                    named("held", numbered("held", sizes.held)),
                ]
            }
            Entry::Derivative => {
                let mut all = vec![rates()];
                all.extend(answer());
                all.push(powers());
                all
            }
        }
    }

    fn drivers(&self) -> Vec<String> {
        self.description.drivers.iter().map(|one| one.joint.to_string()).collect()
    }

    fn of_contacts(&self, quantities: &[&str]) -> Vec<String> {
        let contacts = self.description.contacts.iter();
        contacts.flat_map(|one| quantities.iter().map(move |name| format!("{}.{name}", one.joint))).collect()
    }

    /// Evaluates an entry at so many states. A quantity is one value for all of them or one for each. The answers lie one
    /// quantity after the other, each with the values of all states.
    ///
    /// # Errors
    /// [`BatchError`].
    pub fn evaluate(
        &self,
        entry: Entry,
        inputs: &[&[f64]],
        states: usize,
        outputs: &mut [f64],
    ) -> Result<(), BatchError> {
        let (expected, found) = (self.sizes.input(entry), inputs.len());
        if expected != found {
            return Err(BatchError::Quantities { entry: entry.name(), expected, found });
        }
        for (quantity, values) in inputs.iter().enumerate() {
            if values.len() != 1 && values.len() != states {
                return Err(BatchError::States { quantity, states, found: values.len() });
            }
        }
        let (expected, found) = (self.sizes.output(entry) * states, outputs.len());
        if expected != found {
            return Err(BatchError::Room { expected, found });
        }
        if states == 0 {
            return Ok(());
        }
        match &self.way {
            Way::Eight(columns) => columns.evaluate(entry, inputs, states, outputs),
            Way::Four(columns) => columns.evaluate(entry, inputs, states, outputs),
            Way::Alone(system) => alone(&**system, entry, inputs, (states, outputs)),
            Way::Interpreted => alone(self.interpreter.on_numbers(), entry, inputs, (states, outputs)),
        }
        self.has_masses(entry, outputs, states)
    }

    /// Whether the answers are whole: see [`BatchError::MassLeftOut`].
    fn has_masses(&self, entry: Entry, outputs: &[f64], states: usize) -> Result<(), BatchError> {
        let speeds = self.sizes.all_speeds;
        let mass = speeds * (speeds + 1) / 2 * states;
        let left_out =
            entry == Entry::EquationsOfMotion && mass > 0 && outputs[..mass].iter().all(|x| *x == 0.0);
        if left_out { Err(BatchError::MassLeftOut { speeds }) } else { Ok(()) }
    }

    /// Derivatives of all answers at one state by some of the quantities, by dual numbers: for each of these quantities all answers.
    ///
    /// # Errors
    /// [`BatchError::Quantities`].
    pub fn derivatives(
        &self,
        entry: Entry,
        input: &[f64],
        by: &[usize],
    ) -> Result<Vec<Vec<f64>>, BatchError> {
        let (expected, found) = (self.sizes.input(entry), input.len());
        if expected != found || by.iter().any(|at| *at >= found) {
            return Err(BatchError::Quantities { entry: entry.name(), expected, found });
        }
        let system = self.interpreter.on_duals();
        let sizes = system.sizes();
        let none = Dual::new(0.0, 0.0);
        let (mut output, mut workspace) = (vec![none; sizes.output(entry)], vec![none; sizes.workspace]);
        let mut duals: Vec<Dual<f64>> = input.iter().map(|value| Dual::new(*value, 0.0)).collect();
        let slopes = by.iter().map(|at| {
            duals[*at].derivative = 1.0;
            system.evaluate(entry, &duals, &mut output, &mut workspace);
            duals[*at].derivative = 0.0;
            output.iter().map(|dual| dual.derivative).collect()
        });
        Ok(slopes.collect())
    }
}

/// Components of a contact's motion, as [`CONTACT_MOTION`] has them.
const MOTION: [&str; CONTACT_MOTION] = ["x", "y", "z", "vx", "vy", "vz", "wx", "wy", "wz", "clearance"];
/// Components of a contact's wrench, as [`CONTACT_WRENCH`] has them.
const WRENCH: [&str; CONTACT_WRENCH] = ["Fx", "Fy", "Fz", "Mx", "My", "Mz"];

fn numbered(stem: &str, count: usize) -> Vec<String> {
    (1..=count).map(|number| format!("{stem}{number}")).collect()
}

fn alone(system: &dyn System<f64>, entry: Entry, inputs: &[&[f64]], (states, outputs): (usize, &mut [f64])) {
    let sizes = system.sizes();
    let mut input = vec![0.0; inputs.len()];
    let (mut output, mut workspace) = (vec![0.0; sizes.output(entry)], vec![0.0; sizes.workspace]);
    for state in 0..states {
        for (place, values) in input.iter_mut().zip(inputs) {
            *place = values[state.min(values.len() - 1)];
        }
        system.evaluate(entry, &input, &mut output, &mut workspace);
        for (answers, value) in outputs.chunks_exact_mut(states).zip(&output) {
            answers[state] = *value;
        }
    }
}
