//! The cost of replacements over their age, drawn. In: a plan. Out: SVG. Never knows where it is written.

use linkwear_gamma::Prediction;
use linkwear_gamma::life::Lifetime;
use linkwear_gamma::plan::{Costs, PlanError, age_course};

use super::{Plans, Source};
use crate::page::plan_picture;

/// Ages that are drawn.
const AGES: usize = 60;
/// Of those that are drawn, one of so many lives makes the band: every age costs an integral for each.
const OF_LIVES: usize = 2;

impl Plans {
    /// From an age at which one part of 10000 has failed to twice the best, or until most have failed.
    pub fn picture(&self, source: &Source, costs: &Costs) -> Result<String, PlanError> {
        source.with_life(&|life: &dyn Lifetime| {
            let most = life.quantile(0.98)?;
            let end = self.age.age.map_or(most, |age| (2.5 * age).min(most.max(age)));
            let start = life.quantile(1e-4)?.min(0.5 * end).max(0.1 * self.age.age.unwrap_or(end));
            let ages: Vec<f64> = (0..AGES)
                .map(|at| start + (end - start) * at as f64 / (AGES - 1) as f64)
                .chain(self.age.age)
                .collect();
            let ages = sorted(ages);
            let some = self.possible.one_of(OF_LIVES);
            let course = age_course(life, some.as_slice(), (costs, &ages), Prediction::LEVEL)?;
            let unit = if matches!(source, Source::Lives(..)) { "cycles" } else { "unit of the exposure" };
            Ok(plan_picture(&course, &self.age, self.open.map(|open| open.age), unit))
        })
    }
}

fn sorted(mut ages: Vec<f64>) -> Vec<f64> {
    ages.sort_by(f64::total_cmp);
    ages
}
