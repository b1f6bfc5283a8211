//! How a life varies where bodies come apart: by lives of the dynamics at some per cent of a parameter to both sides. In: a file,
//! parameters. Out: a life, its derivatives and how far off they may be. Never knows tangents.
//!
//! There the wear of a turn has ripples over a hundredth of a parameter or of the clearance. Its derivative is that of the ripple at hand,
//! and clearances of a table are a small sample of them; a life crosses many.

use std::num::NonZero;

use linkwear_codegen::tape::side_by_side;
use linkwear_codegen::{Options, SourceFile};
use linkwear_runtime::Watch;

use super::error::SensitivityError;
use super::varied::Sides;
use crate::backend::Backend;
use crate::life::{Cause, Coupling, LifeResult, LifeStudy, Trajectories};
use crate::mechanism::Mechanism;

/// The farthest step to each side, as a part of a parameter: over several ripples; and where a mechanism has nothing so far away: its loop
/// does not close, another joint fails first.
pub(super) const FARTHEST: [f64; 2] = [0.02, 0.004];

/// How far apart the logarithms of a parameter are, from a step below it to one above.
pub(super) fn across(step: f64) -> f64 {
    step.ln_1p() - (-step).ln_1p()
}

/// A file whose lives are asked for.
pub(super) struct Wide<'s> {
    pub source: &'s SourceFile,
    pub options: &'s Options,
    pub threads: usize,
}

/// A life, and how it varies.
pub(super) struct WideLife {
    /// The joint that fails.
    pub joint: String,
    /// Cycles.
    pub cycles: f64,
    /// How often bodies come apart in a turn, where that is most.
    pub losses: u32,
    /// The derivative by each parameter, and how far off it may be; nothing by those that there are no lives beside.
    pub slopes: Vec<Option<[f64; 2]>>,
}

impl Wide<'_> {
    /// Of the mean path of the file's mechanism.
    pub(super) fn life(
        &self,
        mechanism: &Mechanism,
        sides: &[Sides],
        watch: Watch<'_>,
    ) -> Result<WideLife, SensitivityError> {
        watch.begin("lives beside it");
        let own = mean_path(mechanism, Watch::new(&|_| watch.report(0.0)))?;
        let [long, short] = FARTHEST;
        let (mut slopes, count) = (Vec::with_capacity(sides.len()), sides.len() as f64);
        for (place, sides) in sides.iter().enumerate() {
            let part = place as f64 / count;
            let hear = |_| watch.report(part);
            let watch = Watch::new(&hear);
            let slope = match self.slope(&own, sides, long, watch)? {
                None => self.slope(&own, sides, short, watch)?,
                found => found,
            };
            slopes.push(slope);
        }
        let losses = own.cycles.iter().flat_map(|cycle| &cycle.joints).map(|joint| joint.revolution.losses);
        Ok(WideLife {
            joint: own.failed_joint().joint.clone(),
            cycles: own.end.cycles,
            losses: losses.fold(0.0, f64::max) as u32,
            slopes,
        })
    }

    /// By one parameter: by the logarithms of both, in which a power of the parameter is straight.
    fn slope(
        &self,
        own: &LifeResult,
        sides: &Sides,
        farthest: f64,
        watch: Watch<'_>,
    ) -> Result<Option<[f64; 2]>, SensitivityError> {
        let step = 0.5 * farthest;
        let parts = [-farthest, -step, step, farthest];
        let lives = side_by_side(&parts, self.threads, |part| {
            sides.at(1.0 + part).map(|set| mean_path(&self.mechanism(set)?, watch))
        });
        let mut logarithms = [0.0; 4];
        let mut error = error_of(own);
        for (logarithm, life) in logarithms.iter_mut().zip(lives) {
            let life = match life {
                Some(Ok(life)) if life.end.joint == own.end.joint => life,
                Some(Err(SensitivityError::Interrupted)) => return Err(SensitivityError::Interrupted),
                _ => return Ok(None),
            };
            *logarithm = life.end.cycles.ln();
            error = error.max(error_of(&life));
        }
        let [before, below, above, after] = logarithms;
        let [near, far] = [(above - below) / across(step), (after - before) / across(farthest)];
        // The straight line through all of them.
        let slope = 0.2 * near + 0.8 * far;
        let doubt = (near - far).abs() + error / (10.0_f64.sqrt() * step);
        let unit = own.end.cycles / sides.of.value;
        Ok(Some([slope * unit, doubt * unit.abs()]))
    }

    /// The mechanism with a parameter set.
    pub(super) fn mechanism(&self, set: (String, String)) -> Result<Mechanism, SensitivityError> {
        let mut options = self.options.clone();
        options.overrides.push(set);
        let mechanism = Mechanism::compile(self.source, &options, Backend::Auto);
        mechanism.map_err(|error| SensitivityError::Wear(error.to_string()))
    }
}

/// The mean path of a mechanism.
fn mean_path(mechanism: &Mechanism, watch: Watch<'_>) -> Result<LifeResult, SensitivityError> {
    let study = LifeStudy {
        coupling: Some(Coupling::Full),
        trajectories: Trajectories::MeanPath,
        threads: Some(NonZero::<usize>::MIN),
        ..LifeStudy::new(mechanism)
    };
    study.run_watched(watch).map_err(|error| match *error.cause {
        Cause::Interrupted { .. } => SensitivityError::Interrupted,
        cause => SensitivityError::Wear(cause.to_string()),
    })
}

/// How far a life may be off, as a part of it: by its wear steps, by turns that are not steady.
fn error_of(life: &LifeResult) -> f64 {
    let turns = &life.turn_errors;
    life.step_error / life.end.cycles + turns.settling.unwrap_or(0.0) + turns.averaging.unwrap_or(0.0)
}
