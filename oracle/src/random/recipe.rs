//! What a random mechanism is drawn from. Never knows how.

use super::dice::Dice;
use crate::kind::Kind;

/// What kind of mechanism to draw.
#[derive(Clone, Debug, PartialEq)]
pub struct Recipe {
    /// Same seed, same text.
    pub seed: u64,
    /// Moving bodies.
    pub bodies: usize,
    /// Closed loops, as far as there is room: loops share no joint.
    pub loops: usize,
    /// Joint kinds to draw from; joints of loops get more freedom where counting demands it.
    pub kinds: Vec<Kind>,
    /// Driven coordinates, as far as each loop keeps a freedom for them.
    pub drives: usize,
    /// Springs, dampers, actuators, point forces and torques.
    pub forces: bool,
}

impl Recipe {
    /// A tree of three to seven bodies with every joint kind, drives and forces.
    pub fn tree(seed: u64) -> Self {
        let mut dice = Dice::new(seed ^ 0x7ee);
        let (bodies, drives) = (3 + dice.below(5), dice.below(3));
        Self { seed, bodies, loops: 0, kinds: Kind::ALL.to_vec(), drives, forces: true }
    }

    /// As [`Recipe::tree`], with one or two closed loops and no joint that holds next to nothing.
    pub fn closed(seed: u64) -> Self {
        let mut dice = Dice::new(seed ^ 0x100b);
        let (bodies, loops, drives) = (3 + dice.below(5), 1 + dice.below(2), dice.below(2));
        let kinds =
            Kind::ALL.iter().copied().filter(|kind| !matches!(kind, Kind::Free | Kind::Inplane)).collect();
        Self { seed, bodies, loops, kinds, drives, forces: true }
    }

    /// Two bodies in a row, all joints of one kind; of fixed ones, one is made a revolute.
    pub fn alone(kind: Kind, seed: u64) -> Self {
        Self { seed, bodies: 2, loops: 0, kinds: vec![kind], drives: 0, forces: true }
    }
}
