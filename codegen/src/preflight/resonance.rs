//! Harmonics of drives near frequencies of flexible bodies, kept or left out; links that turn fast beside theirs.
//! In: a mechanism. Out: warnings. Never evaluates equations.

use crate::diagnostic::{Code, Diagnostic};
use crate::id::BodyId;
use crate::model::{Carrier, Flexible, Joint, Look, Mechanism};

/// Harmonics looked at: those of a linkage fall off quickly, and beyond these some harmonic is always near.
const HARMONICS: usize = 20;

/// Distances below this share of a frequency are near: at 1 % damping the response is then above ten times the
/// static one.
const NEAR: f64 = 0.03;

/// Share of the first stiffness of a link that turning may take from linear shapes: they bend by that share too much.
const SOFTER: f64 = 0.1;

/// Warns for every drive of constant speed and every frequency that one of its harmonics is near to.
pub fn near_resonance(mechanism: &Mechanism) -> Vec<Diagnostic> {
    let mut warnings = Vec::new();
    for joint in &mechanism.joints {
        for drive in &joint.drives {
            let Some(turns) = turns_per_second(mechanism, &drive.law) else { continue };
            for body in &mechanism.bodies {
                let Some(flexible) = &body.flexible else { continue };
                let mut told = Vec::new();
                for (name, frequency) in frequencies(flexible, true) {
                    let Some(harmonic) = nearest_harmonic(turns, frequency) else { continue };
                    // Both planes of a round link share their frequencies.
                    if told.contains(&(harmonic, frequency.to_bits())) {
                        continue;
                    }
                    told.push((harmonic, frequency.to_bits()));
                    let message = format!(
                        "harmonic {harmonic} of the drive of `{}`, {:.1} Hz, is near {frequency:.1} Hz of `{}` ({name})",
                        joint.name,
                        turns * harmonic as f64,
                        body.name
                    );
                    warnings.push(Diagnostic::new(Code::NearResonance, message).at(drive.law.span, "").help(
                        "expect large vibrations; change the speed or the link, or make sure of the damping",
                    ));
                }
            }
        }
    }
    warnings
}

/// Warns for every drive that turns links of linear shapes so fast, against the ground, that they miss what pulls them straight.
pub fn fast_for_linear_shapes(mechanism: &Mechanism) -> Vec<Diagnostic> {
    let parameters = mechanism.parameter_values();
    let mut warnings = Vec::new();
    for joint in mechanism.joints.iter().filter(|joint| joint.model.is_hinge()) {
        let Some(drive) = joint.drives.first() else { continue };
        // The mean of the first second: fluctuations are small beside a speed that takes stiffness away.
        let [begin, end] = [0.0, 1.0].map(|t| drive.law.value_at_time(&parameters, t));
        let Some(speed) = begin.zip(end).map(|(begin, end)| (end - begin).abs() / std::f64::consts::TAU)
        else {
            continue;
        };
        for body in turning_with(mechanism, joint) {
            let body = mechanism.body(body);
            let Some(flexible) = body.flexible.as_ref().filter(|own| own.data.second_order.is_none()) else {
                continue;
            };
            let kept = flexible.data.modes.iter().map(|mode| mode.frequency);
            // Static shapes have no frequency.
            let first = kept.filter(|frequency| *frequency > 0.0).fold(f64::INFINITY, f64::min);
            let share = (speed / first).powi(2);
            if share > SOFTER {
                let message = format!(
                    "the drive of `{}`, {speed:.1} Hz, turns `{}` fast beside its first frequency of {first:.1} Hz: linear shapes bend by \
                     {} too much there",
                    joint.name,
                    body.name,
                    if share < 1.0 {
                        format!("{:.0} %", 100.0 * share / (1.0 - share))
                    } else {
                        "any amount".to_owned()
                    }
                );
                warnings.push(
                    Diagnostic::new(Code::FastForOrder1, message).at(body.span, "").help(
                        "write `order = 2` in its `flexible`, which knows how turning pulls it straight",
                    ),
                );
            }
        }
    }
    warnings
}

/// Bodies that turn against the ground as a driven hinge does: what it joins to the ground, and what is fixed to that.
fn turning_with(mechanism: &Mechanism, hinge: &Joint) -> Vec<BodyId> {
    let mut bodies = Vec::new();
    match (hinge.parent, hinge.child) {
        (Carrier::Ground, Carrier::Body(body)) | (Carrier::Body(body), Carrier::Ground) => bodies.push(body),
        _ => {}
    }
    let mut at = 0;
    while let Some(body) = bodies.get(at).copied() {
        at += 1;
        for joint in mechanism.joints.iter().filter(|joint| joint.model.kind.look() == Look::Rigid) {
            let others = [(joint.parent, joint.child), (joint.child, joint.parent)];
            for (_, other) in others.into_iter().filter(|(own, _)| *own == Carrier::Body(body)) {
                if let Carrier::Body(other) = other
                    && !bodies.contains(&other)
                {
                    bodies.push(other);
                }
            }
        }
    }
    bodies
}

/// Names and frequencies [Hz] of a body's modes, kept and left out; of these torsion only if the body is `twisted`.
pub(super) fn frequencies(flexible: &Flexible, twisted: bool) -> impl Iterator<Item = (String, f64)> {
    let kept = flexible.data.modes.iter().map(|mode| (mode.name.clone(), mode.frequency));
    let left_out = flexible.left_out.iter().filter(move |mode| twisted || !mode.torsion);
    kept.chain(left_out.map(|mode| (format!("{}, left out", mode.name), mode.frequency)))
}

/// Frequency of a drive that turns at constant speed [1/s].
pub(super) fn turns_per_second(mechanism: &Mechanism, law: &crate::model::Formula) -> Option<f64> {
    let parameters = mechanism.parameter_values();
    let at = |time: f64| law.value_at_time(&parameters, time);
    // Three unequal steps: a law that is straight over all of them is a straight line.
    let values = [at(0.0)?, at(0.113)?, at(0.371)?, at(1.0)?];
    let speed = values[3] - values[0];
    let straight =
        (values[1] - values[0] - 0.113 * speed).abs() + (values[2] - values[0] - 0.371 * speed).abs();
    let turns = speed.abs() / std::f64::consts::TAU;
    // Rounding of a few turns.
    (straight < 1e-9 * speed.abs() && turns.is_finite() && turns > 0.0).then_some(turns)
}

fn nearest_harmonic(turns: f64, frequency: f64) -> Option<usize> {
    (1..=HARMONICS).find(|n| (*n as f64 * turns - frequency).abs() < NEAR * frequency)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_first_harmonics_count() {
        assert_eq!(nearest_harmonic(10.0, 138.0), Some(14));
        assert_eq!(nearest_harmonic(2.0, 138.0), None);
        assert_eq!(nearest_harmonic(10.0, 145.0), None);
    }
}
