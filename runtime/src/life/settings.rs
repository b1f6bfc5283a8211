//! What a life is asked to be. In: joints, how wear is stepped. Out: checked settings. Never knows the fine scale.

use super::joint::{Feedback, JointLife};
use super::settings_error::SettingsError;
use crate::contact::checked;
use crate::wear::ScalarFeedback;

/// How wear is stepped from cycle to cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WearStep {
    /// One measurement per cycle, geometry constant within it: the recursion of the paper as it stands.
    Cycle,
    /// Geometry changes within a cycle; steps are parts of a cycle or, on the mean path, several cycles.
    Adaptive {
        /// Error of a step over the wear gained in it.
        tolerance: f64,
        /// Shortest step, as a part of a cycle: shorter ones would follow noise.
        shortest: f64,
        /// Longest step in cycles.
        longest: u64,
        /// Whether a step takes what earlier ones have measured, and two measurements of its own in place of three: where
        /// every joint's wear is one number.
        remembers: bool,
    },
}

impl WearStep {
    /// For a fine scale that costs seconds.
    pub const FULL: Self = Self::Adaptive { tolerance: 1e-4, shortest: 0.25, longest: 1024, remembers: true };
    /// For a table.
    pub const TABLE: Self = Self::Adaptive { tolerance: 1e-6, shortest: 0.01, longest: 16, remembers: false };
    /// For a calibration, which compares lives with each other to seven digits.
    pub(super) const FINE: Self =
        Self::Adaptive { tolerance: 1e-7, shortest: 1e-4, longest: 1, remembers: false };
}

/// Everything about a life but its fine scale and its draws.
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct LifeSettings {
    /// Wearing joints, in the order of the fine scale.
    pub joints: Vec<JointLife>,
    /// How wear is stepped.
    pub step: WearStep,
    /// Ends a life that has not failed; it may be exceeded by the rest of a jump.
    pub most_cycles: u64,
    /// Part of a revolution in contact below which Archard's sliding wear is meaningless.
    pub least_touching: f64,
    /// Whether the state keeps the records of all cycles (the observer sees them anyway).
    pub keep_cycles: bool,
}

impl LifeSettings {
    /// Settings for these joints with the steps of full coupling.
    pub fn new(joints: Vec<JointLife>) -> Self {
        Self { joints, step: WearStep::FULL, most_cycles: 100_000, least_touching: 0.5, keep_cycles: true }
    }

    /// The same life with the geometry of the unworn joints throughout: the paper's second baseline.
    pub fn without_feedback(mut self) -> Self {
        for joint in &mut self.joints {
            joint.feedback = Feedback::Scalar(ScalarFeedback::NONE);
        }
        self
    }

    /// The same life with cycles of `factor` times as many revolutions.
    pub fn with_longer_cycles(mut self, factor: f64) -> Self {
        for joint in &mut self.joints {
            joint.revolutions_per_cycle *= factor;
        }
        self
    }

    /// Whether the mean path is measured ahead, at many states of wear together: with one joint whose wear is a number, and steps that
    /// remember what was measured.
    pub fn is_measured_ahead(&self) -> bool {
        matches!(&self.joints[..], [joint] if joint.width() == 1)
            && matches!(self.step, WearStep::Adaptive { remembers: true, .. })
    }

    /// Length of the increments of all joints.
    pub(super) fn width(&self) -> usize {
        self.joints.iter().map(JointLife::width).sum()
    }

    /// The joints, each with its part of the increments of all.
    pub(super) fn parts<'i>(
        &'i self,
        mut increments: &'i [f64],
    ) -> impl Iterator<Item = (&'i JointLife, &'i [f64])> {
        self.joints.iter().map(move |joint| {
            let (own, others) = increments.split_at(joint.width());
            increments = others;
            (joint, own)
        })
    }

    /// A joint with its part of the increments of all.
    pub(super) fn part<'i>(&'i self, at: usize, increments: &'i [f64]) -> (&'i JointLife, &'i [f64]) {
        let first: usize = self.joints[..at].iter().map(JointLife::width).sum();
        let joint = &self.joints[at];
        (joint, &increments[first..first + joint.width()])
    }

    /// Whether everything makes sense.
    ///
    /// # Errors
    /// The first thing that does not.
    pub fn check(&self) -> Result<(), SettingsError> {
        if self.joints.is_empty() {
            return Err(SettingsError::NoJoint);
        }
        self.joints.iter().try_for_each(JointLife::check)?;
        let touching = self.least_touching;
        checked("the least part in contact", touching, "from 0 to below 1", |x| (0.0..1.0).contains(&x))?;
        if let WearStep::Adaptive { tolerance, shortest, longest, .. } = self.step {
            checked("the tolerance of the wear step", tolerance, "between 0 and 1", |x| x > 0.0 && x < 1.0)?;
            let need = "above 0 and at most 1 cycle";
            checked("the shortest wear step", shortest, need, |x| x > 0.0 && x <= 1.0)?;
            checked("the longest wear step", longest as f64, "1 cycle or more", |x| x >= 1.0)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::life::WearOf;
    use crate::wear::{Limits, Measure};

    #[test]
    fn without_feedback_geometry_stays() {
        let joint = JointLife {
            joint: "R1".to_owned(),
            journal_radius: 0.01,
            clearance: 1e-5,
            threshold: 80e-6,
            revolutions_per_cycle: 1e7,
            wear: WearOf::Profile(Measure::Mean),
            feedback: Feedback::Profile,
            bins: Some(72),
            journal_bins: None,
            limits: Limits { hardness: 3.5e9, pressure_speed: None },
        };
        let settings = LifeSettings::new(vec![joint]).without_feedback();
        assert_eq!(settings.joints[0].feedback, Feedback::Scalar(ScalarFeedback::NONE));
        assert_eq!(settings.joints[0].wear, WearOf::Profile(Measure::Mean));
    }
}
