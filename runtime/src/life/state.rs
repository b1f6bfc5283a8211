//! The state of a trajectory as one value: saved, it goes on with the same bits. In: settings. Out: the state and
//! the records of cycles. Never knows files or formats.

use super::control::Control;
use super::curve::Measured;
use super::settings::LifeSettings;
use super::settings_error::SettingsError;
use super::worn::WearState;
use crate::column::{Column, Quantity};
use crate::wear::{ContactMeasure, Profile, Warning};

/// A trajectory between two cycles. `S` is the state of the fine scale.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LifeState<S> {
    /// Number of the trajectory, which picks its random numbers.
    pub trajectory: u64,
    /// Whole cycles done.
    pub cycle: u64,
    /// The wearing joints.
    pub joints: Vec<WearState>,
    /// The fine scale.
    pub fine: S,
    /// What a revolution wears now, if it was measured already.
    pub measured: Option<Vec<ContactMeasure>>,
    /// What the last steps have measured, joint by joint, the latest first, where steps remember it.
    #[cfg_attr(feature = "serde", serde(default))]
    pub earlier: Vec<Vec<Measured>>,
    /// Control of the wear step.
    pub control: Control,
    /// How it ended, if it has.
    pub failure: Option<FailureEvent>,
    /// Warnings, the first of each kind and joint.
    pub warnings: Vec<JointWarning>,
    /// Records of the cycles, if they are kept.
    pub cycles: Vec<CycleRecord>,
    /// Measurements asked of the fine scale.
    pub measurements: u64,
}

/// The end of a life.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FailureEvent {
    /// Index of the joint that failed first.
    pub joint: usize,
    /// Life in cycles, W = `W_crit` interpolated within the last one.
    pub cycles: f64,
    /// Life as an inspection after every cycle sees it.
    pub whole_cycles: u64,
}

/// A warning of a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct JointWarning {
    /// Index of the joint.
    pub joint: usize,
    /// Cycle in which it was first seen, counted from 1.
    pub cycle: u64,
    /// What is out of range.
    pub warning: Warning,
}

/// One cycle.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct CycleRecord {
    /// Its number, counted from 1.
    pub cycle: u64,
    /// Largest W over `W_crit` of a joint at its end: 1 or more is failure.
    pub used: f64,
    /// The wearing joints.
    pub joints: Vec<CycleJoint>,
}

/// A joint in one cycle.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct CycleJoint {
    /// Clearance at the start [m].
    pub clearance: f64,
    /// Mean increment dLambda [m].
    pub mean_increment: f64,
    /// Increment dW [m].
    pub increment: f64,
    /// W at the end [m].
    pub wear: f64,
    /// The revolution last measured before the cycle: its numbers, without profile and extremes.
    pub revolution: ContactMeasure,
}

impl CycleJoint {
    const COLUMNS: [Quantity<Self>; 3] = [
        (Column::new(("clearance", "clearance", "m"), "Clearance at the start of the cycle"), |one| {
            one.clearance
        }),
        (Column::new(("dLambda", "dLambda", "m"), "Mean increment of wear in the cycle"), |one| {
            one.mean_increment
        }),
        (Column::new(("wear", "W", "m"), "Wear at the end of the cycle"), |one| one.wear),
    ];

    /// The columns of a table of cycles: those of the joint, then those of the revolution that are not details.
    pub fn columns() -> impl Iterator<Item = Column> {
        let revolution = ContactMeasure::COLUMNS.map(|(column, _)| column);
        Self::COLUMNS.map(|(column, _)| column).into_iter().chain(revolution).filter(|column| column.brief)
    }

    /// The numbers of these columns.
    pub fn values(&self) -> impl Iterator<Item = f64> {
        let of_revolution = ContactMeasure::COLUMNS.iter().filter(|(column, _)| column.brief);
        let of_revolution = of_revolution.map(|(_, value)| value(&self.revolution));
        Self::COLUMNS.iter().map(|(_, value)| value(self)).chain(of_revolution)
    }
}

impl<S: Default> LifeState<S> {
    /// A trajectory that begins with unworn joints.
    ///
    /// # Errors
    /// If the settings make no sense.
    pub fn new(settings: &LifeSettings, trajectory: u64) -> Result<Self, SettingsError> {
        settings.check()?;
        let joints = settings.joints.iter().map(|joint| WearState {
            clearance: joint.clearance,
            wear: 0.0,
            exposure: 0.0,
            error: 0.0,
            profile: joint.bins.and_then(|bins| Profile::unworn(bins).ok()),
            journal: joint.journal_bins.and_then(|bins| Profile::unworn(bins).ok()),
            half_angle: 0.0,
        });
        Ok(Self {
            trajectory,
            cycle: 0,
            joints: joints.collect(),
            fine: S::default(),
            measured: None,
            earlier: Vec::new(),
            control: Control::new(),
            failure: None,
            warnings: Vec::new(),
            cycles: Vec::new(),
            measurements: 0,
        })
    }
}

impl<S> LifeState<S> {
    /// Whether the state is one of these settings.
    pub(super) fn check(&self, settings: &LifeSettings) -> Result<(), SettingsError> {
        let same = |what, expected, found| {
            if expected == found { Ok(()) } else { Err(SettingsError::State { what, expected, found }) }
        };
        same("the number of wearing joints", settings.joints.len(), self.joints.len())?;
        for (joint, state) in settings.joints.iter().zip(&self.joints) {
            let found = state.profile.as_ref().map_or(0, |profile| profile.depths().len());
            same("the number of bins of a profile", joint.bins.unwrap_or(0), found)?;
            let found = state.journal.as_ref().map_or(0, |profile| profile.depths().len());
            same("the number of bins of a journal", joint.journal_bins.unwrap_or(0), found)?;
        }
        let measured = self.measured.as_ref().map_or(settings.joints.len(), Vec::len);
        same("the number of measured joints", settings.joints.len(), measured)
    }

    /// Notes a warning after so many cycles more, unless the joint had one of its kind; numbers are those of the first.
    pub(super) fn warn(&mut self, joint: usize, warning: Warning, after: u64) {
        let kind = core::mem::discriminant(&warning);
        let known =
            |seen: &JointWarning| seen.joint == joint && core::mem::discriminant(&seen.warning) == kind;
        if !self.warnings.iter().any(known) {
            self.warnings.push(JointWarning { joint, cycle: self.cycle + after + 1, warning });
        }
    }
}
