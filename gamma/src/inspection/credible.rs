//! What the parameters leave open after readings: weighted intervals over nodes or particles.
//! In: values with weights. Out: an interval. Never knows what is asked.

use crate::error::probability;
use crate::life::{Band, FirstPassage, LifeError, LifeMixture, Lifetime};

/// What a law answers, and the probability by it of what has been seen since.
pub type Seen = (f64, f64);

/// A law of life mixed from those of possible parameters.
pub trait Mixture: Lifetime {
    /// Each possible law with its weight; weights sum to 1.
    fn parts(&self) -> Vec<(f64, &FirstPassage)>;

    /// Equal-tailed interval of probability `level` of what `of` gives for the possible parameters, around `value`, the
    /// answer of the mixture. Beside it `of` gives the probability of what has been seen since, by which the law is weighed.
    ///
    /// # Errors
    /// [`LifeError::Probability`] for the level; those of `of`.
    fn credible(
        &self,
        value: f64,
        level: f64,
        of: &dyn Fn(&FirstPassage) -> Result<Seen, LifeError>,
    ) -> Result<Band, LifeError> {
        let (mut values, mut lost) = (Vec::new(), 0.0);
        for (weight, life) in self.parts() {
            let (value, seen) = of(life)?;
            values.push((value, weight * seen));
            lost += weight * (1.0 - seen);
        }
        // Exactly 1 where nothing has been seen: ties stay as they are.
        let total = 1.0 - lost;
        values.sort_by(|a, b| a.0.total_cmp(&b.0));
        let tail = 0.5 - 0.5 * probability(level)?;
        Ok(Band {
            value,
            lower: weighted(&values, tail * total),
            upper: weighted(&values, (1.0 - tail) * total),
        })
    }
}

impl Mixture for LifeMixture {
    fn parts(&self) -> Vec<(f64, &FirstPassage)> {
        self.lives().collect()
    }
}

/// Parameters that are known.
impl Mixture for FirstPassage {
    fn parts(&self) -> Vec<(f64, &FirstPassage)> {
        vec![(1.0, self)]
    }
}

/// First value at which the weights reach `part` of them.
fn weighted(sorted: &[(f64, f64)], part: f64) -> f64 {
    let mut sum = 0.0;
    for (value, weight) in sorted {
        sum += weight;
        if sum >= part {
            return *value;
        }
    }
    sorted.last().map_or(f64::NAN, |last| last.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_decide_where_an_interval_ends() {
        let values = [(1.0, 0.1), (2.0, 0.8), (3.0, 0.1)];
        assert_eq!([0.05, 0.2, 0.95].map(|p| weighted(&values, p)), [1.0, 2.0, 3.0]);
    }
}
