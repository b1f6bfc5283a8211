//! Follows joints with clearance from step to step: what contacts remember, what a turn did to each joint, where
//! wear goes around the bearing, whether steps are fine enough. In: accepted steps. Out: [`ContactMeasure`]s,
//! [`RunWarning`]s. Never knows integrators.

use std::f64::consts::PI;

use super::contact_event::ContactEvent;
use super::motion::{ConstrainedMotion, Totals};
use super::warning::RunWarning;
use crate::clearance_joint::{Clearance, Clearances, ContactState};
use crate::contact_frequency::inverse_mass;
use crate::error::RunError;
use crate::evaluate::Evaluator;
use crate::ledger::{Ledger, Touched, Touches};
use crate::system::CONTACT_WRENCH;
use crate::wear::{ContactMeasure, Observed, Profile};

/// Contact for less than this part of a turn draws a warning.
const RARE: f64 = 0.5;
/// Part of the journal's radius from which a depth is none of contact: the areas of Hertz and the laws of stiffness are
/// those of depths far below the radius.
const TOO_DEEP: f64 = 0.1;
/// A penetration this many times that of the last probe makes the effective mass worth asking again.
const PROBE_AGAIN: f64 = 1.1;

/// One joint within the present turn.
struct Track {
    /// Totals at the start of the turn and at the last step.
    begin: Totals,
    last: Totals,
    losses: u64,
    deposit: Option<Profile>,
    /// What the journal lost, by its own angle.
    journal: Option<Profile>,
    probed_penetration: f64,
    frequency: f64,
    /// Whether it touched at the last step.
    touches: bool,
}

/// Follows all joints with clearance of a run.
pub(super) struct Follower {
    tracks: Vec<Track>,
    /// Contacts at the last accepted step.
    pub(super) contacts: Vec<ContactState>,
    t: f64,
    /// When the present turn began [s].
    pub(super) turn_begin: f64,
    probe: Vec<f64>,
    /// What every joint did, turn by turn.
    pub(super) measures: Vec<Vec<ContactMeasure>>,
    /// Whether the present turn was followed from its begin.
    whole_turn: bool,
    /// Contacts that closed or opened, if anybody asks.
    pub(super) events: Option<Vec<ContactEvent>>,
}

impl Follower {
    /// Begins at a state; nothing to follow without clearance.
    pub(super) fn new(motion: &mut ConstrainedMotion<'_>, t: f64, state: &[f64]) -> Option<Self> {
        let evaluator = &motion.dynamics.evaluator;
        if evaluator.clearances().is_empty() {
            return None;
        }
        let track = |joint: &Clearance| Track {
            begin: Totals::default(),
            last: Totals::default(),
            losses: 0,
            deposit: empty_deposit(joint),
            journal: empty_journal(joint),
            probed_penetration: 0.0,
            frequency: 0.0,
            touches: false,
        };
        let mut follower = Self {
            tracks: evaluator.clearances().joints().iter().map(track).collect(),
            contacts: Vec::new(),
            t,
            turn_begin: t,
            probe: vec![0.0; evaluator.sizes().contacts * CONTACT_WRENCH + evaluator.sizes().speeds],
            measures: Vec::new(),
            whole_turn: true,
            events: None,
        };
        let (q, v, _) = motion.split(state);
        motion.dynamics.evaluator.evaluate_contacts(t, q, v);
        follower.contacts = motion.dynamics.evaluator.clearances().contacts().to_vec();
        for (track, totals) in follower.tracks.iter_mut().zip(motion.totals(state)) {
            track.last = totals;
        }
        follower.note_touching(motion);
        follower.probe_frequencies(motion, state);
        Some(follower)
    }

    /// Goes on from a state that was put back; what the present turn has done so far is not known.
    pub(super) fn resume(&mut self, motion: &mut ConstrainedMotion<'_>, t: f64, state: &[f64]) {
        self.look_again(motion, t, state);
        (self.t, self.whole_turn) = (t, false);
        for (track, totals) in self.tracks.iter_mut().zip(motion.totals(state)) {
            track.last = totals;
        }
        self.note_touching(motion);
    }

    /// The contacts of a state whose laws have changed.
    pub(super) fn look_again(&mut self, motion: &mut ConstrainedMotion<'_>, t: f64, state: &[f64]) {
        let (q, v, _) = motion.split(state);
        motion.dynamics.evaluator.evaluate_contacts(t, q, v);
        self.contacts.copy_from_slice(motion.dynamics.evaluator.clearances().contacts());
    }

    fn note_touching(&mut self, motion: &ConstrainedMotion<'_>) {
        let states = motion.dynamics.evaluator.clearances().states();
        for (track, state) in self.tracks.iter_mut().zip(states) {
            track.touches = state.memory.touching > 0.5;
        }
    }

    /// Accumulates an accepted step that ends in `state`, where the contacts were evaluated last; `closing`: a contact whose gap closes
    /// right there.
    ///
    /// # Errors
    /// [`RunError::Penetration`].
    pub(super) fn accept(
        &mut self,
        motion: &mut ConstrainedMotion<'_>,
        t: f64,
        state: &[f64],
        closing: Option<usize>,
    ) -> Result<(), RunError> {
        self.t = t;
        let totals = motion.totals(state);
        let clearances = motion.dynamics.evaluator.clearances_mut();
        clearances.remember(&self.contacts);
        if let Some(joint) = closing {
            clearances.close(joint);
        }
        let joints = clearances.joints().iter().zip(clearances.contacts());
        for (((track, before), (joint, now)), totals) in
            self.tracks.iter_mut().zip(&self.contacts).zip(joints).zip(totals)
        {
            track.accumulate(joint, (before, now), totals);
        }
        for (joint, (track, state)) in self.tracks.iter_mut().zip(clearances.states()).enumerate() {
            let closes = state.memory.touching > 0.5;
            if let Some(events) = &mut self.events
                && closes != track.touches
            {
                events.push(ContactEvent { t, joint, closes });
            }
            track.touches = closes;
        }
        self.contacts.copy_from_slice(clearances.contacts());
        self.probe_frequencies(motion, state);
        self.check_depths(&motion.dynamics.evaluator)
    }

    /// Whether contacts are deeper than laws of contact hold for.
    fn check_depths(&self, evaluator: &Evaluator<'_>) -> Result<(), RunError> {
        let t = self.t;
        let joints = evaluator.clearances().joints().iter().zip(&*evaluator.description().contacts);
        for (touch, (joint, info)) in self.contacts.iter().zip(joints) {
            let (penetration, journal_radius) = (touch.penetration(), joint.journal_radius());
            if penetration > TOO_DEEP * journal_radius {
                let joint = info.joint.to_string();
                return Err(RunError::Penetration { t, joint, penetration, journal_radius });
            }
        }
        Ok(())
    }

    /// Penetration [m] of every joint up to which steps change nothing but what is added up.
    pub(super) fn watched(&self, clearances: &Clearances) -> impl Iterator<Item = f64> {
        let joints = self.tracks.iter().zip(clearances.joints());
        joints.map(|(track, joint)| {
            (PROBE_AGAIN * track.probed_penetration).min(TOO_DEEP * joint.journal_radius())
        })
    }

    /// Takes over steps that others followed, of which the last ended in `state` with these contacts.
    pub(super) fn take_over(
        &mut self,
        motion: &ConstrainedMotion<'_>,
        (t, state): (f64, &[f64]),
        contact: impl Fn(usize, &ContactState) -> ContactState,
    ) {
        self.t = t;
        for (joint, touch) in self.contacts.iter_mut().enumerate() {
            *touch = contact(joint, touch);
        }
        for (track, totals) in self.tracks.iter_mut().zip(motion.totals(state)) {
            track.last = totals;
        }
    }

    /// Forgets what was before: a turn begins here.
    pub(super) fn begin_turn(&mut self, motion: &ConstrainedMotion<'_>, done: &mut [Touches<f64>]) {
        self.turn_begin = self.t;
        let joints = motion.dynamics.evaluator.clearances().joints();
        for ((track, joint), (done, touch)) in
            self.tracks.iter_mut().zip(joints).zip(done.iter_mut().zip(&self.contacts))
        {
            track.begin = track.last;
            track.losses = 0;
            track.deposit = empty_deposit(joint);
            track.journal = empty_journal(joint);
            done.begin_turn(&touched(touch));
        }
    }

    /// A turn ends here: notes what it did, and begins the next one.
    pub(super) fn end_turn(&mut self, motion: &ConstrainedMotion<'_>, done: &mut [Touches<f64>]) {
        let duration = self.t - self.turn_begin;
        let joints = motion.dynamics.evaluator.clearances().joints().iter().zip(&self.contacts);
        let measure = |((track, touches), (joint, touch)): (
            (&mut Track, &Touches<f64>),
            (&Clearance, &ContactState),
        )| {
            let of_turn = track.last.since(track.begin);
            let extremes = &touches.extremes;
            let observed = joint
                .wear()
                .map(|(archard, _)| Observed::of(extremes, archard.area(), &joint.pair(touch.clearance)));
            ContactMeasure {
                wear_integral: of_turn.wear,
                depth: of_turn.depth,
                mean_force: of_turn.impulse / duration,
                peak_force: extremes.normal_force,
                losses: track.losses as f64,
                touching: (touches.touching / duration).min(1.0),
                loss: of_turn.loss,
                deposit: track.deposit.take(),
                journal: track.journal.take(),
                observed,
            }
        };
        let measures = self.tracks.iter_mut().zip(&*done).zip(joints).map(measure).collect();
        if self.whole_turn {
            self.measures.push(measures);
        }
        self.whole_turn = true;
        self.begin_turn(motion, done);
    }

    /// What of the run is doubtful.
    pub(super) fn warnings(
        &self,
        evaluator: &Evaluator<'_>,
        ledger: &Ledger<f64>,
        limits: Option<(f64, f64)>,
    ) -> Vec<RunWarning> {
        let mut warnings = Vec::new();
        for (joint, (track, done)) in self.tracks.iter().zip(&ledger.joints).enumerate() {
            let name = || evaluator.description().contacts[joint].joint.to_string();
            let (step, frequency) = (ledger.longest_step, track.frequency);
            if let Some((accurate, stable)) = limits
                && step * frequency > accurate
            {
                warnings.push(RunWarning::StepTooCoarse { joint: name(), step, frequency, accurate, stable });
            }
            let (penetration, t, clearance) = (done.deepest, done.deepest_at, self.contacts[joint].clearance);
            if penetration > clearance {
                warnings.push(RunWarning::DeepContact { joint: name(), t, penetration, clearance });
            }
            let parts = self.measures.iter().map(|turn| turn[joint].touching).enumerate();
            let rarest = parts.min_by(|(_, a), (_, b)| a.total_cmp(b));
            if let Some((index, touching_part)) = rarest
                && touching_part < RARE
            {
                let turn = index as u64 + 1;
                warnings.push(RunWarning::ContactLost { joint: name(), turn, touching_part });
            }
        }
        warnings
    }

    /// Asks for the frequency of every contact that is deeper than it has ever been.
    fn probe_frequencies(&mut self, motion: &mut ConstrainedMotion<'_>, state: &[f64]) {
        let (q, v, _) = motion.split(state);
        for (joint, (track, touch)) in self.tracks.iter_mut().zip(&self.contacts).enumerate() {
            if touch.penetration() > PROBE_AGAIN * track.probed_penetration {
                track.probed_penetration = touch.penetration();
                let evaluator = &mut motion.dynamics.evaluator;
                let inverse = inverse_mass(evaluator, (self.t, q, v), (joint, touch), &mut self.probe);
                let tangent_stiffness = evaluator.clearances().joints()[joint].tangent_stiffness(touch);
                let frequency = (tangent_stiffness * inverse).sqrt();
                // Lost numbers stop a run elsewhere.
                if frequency.is_finite() {
                    track.frequency = track.frequency.max(frequency);
                }
            }
        }
    }
}

/// What a contact shows at the end of a step.
pub(super) fn touched(touch: &ContactState) -> Touched<f64> {
    Touched { load: Clearance::load(touch), pressure: touch.pressure }
}

impl Track {
    fn accumulate(
        &mut self,
        joint: &Clearance,
        (before, now): (&ContactState, &ContactState),
        totals: Totals,
    ) {
        let done = totals.since(self.last);
        self.last = totals;
        self.losses += u64::from(before.gap < 0.0 && now.gap >= 0.0);
        let Some((archard, _)) = joint.wear() else { return };
        let volume = archard.volume_rate() * done.wear * mean_factor(before, now);
        if let Some(deposit) = &mut self.deposit
            && done.wear != 0.0
        {
            let radius = joint.journal_radius() + now.clearance;
            let amount = volume / (radius * joint.length());
            spread(deposit, joint, (before, now), (ContactState::angle, amount));
        }
        if let (Some(journal), Some(ratio)) = (&mut self.journal, joint.journal_ratio())
            && done.wear != 0.0
        {
            let surface = joint.journal_radius() * joint.length();
            let amount = ratio * volume / surface;
            spread(journal, joint, (before, now), (ContactState::journal_angle, amount));
        }
    }
}

/// Profile that collects the depth of one turn, if the joint keeps one.
fn empty_deposit(joint: &Clearance) -> Option<Profile> {
    let (_, wear) = joint.wear()?;
    if wear.keeps_profile() { Profile::unworn(wear.bins).ok() } else { None }
}

/// Factor on the wear coefficient in a step, by the work of friction at both ends: its error is of second order in the step.
fn mean_factor(before: &ContactState, now: &ContactState) -> f64 {
    let Some((first, last)) = before.wear_factor.zip(now.wear_factor) else { return 1.0 };
    let work = before.wear_power + now.wear_power;
    // A contact that came and went within a step is told by neither end.
    if work > 0.0 { (first * before.wear_power + last * now.wear_power) / work } else { 1.0 }
}

/// The same of a journal that wears.
fn empty_journal(joint: &Clearance) -> Option<Profile> {
    let (_, wear) = joint.wear()?;
    joint.journal_ratio().and_then(|_| Profile::unworn(wear.bins).ok())
}

/// Spreads the wear of a step, volume over radius and length [m rad], over the angles of bearing or journal that the contact passed
/// in it.
///
/// The amount is the integral of the step by the method itself, so the sum over all angles has its order. The
/// place is taken as linear in time in pieces of at most half a bin: off by less than the width of a bin.
fn spread(
    deposit: &mut Profile,
    joint: &Clearance,
    (before, now): (&ContactState, &ContactState),
    (angle, amount): (fn(&ContactState) -> f64, f64),
) {
    let Some((archard, _)) = joint.wear() else { return };
    let half_angle = |touch: &ContactState| {
        archard.area().half_angle(&Clearance::load(touch), &joint.pair(touch.clearance))
    };
    let touching = |touch: &ContactState| touch.gap < 0.0;
    let (from, to) = match (touching(before), touching(now)) {
        (false, true) => (now, now),
        (true, false) => (before, before),
        _ => (before, now),
    };
    let from_angle = angle(from);
    let arc = (angle(to) - from_angle + PI).rem_euclid(2.0 * PI) - PI;
    let pieces = (2.0 * arc.abs() / deposit.bin_angle()).ceil().max(1.0);
    let (first, last) = (half_angle(from), half_angle(to));
    for piece in 0..pieces as usize {
        let part = (piece as f64 + 0.5) / pieces;
        deposit.deposit(from_angle + part * arc, first + part * (last - first), amount / pieces);
    }
}
