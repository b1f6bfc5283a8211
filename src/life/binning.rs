//! How much the binning of a measured series may be wrong: the mean path in half as many bins. In: a study, the life of all its bins.
//! Out: by how much of itself the life differs. Never refuses the life that it judges.

use std::rc::Rc;

use linkwear_runtime::{System, Watch};

use super::error::{Cause, LifeError};
use super::journal::LifeJournal;
use super::mission::Duty;
use super::result::LifeResult;
use super::run::{Plan, joints};
use super::source::{KeptSource, Log};
use super::study::LifeStudy;

impl LifeStudy<'_> {
    /// Writes the difference into the mission of a result. Bins that are wide may have a mean at which the mechanism cannot run, as
    /// those of a motion to and fro at rest: then the difference is not known, and a warning says why.
    pub(super) fn judge_binning(
        &self,
        (result, duty): (&mut LifeResult, &Duty),
        system: &dyn System<f64>,
        log: &Rc<Log<'_>>,
        (journal, told, between): (Option<&LifeJournal>, Watch<'_>, Watch<'_>),
    ) -> Result<(), LifeError> {
        let life = |duty: &Duty, cycles: f64| cycles * duty.seconds_per_revolution().unwrap_or(1.0);
        let in_half = || -> Result<Option<f64>, LifeError> {
            let Some(coarser) = Duty::coarser(self, system)? else { return Ok(None) };
            told.begin("half as many bins");
            let sources = coarser.sources(system, self.revolutions, between)?;
            let plan = Plan::new(self, &coarser, joints(&sources)?, journal, (told, between))?;
            let cycles = plan.mean_end(&mut KeptSource::new(&coarser, sources, log))?;
            Ok(Some(life(&coarser, cycles)))
        };
        let Some(mission) = &mut result.mission else { return Ok(()) };
        match in_half() {
            Ok(other) => {
                let all = life(duty, result.end.cycles);
                mission.binning = other.map(|other| (other / all - 1.0).abs());
            }
            Err(error) if matches!(*error.cause, Cause::Interrupted { .. } | Cause::Journal(_)) => {
                return Err(error);
            }
            Err(error) => result.warnings.push(format!(
                "how much the binning may be wrong is not known: in half as many bins {error}"
            )),
        }
        Ok(())
    }
}
