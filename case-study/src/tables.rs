//! What a revolution wears, measured once along the clearance: rigid, flexible, and flexible by the finest means.
//! In: mechanisms. Out: [`Tables`], fine scales that cost nothing. Never knows cycles or what they are used for.
//!
//! A table holds the depth by the area of contact and the depth by bearing angle, so that one serves every
//! definition of wear W; the feedback factor gamma says up to which clearance it reaches.

use linkwear_runtime::life::{JointLife, LifeSettings, WearOf, WearStep, WearTable, calibrate};
use linkwear_runtime::wear::{Area, Measure};
use linkwear_runtime::{DynamicsSource, GammaRates, Integrator, RevolutionSettings};
use serde::Serialize;

use super::error::StudyError;
use super::model::Model;
use super::options::{Effort, STEP};
use super::workers::Workers;

/// W as the largest depth around the bearing.
pub(super) const DEEPEST: WearOf = WearOf::Profile(Measure::Maximum);
/// Wear steps that leave no error beside that of a table: those of the finest model.
pub(super) const FINEST: WearStep =
    WearStep::Adaptive { tolerance: 1e-7, shortest: 1e-3, longest: 1, remembers: false };
/// Life of the paper's ground truth [cycles].
pub const TRUE_LIFE: f64 = 25.1;
/// Accuracy of the calibration [cycles].
const CALIBRATED: f64 = 1e-6;
/// Tables reach this part beyond the threshold: the last cycle of Fig. 5 lies there.
const REACH: f64 = 1.4;

/// A table to be measured, from the unworn clearance to that at `reach` times the threshold.
#[derive(Clone, Copy)]
pub(super) struct Survey {
    pub model: Model,
    /// Model of the contact area.
    pub area: Area,
    /// Bearing angles of the profile.
    pub bins: usize,
    pub settings: RevolutionSettings,
    pub points: usize,
    /// Growth of the clearance per W.
    pub gamma: f64,
    pub reach: f64,
}

/// One model, measured.
pub(super) struct Measured {
    survey: Survey,
    /// Wear per revolution; a fine scale.
    pub table: WearTable,
    rates: Option<GammaRates>,
    joints: Vec<JointLife>,
}

/// All models for one gamma.
pub(super) struct Tables<'m> {
    pub rigid: &'m Measured,
    pub flexible: &'m Measured,
    /// Half the time step, more points.
    pub finest: &'m Measured,
}

/// How good a table is.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TableQuality {
    /// Which model.
    pub model: &'static str,
    /// Growth of the clearance per wear.
    pub gamma: f64,
    /// Points from the clearance at the start to that at the end.
    pub points: usize,
    /// Turns that every point is the mean of.
    pub turns: u32,
    /// Largest relative error of a table with every second point, at the points left out.
    pub left_out: f64,
    /// Wear integral of a turn of the unworn joint [J].
    pub wear_integral_first: f64,
    /// The same at the last point [J].
    pub wear_integral_last: f64,
    /// Depth of a turn of the unworn joint by the area of contact [m].
    pub depth_first: f64,
    /// The same at the last point [m].
    pub depth_last: f64,
    /// Largest force at the last point [N].
    pub peak_force_last: f64,
}

impl Survey {
    /// In turns of the compiled mechanism with its usual step, roughly.
    pub fn work(&self) -> f64 {
        let RevolutionSettings { integrator, settle, average } = self.settings;
        let steps = if let Integrator::Rk4 { step } = integrator { STEP / step } else { 1.0 };
        steps * f64::from(settle.unwrap_or(1) + average) * self.points as f64
    }

    pub fn measure(&self, workers: &Workers<'_>) -> Result<Measured, StudyError> {
        let mut mechanism = self.model.mechanism()?;
        let mut rates = None;
        for wear in mechanism.description.contacts.to_mut().iter_mut().filter_map(|joint| joint.wear.as_mut())
        {
            (wear.area, wear.bins, wear.feedback) = (self.area, self.bins, self.gamma);
            wear.measure = Some(Measure::Maximum);
            rates = rates.or(wear.scatter);
        }
        let (system, description) = (mechanism.system(), &mechanism.description);
        workers.piece(self.work(), |watch| {
            let source = DynamicsSource::new(&*system, description, &mechanism.parameters, self.settings)?;
            // Within a revolution nothing is told, and the study may stop all the same.
            let mut source = source.watched_by(watch.piece(0.0, 0.0));
            let joints = source.joints()?;
            let further = joints.iter().cloned();
            let further = further.map(|joint| JointLife {
                wear: WearOf::Depth,
                threshold: self.reach * joint.threshold,
                ..joint
            });
            let settings = LifeSettings::new(further.collect());
            let table = WearTable::measure(&settings, &mut source, self.points, watch)?;
            Ok(Measured { survey: *self, table, rates, joints })
        })
    }
}

impl Measured {
    /// A life with this definition of W.
    pub fn life(&self, wear: WearOf, step: WearStep) -> LifeSettings {
        let joints = self.joints.iter().cloned();
        LifeSettings { step, ..LifeSettings::new(joints.map(|joint| JointLife { wear, ..joint }).collect()) }
    }

    /// Wear at failure [m].
    pub fn threshold(&self) -> f64 {
        self.joints[0].threshold
    }

    /// Clearance at failure over that of the unworn joint.
    pub fn opening(&self) -> f64 {
        1.0 + self.survey.gamma * self.threshold() / self.joints[0].clearance
    }

    fn quality(&self, model: &'static str) -> TableQuality {
        let report = self.table.report();
        let (first, last) = (self.table.at(0, 0.0), self.table.at(0, self.threshold()));
        TableQuality {
            model,
            gamma: self.survey.gamma,
            points: report.points,
            turns: self.survey.settings.average,
            left_out: report.left_out.iter().copied().fold(0.0, f64::max),
            wear_integral_first: first.wear_integral,
            wear_integral_last: last.wear_integral,
            depth_first: first.depth,
            depth_last: last.depth,
            peak_force_last: last.peak_force,
        }
    }
}

impl<'m> Tables<'m> {
    /// What has to be measured for a gamma: the longest first, in the order of [`Self::of`].
    pub fn surveys(gamma: f64, effort: &Effort) -> [Survey; 3] {
        let half = RevolutionSettings { integrator: Integrator::Rk4 { step: 0.5 * STEP }, ..effort.flexible };
        [
            (Model::Rigid, effort.rigid, effort.rigid_points),
            (Model::Flexible, half, effort.finest_points),
            (Model::Flexible, effort.flexible, effort.points),
        ]
        .map(|(model, settings, points)| {
            let (area, bins) = (Area::Hertz, effort.bins);
            Survey { model, area, bins, settings, points, gamma, reach: REACH }
        })
    }

    pub fn of([rigid, finest, flexible]: &'m [Measured; 3]) -> Self {
        Self { rigid, flexible, finest }
    }

    /// Growth of the clearance per W.
    pub fn gamma(&self) -> f64 {
        self.finest.survey.gamma
    }

    /// Revolutions that a cycle stands for: with them the deterministic life of the finest model is that of the paper's
    /// ground truth. One calibration serves all models.
    pub fn revolutions_per_cycle(&self, wear: WearOf) -> Result<f64, StudyError> {
        let life = self.finest.life(wear, FINEST);
        let factor = calibrate(&life, &mut self.finest.table.clone(), TRUE_LIFE, CALIBRATED)?.factor;
        Ok(factor * life.joints[0].revolutions_per_cycle)
    }

    /// Parameters of the Gamma process that the file gives the joint.
    pub fn rates(&self) -> Option<GammaRates> {
        self.finest.rates
    }

    /// How good they are.
    pub fn quality(&self) -> [TableQuality; 3] {
        [self.rigid.quality("rigid"), self.flexible.quality("flexible"), self.finest.quality("finest")]
    }
}
