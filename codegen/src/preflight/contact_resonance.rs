//! Contacts that vibrate near frequencies of flexible bodies, kept or left out.
//! In: a mechanism and its equations. Out: warnings. Never knows the laws of contact.

use linkwear_runtime::{Evaluator, State, contact_frequencies};

use crate::diagnostic::{Code, Diagnostic};
use crate::model::{Body, Mechanism};

use super::resonance::frequencies;

/// Distances below this share of a frequency are near: the force of a contact changes over a turn, and ten times the
/// force is 1.5 times the frequency (power 1/6 of a sphere's law).
const NEAR: f64 = 0.2;

/// Warns for every flexible body with a frequency near to that of a contact that rests at the start.
pub fn contacts_near_modes(
    mechanism: &Mechanism,
    (mut evaluator, start): (Evaluator<'_>, State),
) -> Vec<Diagnostic> {
    let flexible = mechanism.bodies.iter().any(|body| body.flexible.is_some());
    if !flexible {
        return Vec::new();
    }
    let frequencies = contact_frequencies(&mut evaluator, 0.0, &start.q, &start.v);
    let mut warnings = Vec::new();
    for (contact, frequency) in evaluator.description().contacts.iter().zip(frequencies) {
        let Some(frequency) = frequency else { continue };
        for body in &mechanism.bodies {
            let near = modes_near(body, frequency);
            if near.is_empty() {
                continue;
            }
            let message = format!(
                "the contact of `{}` vibrates at about {frequency:.0} Hz where it rests at the start, near {} of `{}`",
                contact.joint,
                near.join(" and "),
                body.name
            );
            let joint = mechanism.joints.iter().find(|joint| joint.name == contact.joint);
            let warning =
                Diagnostic::new(Code::ContactNearMode, message).at_each(joint.map(|joint| joint.span), "");
            warnings.push(warning.help(
                "keep the modes up to twice that frequency, or compare a run with more of them: what is left out cannot answer the contact",
            ));
        }
    }
    warnings
}

/// Frequencies of a body near to one, each with its names.
fn modes_near(body: &Body, frequency: f64) -> Vec<String> {
    let Some(flexible) = &body.flexible else { return Vec::new() };
    let mut told: Vec<u64> = Vec::new();
    let mut near = Vec::new();
    for (name, mode) in frequencies(flexible) {
        // Both planes of a round link share their frequencies.
        if (mode - frequency).abs() < NEAR * mode && !told.contains(&mode.to_bits()) {
            told.push(mode.to_bits());
            near.push(format!("{mode:.1} Hz ({name})"));
        }
    }
    near
}
