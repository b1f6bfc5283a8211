//! Dry friction under the force that a joint carries across its axis.
//!
//! With f and m the parent's force and moment on the child about the joint's point, without their parts along the
//! axis u: one bearing carries `N = |f|`, two bearings at a distance L carry `N = |f/2 + u x m/L| + |f/2 - u x m/L|`.
//! Friction is `-N mu(v) v/sqrt(v² + w²)` against a slide and that times the radius against a turn, with
//! `mu(v) = mu + (mu_rest - mu) exp(-(v/v_s)²)` and the onset w.

use crate::derive::joint_state::JointStates;
use crate::expr::{Expr, Scope, Vec3};
use crate::id::JointId;
use crate::model::{DryFriction, Response};

/// Force below which a bearing counts as unloaded [N]: the square root in its size has no slope at zero. What it
/// adds is below the weight of a cell, and the braking of a mechanism of micrometres is that of its own load.
const UNLOADED: f64 = 1e-12;

/// Force or moment of friction along the coordinate [N or N m].
pub fn dry_friction<'g>(
    g: &'g Scope,
    state: &JointStates<'g>,
    (joint, friction): (JointId, &DryFriction),
    speed: Expr<'g>,
) -> Expr<'g> {
    let asked = |response: fn(JointId, usize) -> Response| {
        Vec3::from_fn(|i| state.responses.symbol(g, response(joint, i)))
    };
    let data = state.geometry.mechanism.joint(joint);
    let axis = state.taken_along(data.parent, g.vector(data.model.axes[0].parent));
    let across = |vector: Vec3<'g>| vector - vector.dot(axis) * axis;
    let size = |vector: Vec3<'g>| (vector.dot(vector) + UNLOADED * UNLOADED).sqrt();
    let force = across(asked(Response::JointForce));
    let carried = match &friction.length {
        None => size(force),
        Some(length) => {
            let moment = state.lower(g, length).recip() * axis.cross(asked(Response::JointMoment));
            let half = g.number(0.5) * force;
            size(half + moment) + size(half - moment)
        }
    };
    let lower = |formula| state.lower(g, formula);
    let (sliding, onset) = (lower(&friction.coefficient), lower(&friction.onset));
    let coefficient = match &friction.stribeck_speed {
        Some(stribeck) => {
            let relative = speed / lower(stribeck);
            sliding + (lower(&friction.at_rest) - sliding) * (-relative.square()).exp()
        }
        None => sliding,
    };
    let direction = speed / (speed.square() + onset.square()).sqrt();
    let arm = friction.radius.as_ref().map_or_else(|| g.number(1.0), lower);
    state.responses.unknown(g, -(arm * coefficient * direction * carried))
}
