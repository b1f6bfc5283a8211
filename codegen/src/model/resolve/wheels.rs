//! Wheels: which body carries the axes of those that mesh, and how their angles relative to it follow from joint
//! coordinates. Never knows teeth.

use super::inertia::{between, cross, distance, dot};
use super::resolver::{Resolver, place};
use crate::diagnostic::Code;
use crate::id::{BodyId, JointId};
use crate::model::{Carrier, CoupledCoordinate, Formula, Joint, Look};
use crate::spec::{CouplingKind, CouplingSpec, Dimension, File, Name};

/// A coupling that is being resolved.
pub(super) struct Draft<'a> {
    pub(super) kind: &'static CouplingKind,
    pub(super) name: &'a Name,
    pub(super) spec: &'a CouplingSpec,
    pub(super) file: &'a File,
    pub(super) joints: &'a [Joint],
}

/// Sines below this are those of parallel axes, distances below this share of a mechanism's size those of one line: a
/// drawing of six digits.
pub(super) const DRAWN: f64 = 1e-6;

/// A body that turns about an axis of a carrier, or slides along a direction of it.
#[derive(Clone, Debug)]
pub(super) struct Seat {
    pub(super) body: BodyId,
    /// The body's own joint.
    pub(super) joint: JointId,
    pub(super) carrier: Carrier,
    /// Where that joint is [m].
    pub(super) centre: [f64; 3],
    /// Unit direction of axis or slide, that of the body's own joint.
    pub(super) axis: [f64; 3],
    /// Coordinates whose sum with these signs is its angle or path relative to the carrier.
    pub(super) path: Vec<(JointId, f64)>,
}

impl Seat {
    /// Whether both turn about one line, as far as drawings tell.
    pub(super) fn is_coaxial(&self, other: &Self, size: f64) -> bool {
        is_parallel(self.axis, other.axis) && off_line(self.centre, self.axis, other.centre) <= DRAWN * size
    }

    /// The joints of its path, each with the direction in which it moves the body over the carrier.
    pub(super) fn slides(&self) -> Vec<(JointId, [f64; 3])> {
        self.path.iter().map(|(joint, sign)| (*joint, self.axis.map(|x| sign * x))).collect()
    }
}

pub(super) fn is_parallel(a: [f64; 3], b: [f64; 3]) -> bool {
    let across = cross(a, b);
    dot(across, across).sqrt() <= DRAWN
}

/// Distance of a point from a line through `origin`.
pub(super) fn off_line(origin: [f64; 3], direction: [f64; 3], point: [f64; 3]) -> f64 {
    let across = cross(between(origin, point), direction);
    dot(across, across).sqrt()
}

/// How a body may sit on others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Seating {
    /// It turns: by revolute joints about one line.
    Turns,
    /// It slides: by prismatic joints along one direction.
    Slides,
}

impl Seating {
    /// Whether a joint leaves this motion and no other.
    fn is_left_by(self, joint: &Joint) -> bool {
        match self {
            Self::Turns => joint.model.is_hinge(),
            Self::Slides => joint.model.kind.look() == Look::Slider,
        }
    }
}

impl Resolver<'_> {
    /// Every way in which a body sits on another: on its neighbours, and on theirs where the line of the axis stays.
    pub(super) fn seats(&self, body: BodyId, seating: Seating, joints: &[Joint]) -> Vec<Seat> {
        let size = self.drawing_size(joints);
        let own = (0..joints.len()).filter(|at| {
            let joint = &joints[*at];
            seating.is_left_by(joint) && side_of(joint, Carrier::Body(body)).is_some()
        });
        let mut seats = Vec::new();
        for at in own {
            let joint = &joints[at];
            let centre = self.position_value(joint.at, Carrier::Body(body));
            let axis = joint.model.axes[0].parent;
            let mut reached = vec![(Carrier::Body(body), Vec::new())];
            let mut next = 0;
            while let Some((from, path)) = reached.get(next).cloned() {
                next += 1;
                for (step, joint) in joints.iter().enumerate() {
                    let first = next == 1;
                    let Some(to) = side_of(joint, from).filter(|_| !first || step == at) else { continue };
                    let same_line = seating.is_left_by(joint)
                        && is_parallel(axis, joint.model.axes[0].parent)
                        && (seating == Seating::Slides
                            || off_line(centre, axis, self.position_value(joint.at, to)) <= DRAWN * size);
                    let known = reached.iter().any(|(body, _)| *body == to);
                    if known || !(same_line || joint.model.rows() == 6) {
                        continue;
                    }
                    let mut path: Vec<(JointId, f64)> = path.clone();
                    if same_line {
                        let along = dot(axis, joint.model.axes[0].parent).signum();
                        path.push((JointId::new(step), if joint.child == from { along } else { -along }));
                    }
                    reached.push((to, path));
                }
            }
            let others = reached.into_iter().skip(1);
            seats.extend(others.map(|(carrier, path)| Seat {
                body,
                joint: JointId::new(at),
                carrier,
                centre,
                axis,
                path,
            }));
        }
        seats
    }

    /// Largest distance of a joint from the first [m].
    pub(super) fn drawing_size(&self, joints: &[Joint]) -> f64 {
        let places: Vec<_> = joints.iter().map(|joint| self.position_value(joint.at, joint.parent)).collect();
        places.iter().map(|place| distance(places[0], *place)).fold(0.0, f64::max)
    }
}

/// The other body of a joint of `body`.
fn side_of(joint: &Joint, body: Carrier) -> Option<Carrier> {
    match (joint.parent == body, joint.child == body) {
        (true, false) => Some(joint.child),
        (false, true) => Some(joint.parent),
        _ => None,
    }
}

impl Resolver<'_> {
    /// Seats of two wheels on the one body that carries the axes of both.
    pub(super) fn pair_of_seats(
        &mut self,
        draft: &Draft<'_>,
        wheels: [BodyId; 2],
        second: Seating,
    ) -> Option<Vec<Seat>> {
        let size = self.drawing_size(draft.joints);
        let seatings = [Seating::Turns, second];
        let all = [0, 1].map(|i| self.seats(wheels[i], seatings[i], draft.joints));
        let wanted = match &draft.spec.carrier {
            Some(name) => Some(self.carrier(name, &place("carrier", "coupling", draft.name))?),
            None => None,
        };
        let pairs = all[0].iter().flat_map(|a| all[1].iter().map(move |b| [a, b]));
        let fits = |pair: &[&Seat; 2]| {
            let [a, b] = pair;
            a.carrier == b.carrier
                && wanted.is_none_or(|wanted| wanted == a.carrier)
                && a.carrier != Carrier::Body(b.body)
                && b.carrier != Carrier::Body(a.body)
                && (second == Seating::Slides || !a.is_coaxial(b, size))
        };
        let best = pairs.filter(fits).min_by_key(|[a, b]| a.path.len() + b.path.len());
        let Some(seats) = best.map(|pair| pair.map(Clone::clone).to_vec()) else {
            let names = wheels.map(|wheel| draft.file.bodies.0[wheel.index()].0.value.clone());
            let message = format!(
                "no body carries the axes of both `{}` and `{}` of coupling `{}`",
                names[0], names[1], draft.name.value
            );
            let help = format!(
                "wheels turn in revolute joints{} on one body, or on bodies that turn about the same line; the axes of both \
                 keep their distance only there",
                if second == Seating::Slides { ", racks slide in prismatic ones," } else { "" }
            );
            self.refuse(Code::BadCoupling, draft.name.span, message).help(help);
            return None;
        };
        self.are_rigid(draft, &seats)?;
        Some(seats)
    }

    /// Seats of bodies that turn about one line, all on one body.
    pub(super) fn seats_on_one_line(&mut self, draft: &Draft<'_>, wheels: &[BodyId]) -> Option<Vec<Seat>> {
        let size = self.drawing_size(draft.joints);
        let all: Vec<Vec<Seat>> =
            wheels.iter().map(|wheel| self.seats(*wheel, Seating::Turns, draft.joints)).collect();
        for first in &all[0] {
            let partner = |seats: &Vec<Seat>| {
                let fits = |seat: &&Seat| seat.carrier == first.carrier && seat.is_coaxial(first, size);
                seats.iter().find(fits).cloned()
            };
            if let Some(seats) = all.iter().map(partner).collect::<Option<Vec<Seat>>>() {
                return Some(seats);
            }
        }
        let names: Vec<String> =
            wheels.iter().map(|wheel| format!("`{}`", draft.file.bodies.0[wheel.index()].0.value)).collect();
        let message =
            format!("{} of coupling `{}` do not turn about one line", names.join(", "), draft.name.value);
        self.refuse(Code::BadCoupling, draft.name.span, message)
            .help("give each a revolute joint on that line, to the ground or to one of the others");
        None
    }

    /// Reports flexible bodies and joints with clearance: there, teeth would mesh elsewhere than drawn.
    fn are_rigid(&mut self, draft: &Draft<'_>, seats: &[Seat]) -> Option<()> {
        for (joint, _) in seats.iter().flat_map(|seat| &seat.path) {
            let joint = &draft.joints[joint.index()];
            let flexible = |carrier: &Carrier| match carrier {
                Carrier::Body(body) => draft.file.bodies.0[body.index()].1.value.flexible.is_some(),
                Carrier::Ground => false,
            };
            let why = if joint.model.clearance {
                "has clearance"
            } else if [joint.parent, joint.child].iter().any(flexible) {
                "is on a flexible body"
            } else {
                continue;
            };
            let message =
                format!("the joint `{}` of a wheel of coupling `{}` {why}", joint.name, draft.name.value);
            self.refuse(Code::BadCoupling, draft.name.span, message).help(
                "teeth mesh where they are drawn only if nothing between them gives way; a `relation` couples the angles alone",
            );
            return None;
        }
        Some(())
    }
}

/// The coordinates of seats with these factors on their angles; those that several have are added up.
pub(super) fn terms(seats: &[Seat], factors: &[f64]) -> Vec<CoupledCoordinate> {
    let mut sums: Vec<(JointId, f64)> = Vec::new();
    for (seat, factor) in seats.iter().zip(factors) {
        for (joint, sign) in &seat.path {
            match sums.iter_mut().find(|(known, _)| known == joint) {
                Some((_, sum)) => *sum += sign * factor,
                None => sums.push((*joint, sign * factor)),
            }
        }
    }
    sums.retain(|(_, factor)| *factor != 0.0);
    let term = |(joint, factor)| CoupledCoordinate {
        joint,
        coordinate: 0,
        factor: Formula::number(factor, Dimension::NONE),
    };
    sums.into_iter().map(term).collect()
}
