//! The loop over cycles: measure, follow the mean path, draw, feed back, compare with the threshold.
//! In: settings, fine scale, draw, state. Out: the state further on, records of cycles, the end of the life.
//! Never knows whether the fine scale is a table or the dynamics, nor where random numbers come from.

use std::ops::ControlFlow;
use std::slice;

use super::crossing::first_reached;
use super::error::LifeError;
use super::increment::IncrementModel;
use super::joint::Feedback;
use super::path::{Path, Walker, rates};
use super::settings::LifeSettings;
use super::source::WearSource;
use super::state::{CycleJoint, CycleRecord, FailureEvent, LifeState};
use super::worn::WearState;
use crate::watch::Watch;
use crate::wear::ContactMeasure;

/// How a life that did not fail to run came to rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LifeOutcome {
    /// A joint reached its threshold.
    Failed(FailureEvent),
    /// The watch stopped it; the state goes on from there.
    Cancelled,
    /// It lasts longer than was asked for; the state goes on with a larger limit.
    CycleLimit,
}

/// Runs a trajectory to its end. A state that was saved goes on with the same bits as one that was not.
///
/// The watch hears of every cycle how much of the threshold is used up, and may stop the life; the state is then at the
/// end of the step, which on the mean path can be several cycles.
///
/// # Errors
/// If it cannot go on; the state is that after the last whole step and can be kept.
pub fn run_life<F: WearSource>(
    settings: &LifeSettings,
    fine: &mut F,
    draw: &dyn IncrementModel,
    state: &mut LifeState<F::State>,
    watch: Watch<'_>,
) -> Result<LifeOutcome, LifeError<F::Error>> {
    settings.check()?;
    state.check(settings)?;
    loop {
        if let Some(failure) = state.failure {
            return Ok(LifeOutcome::Failed(failure));
        }
        if state.cycle >= settings.most_cycles {
            return Ok(LifeOutcome::CycleLimit);
        }
        if advance(settings, fine, draw, state, watch)?.is_break() && state.failure.is_none() {
            return Ok(LifeOutcome::Cancelled);
        }
    }
}

/// One step: a cycle, or several on the mean path.
fn advance<F: WearSource>(
    settings: &LifeSettings,
    fine: &mut F,
    draw: &dyn IncrementModel,
    state: &mut LifeState<F::State>,
    watch: Watch<'_>,
) -> Result<ControlFlow<()>, LifeError<F::Error>> {
    let base = state.joints.clone();
    let mut walker = Walker {
        settings,
        fine,
        base: &base,
        state: state.fine.clone(),
        cycle: state.cycle,
        measurements: state.measurements,
        earlier: state.earlier.clone(),
    };
    let mut control = state.control;
    let step = if draw.is_mean() { None } else { walker.by_middle()? };
    let (path, measured) = match step {
        Some(step) => step,
        None => {
            let measured = match state.measured.clone() {
                Some(measured) => measured,
                None => walker.go_on_to(&vec![0.0; settings.width()])?,
            };
            let most =
                reachable(settings, &base, &measured, state.cycle, draw.is_mean().then_some(control.step))?;
            let left = settings.most_cycles.saturating_sub(state.cycle);
            let ahead = if draw.is_mean() { walker.ahead(&measured, left, watch) } else { None };
            let path = match ahead {
                Some(path) => path,
                None => walker.follow(&measured, &mut control, most)?,
            };
            (path, measured)
        }
    };
    let (fine_state, measurements, earlier) = (walker.state, walker.measurements, walker.earlier);

    let cycles = Cycles::of(settings, &base, &path, draw, (state.trajectory, state.cycle))?;
    // From here on nothing fails: the state changes as a whole.
    let begin = (0.0, measured);
    let seen = if path.seen.is_empty() { slice::from_ref(&begin) } else { &path.seen };
    // What was measured beyond the end counts for nothing.
    let within = seen.iter().take_while(|(time, _)| (*time as usize) < cycles.ends.len()).count();
    let seen = &seen[..within];
    for (time, measured) in seen {
        let (gains, _) = &cycles.ends[*time as usize];
        for (joint, wear) in measured.iter().enumerate() {
            let Some(mut seen) = wear.observed else { continue };
            seen.depth_per_cycle = gains[joint];
            let warnings = settings.joints[joint].limits.warnings(&seen);
            warnings.for_each(|warning| state.warn(joint, warning, *time as u64));
        }
    }
    let mut flow = ControlFlow::Continue(());
    for record in cycles.records(settings, &base, state.cycle, (&path, &begin.1)) {
        if watch.report(record.used.min(1.0)).is_break() {
            flow = ControlFlow::Break(());
        }
        if settings.keep_cycles {
            state.cycles.push(record);
        }
    }
    state.failure = cycles.failure;
    state.measured = if cycles.is_mean { path.end } else { None };
    state.cycle += cycles.ends.len() as u64;
    if let Some((_, last)) = cycles.ends.into_iter().next_back() {
        state.joints = last;
    }
    for (joint, error) in state.joints.iter_mut().zip(&path.error) {
        joint.error += error;
    }
    for (at, joint) in state.joints.iter_mut().enumerate() {
        let half_angles = seen.iter().filter_map(|(_, measured)| Some(measured[at].observed?.half_angle));
        let widest = half_angles.fold(0.0, f64::max);
        joint.half_angle = if widest > 0.0 { widest } else { joint.half_angle };
    }
    (state.fine, state.control, state.measurements) = (fine_state, control, measurements);
    state.earlier = earlier;
    Ok(flow)
}

/// Whole cycles that a step may cover, from what a revolution wears now and, on the mean path, the cycles that a step might take by
/// its error. Half the way to failure, so that wear that speeds up does not carry a stage far beyond, where a table ends and a worn
/// joint may not run any more; all of it where wear changes too little over so many cycles.
fn reachable<E>(
    settings: &LifeSettings,
    base: &[WearState],
    measured: &[ContactMeasure],
    cycle: u64,
    step: Option<f64>,
) -> Result<u64, LifeError<E>> {
    let rates = rates(settings, measured);
    let mut life = f64::INFINITY;
    for ((joint, rate), base) in settings.parts(&rates).zip(base) {
        let increment = joint.after(base, rate, 1.0).wear - base.wear;
        if cycle == 0 && increment >= joint.threshold {
            let (joint, threshold) = (joint.joint.clone(), joint.threshold);
            return Err(LifeError::ThresholdBelowFirstIncrement { joint, threshold, increment });
        }
        if joint.decisive(rate).iter().any(|depth| *depth > 0.0) {
            life = life.min((joint.threshold - base.wear) / increment);
        }
    }
    if life == f64::INFINITY && rates.iter().all(|rate| *rate == 0.0) {
        return Err(LifeError::NoWear { cycle: cycle + 1 });
    }
    Ok(step.map_or(1, |step| {
        let part = if step >= life { 1.0 } else { 0.5 };
        (part * life).ceil().max(1.0) as u64
    }))
}

/// What the cycles of a path come to, after the draw.
struct Cycles {
    /// Mean increments dLambda [m] per joint, and the joints, at the end of every cycle.
    ends: Vec<(Vec<f64>, Vec<WearState>)>,
    failure: Option<FailureEvent>,
    /// Whether the end is that of the mean path, where the next measurement stands already.
    is_mean: bool,
}

impl Cycles {
    /// `origin` is the trajectory's number and the cycles done before.
    fn of<E>(
        settings: &LifeSettings,
        base: &[WearState],
        path: &Path,
        draw: &dyn IncrementModel,
        (trajectory, done): (u64, u64),
    ) -> Result<Self, LifeError<E>> {
        let mut cycles = Self { ends: Vec::new(), failure: None, is_mean: true };
        let mut factors = vec![1.0; base.len()];
        let mut known = vec![0.0; settings.width()];
        for cycle in 1..=path.span {
            let increments = path.at(cycle as f64);
            let before = cycles.ends.last().map_or(base, |(_, joints)| joints.as_slice());
            let from = Begins { settings, base, last: before, known: &known };
            let mean = from.worn(&increments, &vec![1.0; base.len()]);
            let gains: Vec<f64> = mean.iter().zip(before).map(|(to, from)| to.wear - from.wear).collect();
            // Without a mean path over several cycles the draw sees every cycle from its own begin.
            if !draw.is_mean() {
                for (joint, gain) in gains.iter().enumerate() {
                    let value = draw.draw(joint, trajectory, done, *gain);
                    if !(value >= 0.0 && value.is_finite()) {
                        let (joint, cycle) = (settings.joints[joint].joint.clone(), done + 1);
                        return Err(LifeError::Drawn { joint, cycle, value });
                    }
                    factors[joint] = if *gain > 0.0 { value / gain } else { 0.0 };
                }
                cycles.is_mean = factors.iter().all(|factor| *factor == 1.0);
            }
            let mut joints = if cycles.is_mean { mean } else { from.worn(&increments, &factors) };
            for ((joint, from), gain) in joints.iter_mut().zip(before).zip(&gains) {
                joint.exposure = from.exposure + gain;
            }
            let failed =
                (0..base.len()).filter(|joint| joints[*joint].wear >= settings.joints[*joint].threshold);
            let crossing = |joint: usize| {
                let time = from.crossing(path, joint, (factors[joint], cycle));
                FailureEvent { joint, cycles: done as f64 + time, whole_cycles: done + cycle }
            };
            cycles.failure = failed.map(crossing).min_by(|a, b| a.cycles.total_cmp(&b.cycles));
            cycles.ends.push((gains, joints));
            if cycles.failure.is_some() {
                break;
            }
            known = increments;
        }
        Ok(cycles)
    }

    fn records<'c>(
        &'c self,
        settings: &'c LifeSettings,
        base: &'c [WearState],
        done: u64,
        (path, begin): (&'c Path, &'c [ContactMeasure]),
    ) -> impl Iterator<Item = CycleRecord> + 'c {
        let record = move |(index, (gains, joints)): (usize, &'c (Vec<f64>, Vec<WearState>))| {
            let before = if index == 0 { base } else { self.ends[index - 1].1.as_slice() };
            let measured = revolution(settings, path, begin, index as f64);
            let joint = |at: usize| CycleJoint {
                clearance: before[at].clearance,
                mean_increment: gains[at],
                increment: joints[at].wear - before[at].wear,
                wear: joints[at].wear,
                revolution: measured[at].numbers(),
            };
            let used = joints.iter().zip(&settings.joints).map(|(state, joint)| state.wear / joint.threshold);
            CycleRecord {
                cycle: done + index as u64 + 1,
                used: used.fold(0.0, f64::max),
                joints: (0..joints.len()).map(joint).collect(),
            }
        };
        self.ends.iter().enumerate().map(record)
    }
}

/// What a revolution does at a time of a path: as it was measured next to it, with the wear of the path; or at its begin.
fn revolution(
    settings: &LifeSettings,
    path: &Path,
    begin: &[ContactMeasure],
    time: f64,
) -> Vec<ContactMeasure> {
    let far = |(known, _): &&(f64, Vec<ContactMeasure>)| (known - time).abs();
    let Some((_, nearest)) = path.seen.iter().min_by(|a, b| far(a).total_cmp(&far(b))) else {
        return begin.iter().map(ContactMeasure::numbers).collect();
    };
    let mut measured: Vec<_> = nearest.iter().map(ContactMeasure::numbers).collect();
    for ((measured, there), here) in measured.iter_mut().zip(rates(settings, nearest)).zip(path.rates(time)) {
        measured.scale_wear(here / there);
    }
    measured
}

/// Joints at the begin of a path, and at the end of its last cycle with the mean increments up to there.
struct Begins<'a> {
    settings: &'a LifeSettings,
    base: &'a [WearState],
    last: &'a [WearState],
    known: &'a [f64],
}

impl Begins<'_> {
    /// All joints after `factors` times the increments.
    fn worn(&self, increments: &[f64], factors: &[f64]) -> Vec<WearState> {
        factors.iter().enumerate().map(|(at, factor)| self.joint(at, increments, *factor)).collect()
    }

    /// One of them. Wear by angle is taken away in pieces, wherever they begin: those up to the last cycle are gone.
    fn joint(&self, at: usize, increments: &[f64], factor: f64) -> WearState {
        let (joint, own) = self.settings.part(at, increments);
        if joint.feedback != Feedback::Profile {
            return joint.after(&self.base[at], own, factor);
        }
        let (_, known) = self.settings.part(at, self.known);
        let more: Vec<f64> = own.iter().zip(known).map(|(now, known)| now - known).collect();
        joint.after(&self.last[at], &more, factor)
    }

    /// When, in cycles since the start of the path, a joint reached its threshold in the next cycle.
    fn crossing(&self, path: &Path, at: usize, (factor, cycle): (f64, u64)) -> f64 {
        let threshold = self.settings.joints[at].threshold;
        let excess = |time: f64| self.joint(at, &path.at(time), factor).wear - threshold;
        first_reached((cycle - 1) as f64, cycle as f64, excess)
    }
}
