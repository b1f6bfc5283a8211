//! Friction that follows a force which redundant constraints leave undetermined. In: reactions that are not unique. Out: warnings.
//! In a plane mechanism what is not unique out of its plane is zero without loads there, and is left unsaid.

use crate::diagnostic::{Code, Diagnostic};
use crate::model::{Joint, Mechanism, Passive};

use super::analysis::Analysis;

/// A direction this near to an axis of the ground is that axis: of unit vectors, by their rounding.
const ALONG: f64 = 1e-9;

/// One remark for each joint whose friction is as arbitrary as its force.
pub fn remarks(mechanism: &Mechanism, analysis: &Analysis) -> Vec<Diagnostic> {
    let normal = plane_normal(mechanism);
    let joints = mechanism.joints.iter();
    joints.filter_map(|joint| remark(joint, normal, &analysis.non_unique)).collect()
}

fn remark(joint: &Joint, normal: Option<[f64; 3]>, non_unique: &[String]) -> Option<Diagnostic> {
    let friction = joint.passive.iter().find_map(|passive| match passive {
        Passive::DryFriction(friction) => Some(friction),
        _ => None,
    })?;
    let axis = joint.model.axes.first()?.parent;
    let along = |direction: [f64; 3], i: usize| 1.0 - direction[i].abs() < ALONG;
    let carries = |component: &&str| {
        let Some(i) = ["x", "y", "z"].iter().position(|letter| component.ends_with(letter)) else {
            return false;
        };
        let is_moment = component.starts_with('M');
        // Forces along the normal of a plane mechanism and moments about its other axes are out of its plane.
        let out_of_plane = normal.is_some_and(|normal| along(normal, i) != is_moment);
        (!is_moment || friction.length.is_some()) && !along(axis, i) && !out_of_plane
    };
    let prefix = format!("{}.", joint.name);
    let own = non_unique.iter().filter_map(|name| name.strip_prefix(&prefix)).filter(carries);
    let components: Vec<String> = own.map(|component| format!("`{prefix}{component}`")).collect();
    if components.is_empty() {
        return None;
    }
    let message = format!(
        "the friction of joint `{}` follows {}, which redundant constraints do not determine: it is as arbitrary as that",
        joint.name,
        components.join(", ")
    );
    let help = "let other joints of the loop hold less (a spherical or inline joint for a second hinge), or one joint with `length` stand for both bearings";
    Some(Diagnostic::new(Code::FrictionNotUnique, message).at(joint.span, "has dry friction").help(help))
}

/// The normal of a mechanism in whose plane all joints move, along an axis of the ground.
fn plane_normal(mechanism: &Mechanism) -> Option<[f64; 3]> {
    let turning = mechanism.joints.iter().find(|joint| !joint.model.turns().is_empty())?;
    let normal = turning.model.axes.first()?.parent;
    let parallel = |a: [f64; 3], b: [f64; 3]| (0..3).map(|i| a[i] * b[i]).sum::<f64>().abs();
    let in_plane = mechanism.joints.iter().all(|joint| {
        let Some(axis) = joint.model.axes.first() else { return joint.model.rows() == 6 };
        let cosine = parallel(axis.parent, normal);
        joint.model.kind.is_plane()
            && if joint.model.is_guide() { cosine < ALONG } else { 1.0 - cosine < ALONG }
    });
    let on_axis = (0..3).any(|i| 1.0 - normal[i].abs() < ALONG);
    (in_plane && on_axis).then_some(normal)
}
