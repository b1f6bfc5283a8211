//! The end of a run. In: what was recorded and added up. Out: a [`Run`], with what there is to warn of.

use super::Sampler;
use crate::error::RunError;
use crate::ledger::Ledger;
use crate::simulate::extremes::{Collector, Peak};
use crate::simulate::guard::is_doubtful;
use crate::simulate::motion::ConstrainedMotion;
use crate::simulate::run::{Run, Statistics};
use crate::simulate::warning::{self, RunWarning};

impl Sampler<'_> {
    /// Gives the recorded samples away; `limits`: see [`warning::step_limits`].
    pub(in crate::simulate) fn finish(
        mut self,
        motion: &ConstrainedMotion<'_>,
        limits: Option<(f64, f64)>,
        stopped: Option<RunError>,
    ) -> Run {
        self.statistics.evaluations += motion.dynamics.evaluations;
        self.statistics.rank_revealing_solves = motion.dynamics.rank_revealing_solves;
        self.statistics.projections = motion.projections;
        let Ledger { balance, open, .. } = &self.ledger;
        (self.statistics.energy_error_J, self.statistics.energy_throughput_J) =
            (balance.error, balance.throughput);
        [self.statistics.max_loop_error_m, self.statistics.max_loop_error_rad] = *open;
        if let (Some(looks), Some(extremes)) = (&mut self.looks, &mut self.extremes) {
            looks.finish(extremes);
        }
        let (extremes, peaks) = self.extremes.take().map(Collector::finish).unwrap_or_default();
        let mut run = Run {
            extremes,
            peaks,
            channels: self.columns.channels,
            times: self.times,
            rows: self.rows,
            statistics: self.statistics,
            stopped,
            ..Run::default()
        };
        if let Some(follower) = self.follower {
            run.warnings = follower.warnings(&motion.dynamics.evaluator, &self.ledger, limits);
            run.turns = follower.measures;
        }
        run.warnings.extend(self.bends.warnings());
        run.warnings.extend(peak_between(&run));
        run.warnings.extend(self.unbounded.warnings(&run.channels));
        run.warnings.extend(warning::rounded_angle(motion.angles(&self.reached.1)));
        if run.stopped.is_none() && is_doubtful(&self.ledger, motion.worn(&self.reached.1)) {
            let Statistics { energy_error_J: error, energy_throughput_J: throughput, .. } = run.statistics;
            run.warnings.push(RunWarning::EnergyOff { error, throughput });
        }
        run
    }
}

/// Part of a peak by which rows may exceed it: looks at steps, and at 240 places of a turn, miss less of a force that they resolve.
const MISSED: f64 = 0.1;
/// Part of the largest peak below which a force may be rounding.
const ROUNDING: f64 = 1e-3;

/// The row whose force exceeds the peak of its joint most, if one does.
fn peak_between(run: &Run) -> Option<RunWarning> {
    let place = |name: String| run.channels.iter().position(|channel| channel.name == name);
    let largest = run.peaks.iter().fold(0.0_f64, |most, peak| most.max(peak.force.value));
    let of_joint = |peak: &Peak| {
        let [x, y, z] = ["x", "y", "z"].map(|axis| place(format!("{}.F{axis}", peak.joint)));
        let places = [x?, y?, z?];
        let size = |row: &Vec<f64>| places.iter().map(|place| row[*place] * row[*place]).sum::<f64>().sqrt();
        let forces = run.times.iter().zip(run.rows.iter().map(size)).filter(|(_, force)| force.is_finite());
        let (t, force) = forces.max_by(|a, b| a.1.total_cmp(&b.1))?;
        let (joint, peak) = (peak.joint.clone(), peak.force.value);
        let is_missed = force > (1.0 + MISSED) * peak && force > ROUNDING * largest;
        is_missed.then_some((force / peak, RunWarning::PeakBetween { joint, t: *t, force, peak }))
    };
    let missed = run.peaks.iter().filter_map(of_joint).max_by(|a, b| a.0.total_cmp(&b.0));
    missed.map(|(_, warning)| warning)
}
