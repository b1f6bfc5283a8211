//! What is known about how a life varies. SI, life in cycles.

use super::varied::Varying;

/// A number and its derivatives by all parameters.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Derived {
    /// The number.
    pub value: f64,
    /// Its derivative by each parameter, in the order of [`SensitivityResult::parameters`].
    pub by: Vec<f64>,
    /// What steps leave open of each derivative: by how much it differs from the one in three quarters of them; no number where these are
    /// not enough. Of a life, a third of the difference to one by every second point comes on top. Of one by lives of the dynamics, by how
    /// much nearer ones say something else, and what the error of each leaves open. Nothing of what has no steps.
    pub doubts: Vec<f64>,
}

/// What a settled revolution of the unworn mechanism wears at a joint.
#[derive(Clone, Debug, PartialEq)]
pub struct JointSensitivity {
    /// The joint.
    pub joint: String,
    /// Wear integral S [J].
    pub wear_integral: Derived,
    /// Depth [m].
    pub depth: Derived,
}

/// The mean path.
#[derive(Clone, Debug, PartialEq)]
pub struct LifeSensitivity {
    /// The joint that fails.
    pub joint: String,
    /// Its life [cycles].
    pub cycles: Derived,
    /// Whether all of that is by lives of the dynamics at 98 to 102 % of each parameter, because bodies come apart or derivatives of turns do
    /// not settle; else it is by turns at several clearances.
    pub is_by_lives: bool,
}

/// The mean of random lives.
#[derive(Clone, Debug, PartialEq)]
pub struct RandomSensitivity {
    /// How many.
    pub trajectories: u64,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Their mean [cycles].
    pub mean: Derived,
    /// Standard error of the mean by the number of lives [cycles].
    pub error: f64,
    /// Standard errors of its derivatives by the number of lives.
    pub errors: Vec<f64>,
}

/// A parameter that nothing is differentiated by.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LeftOut {
    /// Its name.
    pub parameter: String,
    /// Why.
    pub reason: String,
}

/// How wear and life of a mechanism vary with its parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct SensitivityResult {
    /// The parameters.
    pub parameters: Vec<Varying>,
    /// Parameters of the file without derivatives.
    pub left_out: Vec<LeftOut>,
    /// Wear of a revolution of the unworn mechanism, joint by joint.
    pub joints: Vec<JointSensitivity>,
    /// The mean path.
    pub life: LifeSensitivity,
    /// The mean of random lives, if they were asked for.
    pub random: Option<RandomSensitivity>,
    /// Steps of a turn, at the place where most were needed.
    pub steps: u64,
    /// Length of these steps [s].
    pub step: f64,
    /// Largest difference of the wear of a turn from that by adaptive steps, as a part of it.
    pub step_error: f64,
    /// Turns until derivatives had settled, where most were needed; 0 where they did not, and are differences of turns beside it.
    pub turns: u32,
    /// How often bodies came apart in a turn, where that was most.
    pub losses: u32,
    /// Clearances at which turns have derivatives: where bodies come apart and no random lives are asked for, the first alone.
    pub points: usize,
}

impl SensitivityResult {
    /// The relative change of a number by that of a parameter, p/y dy/dp; nothing of a parameter that is zero.
    pub fn elasticity(&self, of: &Derived, parameter: usize) -> Option<f64> {
        let value = self.parameters[parameter].value;
        (value != 0.0).then(|| of.by[parameter] * value / of.value)
    }
}
