//! What a revolution wears, measured once along the clearance: rigid, flexible, and flexible by the finest means.
//! In: mechanisms. Out: [`Tables`], fine scales that cost nothing. Never knows cycles or what they are used for.
//!
//! A table holds the depth by the area of contact and the depth by bearing angle, so that one serves every
//! definition of wear W; the feedback factor gamma says up to which clearance it reaches.

use linkwear_runtime::life::{Feedback, JointLife, LifeSettings, WearOf, WearStep, WearTable, calibrate};
use linkwear_runtime::wear::{Area, Measure, ScalarFeedback};
use linkwear_runtime::{GammaRates, Integrator, RevolutionSettings, SetupError, Watch};
use serde::Serialize;

use super::error::StudyError;
use super::job_pool::{Job, run_all};
use super::model::Model;
use super::options::Effort;
use super::progress::Progress;

/// What counts as wear and what it does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Definition {
    /// What W is.
    pub wear: WearOf,
    /// Growth of the clearance per W.
    pub gamma: f64,
}

impl Definition {
    /// W is the largest depth around the bearing, and the clearance opens by it.
    pub const DEEPEST: Self = Self { wear: WearOf::Profile(Measure::Maximum), gamma: 1.0 };
}

/// Life of the paper's ground truth [cycles].
pub const TRUE_LIFE: f64 = 25.1;
/// Accuracy of the calibration [cycles].
const CALIBRATED: f64 = 1e-6;

/// One model, measured.
pub(super) struct Measured {
    /// Wear per revolution; a fine scale.
    pub table: WearTable,
    rates: Option<GammaRates>,
    joints: Vec<JointLife>,
}

/// All models for one gamma.
pub(super) struct Tables {
    pub rigid: Measured,
    pub flexible: Measured,
    /// Half the time step, more points.
    pub finest: Measured,
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

impl Measured {
    /// A life with this definition of wear.
    pub fn life(&self, definition: Definition, step: WearStep) -> Result<LifeSettings, StudyError> {
        let joints = self.joints.iter().map(|joint| {
            let feedback = scalar(definition.gamma)?;
            Ok(JointLife { wear: definition.wear, feedback, ..joint.clone() })
        });
        let joints: Result<Vec<_>, StudyError> = joints.collect();
        Ok(LifeSettings { step, ..LifeSettings::new(joints?) })
    }

    /// Wear at failure [m].
    pub fn threshold(&self) -> f64 {
        self.joints[0].threshold
    }

    /// Clearance of the unworn joint [m].
    pub fn clearance(&self) -> f64 {
        self.joints[0].clearance
    }

    fn quality(&self, model: &'static str, gamma: f64, turns: u32) -> TableQuality {
        let report = self.table.report();
        let (first, last) = (self.table.at(0, 0.0), self.table.at(0, self.joints[0].threshold));
        TableQuality {
            model,
            gamma,
            points: report.points,
            turns,
            left_out: report.left_out.iter().copied().fold(0.0, f64::max),
            wear_integral_first: first.wear_integral,
            wear_integral_last: last.wear_integral,
            depth_first: first.depth,
            depth_last: last.depth,
            peak_force_last: last.peak_force,
        }
    }
}

fn scalar(gamma: f64) -> Result<Feedback, StudyError> {
    let wrong = |error: linkwear_runtime::contact::OutOfRange| {
        StudyError::Setup(SetupError::Setting { name: error.name, value: error.value, need: error.need })
    };
    Ok(Feedback::Scalar(ScalarFeedback::new(gamma).map_err(wrong)?))
}

impl Tables {
    /// Measures all models, for every gamma from the unworn clearance to that at `reach` times the threshold.
    pub fn measure(
        threads: usize,
        (gammas, reach): (&[f64], f64),
        effort: &Effort,
        progress: &Progress<'_>,
    ) -> Result<Vec<Self>, StudyError> {
        let half = Integrator::Rk4 { step: 0.5 * effort.step };
        let fine = RevolutionSettings { integrator: half, ..effort.flexible };
        let worn = (Area::Hertz, effort.bins);
        let rigid =
            |gamma| job(Model::rigid, worn, (effort.rigid, effort.rigid_points), (gamma, reach), progress);
        let finest = |gamma| job(flexible, worn, (fine, effort.finest_points), (gamma, reach), progress);
        let proposed =
            |gamma| job(flexible, worn, (effort.flexible, effort.points), (gamma, reach), progress);
        let gammas = || gammas.iter().copied();
        // The longest first.
        let jobs = gammas().map(rigid).chain(gammas().map(finest)).chain(gammas().map(proposed)).collect();
        let found: Result<Vec<Measured>, StudyError> = run_all(threads, jobs).into_iter().collect();
        let mut found = found?;
        let flexible = found.split_off(2 * gammas().count());
        let finest = found.split_off(gammas().count());
        let tables = found.into_iter().zip(finest).zip(flexible);
        Ok(tables.map(|((rigid, finest), flexible)| Self { rigid, flexible, finest }).collect())
    }

    /// Revolutions that a cycle stands for: with them the deterministic life of the finest model is that of the paper's
    /// ground truth. One calibration serves all models.
    pub fn revolutions_per_cycle(&self, definition: Definition, effort: &Effort) -> Result<f64, StudyError> {
        let life = self.finest.life(definition, effort.finest_wear_step)?;
        let factor = calibrate(&life, &mut self.finest.table.clone(), TRUE_LIFE, CALIBRATED)?.factor;
        Ok(factor * life.joints[0].revolutions_per_cycle)
    }

    /// Wear at failure [m].
    pub fn threshold(&self) -> f64 {
        self.finest.threshold()
    }

    /// Parameters of the Gamma process that the file gives the joint.
    pub fn rates(&self) -> Option<GammaRates> {
        self.finest.rates
    }

    /// Clearance of the unworn joint [m].
    pub fn clearance(&self) -> f64 {
        self.finest.clearance()
    }

    /// How good they are.
    pub fn quality(&self, gamma: f64, effort: &Effort) -> Vec<TableQuality> {
        vec![
            self.rigid.quality("rigid", gamma, effort.rigid.average),
            self.flexible.quality("flexible", gamma, effort.flexible.average),
            self.finest.quality("finest", gamma, effort.flexible.average),
        ]
    }
}

/// The flexible model, where a model may be refused.
pub(super) fn flexible() -> Result<Model, StudyError> {
    Ok(Model::flexible())
}

/// Measuring one model, worn over an area and by so many bearing angles, as a job: see [`measured`].
pub(super) fn job<'w>(
    model: fn() -> Result<Model, StudyError>,
    (area, bins): (Area, usize),
    (settings, points): (RevolutionSettings, usize),
    range: (f64, f64),
    progress: &'w Progress<'_>,
) -> Job<'w, Result<Measured, StudyError>> {
    Box::new(move || measured(&model()?.wearing(area, bins), (settings, points), range, progress))
}

/// Measures one model from the unworn clearance to that at `reach` times the threshold.
fn measured(
    model: &Model,
    (settings, points): (RevolutionSettings, usize),
    (gamma, reach): (f64, f64),
    progress: &Progress<'_>,
) -> Result<Measured, StudyError> {
    model.measuring(settings, progress, |revolutions| {
        let joints = revolutions.inner.joints()?;
        let feedback = scalar(gamma)?;
        let further = |joint: &JointLife| JointLife {
            wear: WearOf::Depth,
            feedback,
            threshold: reach * joint.threshold,
            ..joint.clone()
        };
        let wears = model.mechanism.description.contacts.iter().find_map(|contact| contact.wear);
        let rates = wears.and_then(|wear| wear.scatter);
        let surveyed = LifeSettings::new(joints.iter().map(further).collect());
        let table = WearTable::measure(&surveyed, revolutions, points, Watch::NONE)?;
        Ok(Measured { table, rates, joints })
    })
}
