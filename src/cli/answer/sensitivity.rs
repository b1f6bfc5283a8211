//! `sensitivity --format json`. SI throughout, lives in cycles.

#[cfg(test)]
use schemars::JsonSchema;
use serde::Serialize;

use crate::sensitivity::{Derived, SensitivityResult};

/// How wear and life of a mechanism vary with its parameters.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct SensitivityAnswer<'a> {
    /// Name of the mechanism.
    pub name: &'a str,
    /// The parameters, each with the derivatives by it.
    pub parameters: Vec<ParameterSensitivity<'a>>,
    /// Parameters of the file that nothing is differentiated by.
    pub left_out: Vec<LeftOutAnswer<'a>>,
    /// Wear of a settled revolution of the unworn mechanism, joint by joint.
    pub joints: Vec<RevolutionAnswer<'a>>,
    /// Joint that fails first on the mean path.
    pub failed_joint: &'a str,
    /// Life of the mean path [cycles].
    pub mean_path_cycles: f64,
    /// Whether the life and its derivatives are by lives of the dynamics at 98 to 102 % of each parameter, because bodies come apart or
    /// derivatives of turns do not settle; else they are by turns at several clearances.
    pub is_by_lives: bool,
    /// Random lives; null where none were asked for.
    pub random: Option<RandomMean>,
    /// Steps of a turn, at the clearance where most were needed.
    pub steps: u64,
    /// Length of these steps [s].
    pub step_s: f64,
    /// Largest difference of the wear of a turn from that by adaptive steps, as a part of it.
    pub step_error: f64,
    /// Turns until derivatives had settled, where most were needed.
    pub turns: u32,
    /// How often bodies came apart in a turn, where that was most.
    pub contact_losses: u32,
    /// Clearances at which turns have derivatives: where bodies come apart and no random lives are asked for, the first alone.
    pub points: usize,
}

/// A parameter and the derivatives by it, each in the unit of what is differentiated per unit of the parameter.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct ParameterSensitivity<'a> {
    /// Its name.
    name: &'a str,
    /// Its value.
    value: f64,
    /// Its unit, 1 if it has none.
    unit: &'a str,
    /// Life of the mean path [cycles].
    life: SlopeAnswer,
    /// Mean of the random lives [cycles]; null without.
    mean_life: Option<MeanSlope>,
    /// Wear of a settled revolution of the unworn mechanism, joint by joint.
    joints: Vec<JointSlopes<'a>>,
}

/// A derivative.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
struct SlopeAnswer {
    /// The derivative.
    derivative: f64,
    /// By how much it differs from that in three quarters of the steps, of a life with a third of the difference to that by every second
    /// clearance; null where these steps are not enough. By lives: how much nearer ones differ, and what the error of each leaves open.
    doubt: Option<f64>,
    /// Relative change per relative change of the parameter; null where the parameter is zero.
    elasticity: Option<f64>,
}

/// A derivative of a mean.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
struct MeanSlope {
    /// The derivative.
    derivative: f64,
    /// Its standard error by the number of lives.
    standard_error: f64,
    /// Relative change per relative change of the parameter; null where the parameter is zero.
    elasticity: Option<f64>,
}

/// Derivatives of the wear of a joint.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
struct JointSlopes<'a> {
    /// The joint.
    joint: &'a str,
    /// Wear integral S [J].
    wear_integral: SlopeAnswer,
    /// Depth [m].
    depth: SlopeAnswer,
}

/// What a settled revolution of the unworn mechanism wears.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct RevolutionAnswer<'a> {
    /// The joint.
    joint: &'a str,
    /// Wear integral S [J].
    #[serde(rename = "wear_integral_J")]
    wear_integral: f64,
    /// Depth [m].
    depth_m: f64,
}

/// Random lives.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct RandomMean {
    /// How many.
    trajectories: u64,
    /// Seed of their random numbers.
    seed: u64,
    /// Their mean [cycles].
    mean: f64,
    /// Its standard error [cycles].
    standard_error: f64,
}

/// A parameter without derivatives.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct LeftOutAnswer<'a> {
    /// Its name.
    name: &'a str,
    /// Why.
    reason: &'a str,
}

impl<'a> SensitivityAnswer<'a> {
    pub fn new(name: &'a str, found: &'a SensitivityResult) -> Self {
        let slope = |of: &Derived, at: usize| SlopeAnswer {
            derivative: of.by[at],
            doubt: Some(of.doubts[at]).filter(|doubt| doubt.is_finite()),
            elasticity: found.elasticity(of, at),
        };
        let parameter = |at: usize| ParameterSensitivity {
            name: &found.parameters[at].name,
            value: found.parameters[at].value,
            unit: &found.parameters[at].unit,
            life: slope(&found.life.cycles, at),
            mean_life: found.random.as_ref().map(|random| MeanSlope {
                derivative: random.mean.by[at],
                standard_error: random.errors[at],
                elasticity: found.elasticity(&random.mean, at),
            }),
            joints: found
                .joints
                .iter()
                .map(|joint| JointSlopes {
                    joint: &joint.joint,
                    wear_integral: slope(&joint.wear_integral, at),
                    depth: slope(&joint.depth, at),
                })
                .collect(),
        };
        let revolution = |joint: &'a crate::sensitivity::JointSensitivity| RevolutionAnswer {
            joint: &joint.joint,
            wear_integral: joint.wear_integral.value,
            depth_m: joint.depth.value,
        };
        let left_out = found.left_out.iter();
        Self {
            name,
            parameters: (0..found.parameters.len()).map(parameter).collect(),
            left_out: left_out
                .map(|one| LeftOutAnswer { name: &one.parameter, reason: &one.reason })
                .collect(),
            joints: found.joints.iter().map(revolution).collect(),
            failed_joint: &found.life.joint,
            mean_path_cycles: found.life.cycles.value,
            is_by_lives: found.life.is_by_lives,
            random: found.random.as_ref().map(|random| RandomMean {
                trajectories: random.trajectories,
                seed: random.seed,
                mean: random.mean.value,
                standard_error: random.error,
            }),
            steps: found.steps,
            step_s: found.step,
            step_error: found.step_error,
            turns: found.turns,
            contact_losses: found.losses,
            points: found.points,
        }
    }
}
