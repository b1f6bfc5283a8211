//! Wear fed back as one number: c_(n+1) = c_n + gamma dW_n. In: clearance, wear increment.
//! Out: the next clearance; the wear W of a set of depths. Never knows how the wear came about.

use crate::contact::{OutOfRange, not_negative};
use crate::named::named;
use crate::scalar::Scalar;

named! {
    /// What the wear W of a joint is when its depth differs from angle to angle.
    pub enum Measure {
        /// The mean over the circumference.
        Mean = "mean", "mean depth";
        /// The deepest place.
        Maximum = "maximum", "largest depth";
    }
}

impl Measure {
    /// W [m] of depths on equal parts of the circumference [m]; zero for none.
    pub fn of(self, depths: &[f64]) -> f64 {
        match self {
            Self::Mean if depths.is_empty() => 0.0,
            Self::Mean => depths.iter().sum::<f64>() / depths.len() as f64,
            Self::Maximum => depths.iter().fold(0.0, |deepest, depth| Scalar::max(*depth, deepest)),
        }
    }
}

/// Feedback of wear to the clearance by one factor.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ScalarFeedback {
    gamma: f64,
}

impl ScalarFeedback {
    /// No feedback: the clearance stays.
    pub const NONE: Self = Self { gamma: 0.0 };

    /// `gamma` [1]: clearance gained per wear; zero switches the feedback off.
    ///
    /// # Errors
    /// If it is below zero or not finite.
    pub fn new(gamma: f64) -> Result<Self, OutOfRange> {
        Ok(Self { gamma: not_negative("feedback factor gamma", gamma)? })
    }

    /// gamma [1].
    pub fn gamma(&self) -> f64 {
        self.gamma
    }

    /// The clearance [m] after a wear increment [m].
    #[inline]
    pub fn next_clearance<T: Scalar>(&self, clearance: T, wear_increment: T) -> T {
        clearance + T::constant(self.gamma) * wear_increment
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clearance_grows_by_gamma_times_the_increment() {
        let feedback = ScalarFeedback::new(0.5).unwrap();
        assert_eq!(feedback.next_clearance(10.0, 4.0), 12.0);
        assert_eq!(ScalarFeedback::new(0.0).unwrap().next_clearance(1e-5, 1e-6), 1e-5);
        assert_eq!(ScalarFeedback::new(-0.1).unwrap_err().name, "feedback factor gamma");
    }

    #[test]
    fn wear_of_depths_is_their_mean_or_maximum() {
        assert_eq!(Measure::Mean.of(&[1.0, 2.0, 6.0]), 3.0);
        assert_eq!(Measure::Maximum.of(&[1.0, 6.0, 2.0]), 6.0);
        assert_eq!((Measure::Mean.of(&[]), Measure::Maximum.of(&[])), (0.0, 0.0));
    }
}
