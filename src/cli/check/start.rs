//! Where the joints stand at t = 0. In: a compiled mechanism. Out: its coordinates by joint, for people and machines. Never knows how
//! the loops are closed.

use linkwear_codegen::Compiled;
use linkwear_runtime::{Settings, Simulation, Span};
use serde_json::{Map, Value, json};

use crate::number::number;

/// Angles [rad] and lengths [m] below this are the zero that assembly, which ends at some 1e-12 of a lever arm, means.
const ZERO: f64 = 1e-9;

/// The consistent start.
pub struct Start {
    /// Column of a position (`R1.q`, `S2.q0`), its SI unit, its value.
    positions: Vec<(String, String, f64)>,
    /// Radial clearances [m], joint by joint.
    pub clearances: Vec<f64>,
}

impl Start {
    /// None where a run would not start; it says why.
    pub fn of(compiled: &Compiled) -> Option<Self> {
        let (system, description) = (compiled.interpreter_at_hand(), compiled.description());
        let settings = Settings { span: Span::Time(1.0), ..Settings::default() };
        let mut run = Simulation::start(&*system, description, &compiled.parameters(), &settings).ok()?;
        let joints = &compiled.mechanism.joints;
        let is_position = |column: &str| {
            column.rsplit_once('.').is_some_and(|(joint, member)| {
                let number = member.strip_prefix('q');
                let is_q = number.is_some_and(|digits| digits.bytes().all(|byte| byte.is_ascii_digit()));
                is_q && joints.iter().any(|known| known.name == joint)
            })
        };
        let columns = run.channels().iter().zip(run.values());
        let positions = columns
            .filter(|(channel, _)| is_position(&channel.name))
            .map(|(channel, value)| (channel.name.to_string(), channel.unit.to_string(), *value))
            .collect();
        Some(Self { positions, clearances: run.clearances() })
    }

    /// All positions by column, SI.
    pub fn by_column(&self) -> Map<String, Value> {
        self.positions.iter().map(|(column, _, value)| (column.clone(), json!(value))).collect()
    }

    /// Where a joint stands, as `[assembly]` would say it: angles in degrees, of a ball the rotation vector, lengths in millimetres.
    pub fn of_joint(&self, joint: &str) -> String {
        let own: Vec<(&str, &str, f64)> = self
            .positions
            .iter()
            .filter_map(|(column, unit, value)| {
                let (of, member) = column.rsplit_once('.')?;
                (of == joint).then_some((member, unit.as_str(), *value))
            })
            .collect();
        let (parts, others): (Vec<_>, Vec<_>) = own.iter().copied().partition(|one| one.1 == "1");
        let mut shown = Vec::new();
        if let [w, x, y, z] = parts.iter().map(|one| one.2).collect::<Vec<f64>>()[..] {
            let vector = rotation_vector([w, x, y, z]).map(|angle| number(zeroed(angle).to_degrees()));
            shown.push(if vector.iter().all(|angle| angle == "0") {
                "0 deg".to_owned()
            } else {
                vector.join(", ") + " deg"
            });
        }
        for (member, unit, value) in others {
            let value = zeroed(value);
            let value = match unit {
                "rad" => format!("{} deg", number(value.to_degrees())),
                _ => format!("{} mm", number(1e3 * value)),
            };
            shown.push(if own.len() == 1 { value } else { format!("{member} {value}") });
        }
        shown.join("; ")
    }
}

fn zeroed(value: f64) -> f64 {
    if value.abs() < ZERO { 0.0 } else { value }
}

/// Axis times angle, in (-pi, pi], of a unit quaternion.
fn rotation_vector([w, x, y, z]: [f64; 4]) -> [f64; 3] {
    let sine = (x * x + y * y + z * z).sqrt();
    // q and -q are one rotation: the shorter way round.
    let sign = if w < 0.0 { -1.0 } else { 1.0 };
    // Half the angle over its sine is one at zero.
    let per_sine = if sine > 0.0 { 2.0 * sine.atan2(sign * w) / sine } else { 2.0 };
    [x, y, z].map(|part| sign * part * per_sine)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quaternion_is_shown_as_its_rotation_vector() {
        let half = 30.0_f64.to_radians() / 2.0;
        for sign in [1.0, -1.0] {
            let vector = rotation_vector([half.cos(), 0.0, 0.0, half.sin()].map(|part| sign * part));
            assert!((vector[2].to_degrees() - 30.0).abs() < 1e-12 && vector[..2] == [0.0, 0.0], "{vector:?}");
        }
        assert_eq!(rotation_vector([1.0, 0.0, 0.0, 0.0]), [0.0; 3]);
    }
}
