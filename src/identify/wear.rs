//! Wear at inspections, as the mean path of a life has it. In: a mechanism, joints, revolutions. Out: wear [m]. Never knows what is
//! sought.
//!
//! Archard's depth is proportional to the coefficient, so that wear is a function of coefficient times revolutions: one path, by a
//! table of what revolutions wear, serves all values of the coefficient.

use linkwear_gamma::monte_carlo::GammaMean;
use linkwear_runtime::life::{
    DEFAULT_POINTS, LifeOutcome, LifeSettings, LifeState, WearStep, WearTable, run_life,
};
use linkwear_runtime::{DynamicsSource, GammaRates, RevolutionSettings, Watch};

use super::errors::ModelFault;
use crate::mechanism::Mechanism;
use crate::study::{LIFE_FAILED, PointError};

/// Inspections of a joint that began unworn.
#[derive(Clone, Debug, PartialEq)]
pub struct Inspections {
    /// The joint.
    pub joint: String,
    /// Revolutions since it was new, rising; or seconds.
    pub at: Vec<f64>,
    /// Whether `at` are seconds.
    pub by_time: bool,
    /// Wear W [m].
    pub wear: Vec<f64>,
    /// Standard deviation of the gauge [m], if known.
    pub gauge: Option<f64>,
}

/// A joint on a path.
#[derive(Clone, Debug, PartialEq)]
pub struct WornJoint {
    /// Its name.
    pub joint: String,
    /// Wear [m] at the revolutions of the path.
    pub wear: Vec<f64>,
}

/// Wear over revolutions.
#[derive(Clone, Debug, PartialEq)]
pub struct WearPath {
    /// Coefficient of the first wearing joint that it was lived with.
    coefficient: f64,
    /// Revolutions, equally far apart from 0 on.
    revolutions: Vec<f64>,
    joints: Vec<WornJoint>,
    /// The joint that ended it.
    ended_by: usize,
    seconds_per_revolution: Option<f64>,
}

/// Points of a path until its end: a cubic between them is right to a millionth of the wear there.
const CYCLES: f64 = 64.0;
/// How far beyond what was measured a path goes.
const BEYOND: f64 = 1.5;

/// A life that came to nothing.
fn failed(message: impl ToString) -> ModelFault {
    ModelFault::Failed(PointError {
        code: LIFE_FAILED.to_owned(),
        message: message.to_string(),
        help: String::new(),
    })
}

impl WearPath {
    /// Lives until a joint has worn beyond what was measured of it.
    ///
    /// # Errors
    /// [`ModelFault`].
    pub fn live(
        mechanism: &Mechanism,
        inspected: &[Inspections],
        revolutions: RevolutionSettings,
        watch: Watch<'_>,
    ) -> Result<Self, ModelFault> {
        let coefficient = first_coefficient(mechanism).ok_or_else(|| failed("no joint wears"))?;
        let system = mechanism.system();
        let source =
            DynamicsSource::new(&*system, &mechanism.description, &mechanism.parameters, revolutions);
        let mut source = source.map_err(failed)?.watched_by(watch);
        let seconds_per_revolution = source.seconds_per_revolution().map_err(failed)?;
        let mut settings = LifeSettings::new(source.joints().map_err(failed)?);
        settings.step = WearStep::TABLE;
        let most = |joint: &str| {
            let own = inspected.iter().filter(|one| one.joint == joint).flat_map(|one| &one.wear);
            own.copied().fold(0.0, f64::max)
        };
        let largest = settings.joints.iter().map(|joint| most(&joint.joint)).fold(0.0, f64::max);
        for joint in &mut settings.joints {
            let own = most(&joint.joint);
            joint.threshold = if own > 0.0 { BEYOND * own } else { joint.threshold.max(BEYOND * largest) };
        }
        let interrupted = |error: String| {
            if watch.report(0.0).is_break() { ModelFault::Interrupted } else { failed(error) }
        };
        let table = WearTable::measure(&settings, &mut source, DEFAULT_POINTS, watch);
        let mut table = table.map_err(|error| interrupted(error.to_string()))?;
        // As many revolutions a cycle as the joint that is worn first takes for a part of its threshold, as it wears when new.
        // On the mean path of a life alpha over beta times what physics wears.
        let worn = mechanism.description.contacts.iter().filter_map(|contact| contact.wear.as_ref());
        let rates = worn.map(|wear| wear.scatter.unwrap_or(GammaRates { alpha: 1.0, beta: 1.0 }));
        let rates: Vec<GammaRates> = rates.collect();
        let mean = GammaMean::new(&rates);
        let wears = settings.joints.iter().zip(&rates).enumerate().map(|(at, (joint, rates))| {
            rates.alpha / rates.beta * joint.wear.of(&table.at(at, 0.0)) / joint.threshold
        });
        let fastest = wears.fold(0.0, f64::max);
        if fastest.is_nan() || fastest <= 0.0 {
            return Err(failed("wear stands still"));
        }
        let length = 1.0 / (CYCLES * fastest);
        for joint in &mut settings.joints {
            joint.revolutions_per_cycle = length;
        }
        let mut state = LifeState::new(&settings, 0).map_err(failed)?;
        let outcome = run_life(&settings, &mut table, &mean, &mut state, watch);
        let ended_by = match outcome.map_err(|error| interrupted(error.to_string()))? {
            LifeOutcome::Failed(end) => end.joint,
            LifeOutcome::Cancelled => return Err(ModelFault::Interrupted),
            LifeOutcome::CycleLimit => return Err(failed("wear all but stands still")),
        };
        let count = state.cycles.len();
        let joint = |(at, joint): (usize, &linkwear_runtime::life::JointLife)| {
            let wear = state.cycles.iter().map(|cycle| cycle.joints[at].wear);
            WornJoint { joint: joint.joint.clone(), wear: std::iter::once(0.0).chain(wear).collect() }
        };
        Ok(Self {
            coefficient,
            revolutions: (0..=count).map(|cycle| cycle as f64 * length).collect(),
            joints: settings.joints.iter().enumerate().map(joint).collect(),
            ended_by,
            seconds_per_revolution,
        })
    }

    /// Wear [m] of a joint at its inspections, with a coefficient of the first wearing joint in place of that of the path.
    ///
    /// # Errors
    /// If there is no such joint, revolutions last differently where times are given, or another joint ends the path before.
    pub fn at(&self, inspections: &Inspections, coefficient: f64) -> Result<Vec<f64>, ModelFault> {
        let place = self.joints.iter().position(|joint| joint.joint == inspections.joint);
        let place = place.ok_or_else(|| failed(format!("joint {} does not wear", inspections.joint)))?;
        let per_revolution = if inspections.by_time {
            self.seconds_per_revolution
                .ok_or_else(|| failed("revolutions last differently: give them, not time"))?
        } else {
            1.0
        };
        let end = self.revolutions.last().copied().unwrap_or_default();
        let wear = |at: &f64| {
            let revolutions = at / per_revolution * coefficient / self.coefficient;
            if revolutions > end && self.ended_by != place {
                let other = &self.joints[self.ended_by].joint;
                return Err(failed(format!("{other} has failed before the inspection at {at:e}")));
            }
            Ok(self.wear(place, revolutions))
        };
        inspections.at.iter().map(wear).collect()
    }

    /// Cubic through the points, by the slopes of parabolas; a straight line beyond the end.
    fn wear(&self, joint: usize, revolutions: f64) -> f64 {
        let wear = &self.joints[joint].wear;
        let last = wear.len() - 1;
        let length = self.revolutions[1];
        let slope = |at: usize| match at {
            0 if last == 1 => wear[1] - wear[0],
            0 => 2.0 * wear[1] - 1.5 * wear[0] - 0.5 * wear[2],
            at if at == last && last == 1 => wear[1] - wear[0],
            at if at == last => 1.5 * wear[at] - 2.0 * wear[at - 1] + 0.5 * wear[at - 2],
            at => 0.5 * (wear[at + 1] - wear[at - 1]),
        };
        let x = (revolutions / length).max(0.0);
        if x >= last as f64 {
            return wear[last] + (x - last as f64) * slope(last);
        }
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "from 0 to below the last"
        )]
        let at = x as usize;
        let (s, from, to) = (x - at as f64, slope(at), slope(at + 1));
        let (h, g) = (s * s * (3.0 - 2.0 * s), s * (1.0 - s));
        wear[at] * (1.0 - h) + wear[at + 1] * h + g * ((1.0 - s) * from - s * to)
    }
}

/// Archard's coefficient of the first joint that wears.
pub(super) fn first_coefficient(mechanism: &Mechanism) -> Option<f64> {
    mechanism.description.contacts.iter().find_map(|contact| contact.wear).map(|wear| wear.coefficient)
}
