//! Speeds that nothing made of matter stands: a slip of a unit or an exponent. In: a mechanism; its drivers, run by the interpreter.
//! Out: warnings. Never knows loops.

use linkwear_runtime::{Description, DriverInfo, System};

use crate::diagnostic::{Code, Diagnostic};
use crate::model::{Carrier, Coordinate, Joint, Mechanism, Start};

use super::failures::named;
use super::plausible::{length, shown, with_unit};
use super::prescribed::laws_at;

/// Speed [m/s] of the end of a turning body above which no material holds: a ring bears a speed of sqrt(strength/density), at most
/// 2 km/s with the strongest fibres.
const TURNING: f64 = 4e3;
/// Speed [m/s] of what slides: guns reach some 3 km/s, satellites 8 km/s.
const SLIDING: f64 = 2e4;
/// Times [s] at which drivers are asked, each so much later than the one before that laws of any frequency are met in all phases.
const FIRST: f64 = 1e-9;
const LATER: f64 = 1.37;
const TIMES: i32 = 66;

/// Remarks on start values.
pub fn fast_starts(mechanism: &Mechanism) -> Vec<Diagnostic> {
    let values = mechanism.parameter_values();
    let remark = |start: &Start| {
        let joint = mechanism.joint(start.joint);
        let law = start.speed.as_ref()?;
        let angular = *joint.model.start_values().get(start.coordinate)? == Coordinate::Angle;
        Some(fast(mechanism, joint, angular, law.value(&values)?.abs())?.at(law.span, "started here"))
    };
    mechanism.starts.iter().filter_map(remark).collect()
}

/// Remarks on what drivers prescribe in the first second.
pub fn fast_drives(
    mechanism: &Mechanism,
    description: &Description,
    system: &dyn System<f64>,
) -> Vec<Diagnostic> {
    let mut fastest = vec![0.0_f64; description.drivers.len()];
    for step in 0..TIMES {
        let laws = laws_at(FIRST * LATER.powi(step), description, system);
        for (fastest, [_, speed, _]) in fastest.iter_mut().zip(laws) {
            *fastest = fastest.max(speed.abs());
        }
    }
    let drivers = description.drivers.iter().zip(fastest);
    let remark = |(driver, speed): (&DriverInfo, f64)| {
        let joint = named(mechanism, &driver.joint)?;
        Some(fast(mechanism, joint, driver.angular, speed)?.at(joint.span, "driven here"))
    };
    drivers.filter_map(remark).collect()
}

/// A remark if a joint moves with such a speed, from 0 up [rad/s or m/s].
fn fast(mechanism: &Mechanism, joint: &Joint, angular: bool, speed: f64) -> Option<Diagnostic> {
    let name = &joint.name;
    if !angular {
        return (speed > SLIDING).then(|| odd(format!("`{name}` slides with {}", with_unit(speed, "m/s"))));
    }
    let bodies = [joint.parent, joint.child].into_iter().filter_map(|carrier| match carrier {
        Carrier::Body(body) => Some(body),
        Carrier::Ground => None,
    });
    let lengths = bodies.map(|body| (length(mechanism, body.index()), body));
    let (arm, body) = lengths.max_by(|a, b| a.0.total_cmp(&b.0))?;
    let end = arm * speed;
    (end > TURNING).then(|| {
        odd(format!(
            "`{name}` turns with {} rad/s, and the end of `{}`, {} long, moves with {}",
            shown(speed),
            mechanism.body(body).name,
            with_unit(arm, "m"),
            with_unit(end, "m/s")
        ))
    })
}

fn odd(message: String) -> Diagnostic {
    Diagnostic::new(Code::TooFast, message)
        .help("nothing holds together at that speed: check units and exponents")
}
