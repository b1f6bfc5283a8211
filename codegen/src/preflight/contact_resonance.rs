//! Contacts that vibrate near frequencies of flexible bodies, kept or left out.
//! In: a mechanism, its equations, positions of its motion. Out: warnings. Never knows the laws of contact.

use linkwear_runtime::{Evaluator, Layout, State, contact_frequencies, resting_contacts};

use crate::diagnostic::{Code, Diagnostic};
use crate::model::{Body, Carrier, Mechanism};

use super::course::Waypoint;
use super::resonance::frequencies;

/// Distances below this share of a frequency are near: a contact that loses a tenth of its speed in a bounce is damped by
/// 0.03 of the critical damping, so that it answers strongly within 3 % of its frequency, which is told as well as that.
const NEAR: f64 = 0.05;
/// Positions looked at: 15 degrees of a turn apart, in which forces hardly change by more than bounces do.
const POSITIONS: usize = 24;

/// Frequencies [Hz] of one contact where it rests, with the times [s].
type Heard = Vec<(f64, f64)>;

/// Warns for every flexible body with a frequency near to that of a contact that rests: at the start, and at positions of the
/// motion if `waypoints` has them.
pub fn contacts_near_modes(
    mechanism: &Mechanism,
    (mut evaluator, start): (Evaluator<'_>, State),
    waypoints: &[Waypoint],
) -> Vec<Diagnostic> {
    if !mechanism.bodies.iter().any(|body| body.flexible.is_some()) {
        return Vec::new();
    }
    let description = evaluator.description();
    let mut heard: Vec<Heard> = vec![Vec::new(); description.contacts.len()];
    let mut listen = |evaluator: &mut Evaluator<'_>, t: f64, state: &State| {
        let frequencies = contact_frequencies(evaluator, t, &state.q, &state.v);
        for (heard, frequency) in heard.iter_mut().zip(frequencies) {
            heard.extend(frequency.map(|frequency| (t, frequency)));
        }
    };
    listen(&mut evaluator, 0.0, &start);
    let layout = Layout::new(&description.motions);
    let stride = waypoints.len().div_ceil(POSITIONS).max(1);
    let mut last = 0.0;
    for waypoint in waypoints.iter().step_by(stride).skip(1) {
        let guess = State { q: free(&layout, &waypoint.q, &start.q), v: vec![0.0; layout.speeds] };
        if let Some(state) = resting_contacts(&mut evaluator, waypoint.t, &guess) {
            listen(&mut evaluator, waypoint.t, &state);
            last = waypoint.t;
        }
    }
    let contacts = description.contacts.iter().zip(&heard);
    let pairs = contacts.flat_map(|contact| mechanism.bodies.iter().map(move |body| (contact, body)));
    pairs.filter_map(|((info, heard), body)| warning(mechanism, &info.joint, (heard, last), body)).collect()
}

/// The coordinates that no driver has, of a position: those behind them, the file's own states, are no matter of it and stay as at the start.
fn free(layout: &Layout, all: &[f64], start: &[f64]) -> Vec<f64> {
    let part = |group: &linkwear_runtime::Group| {
        let length = group.motion.lengths().0;
        let own = all.get(group.all_coordinate..group.all_coordinate + length);
        own.unwrap_or(&start[group.coordinate..group.coordinate + length]).iter().copied()
    };
    layout.free().flat_map(part).collect()
}

fn warning(
    mechanism: &Mechanism,
    name: &str,
    (heard, last): (&Heard, f64),
    body: &Body,
) -> Option<Diagnostic> {
    let near = modes_near(body, is_twisted(mechanism, body), heard);
    if near.is_empty() {
        return None;
    }
    let frequencies = heard.iter().map(|(_, frequency)| *frequency);
    let [low, high] =
        [frequencies.clone().fold(f64::INFINITY, f64::min), frequencies.fold(0.0_f64, f64::max)];
    let range = if high - low < 1.0 { format!("{low:.0}") } else { format!("{low:.0} to {high:.0}") };
    let rests = if last > 0.0 {
        format!("where it rests, in {} positions up to t = {last:.3} s", heard.len())
    } else {
        "where it rests at the start, the one position looked at".to_owned()
    };
    let message = format!(
        "the contact of `{name}` vibrates at about {range} Hz {rests}, near {} of `{}`",
        near.join(" and "),
        body.name
    );
    let joint = mechanism.joint_of_contact(name);
    let warning = Diagnostic::new(Code::ContactNearMode, message).at_each(joint.map(|joint| joint.span), "");
    Some(warning.help(
        "keep the modes up to twice that frequency, or compare a run with more of them: what is left out cannot answer the contact",
    ))
}

/// Whether a joint of the body can twist it: balls cannot.
fn is_twisted(mechanism: &Mechanism, body: &Body) -> bool {
    let is_body = |carrier| matches!(carrier, Carrier::Body(id) if mechanism.body(id).name == body.name);
    let mut own = mechanism.joints.iter().filter(|joint| is_body(joint.parent) || is_body(joint.child));
    own.any(|joint| !joint.model.turns_freely())
}

/// Frequencies of a body near to one of those heard, each with its names. Nothing sets the torsion of a body off that is
/// not `twisted`.
fn modes_near(body: &Body, twisted: bool, heard: &Heard) -> Vec<String> {
    let Some(flexible) = &body.flexible else { return Vec::new() };
    let mut told: Vec<u64> = Vec::new();
    let mut near = Vec::new();
    for (name, mode) in frequencies(flexible, twisted) {
        let is_near = |(_, frequency): &(f64, f64)| (mode - frequency).abs() < NEAR * mode;
        // Both planes of a round link share their frequencies.
        if heard.iter().any(is_near) && !told.contains(&mode.to_bits()) {
            told.push(mode.to_bits());
            near.push(format!("{mode:.1} Hz ({name})"));
        }
    }
    near
}
