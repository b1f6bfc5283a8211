//! The only contract with generated code: entry points from flat inputs to flat outputs.
//! In: parameters, time, coordinates, speeds. Out: what each [`Entry`] lists.
//! Never knows how the numbers are made: compiled code and the interpreter implement the same trait.
//!
//! A *free* coordinate or speed is one that no driver prescribes. States hold the free ones only.

use crate::Scalar;

/// Which question is asked. Inputs and outputs are concatenated in the order listed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Entry {
    /// In: parameters, t. Out: for every driver position, speed, acceleration (3 each, driver by driver).
    Prescribed,
    /// In: parameters, t. Out: guess of the free coordinates `q`, wish for the free speeds `v`.
    Start,
    /// In: parameters, t, q, v. Out: accelerations `v̇` (free speeds), multipliers, drive forces,
    /// loop pivots (one per kept constraint row, positive; small next to their usual size near a singular position).
    ForwardDynamics,
    /// In: parameters, t, q, v, drive forces. Out: `q̇`, power supplied [W], power dissipated [W].
    Rates,
    /// In: parameters, t, q, v. Out: position residuals of every row (kept and dropped alike, row order
    /// of the description), velocity residuals of the kept rows, Jacobian of the kept rows by the free
    /// speeds (row major).
    Closure,
    /// In: parameters, t, q, v. Out: kinetic energy [J], potential energy [J].
    Energy,
    /// In: parameters, t, q, v, `v̇`, multipliers of every row (kept and dropped alike; zero for dropped rows
    /// except where kept rows lose rank), drive forces. Out: one value per output channel.
    Observe,
    /// In: parameters, t, ALL coordinates, ALL speeds (driven ones too, tree order).
    /// Out: upper triangle of M (row by row), h (with gravity, springs and damping on the left side:
    /// `M v̇ + h = Q_drive + Phi_qᵀ lambda`), and of every row, kept and dropped alike: Phi, Phi_q (row
    /// major), gamma. Dropped rows take over where the kept ones happen to lose rank.
    EquationsOfMotion,
}

impl Entry {
    /// Every entry, in the order in which generated code lists them.
    pub const ALL: [Self; 8] = [
        Self::Prescribed,
        Self::Start,
        Self::ForwardDynamics,
        Self::Rates,
        Self::Closure,
        Self::Energy,
        Self::Observe,
        Self::EquationsOfMotion,
    ];

    /// Name in snake case, as functions of generated code are called.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Prescribed => "prescribed",
            Self::Start => "start",
            Self::ForwardDynamics => "forward_dynamics",
            Self::Rates => "rates",
            Self::Closure => "closure",
            Self::Energy => "energy",
            Self::Observe => "observe",
            Self::EquationsOfMotion => "equations_of_motion",
        }
    }
}

/// Counts that fix the layout of every entry's input and output.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sizes {
    /// Tunable parameters.
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
    /// Output channels of [`Entry::Observe`].
    pub channels: usize,
    /// Length of the scratch slice that [`System::evaluate`] wants.
    pub workspace: usize,
}

impl Sizes {
    /// Length of the input slice of `entry`.
    #[must_use]
    pub const fn input(&self, entry: Entry) -> usize {
        let base = self.parameters + 1;
        let state = base + self.coordinates + self.speeds;
        match entry {
            Entry::Prescribed | Entry::Start => base,
            Entry::ForwardDynamics | Entry::Closure | Entry::Energy => state,
            Entry::Rates => state + self.drivers,
            Entry::Observe => state + self.speeds + self.all_rows + self.drivers,
            Entry::EquationsOfMotion => base + self.all_coordinates + self.all_speeds,
        }
    }

    /// Length of the output slice of `entry`.
    #[must_use]
    pub const fn output(&self, entry: Entry) -> usize {
        let n = self.all_speeds;
        match entry {
            Entry::Prescribed => 3 * self.drivers,
            Entry::Start => self.coordinates + self.speeds,
            Entry::ForwardDynamics => self.speeds + self.rows + self.drivers + self.rows,
            Entry::Rates => self.coordinates + 2,
            Entry::Closure => self.all_rows + self.rows + self.rows * self.speeds,
            Entry::Energy => 2,
            Entry::Observe => self.channels,
            Entry::EquationsOfMotion => n * (n + 1) / 2 + n + self.all_rows * (n + 2),
        }
    }
}

/// Equations of one mechanism, evaluated on scalars of type `T`.
pub trait System<T: Scalar> {
    /// The layout of inputs and outputs.
    fn sizes(&self) -> Sizes;

    /// Evaluates `entry`. Does not allocate and does not branch on `input`.
    ///
    /// # Panics
    /// If a slice is shorter than [`Sizes`] says.
    fn evaluate(&self, entry: Entry, input: &[T], output: &mut [T], workspace: &mut [T]);
}
