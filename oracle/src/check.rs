//! Checks before a mechanism is modelled: formulas that must be constant are, and what acts on a joint
//! coordinate acts on one that exists. In: a mechanism. Out: nothing, or an error. Never knows numbers.

use linkwear_codegen::model::{Amount, Body, Formula, Inertia, Joint, Mechanism, Passive, Position, Term};

use crate::error::OracleError;
use crate::joint::JointGeometry;
use crate::kind::Kind;

/// Everything but motion laws, actuators and components of forces must have a value without a state.
pub(crate) fn check_constants(mechanism: &Mechanism, parameters: &[f64]) -> Result<(), OracleError> {
    let check = |element: &str, formulas: &[&Formula]| {
        if formulas.iter().all(|formula| formula.value(parameters).is_some()) {
            Ok(())
        } else {
            Err(OracleError::NotConstant { element: element.to_owned() })
        }
    };
    check("gravity", &mechanism.gravity.each_ref())?;
    for point in &mechanism.points {
        match &point.position {
            Position::Shared(position) => check(&point.name, &position.each_ref())?,
            Position::PerBody(positions) => {
                positions.iter().try_for_each(|(_, p)| check(&point.name, &p.each_ref()))?;
            }
        }
    }
    for body in &mechanism.bodies {
        check(&body.name, &of_body(body))?;
    }
    for joint in &mechanism.joints {
        check(&joint.name, &of_joint(joint))?;
    }
    for force in mechanism.forces.iter().filter(|force| !force.is_over_state()) {
        check(&force.name, &force.formulas.iter().collect::<Vec<_>>())?;
    }
    Ok(())
}

/// Forces depend on positions, speeds and the time alone.
pub(crate) fn check_responses(mechanism: &Mechanism) -> Result<(), OracleError> {
    let refuse = |element: &str| Err(OracleError::Responses { element: element.to_owned() });
    let unknown = |formula: &Formula| {
        let mut found = false;
        formula.term.visit(&mut |term| {
            found |= matches!(
                term,
                Term::Response(_) | Term::BodySpin(..) | Term::ForceValue(..) | Term::State(_)
            );
        });
        found
    };
    if let Some(state) = mechanism.states.first() {
        return refuse(&state.name);
    }
    for joint in &mechanism.joints {
        let asks = |passive: &Passive| match passive {
            Passive::Actuator { force, .. } => unknown(force),
            Passive::DryFriction(_) => true,
            Passive::Damping { .. } | Passive::Spring { .. } => false,
        };
        if joint.passive.iter().any(asks) {
            return refuse(&joint.name);
        }
    }
    match mechanism.forces.iter().find(|force| force.formulas.iter().any(unknown)) {
        Some(force) => refuse(&force.name),
        None => Ok(()),
    }
}

fn of_body(body: &Body) -> Vec<&Formula> {
    match &body.inertia {
        Inertia::Rod { radius, inner_radius, amount: Amount::Density(much) | Amount::Mass(much), .. } => {
            vec![radius, inner_radius, much]
        }
        Inertia::Box { width: [a, b], amount: Amount::Density(much) | Amount::Mass(much), .. } => {
            vec![a, b, much]
        }
        Inertia::Given { mass, inertia, .. } => std::iter::once(mass).chain(inertia).collect(),
    }
}

fn of_joint(joint: &Joint) -> Vec<&Formula> {
    let mut formulas = Vec::new();
    for passive in &joint.passive {
        match passive {
            Passive::Damping { coefficient, .. } => formulas.push(coefficient),
            Passive::Spring { stiffness, rest, preload, .. } => formulas.extend([stiffness, rest, preload]),
            Passive::Actuator { .. } | Passive::DryFriction(_) => {}
        }
    }
    formulas
}

/// Drives, springs, dampers and actuators act on scalar coordinates that the joint has; a damper in a
/// spherical joint acts on its angular velocity.
pub(crate) fn check_coordinates(mechanism: &Mechanism, joints: &[JointGeometry]) -> Result<(), OracleError> {
    for (joint, geometry) in mechanism.joints.iter().zip(joints) {
        let round = geometry.kind == Kind::Spherical;
        let drives = joint.drives.iter().map(|drive| drive.coordinate);
        let passive = joint.passive.iter().filter_map(|passive| match passive {
            Passive::Damping { coordinate, .. } if round && *coordinate == 0 => None,
            Passive::Damping { coordinate, .. }
            | Passive::Spring { coordinate, .. }
            | Passive::Actuator { coordinate, .. } => Some(*coordinate),
            Passive::DryFriction(_) => Some(0),
        });
        if let Some(coordinate) = drives.chain(passive).find(|k| *k >= geometry.scalars()) {
            return Err(OracleError::NoCoordinate { joint: joint.name.clone(), coordinate });
        }
    }
    Ok(())
}
