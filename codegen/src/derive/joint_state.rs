//! Coordinates, speeds and accelerations of joints and points, wherever they come from: a coordinate of the
//! tree, or recomputed across a cut. In: link motion. Out: expressions. Never knows forces.

use std::rc::Rc;

use crate::expr::{Expr, Scope, Vec3};
use crate::id::{BodyId, JointId, PointId};
use crate::model::{Carrier, Formula, Term};

use super::force_values::force_values;
use super::geometry::Geometry;
use super::joint_coordinates::{JointCoordinates, joint_coordinates};
use super::joint_markers::{joint_in_child, joint_links, joint_markers};
use super::linkage::LinkIndex;
use super::motion::Motion;
use super::relative_motion::{Place, RelativeMotion, Side, Sums};
use super::responses::Responses;

/// All a formula or an output column may ask of the state.
pub struct JointStates<'g> {
    pub geometry: Geometry<'g>,
    pub motion: Motion<'g>,
    pub q: Vec<Expr<'g>>,
    pub v: Vec<Expr<'g>>,
    /// All speed derivatives (zero where they are not asked for).
    pub v_dot: Vec<Expr<'g>>,
    /// Values of the file's own states.
    pub own: Vec<Expr<'g>>,
    /// What formulas ask of the solution of the instant.
    pub responses: Rc<Responses<'g>>,
    /// Whether velocities of points are summed up in W, else in the frames of their links.
    pub points_in_ground: bool,
}

impl<'g> JointStates<'g> {
    /// Coordinates of a joint; for tree joints read from the state, else recomputed.
    pub fn coordinates(&self, g: &'g Scope, joint: JointId) -> JointCoordinates<'g> {
        let count = self.geometry.mechanism.joint(joint).model.coordinates().len();
        let linkage = self.geometry.linkage;
        let links: Vec<Option<usize>> = (0..count).map(|c| linkage.link_of_coordinate(joint, c)).collect();
        if links.iter().all(Option::is_some) {
            let links: Vec<usize> = links.into_iter().flatten().collect();
            let pick = |values: &[Expr<'g>], first: fn(&super::linkage::Link) -> usize| {
                links.iter().map(|at| values[first(&linkage.links[*at])]).collect::<Vec<Expr<'g>>>()
            };
            return JointCoordinates {
                position: pick(&self.q, |link| link.first_coordinate),
                speed: pick(&self.v, |link| link.first_speed),
                acceleration: pick(&self.v_dot, |link| link.first_speed),
                wraps: vec![false; links.len()],
                duals: Vec::new(),
            };
        }
        let motion = self.relative_motion(joint);
        joint_coordinates(g, &self.geometry, &self.geometry.mechanism.joint(joint).model, &motion)
    }

    /// Relative motion of the child of any joint.
    pub fn relative_motion(&self, joint: JointId) -> RelativeMotion<'g> {
        let links = joint_links(&self.geometry, joint);
        let in_child = joint_in_child(&self.geometry, joint, links);
        let markers = joint_markers(&self.geometry, joint, links, in_child);
        let side = if in_child { Side::Child } else { Side::Parent };
        RelativeMotion::between(&self.motion, markers, side, (Place::Child, Sums::Links))
    }

    /// The link that carries a named point, and its place in the link's frame [m].
    fn place_of(&self, point: PointId) -> (LinkIndex, Vec3<'g>) {
        let carrier = self.geometry.mechanism.point(point).carrier;
        let link = self.geometry.linkage.link_at(carrier, point, false);
        (link, self.geometry.local(link, point))
    }

    /// Components in W of a vector that a carrier takes along, given at the reference pose.
    pub fn taken_along(&self, carrier: Carrier, vector: Vec3<'g>) -> Vec3<'g> {
        let Some(at) = self.geometry.linkage.link(carrier) else { return vector };
        let local = self.geometry.turn(&self.geometry.linkage.links[at].frame, vector);
        self.motion.poses.world[at].rotation * local
    }

    /// Position of a named point in W [m].
    pub fn point(&self, point: PointId) -> Vec3<'g> {
        let (link, local) = self.place_of(point);
        self.motion.poses.position(link, local)
    }

    /// Velocity of a named point in W [m/s].
    pub fn point_velocity(&self, point: PointId) -> Vec3<'g> {
        let (link, local) = self.place_of(point);
        if self.points_in_ground {
            return self.motion.velocity_in_ground(link, local);
        }
        let rotation = self.motion.poses.world_of(self.geometry.g, link).rotation;
        self.motion.velocity(link, local, rotation)[1]
    }

    /// A formula over the state.
    pub fn lower(&self, g: &'g Scope, formula: &Formula) -> Expr<'g> {
        self.lower_asking(g, formula, &self.responses)
    }

    /// The same, with symbols of `responses` for what it asks of the solution of the instant.
    pub fn lower_asking(&self, g: &'g Scope, formula: &Formula, responses: &Responses<'g>) -> Expr<'g> {
        self.geometry.inputs.lower_with(formula, &|term| match term {
            Term::JointPosition(joint, c) => self.coordinates(g, *joint).position[*c],
            Term::JointSpeed(joint, c) => self.coordinates(g, *joint).speed[*c],
            Term::PointPosition(point, i) => self.point(*point)[*i],
            Term::PointSpeed(point, i) => self.point_velocity(*point)[*i],
            Term::BodySpin(body, i) => self.spin(*body)[*i],
            Term::ForceValue(force, at) => {
                let element = &self.geometry.mechanism.forces[force.index()];
                force_values(element, &self.motion)[*at]
            }
            Term::State(id) => self.own[id.index()],
            Term::Response(response) => responses.symbol(g, *response),
            _ => g.zero(),
        })
    }

    /// The value of a force; of one that asks for the solution of the instant the symbol that stands for it.
    pub fn force_law(&self, g: &'g Scope, formula: &Formula) -> Expr<'g> {
        let value = self.lower(g, formula);
        if formula.asks_for_responses() { self.responses.unknown(g, value) } else { value }
    }

    /// Acceleration of a named point in W [m/s²].
    pub fn point_acceleration(&self, point: PointId) -> Vec3<'g> {
        let (link, local) = self.place_of(point);
        let Some(at) = link else { return self.geometry.g.zero_vector() };
        let with_weight = self.motion.accelerations[at].at(local);
        self.motion.poses.world[at].rotation * with_weight - self.motion.ground
    }

    /// Angular acceleration of a body in W [rad/s²].
    pub fn spin_rate(&self, body: BodyId) -> Vec3<'g> {
        let at = self.geometry.linkage.link_of_body[body.index()];
        self.motion.poses.world[at].rotation * self.motion.accelerations[at].alpha
    }

    /// Angular velocity of a body in W [rad/s].
    pub fn spin(&self, body: BodyId) -> Vec3<'g> {
        let at = self.geometry.linkage.link_of_body[body.index()];
        self.motion.poses.world[at].rotation * self.motion.twists[at].omega
    }
}
