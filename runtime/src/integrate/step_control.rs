//! How long steps are: by the errors of the last ones. In: errors, 1 just accepted. Out: lengths. Never knows states.
//!
//! PI control of the step: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, 2nd ed., II.4 (code DOPRI5).

use crate::scalar::Scalar;

pub(super) const SAFETY: f64 = 0.9;
const SHRINK_MOST: f64 = 0.2;
const GROW_MOST: f64 = 10.0;
/// Weight of the previous error in the step control.
const PI_WEIGHT: f64 = 0.04;
/// Steps below this part of the time (or of the whole span) are at the limit of rounding.
const SMALLEST_STEP: f64 = 16.0 * f64::EPSILON;

/// By how much a step may grow, from the error of the step before and its own; `order`: that of the error estimate, plus one.
pub(super) fn growth(order: f64, last_error: f64, error: f64) -> f64 {
    SAFETY * libm::pow(last_error, PI_WEIGHT) / libm::pow(error, 1.0 / order - 0.75 * PI_WEIGHT)
}

/// An error, or the least that counts: of none, no length would follow.
#[inline(always)]
pub(crate) fn floored<T: Scalar>(error: T) -> T {
    error.max(T::constant(1e-10))
}

/// Chooses the lengths of steps.
#[derive(Clone, Debug)]
pub(crate) struct StepControl {
    /// Order of the error estimate, plus one.
    order: f64,
    /// See [`growth`].
    growth: fn(f64, f64) -> f64,
    longest_step: f64,
    span: f64,
    /// Beginning of the last accepted step.
    before: f64,
    t: f64,
    /// The next step to try.
    step: f64,
    last_step: f64,
    last_error: f64,
    just_rejected: bool,
    rejected: u64,
}

impl StepControl {
    /// From one time to another.
    pub(super) fn new(
        (order, growth): (f64, fn(f64, f64) -> f64),
        (t, end): (f64, f64),
        longest_step: f64,
    ) -> Self {
        Self {
            order,
            growth,
            longest_step: longest_step.min(end - t),
            span: end - t,
            before: t,
            t,
            step: 0.0,
            last_step: 0.0,
            last_error: 1e-4,
            just_rejected: false,
            rejected: 0,
        }
    }

    /// Time reached.
    pub(crate) fn t(&self) -> f64 {
        self.t
    }

    /// Time at the beginning of the last accepted step.
    pub(crate) fn before(&self) -> f64 {
        self.before
    }

    /// Length of the last accepted step.
    pub(super) fn last_step(&self) -> f64 {
        self.last_step
    }

    /// Error of the last accepted step, as the next one is judged by it.
    pub(crate) fn last_error(&self) -> f64 {
        self.last_error
    }

    /// Steps tried and not accepted.
    pub(crate) fn rejected(&self) -> u64 {
        self.rejected
    }

    pub(super) fn longest_step(&self) -> f64 {
        self.longest_step
    }

    /// The next step to try: at most the longest.
    pub(super) fn set_step(&mut self, step: f64) {
        self.step = step.min(self.longest_step);
    }

    /// Length and end of the step to try, never beyond `end` and onto it exactly.
    pub(crate) fn propose(&self, end: f64) -> (f64, f64) {
        let left = end - self.t;
        // A last crumb of a step would be all rounding: stretch this one.
        let last = 1.01 * self.step >= left;
        let step = if last { left } else { self.step };
        (step, if last { end } else { self.t + step })
    }

    /// Whether no shorter step makes sense.
    pub(crate) fn is_smallest(&self, length: f64) -> bool {
        length <= SMALLEST_STEP * self.span.max(self.t.abs())
    }

    /// A step was too long by its error, above 1.
    pub(crate) fn reject(&mut self, length: f64, error: f64) {
        self.shorten(length, (SAFETY * libm::pow(error, -1.0 / self.order)).max(SHRINK_MOST));
    }

    /// A step did not succeed: the next one is this part of it.
    pub(super) fn shorten(&mut self, length: f64, part: f64) {
        self.step = length * part;
        self.just_rejected = true;
        self.rejected += 1;
    }

    /// A step counts; `noisy`: its error is rounding, and tells nothing of a longer one.
    pub(super) fn accept(&mut self, step: (f64, f64), error: f64, noisy: bool) {
        let error = floored(error);
        let growth = if noisy { 1.0 } else { (self.growth)(self.last_error, error) };
        self.accept_grown(step, error, growth);
    }

    /// The same, if it is known by how much the next one may be longer; `error`: not below the least that counts.
    pub(super) fn accept_grown(&mut self, (length, end): (f64, f64), error: f64, growth: f64) {
        (self.before, self.t, self.last_step) = (self.t, end, length);
        let most = if self.just_rejected { 1.0 } else { GROW_MOST };
        self.step = (length * growth.clamp(SHRINK_MOST, most)).min(self.longest_step);
        self.last_error = error.max(1e-4);
        self.just_rejected = false;
    }

    /// Back to the beginning of the last accepted step. A shorter one that counts in its place lets none be longer than the
    /// one that would have come next.
    pub(super) fn take_back(&mut self) -> Longest {
        self.t = self.before;
        self.just_rejected = true;
        Longest(self.step)
    }

    /// Goes on from another time than that of the last step, with steps of the length that it would have proposed.
    pub(super) fn go_on_from(&mut self, t: f64) {
        (self.before, self.t, self.last_step) = (t, t, 0.0);
    }

    /// Shows every number that it stands on.
    pub(super) fn visit_memory(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        let mut rejected = f64::from(u8::from(self.just_rejected));
        let Self { before, t, step, last_step, last_error, .. } = self;
        [before, t, step, last_step, last_error, &mut rejected].into_iter().for_each(visit);
        self.just_rejected = rejected != 0.0;
    }

    /// Of a step that was taken again.
    pub(super) fn limit(&mut self, Longest(step): Longest) {
        self.step = self.step.min(step);
    }
}

/// The next step before one was taken back.
pub(super) struct Longest(f64);
