//! What is computed in a step of one mechanism, over any scalar: machine code is written by running it on numbers that write down what is
//! done with them. In: a description. Out: [`StepPlan`], whose parts stand beside this file. Never knows machine code.

use super::places::Places;
use crate::clearance_joint::{Clearance, Clearances};
use crate::description::Description;
use crate::error::SetupError;
use crate::flat_laws::{CONTACT_ANSWER, PENETRATION, in_words};
use crate::layout::Layout;
use crate::scalar::Scalar;
use crate::system::{Entry, Sizes};

/// Answers an entry, as [`crate::System::evaluate`] does.
pub type Evaluate<'e, T> = &'e dyn Fn(Entry, &[T]) -> Vec<T>;

/// What has to be known of a mechanism for its steps.
#[derive(Clone, Debug)]
pub struct StepPlan {
    pub(super) sizes: Sizes,
    pub(super) joints: Vec<Clearance>,
    pub(super) layout: Layout,
    /// Of every kept row, its row among all.
    pub(super) kept: Vec<usize>,
    /// Of every row, whether it is an angle; of every free speed, whether it turns.
    pub(super) angular: Vec<bool>,
    pub(super) turning: Vec<bool>,
    pub(super) places: Places,
}

impl StepPlan {
    /// Numbers of a contact in the answer of [`Self::derivative`].
    pub const CONTACT_ANSWER: usize = CONTACT_ANSWER;
    /// Places of its penetration and of the rate of that among them.
    pub const PENETRATION: [usize; 2] = PENETRATION;

    /// Of a mechanism with these counts.
    ///
    /// # Errors
    /// [`SetupError::Contact`] if a constant of a law is out of range.
    pub fn new(description: &Description, sizes: Sizes) -> Result<Self, SetupError> {
        Ok(Self {
            sizes,
            joints: Clearances::of(description)?.joints().to_vec(),
            layout: Layout::new(&description.motions),
            kept: description.kept_rows(sizes.rows),
            angular: description.rows.iter().map(|row| row.angular).collect(),
            turning: description.turning_speeds(),
            places: Places::new(&sizes),
        })
    }

    /// The counts of the mechanism.
    pub fn sizes(&self) -> Sizes {
        self.sizes
    }

    /// The joints with clearance.
    pub fn joints(&self) -> &[Clearance] {
        &self.joints
    }

    /// The laws of these joints, in words that are equal for equal laws alone.
    pub fn laws(&self) -> String {
        in_words(&self.joints)
    }

    /// Length of the question of [`Self::step`].
    pub fn step_question(&self) -> usize {
        self.places.question()
    }

    /// Length of the question of [`Self::conclude`]: that of a step and where it ends.
    pub fn conclude_question(&self) -> usize {
        self.places.conclusion.start()
    }

    /// Length of all numbers of a step.
    pub fn arena(&self) -> usize {
        self.places.conclusion.all
    }

    /// Question of an entry of coordinates and speeds.
    pub(super) fn ask<T: Scalar>(&self, arena: &[T], t: T, state: &[T]) -> Vec<T> {
        let state = &state[..self.sizes.coordinates + self.sizes.speeds];
        [&arena[self.places.parameters.clone()], &[t], state].concat()
    }
}

/// `nothing`, which is zero, unless a value is infinite or none. Values whose sum is infinite count as such.
pub(super) fn none_of<T: Scalar>(nothing: T, values: &[T]) -> T {
    let sum = values.iter().copied().reduce(|sum, value| sum + value);
    sum.map_or(nothing, |sum| nothing + T::constant(0.0) * sum)
}
