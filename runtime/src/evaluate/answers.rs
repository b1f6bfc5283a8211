//! What an evaluator answers, as slices of its storage. Never knows how it was evaluated.

/// Answer of [`crate::Entry::ForwardDynamics`].
#[derive(Clone, Copy, Debug)]
pub struct Forward<'a> {
    /// Accelerations of the free speeds.
    pub accelerations: &'a [f64],
    /// Multipliers of the kept rows.
    pub multipliers: &'a [f64],
    /// Drive forces.
    pub drives: &'a [f64],
    /// Loop pivots, one per kept row.
    pub pivots: &'a [f64],
}

/// Answer of [`crate::Entry::Accelerations`].
#[derive(Clone, Copy, Debug)]
pub struct Accelerations<'a> {
    /// Accelerations of the free speeds.
    pub values: &'a [f64],
    /// Loop pivots, one per kept row.
    pub pivots: &'a [f64],
}

impl<'a> Accelerations<'a> {
    pub(super) fn of(output: &'a [f64], speeds: usize) -> Self {
        let (values, pivots) = output.split_at(speeds);
        Self { values, pivots }
    }
}

/// Answer of [`crate::Entry::Closure`].
#[derive(Clone, Copy, Debug)]
pub struct Closure<'a> {
    /// Position residuals of all rows [m, rad].
    pub positions: &'a [f64],
    /// Velocity residuals of the kept rows [m/s, rad/s].
    pub speeds: &'a [f64],
    /// Jacobian of the kept rows by the free speeds, row major.
    pub jacobian: &'a [f64],
}

/// Answer of [`crate::Entry::Rates`].
#[derive(Clone, Copy, Debug)]
pub struct Rates<'a> {
    /// Derivatives of the free coordinates.
    pub coordinates: &'a [f64],
    /// Power put in by drivers and prescribed forces [W].
    pub supplied: f64,
    /// Power taken out by dampers and friction [W].
    pub dissipated: f64,
}

/// Answer of [`crate::Entry::EquationsOfMotion`], over all speeds.
#[derive(Clone, Copy, Debug)]
pub struct Equations<'a> {
    /// Upper triangle of the mass matrix, row by row.
    pub mass: &'a [f64],
    /// Velocity terms, gravity, springs and damping, on the left side.
    pub bias: &'a [f64],
    /// Position residuals of all rows.
    pub positions: &'a [f64],
    /// Jacobian of all rows, row major.
    pub jacobian: &'a [f64],
    /// Right side of the acceleration constraints, of all rows.
    pub gamma: &'a [f64],
}

impl Equations<'_> {
    /// Writes the forces of inertia `M a`, for the accelerations `a` of all speeds.
    pub fn inertia(&self, accelerations: &[f64], forces: &mut [f64]) {
        forces.fill(0.0);
        let mut rows = self.mass;
        for i in 0..forces.len() {
            // Of slices cut to one length compilers make loops without checks.
            let forces = &mut forces[i..];
            let n = forces.len();
            let (row, below) = rows.split_at(n);
            let accelerations = &accelerations[i..][..n];
            rows = below;
            let (acceleration, mut force) = (accelerations[0], row[0] * accelerations[0]);
            for j in 1..n {
                force += row[j] * accelerations[j];
                forces[j] += row[j] * acceleration;
            }
            forces[0] += force;
        }
    }

    /// Whether the mass matrix is left out, as it is of long mechanisms: zeros stand in its place.
    pub fn is_without_masses(&self) -> bool {
        !self.mass.is_empty() && self.mass.iter().all(|entry| *entry == 0.0)
    }

    /// Writes the full mass matrix, row major, `n` x `n`.
    pub fn unpack_mass(&self, n: usize, full: &mut [f64]) {
        let mut packed = self.mass.iter();
        for i in 0..n {
            for (j, value) in (i..n).zip(&mut packed) {
                full[i * n + j] = *value;
                full[j * n + i] = *value;
            }
        }
    }
}

/// How far loops are open, over all rows, dropped ones too.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LoopError {
    /// Largest residual of a row in metres.
    pub metres: f64,
    /// Largest residual of a row in radians.
    pub radians: f64,
    /// The row with the largest number.
    pub worst: usize,
}
