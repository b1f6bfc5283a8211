//! Members of joints, points and bodies that only the solution of an instant tells, and where formulas cannot ask for them.

use super::resolver::Resolver;
use crate::diagnostic::Code;
use crate::id::{BodyId, ForceId, JointId, PointId};
use crate::model::{Coordinate, Force, Formula, Joint, Passive, Response, StateVariable, Term};
use crate::spec::{ByCoordinate, Dimension, File};

const XYZ: [&str; 3] = ["x", "y", "z"];
const ANGULAR_SPEED: Dimension = Dimension::of(0, 0, -1);
const ANGULAR_ACCELERATION: Dimension = Dimension::of(0, 0, -2);
const ACCELERATION: Dimension = Dimension::of(1, 0, -2);

/// A member that exists, or what there is instead.
pub(super) type Member = Result<(Term, Dimension), String>;

fn component(of: &str, prefix: &str) -> Option<usize> {
    let letter = of.strip_prefix(prefix)?;
    XYZ.iter().position(|known| letter == *known)
}

/// The coordinate that a number behind a letter means, among `count` of them: the only one needs none.
pub(super) fn coordinate_of(number: &str, count: usize) -> Option<usize> {
    match number.parse::<usize>() {
        Ok(number) if count > 1 => number.checked_sub(1),
        Ok(1) => Some(0),
        Err(_) if number.is_empty() && count == 1 => Some(0),
        _ => None,
    }
}

impl Resolver<'_> {
    /// Takes note of the coordinates that drives prescribe: formulas may ask for their forces.
    pub(super) fn note_drives(&mut self, file: &File) {
        for (at, (_, joint)) in file.joints.0.iter().enumerate() {
            let joint_id = JointId::new(at);
            match &joint.value.drive {
                None => {}
                Some(ByCoordinate::One(_)) => self.driven.push((joint_id, 0)),
                Some(ByCoordinate::Each(each)) => {
                    let own = &each.value;
                    let keys = [own.q.as_ref().or(own.q1.as_ref()), own.q2.as_ref(), own.q3.as_ref()];
                    let given = keys.iter().enumerate().filter(|(_, key)| key.is_some());
                    self.driven.extend(given.map(|(coordinate, _)| (joint_id, coordinate)));
                }
            }
        }
    }

    /// `ax`, `ay`, `az` of a point.
    pub(super) fn point_response(point: PointId, member: &str) -> Option<(Term, Dimension)> {
        let axis = component(member, "a")?;
        Some((Term::Response(Response::PointAcceleration(point, axis)), ACCELERATION))
    }

    /// Angular velocity and acceleration of a body.
    pub(super) fn body_member(body: BodyId, member: &str) -> Member {
        if let Some(axis) = component(member, "w") {
            return Ok((Term::BodySpin(body, axis), ANGULAR_SPEED));
        }
        match component(member, "alpha_") {
            Some(axis) => {
                Ok((Term::Response(Response::BodyAcceleration(body, axis)), ANGULAR_ACCELERATION))
            }
            None => Err(
                "a body has the angular velocity `wx`, `wy`, `wz` and the angular acceleration `alpha_x`, `alpha_y`, `alpha_z`"
                    .to_owned(),
            ),
        }
    }

    /// What a force element tells of itself; nothing of one whose kind is wrong, which is reported there.
    pub(super) fn force_member(&self, force: ForceId, member: &str) -> Option<Member> {
        let kind = (*self.force_kinds.get(force.index())?)?;
        let columns = kind.told.columns();
        let at = columns.iter().position(|(known, _)| *known == member);
        Some(at.map(|at| (Term::ForceValue(force, at), columns[at].1)).ok_or_else(|| {
            match columns.split_last() {
                None => format!("a {} has no members in formulas", kind.name),
                Some(((last, _), before)) => {
                    let before: Vec<String> = before.iter().map(|(name, _)| format!("`{name}`")).collect();
                    format!("a {} has {} and `{last}`", kind.name, before.join(", "))
                }
            }
        }))
    }

    /// Acceleration of a coordinate of a joint, force and moment in it, force of its drive; nothing if it is none of these.
    pub(super) fn joint_response(
        &self,
        joint: JointId,
        member: &str,
        coordinates: &[Coordinate],
    ) -> Option<Member> {
        let numbered = |number| coordinate_of(number, coordinates.len());
        if let Some(axis) = component(member, "F") {
            return Some(Ok((Term::Response(Response::JointForce(joint, axis)), Dimension::FORCE)));
        }
        if let Some(axis) = component(member, "M") {
            return Some(Ok((Term::Response(Response::JointMoment(joint, axis)), Dimension::TORQUE)));
        }
        if let Some(number) = member.strip_prefix("drive") {
            let at = numbered(number)?;
            let coordinate = coordinates.get(at)?;
            if !self.driven.contains(&(joint, at)) {
                return Some(Err("this coordinate of the joint has no drive".to_owned()));
            }
            return Some(Ok((Term::Response(Response::Drive(joint, at)), coordinate.force())));
        }
        let at = numbered(member.strip_prefix('a')?)?;
        let acceleration = match coordinates.get(at)? {
            Coordinate::Angle => ANGULAR_ACCELERATION,
            Coordinate::Length => ACCELERATION,
        };
        Some(Ok((Term::Response(Response::JointAcceleration(joint, at)), acceleration)))
    }

    /// Contact forces come from outside the equations, which cannot be solved for what asks for their outcome.
    pub(super) fn check_responses(&mut self, joints: &[Joint], forces: &[Force], states: &[StateVariable]) {
        let Some(loose) = joints.iter().find(|joint| joint.clearance.is_some()) else { return };
        let (name, span) = (loose.name.clone(), loose.span);
        let asking = |formula: &Formula| formula.asks_for_responses().then_some(formula.span);
        let of_joints = joints.iter().flat_map(|joint| &joint.passive).filter_map(|passive| match passive {
            Passive::Actuator { force, .. } => asking(force),
            Passive::DryFriction(friction) => Some(friction.coefficient.span),
            _ => None,
        });
        let of_forces = forces.iter().flat_map(|force| &force.formulas).filter_map(asking);
        let of_states = states.iter().filter_map(|state| asking(&state.rate));
        let all: Vec<_> = of_joints.chain(of_forces).chain(of_states).collect();
        for place in all {
            let message = format!(
                "what depends on accelerations or forces of joints cannot be solved beside the contact in joint `{name}`"
            );
            self.refuse(Code::NotAllowedHere, place, message)
                .also(span, "has clearance")
                .help("take the clearance away, or let the formula depend on positions and speeds only");
        }
    }
}
