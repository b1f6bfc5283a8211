//! Harmonics of drives near frequencies of flexible bodies, kept or left out.
//! In: a mechanism. Out: warnings. Never evaluates equations.

use crate::diagnostic::{Code, Diagnostic};
use crate::model::{Flexible, Mechanism};

/// Harmonics looked at: those of a linkage fall off quickly, and beyond these some harmonic is always near.
const HARMONICS: usize = 20;

/// Distances below this share of a frequency are near: at 1 % damping the response is then above ten times the
/// static one.
const NEAR: f64 = 0.03;

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
