//! Random mechanisms as TOML text, the same for the same seed.
//!
//! Points and axes are drawn freely in one common reference pose, so every loop is closed there: nothing
//! has to be solved to make a mechanism that can be assembled. `plan` decides what connects to what,
//! `write` turns the plan into text, one function per table.

mod dice;
mod plan;
mod recipe;
mod write;

pub use dice::Dice;
pub use recipe::Recipe;

impl Recipe {
    /// The mechanism as text.
    pub fn toml(&self) -> String {
        let mut dice = Dice::new(self.seed);
        let plan = plan::Plan::new(self, &mut dice);
        write::mechanism(self, &plan, &mut dice)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kind::Kind;

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
