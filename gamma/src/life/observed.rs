//! A law of life as lives have shown it. In: lives that all ended. Out: a [`Lifetime`]. Never knows where they come from.

use super::lifetime::Lifetime;
use crate::error::LifeError;

/// The distribution of observed lives: the i-th of n in order has the probability (i - 1/2)/n behind it, with straight lines
/// between; half a life's share lies before the first and after the last, as far as its neighbour is.
#[derive(Clone, Debug)]
pub struct ObservedLives {
    /// Time, part that has failed; ascending.
    points: Vec<(f64, f64)>,
}

impl ObservedLives {
    /// Of lives in any order.
    ///
    /// # Errors
    /// [`LifeError::FewLives`], [`LifeError::Life`].
    pub fn of(lives: &[f64]) -> Result<Self, LifeError> {
        if lives.len() < 2 {
            return Err(LifeError::FewLives { lives: lives.len() });
        }
        if let Some(at) = lives.iter().position(|life| !(life.is_finite() && *life > 0.0)) {
            return Err(LifeError::Life { row: at + 1, value: lives[at] });
        }
        let mut sorted = lives.to_vec();
        sorted.sort_unstable_by(f64::total_cmp);
        let count = sorted.len();
        let (first, last) = (sorted[0], sorted[count - 1]);
        let mut points = vec![((2.0 * first - sorted[1]).max(0.0), 0.0)];
        points.extend(sorted.iter().enumerate().map(|(i, life)| (*life, (i as f64 + 0.5) / count as f64)));
        points.push((2.0 * last - sorted[count - 2], 1.0));
        Ok(Self { points })
    }
}

impl Lifetime for ObservedLives {
    fn reliability(&self, t: f64) -> f64 {
        1.0 - self.failed(t)
    }

    fn failed(&self, t: f64) -> f64 {
        let above = self.points.partition_point(|(time, _)| *time <= t);
        match (above.checked_sub(1).map(|at| self.points[at]), self.points.get(above)) {
            (None, _) => 0.0,
            (Some(_), None) => 1.0,
            (Some((from, before)), Some((to, after))) => before + (after - before) * (t - from) / (to - from),
        }
    }

    fn typical(&self) -> f64 {
        self.points[self.points.len() / 2].0
    }

    fn accuracy(&self) -> f64 {
        1e-9
    }

    fn breaks(&self) -> Vec<f64> {
        self.points.iter().map(|(time, _)| *time).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lives_in_any_order_have_their_mean_and_quantiles() {
        let lives = [4.0, 1.0, 3.0, 2.0, 2.0];
        let law = ObservedLives::of(&lives).expect("valid");
        // Trapezia over the points by hand: 1 to 4 with halves at the ends.
        assert!((law.failed(2.5) - 0.6).abs() < 1e-12, "{}", law.failed(2.5));
        assert!((law.quantile(0.5).expect("valid") - 2.0).abs() < 1e-9);
        assert!((law.moments().expect("finite").mean - 2.4).abs() < 1e-6, "{:?}", law.moments());
        assert_eq!((law.failed(-1.0), law.failed(9.0)), (0.0, 1.0));
        assert!(matches!(ObservedLives::of(&[1.0]), Err(LifeError::FewLives { lives: 1 })));
        assert!(matches!(ObservedLives::of(&[1.0, -2.0]), Err(LifeError::Life { row: 2, .. })));
    }
}
