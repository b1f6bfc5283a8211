//! From the mean increment of a cycle to its wear. In: joint, trajectory, cycle, dLambda. Out: dW.
//! Never knows the trajectory's state: a draw depends on its arguments alone, so the order of work changes no bit.

/// Lives that are drawn side by side.
pub const LANES: usize = 8;

/// One cycle each of several lives.
#[derive(Clone, Copy, Debug, Default)]
pub struct Lanes {
    /// Numbers of the trajectories.
    pub trajectories: [u64; LANES],
    /// Their cycles, counted from 0.
    pub cycles: [u64; LANES],
    /// What [`IncrementModel::of_trajectory`] says of them.
    pub own: [f64; LANES],
}

/// Draws the wear increment of a joint in a cycle.
pub trait IncrementModel {
    /// Wear increment dW [m], not below zero, of a joint (index among the wearing joints) in a cycle (counted from
    /// 0) of a trajectory, from its mean dLambda [m].
    ///
    /// The same arguments must give the same bits: streams are picked by (trajectory, joint, cycle), not by order.
    fn draw(&self, joint: usize, trajectory: u64, cycle: u64, mean: f64) -> f64;

    /// A number that all draws of a trajectory share, made once for each.
    fn of_trajectory(&self, trajectory: u64) -> f64 {
        let _ = trajectory;
        1.0
    }

    /// [`Self::draw`] for one cycle each of several trajectories, the same bits.
    fn draw_lanes(&self, joint: usize, lanes: &Lanes, means: &[f64; LANES]) -> [f64; LANES] {
        core::array::from_fn(|lane| {
            self.draw(joint, lanes.trajectories[lane], lanes.cycles[lane], means[lane])
        })
    }

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
