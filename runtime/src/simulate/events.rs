//! Locates where gaps close within an adaptive step, and ends the step there. In: an accepted step and the contacts
//! at its begin. Out: the step, shortened where needed. Never knows forces.
//!
//! A gap that closes changes the equations; a step across mixes both sides, and the speed at which it closed is the
//! initial value of the contact. Gap and rate at both ends of a step give a cubic; where it says that a gap
//! closes (or that a contact opens and closes again), the dense output of the step is searched.

use super::motion::ConstrainedMotion;
use super::sampler::Sampler;
use crate::clearance_joint::ContactState;
use crate::contact::Course;
use crate::error::RunError;
use crate::integrate::{Adaptive, Method};

/// Accuracy of a located onset, as a part of the step.
const LOCATED: f64 = 1e-12;
/// Onsets in this first part of a step belong to its begin.
const AT_BEGIN: f64 = 1e-9;

/// What happens in a step first.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Event {
    /// Part of the step at which it happens.
    at: f64,
    /// The contact whose gap closes there; nothing if a contact only opened for a while.
    closing: Option<usize>,
}

/// Ends the last step of `method` where the first gap closes within it.
pub(super) fn stop_at_contact<M: Method>(
    motion: &mut ConstrainedMotion<'_>,
    sampler: &mut Sampler<'_>,
    method: &mut Adaptive<M>,
    between: &mut [f64],
) -> Result<(), RunError> {
    while let Some(event) = first_event(motion, sampler, method, between) {
        sampler.closing = event.closing;
        if event.at >= 1.0 {
            break;
        }
        let t = method.before() + event.at * (method.t() - method.before());
        method.retake(motion, t)?;
        if method.t() >= t {
            break;
        }
        // Its error had it end earlier still: what it leads to is another motion.
        sampler.closing = None;
    }
    Ok(())
}

/// What happens to a contact in the last step first.
fn first_event<M: Method>(
    motion: &mut ConstrainedMotion<'_>,
    sampler: &Sampler<'_>,
    method: &Adaptive<M>,
    between: &mut [f64],
) -> Option<Event> {
    let follower = sampler.follower.as_ref()?;
    let (begin, length) = (method.before(), method.t() - method.before());
    let mut first: Option<Event> = None;
    for (joint, before) in follower.contacts.iter().enumerate() {
        let Some(suspect) = suspect(motion, method, (joint, before)) else { continue };
        let mut penetration = |part: f64| -> f64 {
            method.interpolate(begin + part * length, between);
            motion.penetration(joint, begin + part * length, between)
        };
        if let Some(event) = suspect.event(joint, &mut penetration)
            && first.is_none_or(|first| event.at < first.at)
        {
            first = Some(event);
        }
        // The search left the contacts at other places of the step.
        evaluate_end(motion, method);
    }
    first
}

/// Whether the last step may have to end earlier: then its dense output is searched.
pub(super) fn is_suspect<M: Method>(
    motion: &mut ConstrainedMotion<'_>,
    sampler: &Sampler<'_>,
    method: &Adaptive<M>,
) -> bool {
    let Some(follower) = &sampler.follower else { return false };
    follower.contacts.iter().enumerate().any(|begun| suspect(motion, method, begun).is_some())
}

/// What may happen to a joint in the last step, by its contact at both ends.
fn suspect<M: Method>(
    motion: &mut ConstrainedMotion<'_>,
    method: &Adaptive<M>,
    (joint, before): (usize, &ContactState),
) -> Option<Suspect> {
    evaluate_end(motion, method);
    let clearances = motion.dynamics.evaluator.clearances();
    let touching = clearances.states()[joint].memory.touching > 0.5;
    let length = method.t() - method.before();
    let end = |touch: &ContactState| (touch.penetration(), touch.penetration_rate);
    may_happen(&Course::new(end(before), end(&clearances.contacts()[joint]), length), touching)
}

/// Evaluates the contacts at the end of the last step.
fn evaluate_end<M: Method>(motion: &mut ConstrainedMotion<'_>, method: &Adaptive<M>) {
    let (q, v, _) = motion.split(method.y());
    motion.dynamics.evaluator.evaluate_contacts(method.t(), q, v);
}

/// What may happen in a step by the course of a penetration; `touching`: a contact runs at its start, also if its penetration is
/// still zero there but for rounding. Where [`Course::may_change`] says that nothing does, it is nothing.
fn may_happen(course: &Course<f64>, touching: bool) -> Option<Suspect> {
    let Course { from, to, from_rate, to_rate } = *course;
    let turns = (from_rate > 0.0) != (to_rate > 0.0) && !course.keeps_its_side();
    match (touching, to > 0.0) {
        (false, true) if from < 0.0 => Some(Suspect::Closes),
        (false, false) if turns && from_rate > 0.0 && from < 0.0 => {
            let top = course.turning_point();
            (course.at(top) > 0.0).then_some(Suspect::Touches { top })
        }
        (true, true) if turns && from_rate < 0.0 => {
            let bottom = course.turning_point();
            (course.at(bottom) < 0.0).then_some(Suspect::Opens { bottom })
        }
        _ => None,
    }
}

/// What may happen in a step.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Suspect {
    /// A gap closes.
    Closes,
    /// It closes and opens again around this part.
    Touches { top: f64 },
    /// A contact opens and closes again around this part.
    Opens { bottom: f64 },
}

impl Suspect {
    /// What happens first, by the penetration at parts of the step.
    fn event(self, joint: usize, penetration: &mut dyn FnMut(f64) -> f64) -> Option<Event> {
        match self {
            Self::Closes => close(joint, 1.0, penetration),
            Self::Touches { top } if penetration(top) > 0.0 => close(joint, top, penetration),
            Self::Opens { bottom } if penetration(bottom) < 0.0 => Some(Event { at: bottom, closing: None }),
            Self::Touches { .. } | Self::Opens { .. } => None,
        }
    }
}

/// A gap that closes before part `high` of the step; nothing if that belongs to its begin.
fn close(joint: usize, high: f64, penetration: &mut dyn FnMut(f64) -> f64) -> Option<Event> {
    let at = root(high, penetration);
    (at > AT_BEGIN).then_some(Event { at, closing: Some(joint) })
}

/// Where the penetration gets above zero between the start of the step and `high`.
fn root(mut high: f64, penetration: &mut dyn FnMut(f64) -> f64) -> f64 {
    let mut low = 0.0;
    while high - low > LOCATED {
        let middle = 0.5 * (low + high);
        if penetration(middle) > 0.0 {
            high = middle;
        } else {
            low = middle;
        }
    }
    high
}
