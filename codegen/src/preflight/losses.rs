//! What takes energy out of a mechanism, more than anything does: coefficients of friction, damping ratios of modes. In: a mechanism.
//! Out: warnings, each with the number that is odd.

use crate::diagnostic::{Code, Diagnostic};
use crate::model::{Body, Joint, Mechanism, Passive};
use crate::source::Span;

/// Soft rubber on dry, rough ground has a coefficient of friction of one to two.
const FRICTION: f64 = 2.0;
/// From the critical ratio on a mode does not swing any more; structures have 1e-3 to 0.1.
const DAMPING: f64 = 1.0;

/// Remarks on what is odd.
pub(super) fn remarks(mechanism: &Mechanism) -> impl Iterator<Item = Diagnostic> {
    let frictions = mechanism.joints.iter().flat_map(|joint| frictions(mechanism, joint));
    frictions.chain(mechanism.bodies.iter().filter_map(damping))
}

/// Of a joint's contact, and of its bearing without one.
fn frictions(mechanism: &Mechanism, joint: &Joint) -> Vec<Diagnostic> {
    let values = mechanism.parameter_values();
    let contact = joint.clearance.as_ref().and_then(|clearance| {
        let (strength, ..) = clearance.laws.friction?;
        let (moving, at_rest) = strength.given();
        let most = at_rest.map_or(moving, |(at_rest, _)| at_rest.max(moving));
        Some((most, clearance.places.friction))
    });
    let dry = joint.passive.iter().filter_map(|passive| match passive {
        Passive::DryFriction(friction) => {
            let sizes =
                [&friction.coefficient, &friction.at_rest].map(|part| (part.value(&values), part.span));
            let sizes = sizes.into_iter().filter_map(|(size, span)| Some((size?, span)));
            sizes.max_by(|a, b| a.0.total_cmp(&b.0))
        }
        _ => None,
    });
    let odd = contact.into_iter().chain(dry).filter(|(coefficient, _)| *coefficient > FRICTION);
    let told = |(coefficient, span): (f64, Span)| {
        let message = format!("the coefficient of friction of `{}` is {coefficient}", joint.name);
        let help = "oiled metals have 0.05 to 0.2, dry ones 0.15 to 0.6, rubber up to 2";
        Diagnostic::new(Code::OddMaterial, message).at(span, "").help(help)
    };
    odd.map(told).collect()
}

fn damping(body: &Body) -> Option<Diagnostic> {
    let flexible = body.flexible.as_ref()?;
    let data = &flexible.data;
    let ratio =
        |k: usize| data.damping[k][k] / (2.0 * (data.stiffness[k][k] * data.mass_matrix[k][k]).sqrt());
    // Of a mode without stiffness there is none.
    let ratios = (0..data.mode_count()).map(|k| (k, ratio(k))).filter(|(_, ratio)| ratio.is_finite());
    let (mode, most) = ratios.max_by(|a, b| a.1.total_cmp(&b.1))?;
    (most > DAMPING).then(|| {
        let name = &data.modes[mode].name;
        let message = format!("the damping ratio of mode `{name}` of `{}` is {most:.3}", body.name);
        let help = "it is a share of the critical damping: steel structures have 0.001 to 0.02, bolted ones up to 0.1";
        Diagnostic::new(Code::OddMaterial, message).at(flexible.damped, "").help(help)
    })
}
