//! How fast contacts vibrate: penetration against the mass that it moves. In: a mechanism at a state. Out: frequencies.
//! Never knows runs.

use std::f64::consts::PI;

use crate::clearance_joint::ContactState;
use crate::evaluate::Evaluator;
use crate::linear::dot;
use crate::system::{CONTACT_MOTION, CONTACT_WRENCH};

/// Frequency [Hz] of small vibrations of every contact along its normal, at one state; nothing where there is none.
/// It grows with the force to the power 1/6 of a sphere's law, so that a state at rest tells that of a whole turn
/// within tens of per cent.
pub fn contact_frequencies(evaluator: &mut Evaluator<'_>, t: f64, q: &[f64], v: &[f64]) -> Vec<Option<f64>> {
    evaluator.evaluate_contacts(t, q, v);
    let touches = evaluator.clearances().contacts().to_vec();
    let sizes = evaluator.sizes();
    let mut storage = vec![0.0; sizes.contacts * CONTACT_WRENCH + sizes.speeds];
    let frequency = |(joint, touch): (usize, &ContactState)| {
        let inverse = inverse_mass(evaluator, (t, q, v), (joint, touch), &mut storage);
        let tangent_stiffness = evaluator.clearances().joints()[joint].tangent_stiffness(touch);
        let frequency = (tangent_stiffness * inverse).sqrt() / (2.0 * PI);
        (frequency.is_finite() && frequency > 0.0).then_some(frequency)
    };
    touches.iter().enumerate().map(frequency).collect()
}

/// Inverse of the mass [1/kg] that a contact moves along its normal: what a unit force there changes in the
/// acceleration of the offset.
pub(crate) fn inverse_mass(
    evaluator: &mut Evaluator<'_>,
    (t, q, v): (f64, &[f64], &[f64]),
    (joint, touch): (usize, &ContactState),
    storage: &mut [f64],
) -> f64 {
    let (wrenches, change) = storage.split_at_mut(evaluator.sizes().contacts * CONTACT_WRENCH);
    let normal = touch.normal();
    wrenches.copy_from_slice(evaluator.clearances().wrenches());
    change.copy_from_slice(evaluator.accelerations_under(t, q, v, wrenches).values);
    for (wrench, component) in wrenches[joint * CONTACT_WRENCH..].iter_mut().zip(normal) {
        *wrench += component;
    }
    let loaded = evaluator.accelerations_under(t, q, v, wrenches).values;
    change.iter_mut().zip(loaded).for_each(|(change, loaded)| *change = loaded - *change);
    // Rates of the offset are linear in the speeds: accelerations in their place give its acceleration.
    let rate = |motion: &[f64]| dot(&motion[joint * CONTACT_MOTION + 3..][..3], &normal);
    let moving = rate(evaluator.contact_motion(t, q, change));
    change.fill(0.0);
    moving - rate(evaluator.contact_motion(t, q, change))
}
