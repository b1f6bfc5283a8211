//! The mean path of wear over a cycle, or over several in one step. In: joints at its begin, the fine scale.
//! Out: mean increments at any time of it, an estimate of their error. Never knows draws, thresholds or records.
//!
//! Bogacki and Shampine's pair of order 3 and 2 (Appl. Math. Lett. 2 (1989) 321-325): its last stage is the first of
//! the next step, which is what counts when a stage costs revolutions of the dynamics.

use super::asked::{measure, measure_each};
use super::control::Control;
use super::curve::Measured;
use super::error::LifeError;
use super::interpolate::{at, cubic};
use super::joint::{Feedback, JointLife};
use super::settings::{LifeSettings, WearStep};
use super::source::{JointWear, WearSource};
use super::worn::WearState;
use crate::wear::{ContactMeasure, Profile};

/// Mean increments since the start of a path: per joint the depth [m], then the bins of its profile [m].
pub(super) type Increments = Vec<f64>;

/// One step of a path: a cubic between two measurements. Times in cycles.
pub(super) struct Segment {
    pub(super) start: f64,
    pub(super) length: f64,
    pub(super) from: Increments,
    pub(super) to: Increments,
    pub(super) from_rate: Increments,
    pub(super) to_rate: Increments,
}

/// A finished path.
pub(super) struct Path {
    pub(super) segments: Vec<Segment>,
    /// Whole cycles that it covers.
    pub(super) span: u64,
    /// What a revolution wears at its end; unknown if geometry was constant.
    pub(super) end: Option<Vec<ContactMeasure>>,
    /// Estimated error per joint [cycles].
    pub(super) error: Vec<f64>,
    /// What was measured on its way, with the times [cycles]; nothing where that is what stands at its begin alone.
    pub(super) seen: Vec<(f64, Vec<ContactMeasure>)>,
}

impl Path {
    /// Whether it leads anywhere, and nowhere back.
    pub(super) fn is_finite(&self) -> bool {
        let onward = |to: &f64| to.is_finite() && *to >= 0.0;
        self.segments.iter().all(|segment| segment.to.iter().chain(&segment.to_rate).all(onward))
    }

    /// Increments at a time in cycles after its begin.
    pub(super) fn at(&self, time: f64) -> Increments {
        self.segment(time).map_or_else(Vec::new, |segment| segment.at(time))
    }

    /// What a cycle adds to them at that time.
    pub(super) fn rates(&self, time: f64) -> Increments {
        self.segment(time).map_or_else(Vec::new, |segment| segment.rates(time))
    }

    fn segment(&self, time: f64) -> Option<&Segment> {
        self.segments.get(self.segments.partition_point(|segment| segment.start < time).max(1) - 1)
    }
}

impl Segment {
    fn at(&self, time: f64) -> Increments {
        let part = (time - self.start) / self.length;
        // Rounding of equal steps must not part the end from what was measured there.
        if part >= 1.0 - 1e-9 {
            return self.to.clone();
        }
        (0..self.from.len()).map(|i| at(&self.cubic(i), part)).collect()
    }

    fn rates(&self, time: f64) -> Increments {
        let part = (time - self.start) / self.length;
        let rate = |i: usize| {
            let [a, b, c, _] = self.cubic(i);
            ((3.0 * a * part + 2.0 * b) * part + c) / self.length
        };
        (0..self.from.len()).map(rate).collect()
    }

    fn cubic(&self, i: usize) -> [f64; 4] {
        cubic((self.from[i], self.length * self.from_rate[i]), (self.to[i], self.length * self.to_rate[i]))
    }
}

/// A step: its path, and what a revolution wears at its begin.
pub(super) type Step = (Path, Vec<ContactMeasure>);

/// Walks along the mean path from where the joints are.
pub(super) struct Walker<'a, F: WearSource> {
    pub(super) settings: &'a LifeSettings,
    pub(super) fine: &'a mut F,
    /// Joints at the start.
    pub(super) base: &'a [WearState],
    /// State of the fine scale, after every accepted step.
    pub(super) state: F::State,
    /// Whole cycles before the path.
    pub(super) cycle: u64,
    pub(super) measurements: u64,
    /// What the last steps have measured, joint by joint, the latest first, where steps remember it.
    pub(super) earlier: Vec<Vec<Measured>>,
}

/// A step that was tried.
struct Trial<S> {
    to: Increments,
    measured: Vec<ContactMeasure>,
    state: S,
    /// Error over gain.
    ratio: f64,
    error: Vec<f64>,
    /// Its measurements, joint by joint.
    seen: Vec<Vec<Measured>>,
}

impl<F: WearSource> Walker<'_, F> {
    /// What a revolution wears after these increments.
    pub(super) fn measure(
        &mut self,
        increments: &[f64],
        state: &mut F::State,
    ) -> Result<Vec<ContactMeasure>, LifeError<F::Error>> {
        let joints = self.worn(increments);
        self.measurements += 1;
        measure(self.settings, self.fine, &joints, state, self.cycle + 1)
    }

    /// What revolutions wear after each of these increments, each from a state of its own.
    pub(super) fn measure_each(
        &mut self,
        increments: &[Increments],
        states: &mut [F::State],
    ) -> Result<Vec<Vec<ContactMeasure>>, LifeError<F::Error>> {
        let joints: Vec<Vec<JointWear>> = increments.iter().map(|one| self.worn(one)).collect();
        self.measurements += joints.len() as u64;
        measure_each(self.settings, self.fine, &joints, states, self.cycle + 1)
    }

    /// The joints after these increments, as the fine scale has to know them.
    fn worn(&self, increments: &[f64]) -> Vec<JointWear> {
        let worn = |((joint, increment), base): ((&JointLife, &[f64]), &WearState)| {
            let WearState { clearance, wear, profile, journal, .. } = joint.after(base, increment, 1.0);
            let fed_back = |profile: Option<Profile>| profile.filter(|_| joint.feedback == Feedback::Profile);
            JointWear { clearance, wear, profile: fed_back(profile), journal: fed_back(journal) }
        };
        self.settings.parts(increments).zip(self.base).map(worn).collect()
    }

    /// The same of the motion that goes on from there.
    pub(super) fn go_on_to(
        &mut self,
        increments: &[f64],
    ) -> Result<Vec<ContactMeasure>, LifeError<F::Error>> {
        let mut state = self.state.clone();
        let measured = self.measure(increments, &mut state)?;
        self.state = state;
        Ok(measured)
    }

    /// The path from a measurement at its begin over the cycles of one step, at most `most`, or over one cycle.
    pub(super) fn follow(
        &mut self,
        start: &[ContactMeasure],
        control: &mut Control,
        most: u64,
    ) -> Result<Path, LifeError<F::Error>> {
        let rates = rates(self.settings, start);
        let nothing = vec![0.0; rates.len()];
        let WearStep::Adaptive { tolerance, shortest, longest, remembers } = self.settings.step else {
            let (from_rate, to_rate) = (rates.clone(), rates.clone());
            let segment = Segment { start: 0.0, length: 1.0, from: nothing, to: rates, from_rate, to_rate };
            let error = vec![0.0; self.base.len()];
            return Ok(Path { segments: vec![segment], span: 1, end: None, error, seen: Vec::new() });
        };
        // A jump of several cycles is one step.
        let mut span = (control.step.floor() as u64).clamp(1, most.min(longest).max(1));
        let remembers = remembers && self.has_numbers_alone();
        if remembers && self.earlier.len() == rates.len() {
            let (path, ratio) = self.along_curves(&rates, span)?;
            let before = *control;
            if path.is_finite() && control.accepts(ratio, span as f64, None, (tolerance, shortest)) {
                return Ok(path);
            }
            *control = before;
        }
        let error = vec![0.0; self.base.len()];
        let mut path = Path { segments: Vec::new(), span, end: None, error, seen: Vec::new() };
        let (mut time, mut from, mut from_rate) = (0.0, nothing, rates);
        let mut refused: Option<(f64, f64)> = None;
        loop {
            let left = span as f64 - time;
            // Equal steps to the end; a hair of slack keeps rounding from adding one.
            let length = left / ((left / control.step.max(shortest) - 1e-9).ceil().max(1.0));
            let trial = self.attempt(&from, &from_rate, length)?;
            if !control.accepts(trial.ratio, length, refused, (tolerance, shortest)) {
                refused = Some((length, trial.ratio));
                span = span.min((control.step.floor() as u64).max(1));
                path.span = span;
                continue;
            }
            refused = None;
            let to_rate = self::rates(self.settings, &trial.measured);
            path.segments.push(Segment {
                start: time,
                length,
                from: core::mem::replace(&mut from, trial.to.clone()),
                to: trial.to,
                from_rate: core::mem::replace(&mut from_rate, to_rate.clone()),
                to_rate,
            });
            path.error.iter_mut().zip(&trial.error).for_each(|(sum, more)| *sum += more);
            if remembers {
                self.remember(trial.seen);
            }
            self.state = trial.state;
            // The last of equal steps ends there, up to rounding.
            time += length;
            if span as f64 - time < 1e-9 {
                path.end = Some(trial.measured);
                return Ok(path);
            }
        }
    }

    /// One step of the pair.
    fn attempt(
        &mut self,
        from: &[f64],
        k1: &[f64],
        length: f64,
    ) -> Result<Trial<F::State>, LifeError<F::Error>> {
        let mut state = self.state.clone();
        let moved = |rate: &dyn Fn(usize) -> f64| -> Increments {
            from.iter().enumerate().map(|(i, value)| value + length * rate(i)).collect()
        };
        let first = moved(&|i| 0.5 * k1[i]);
        let measured = self.measure(&first, &mut state)?;
        let k2 = rates(self.settings, &measured);
        let second = moved(&|i| 0.75 * k2[i]);
        let measured = self.measure(&second, &mut state)?;
        let k3 = rates(self.settings, &measured);
        let to = moved(&|i| (2.0 * k1[i] + 3.0 * k2[i] + 4.0 * k3[i]) / 9.0);
        let measured = self.measure(&to, &mut state)?;
        let k4 = rates(self.settings, &measured);
        // The pair's own estimate goes with the third derivative alone. Wear that goes with the root of the
        // clearance (Hertz) has none, although steps err; a second difference of the stages sees it. Its factor
        // makes both equal for wear that is linear in the clearance.
        let error = |i: usize| {
            let own = -5.0 / 72.0 * k1[i] + k2[i] / 12.0 + k3[i] / 9.0 - k4[i] / 8.0;
            let second = (k1[i] - 2.0 * k2[i] + k4[i]) / 24.0;
            length * own.abs().max(second.abs())
        };
        let errors: Increments = (0..to.len()).map(error).collect();
        let gains: Increments = to.iter().zip(from).map(|(to, from)| to - from).collect();
        let (error, ratio) = self.judge(&errors, &gains, length);
        let seen = |(joint, base): (usize, &WearState)| {
            let at = |increment: f64, rate| Measured { wear: base.wear + increment, rate };
            let inner = [at(first[joint], k2[joint]), at(second[joint], k3[joint])];
            vec![at(from[joint], k1[joint]), inner[0], inner[1], at(to[joint], k4[joint])]
        };
        let seen = self.base.iter().enumerate().map(seen).collect();
        Ok(Trial { to, measured, state, ratio, error, seen })
    }

    /// Error per joint in cycles, and the largest error of W over the largest gain, both as parts of the thresholds:
    /// a joint that hardly wears does not set the step.
    ///
    /// An error of W early in life grows with the rate of wear, the same error as a time does not: it can be summed.
    pub(super) fn judge(&self, errors: &[f64], gains: &[f64], length: f64) -> (Vec<f64>, f64) {
        let largest = |values: &[f64]| values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        let mut per_joint = Vec::with_capacity(self.base.len());
        let (mut error, mut gain) = (0.0_f64, 0.0_f64);
        for ((joint, errors), (_, gains)) in self.settings.parts(errors).zip(self.settings.parts(gains)) {
            let (wrong, gained) = (largest(joint.decisive(errors)), largest(joint.decisive(gains)));
            error = error.max(wrong / joint.threshold);
            gain = gain.max(gained / joint.threshold);
            per_joint.push(if gained > 0.0 { wrong / gained * length } else { 0.0 });
        }
        (per_joint, if gain > 0.0 { error / gain } else { 0.0 })
    }
}

/// Mean increments per cycle.
pub(super) fn rates(settings: &LifeSettings, measured: &[ContactMeasure]) -> Increments {
    let mut rates = Vec::with_capacity(settings.width());
    for (joint, wear) in settings.joints.iter().zip(measured) {
        rates.push(joint.revolutions_per_cycle * wear.depth);
        if let (Some(_), Some(profile)) = (joint.bins, &wear.deposit) {
            rates.extend(profile.depths().iter().map(|depth| joint.revolutions_per_cycle * depth));
        }
        if let (Some(_), Some(journal)) = (joint.journal_bins, &wear.journal) {
            rates.extend(journal.depths().iter().map(|depth| joint.revolutions_per_cycle * depth));
        }
    }
    rates
}
