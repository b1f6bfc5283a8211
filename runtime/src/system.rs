//! The only contract with generated code: entry points from flat inputs to flat outputs.
//! In: parameters, time, coordinates, speeds. Out: what each [`Entry`] lists. Where parameters are named here, the
//! mechanism's inputs stand behind them.
//! Never knows how the numbers are made: compiled code and the interpreter implement the same trait.
//!
//! A *free* coordinate or speed is one that no driver prescribes. States hold the free ones only.

use crate::scalar::Scalar;

/// Which question is asked. Inputs and outputs are concatenated in the order listed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Entry {
    /// In: parameters, t. Out: for every driver position, speed, acceleration (3 each, driver by driver).
    Prescribed,
    /// In: parameters, t. Out: guess of the free coordinates `q`, wish for the free speeds `v`.
    Start,
    /// In: parameters, t, q, v, contact wrenches ([`CONTACT_WRENCH`] each). Out: accelerations `v̇` (free speeds),
    /// multipliers, drive forces, loop pivots (one per kept constraint row, positive; small next to their usual size near a singular position).
    ForwardDynamics,
    /// In: as [`Entry::ForwardDynamics`]. Out: of its answer accelerations and pivots alone.
    Accelerations,
    /// In: parameters, t, q, v, drive forces. Out: `q̇`, power supplied [W], power dissipated [W].
    Rates,
    /// In: parameters, t, q, v. Out: position residuals of every row (kept and dropped alike, row order
    /// of the description), velocity residuals of the kept rows, Jacobian of the kept rows by the free
    /// speeds (row major).
    Closure,
    /// In: parameters, t, q, v. Out: kinetic energy [J], potential energy [J].
    Energy,
    /// In: parameters, t, q, v, `v̇`, multipliers of every row (kept and dropped alike; zero for dropped rows
    /// except where kept rows lose rank), drive forces, contact wrenches. Out: one value per output channel.
    Observe,
    /// In: parameters, t, ALL coordinates, ALL speeds (driven ones too, tree order), contact wrenches.
    /// Out: upper triangle of M (row by row), h (with gravity, springs and damping on the left side:
    /// `M v̇ + h = Q_drive + Phi_qᵀ lambda`), and of every row, kept and dropped alike: Phi, Phi_q (row
    /// major), gamma. Dropped rows take over where the kept ones happen to lose rank.
    EquationsOfMotion,
    /// In: parameters, t, q, v. Out: [`CONTACT_MOTION`] values for every joint with clearance, [CS (7)-(12)]; then
    /// values for [`Entry::Derivative`], as many as [`Sizes::held`] says.
    Contacts,
    /// In: as [`Entry::ForwardDynamics`], then the answer of [`Entry::Contacts`] at the same parameters, t, q, v.
    /// Out: `q̇`, the answer of [`Entry::ForwardDynamics`], power supplied [W], power dissipated [W].
    Derivative,
}

/// Values per joint with clearance in the output of [`Entry::Contacts`], in the frame of the bearing (the joint's
/// parent; for a revolute joint e_z is the axis): offset of the journal's centre from the bearing's (3) [m], its
/// rate seen from the bearing (3) [m/s], angular velocity of the journal relative to the bearing (3) [rad/s],
/// clearance [m]. A journal in a revolute joint does not slide along the axis: where it wears, the third component of the
/// offset is the angle of the joint [rad], and where its wear coefficient varies, parameters and inputs that it depends on are in
/// the third component of the rate and the first two of the angular velocity. A rod that is loose in its bush along its length has a row for each
/// end, of the rod's centre there, in the frame of the bush; its rate has the speed along the axis as third component.
pub const CONTACT_MOTION: usize = 10;

/// Values per joint with clearance that contact laws hand back: force on the journal (3) [N] and moment about the
/// journal's centre (3) [N m], in the frame of the bearing. The opposite acts on the bearing at the same place. A
/// revolute joint takes force x, y and moment z; the other components belong to its constraints and are ignored. A rod loose in its bush takes all at
/// each end.
pub const CONTACT_WRENCH: usize = 6;

/// Numbers that are integrated with a state for every mechanism: work supplied and work dissipated [J].
pub const WORKS: usize = 2;

/// Numbers that are integrated with a state for every joint with clearance: wear integral [J], depth by the contact area [m],
/// integral of the normal force [N s], energy lost in damping and friction [J].
pub const TOTALS: usize = 4;

impl Entry {
    /// Every entry, in the order in which generated code lists them.
    pub const ALL: [Self; 11] = [
        Self::Prescribed,
        Self::Start,
        Self::ForwardDynamics,
        Self::Accelerations,
        Self::Rates,
        Self::Closure,
        Self::Energy,
        Self::Observe,
        Self::EquationsOfMotion,
        Self::Contacts,
        Self::Derivative,
    ];

    /// Name in snake case, as functions of generated code are called.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Prescribed => "prescribed",
            Self::Start => "start",
            Self::ForwardDynamics => "forward_dynamics",
            Self::Accelerations => "accelerations",
            Self::Rates => "rates",
            Self::Closure => "closure",
            Self::Energy => "energy",
            Self::Observe => "observe",
            Self::EquationsOfMotion => "equations_of_motion",
            Self::Contacts => "contacts",
            Self::Derivative => "derivative",
        }
    }
}

/// Counts that fix the layout of every entry's input and output.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sizes {
    /// Tunable parameters and inputs.
    pub parameters: usize,
    /// Free coordinates `q` (4 for a quaternion).
    pub coordinates: usize,
    /// Free speeds `v`.
    pub speeds: usize,
    /// All coordinates, driven ones included.
    pub all_coordinates: usize,
    /// All speeds, driven ones included.
    pub all_speeds: usize,
    /// Constraint rows kept (independent).
    pub rows: usize,
    /// Constraint rows before redundant ones were dropped.
    pub all_rows: usize,
    /// Drivers.
    pub drivers: usize,
    /// Joints with clearance.
    pub contacts: usize,
    /// Output channels of [`Entry::Observe`].
    pub channels: usize,
    /// Values that [`Entry::Contacts`] hands to [`Entry::Derivative`] besides the motion of journals.
    pub held: usize,
    /// Length of the scratch slice that [`System::evaluate`] wants.
    pub workspace: usize,
}

impl Sizes {
    /// With what [`Entry::Contacts`] hands on, by the length of its output.
    pub const fn with_held(self, contacts: usize) -> Self {
        let without = Self { held: 0, ..self };
        Self { held: contacts.saturating_sub(without.output(Entry::Contacts)), ..without }
    }

    /// Length of the input slice of `entry`.
    pub const fn input(&self, entry: Entry) -> usize {
        let base = self.parameters + 1;
        let state = base + self.coordinates + self.speeds;
        let wrenches = CONTACT_WRENCH * self.contacts;
        match entry {
            Entry::Prescribed | Entry::Start => base,
            Entry::Closure | Entry::Energy | Entry::Contacts => state,
            Entry::ForwardDynamics | Entry::Accelerations => state + wrenches,
            Entry::Derivative => state + wrenches + self.output(Entry::Contacts),
            Entry::Rates => state + self.drivers,
            Entry::Observe => state + self.speeds + self.all_rows + self.drivers + wrenches,
            Entry::EquationsOfMotion => base + self.all_coordinates + self.all_speeds + wrenches,
        }
    }

    /// Length of a flat state: coordinates, speeds, works, totals of every joint with clearance.
    pub const fn flat_state(&self) -> usize {
        self.coordinates + self.speeds + WORKS + TOTALS * self.contacts
    }

    /// Length of the output slice of `entry`.
    pub const fn output(&self, entry: Entry) -> usize {
        let n = self.all_speeds;
        match entry {
            Entry::Prescribed => 3 * self.drivers,
            Entry::Start => self.coordinates + self.speeds,
            Entry::ForwardDynamics => self.speeds + self.rows + self.drivers + self.rows,
            Entry::Accelerations => self.speeds + self.rows,
            Entry::Rates => self.coordinates + 2,
            Entry::Closure => self.all_rows + self.rows + self.rows * self.speeds,
            Entry::Energy => 2,
            Entry::Observe => self.channels,
            Entry::EquationsOfMotion => n * (n + 1) / 2 + n + self.all_rows * (n + 2),
            Entry::Contacts => CONTACT_MOTION * self.contacts + self.held,
            Entry::Derivative => self.coordinates + self.output(Entry::ForwardDynamics) + 2,
        }
    }
}

/// Equations of one mechanism, evaluated on scalars of type `T`.
///
/// ```
/// use linkwear_runtime::{Dual, Entry, System};
///
/// mod fall {
///     // Generated code: `linkwear_runtime::include_mechanism!("fall")`. This one was written by hand.
///     include!(concat!(env!("CARGO_MANIFEST_DIR"), "/src/fall.rs.txt"));
/// }
///
/// // Acceleration of a point at 3 m that moves at 2 m/s, and its derivative by g.
/// let mechanism = fall::Mechanism::default();
/// let input = [Dual::new(9.81, 1.0), Dual::new(0.0, 0.0), Dual::new(3.0, 0.0), Dual::new(2.0, 0.0)];
/// let mut output = [Dual::new(0.0, 0.0); fall::SIZES.output(Entry::Accelerations)];
/// mechanism.evaluate(Entry::Accelerations, &input, &mut output, &mut []);
/// assert_eq!(output[0], Dual::new(-9.81, -1.0));
/// ```
pub trait System<T: Scalar> {
    /// The layout of inputs and outputs.
    fn sizes(&self) -> Sizes;

    /// Evaluates `entry`. Does not branch on `input`, and does not allocate, but where code for an entry is made when it is first
    /// asked for.
    ///
    /// # Panics
    /// If a slice is shorter than [`Sizes`] says.
    fn evaluate(&self, entry: Entry, input: &[T], output: &mut [T], workspace: &mut [T]);

    /// What answers at several states at once, if that takes less time than one after the other.
    fn side_by_side(&self) -> Option<&dyn SideBySide<T>> {
        None
    }

    /// What answers [`Entry::Derivative`] with the laws of contact inside, if there is such code.
    fn laws_inside(&self) -> Option<&dyn WithLaws<T>> {
        None
    }
}

/// From a state to its derivative in one call, the laws of contact in the middle: see `StepPlan::derivative`, in whose bits it
/// answers.
pub trait WithLaws<T: Scalar> {
    /// What its laws are, as `StepPlan::laws` has it: constants of laws are part of the code, and a description may have others.
    fn laws(&self) -> &str;

    /// Length of the scratch slice that [`Self::derivative`] wants.
    fn workspace(&self) -> usize;

    /// Evaluates the derivative. Does not allocate.
    ///
    /// # Panics
    /// If a slice is shorter than the plan says, or the scratch slice than [`Self::workspace`].
    fn derivative(&self, question: &[T], answer: &mut [T], workspace: &mut [T]);

    /// Whole steps, if there is code for them. Code may be written when it is asked for first: who takes a step or two does without.
    fn classical_step(&self, sum: StageSum) -> Option<&dyn ClassicalStep<T>> {
        let _ = sum;
        None
    }
}

/// The order in which the slopes of a step's four stages are summed, on which its last digits depend.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StageSum {
    /// Those at both ends first, as [`crate::integrate::Rk4`] does.
    EndsFirst,
    /// One stage after the other, as [`crate::integrate::Rk43`] does.
    InTurn,
}

/// A step of the classical Runge-Kutta method that is asked for.
#[derive(Clone, Copy, Debug)]
pub struct StepOf<'s> {
    /// How its slopes are summed.
    pub sum: StageSum,
    /// Times in its middle and at its end [s].
    pub times: [f64; 2],
    /// Its length [s].
    pub length: f64,
    /// The flat state where it begins.
    pub y: &'s [f64],
    /// Its slope there.
    pub slope: &'s [f64],
}

/// A step of the classical Runge-Kutta method in one call, the laws of contact inside: see `StepPlan::classical_step`, in whose bits it
/// answers.
pub trait ClassicalStep<T: Scalar> {
    /// Length of the scratch slice that [`Self::evaluate`] wants.
    fn workspace(&self) -> usize;

    /// Evaluates the step. Does not allocate.
    ///
    /// # Panics
    /// If a slice is shorter than the plan says, or the scratch slice than [`Self::workspace`].
    fn evaluate(&self, question: &[T], answer: &mut [T], workspace: &mut [T]);
}

/// States that [`SideBySide`] answers at once.
pub const STATES: usize = 4;

/// Answers entries at several states at once, each with the bits that it has alone. Every value is that of all states.
pub trait SideBySide<T: Scalar> {
    /// Whether it answers this entry: [`Entry::Observe`] always.
    fn answers(&self, entry: Entry) -> bool;

    /// Length of the scratch slice that [`Self::evaluate`] wants.
    fn workspace(&self) -> usize;

    /// Evaluates an entry that it answers. Does not allocate.
    ///
    /// # Panics
    /// If it does not answer this entry, a slice is shorter than [`Sizes`] says, or the scratch slice than [`Self::workspace`].
    fn evaluate(
        &self,
        entry: Entry,
        input: &[[T; STATES]],
        output: &mut [[T; STATES]],
        workspace: &mut [[T; STATES]],
    );
}
