//! Points and the bodies that elements hold them on: points that nobody has, and such that another body has.
//! In: bodies, joints, forces, carriers of points. Out: warnings.

use super::resolver::Resolver;
use crate::diagnostic::Code;
use crate::id::{BodyId, PointId};
use crate::model::{Body, Carrier, Force, Joint, Position};
use crate::spec::File;

/// A body as a file calls it.
fn called(bodies: &[Body], carrier: Carrier) -> &str {
    match carrier {
        Carrier::Ground => "ground",
        Carrier::Body(body) => bodies.get(body.index()).map_or("", |body| &body.name),
    }
}

impl Resolver<'_> {
    /// A point that nothing says who carries.
    pub(super) fn warn_unplaced(&mut self, point: PointId, bodies: &[Body], forces: &[Force]) {
        let (name, span) = (self.points[point.index()].name.clone(), self.points[point.index()].span);
        let mut ends = forces.iter().flat_map(|force| force.at.iter().zip(&force.bodies));
        let holder = ends.find(|(at, body)| **at == point && **body != Carrier::Ground);
        let on = match (holder, bodies.first()) {
            (Some((_, body)), _) => called(bodies, *body),
            (None, Some(first)) => &first.name,
            (None, None) => return,
        };
        let message = format!("nothing says which body carries the point `{name}`: it rests");
        self.refuse(Code::UnplacedPoint, span, message).help(format!(
            "write `{name} = {{ at = [...], on = \"{on}\" }}` with the body that carries it, or `on = \"ground\"`"
        ));
    }

    /// Warns of points that a force element holds on a body that does not have them, where others do.
    pub(super) fn warn_held_elsewhere(
        &mut self,
        file: &File,
        bodies: &[Body],
        joints: &[Joint],
        forces: &[Force],
    ) {
        for force in forces.iter().filter(|force| !force.of_joint && force.kind.points > 0) {
            let owners = force.at.map(|point| self.owners(file, bodies, joints, point));
            let is_elsewhere =
                |end: usize| !owners[end].is_empty() && !owners[end].contains(&force.bodies[end]);
            // Both ends of a spring may be drawn at one place, where one of the bodies has a point.
            let one_place = force.at[0] == force.at[1];
            let wrong = match (one_place, is_elsewhere(0), is_elsewhere(1)) {
                (true, true, true) | (false, true, _) => 0,
                (false, false, true) => 1,
                _ => continue,
            };
            let other = 1 - wrong;
            let body = called(bodies, force.bodies[wrong]);
            let [point, other_point] =
                [wrong, other].map(|end| self.points[force.at[end].index()].name.clone());
            let carriers: Vec<String> =
                owners[wrong].iter().map(|owner| format!("`{}`", called(bodies, *owner))).collect();
            let message = format!(
                "`{}` holds the point `{point}` on `{body}`, but it is one of {}",
                force.name,
                carriers.join(", ")
            );
            let is_swapped = !one_place
                && owners[wrong].contains(&force.bodies[other])
                && (owners[other].is_empty() || owners[other].contains(&force.bodies[wrong]));
            let help = if is_swapped {
                let order = if wrong == 0 { [&other_point, &point] } else { [&point, &other_point] };
                format!(
                    "the points are the other way round: write `at = [\"{}\", \"{}\"]`",
                    order[0], order[1]
                )
            } else {
                format!(
                    "take a point of `{body}`; if the place is right, `{point} = {{ at = [...], on = \"{body}\" }}` says so"
                )
            };
            self.refuse(Code::HeldElsewhere, force.span, message).help(help);
        }
    }

    /// Bodies that have a point by what the file says of bodies, joints and points, each once.
    fn owners(&self, file: &File, bodies: &[Body], joints: &[Joint], point: PointId) -> Vec<Carrier> {
        let known = &self.points[point.index()];
        let written = file.points.0.get(point.index()).is_some_and(|(_, point)| point.value.on.is_some());
        let listed: &[_] = match &known.position {
            Position::PerBody(list) => list,
            Position::Shared(_) => &[],
        };
        let described = bodies.iter().enumerate().filter(|(_, body)| body.inertia.points().contains(&point));
        let jointed = joints.iter().flat_map(|joint| {
            let [on_parent, on_child] = joint.points();
            [(on_parent, joint.parent), (on_child, joint.child)]
        });
        let all = described
            .map(|(body, _)| Carrier::Body(BodyId::new(body)))
            .chain(jointed.filter(|(at, _)| *at == point).map(|(_, carrier)| carrier))
            .chain(listed.iter().map(|(carrier, _)| *carrier))
            .chain(written.then_some(known.carrier));
        let mut owners: Vec<Carrier> = Vec::new();
        for carrier in all {
            if !owners.contains(&carrier) {
                owners.push(carrier);
            }
        }
        owners
    }
}
