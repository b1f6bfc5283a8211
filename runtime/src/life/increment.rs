//! From the mean increment of a cycle to its wear. In: joint, trajectory, cycle, dLambda. Out: dW.
//! Never knows the trajectory's state: a draw depends on its arguments alone, so the order of work changes no bit.

/// Draws the wear increment of a joint in a cycle.
pub trait IncrementModel {
    /// Wear increment dW [m], not below zero, of a joint (index among the wearing joints) in a cycle (counted from
    /// 0) of a trajectory, from its mean dLambda [m].
    ///
    /// The same arguments must give the same bits: streams are picked by (trajectory, joint, cycle), not by order.
    fn draw(&self, joint: usize, trajectory: u64, cycle: u64, mean: f64) -> f64;

    /// Whether every increment is its mean. Then several cycles may be jumped over in one step.
    fn is_mean(&self) -> bool {
        false
    }
}

/// The deterministic life: dW = dLambda.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MeanIncrement;

impl IncrementModel for MeanIncrement {
    fn draw(&self, _joint: usize, _trajectory: u64, _cycle: u64, mean: f64) -> f64 {
        mean
    }

    fn is_mean(&self) -> bool {
        true
    }
}
