//! Plans: when to replace a part, when to look at it, how many spares to keep, what a look is worth.
//! In: a law of life, or of wear; costs in any one currency. Out: the cheapest plan in the long run, and what others cost.
//! Never knows how laws were estimated, files.
//!
//! In the long run a cost per unit of time is the expected cost of a cycle, from new part to new part, over its expected
//! length (the theorem of renewal and reward).

mod age;
mod bands;
mod condition;
mod condition_levels;
mod condition_search;
mod costs;
mod error;
mod hidden;
mod mean_use;
mod search;
mod spares;
mod worth;

pub use age::{AgePlan, PlannedLife, age_cost_rate, best_age};
pub use bands::{AgeBands, Course, Ends, LookBands, age_bands, age_course, look_bands};
pub use condition::{ConditionCost, Monitored};
pub use condition_search::{ConditionPlan, best_inspection};
pub use costs::{Costs, Looks};
pub use error::PlanError;
pub use hidden::{HiddenPlan, best_hidden, hidden_cost};
pub use spares::{FLEET, Spares, Standstill, spares};
pub use worth::{InUse, Worth, worth_of_a_look};

#[cfg(test)]
mod hidden_tests;
#[cfg(test)]
mod looks_tests;
#[cfg(test)]
mod spares_tests;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod worth_tests;
