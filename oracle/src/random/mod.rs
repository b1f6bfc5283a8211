//! Random mechanisms as TOML text, the same for the same seed.
//!
//! Points and axes are drawn freely in one common reference pose, so every loop is closed there: nothing
//! has to be solved to make a mechanism that can be assembled. `plan` decides what connects to what,
//! `write` turns the plan into text, one function per table.

mod dice;
mod plan;
mod write;

pub use dice::Dice;
pub use plan::Kind;

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
    #[must_use]
    pub fn tree(seed: u64) -> Self {
        let mut dice = Dice::new(seed ^ 0x7ee);
        let (bodies, drives) = (3 + dice.below(5), dice.below(3));
        Self { seed, bodies, loops: 0, kinds: Kind::ALL.to_vec(), drives, forces: true }
    }

    /// As [`Recipe::tree`], with one or two closed loops and no free joint.
    #[must_use]
    pub fn closed(seed: u64) -> Self {
        let mut dice = Dice::new(seed ^ 0x100b);
        let (bodies, loops, drives) = (3 + dice.below(5), 1 + dice.below(2), dice.below(2));
        let kinds = Kind::ALL.iter().copied().filter(|kind| *kind != Kind::Free).collect();
        Self { seed, bodies, loops, kinds, drives, forces: true }
    }

    /// Two bodies in a row, all joints of one kind; of fixed ones, one is made a revolute.
    #[must_use]
    pub fn alone(kind: Kind, seed: u64) -> Self {
        Self { seed, bodies: 2, loops: 0, kinds: vec![kind], drives: 0, forces: true }
    }

    /// The mechanism as text.
    #[must_use]
    pub fn toml(&self) -> String {
        let mut dice = Dice::new(self.seed);
        let plan = plan::Plan::new(self, &mut dice);
        write::mechanism(self, &plan, &mut dice)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_seed_gives_the_same_text_and_another_seed_another() {
        assert_eq!(Recipe::closed(5).toml(), Recipe::closed(5).toml());
        assert_ne!(Recipe::closed(5).toml(), Recipe::closed(6).toml());
    }

    #[test]
    fn closed_recipes_do_close_loops_and_all_kinds_come_up() {
        let texts: Vec<String> = (0..600).map(|seed| Recipe::closed(seed).toml()).collect();
        let with_loops = texts.iter().filter(|text| text.contains("close0 = ")).count();
        assert!(with_loops >= 500, "{with_loops}");
        let trees: Vec<String> = (0..60).map(|seed| Recipe::tree(seed).toml()).collect();
        for kind in Kind::ALL {
            let key = format!("{{ {} = [", kind.key());
            assert!(trees.iter().any(|text| text.contains(&key)), "{kind:?}");
        }
    }
}
