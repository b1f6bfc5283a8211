//! Start values of the free coordinates and speeds, as the file gives them.
//! In: [`crate::model::Start`]s. Out: expressions over parameters and t. Never assembles the loops.

use crate::expr::{Expr, Vec3};
use crate::model::{Carrier, Formula, Start};

use super::geometry::Geometry;
use super::kinematics::{Poses, Twist, carried_twist, twists};
use super::linkage::{Freedom, Link};
use super::orientation::{
    link_displacement, quaternion_of_vector, quaternion_product, rotation_of_quaternion,
};

/// Start coordinates and speeds of all, driven ones included, and which of them the file demands.
pub struct StartValues<'g> {
    pub q: Vec<Expr<'g>>,
    pub v: Vec<Expr<'g>>,
    /// Whether each coordinate is demanded exactly.
    pub held_q: Vec<bool>,
    /// Whether each speed is demanded exactly.
    pub held_v: Vec<bool>,
}

/// Start values; `driven` gives driven coordinates and speeds by their index among all.
pub fn start_values<'g>(
    geometry: &Geometry<'g>,
    driven: impl Iterator<Item = (usize, usize, [Expr<'g>; 3])>,
) -> StartValues<'g> {
    let linkage = geometry.linkage;
    let zero = geometry.g.zero();
    let mut values = StartValues {
        q: vec![zero; linkage.coordinates()],
        v: vec![zero; linkage.speeds()],
        held_q: vec![false; linkage.coordinates()],
        held_v: vec![false; linkage.speeds()],
    };
    for at in 0..linkage.links.len() {
        values.position(geometry, at);
    }
    for (coordinate, speed, [position, rate, _]) in driven {
        values.q[coordinate] = position;
        values.v[speed] = rate;
    }
    // Orientations of ball links depend on the angles inboard of them, driven ones included.
    for at in 0..linkage.links.len() {
        values.orientation(geometry, at);
    }
    for at in 0..linkage.links.len() {
        values.scalar_speed(geometry, at);
    }
    values.absolute_speeds(geometry);
    values
}

/// What the file says of the coordinate with this number among those of a link.
fn find<'g>(geometry: &Geometry<'g>, link: &Link, number: usize) -> Option<&'g Start> {
    let coordinate = link.joint_coordinate + number;
    geometry.mechanism.starts.iter().find(|start| start.joint == link.joint && start.coordinate == coordinate)
}

/// What the file asks for, or zero; and whether it demands it exactly.
fn wished<'g>(
    geometry: &Geometry<'g>,
    link: &Link,
    number: usize,
    which: fn(&Start) -> Option<&Formula>,
) -> (Expr<'g>, bool) {
    match find(geometry, link, number).and_then(|start| Some((which(start)?, start.held))) {
        Some((formula, held)) => (geometry.inputs.lower(formula), held),
        None => (geometry.g.zero(), false),
    }
}

fn wished_position<'g>(geometry: &Geometry<'g>, link: &Link, number: usize) -> (Expr<'g>, bool) {
    wished(geometry, link, number, |start| start.position.as_ref())
}

fn wished_speed<'g>(geometry: &Geometry<'g>, link: &Link, number: usize) -> (Expr<'g>, bool) {
    wished(geometry, link, number, |start| start.speed.as_ref())
}

/// Where the point of a link's joint is at the reference pose, in W [m].
fn origin_of<'g>(geometry: &Geometry<'g>, link: &Link) -> Vec3<'g> {
    geometry.described(geometry.mechanism.joint(link.joint).at, Carrier::Body(link.body))
}

impl<'g> StartValues<'g> {
    fn position(&mut self, geometry: &Geometry<'g>, at: usize) {
        let link = &geometry.linkage.links[at];
        if let Freedom::Flexible { .. } = link.freedom {
            return self.modes(geometry, at);
        }
        if link.freedom.coordinates() == 1 {
            let first = link.first_coordinate;
            (self.q[first], self.held_q[first]) = wished_position(geometry, link, 0);
        }
    }

    /// Modes start undeformed and at rest unless the file says otherwise, and assembly leaves them so.
    fn modes(&mut self, geometry: &Geometry<'g>, at: usize) {
        let link = &geometry.linkage.links[at];
        let Some(flexible) = &geometry.mechanism.body(link.body).flexible else { return };
        for (k, (coordinate, speed)) in link.coordinates().zip(link.speeds()).enumerate() {
            [self.q[coordinate], self.v[speed]] = flexible.start[k].map(|x| geometry.g.number(x));
            (self.held_q[coordinate], self.held_v[speed]) = (true, true);
        }
    }

    fn orientation(&mut self, geometry: &Geometry<'g>, at: usize) {
        let link = &geometry.linkage.links[at];
        if !matches!(link.freedom, Freedom::Ball | Freedom::Free) {
            return;
        }
        let (g, linkage) = (geometry.g, geometry.linkage);
        let starts = [0, 1, 2].map(|i| wished_position(geometry, link, i));
        let vector = Vec3(starts.map(|(component, _)| component));
        // The file gives the child's rotation relative to the parent; seen from a reversed joint it is undone.
        let vector = if linkage.reversed[link.joint.index()] { -vector } else { vector };
        let relative = quaternion_of_vector(vector);
        let parent = link_displacement(g, linkage, &self.q, link.parent);
        let turned = quaternion_product(relative, link.frame.quaternion().map(|x| g.number(x)));
        let held = starts.iter().any(|(_, held)| *held);
        let first = link.first_coordinate;
        for (i, component) in quaternion_product(parent, turned).into_iter().enumerate() {
            (self.q[first + i], self.held_q[first + i]) = (component, held);
        }
        if link.freedom == Freedom::Free {
            let moved = [3, 4, 5].map(|i| wished_position(geometry, link, i));
            let way = Vec3(moved.map(|(component, _)| component));
            // Of the ground as the body sees it, if the joint is reversed.
            let way = match linkage.reversed[link.joint.index()] {
                true => -(rotation_of_quaternion(relative) * way),
                false => way,
            };
            for (i, place) in (origin_of(geometry, link) + way).into_iter().enumerate() {
                (self.q[first + 4 + i], self.held_q[first + 4 + i]) = (place, moved[i].1);
            }
        }
    }

    fn scalar_speed(&mut self, geometry: &Geometry<'g>, at: usize) {
        let link = &geometry.linkage.links[at];
        if link.freedom.speeds() != 1 || link.node.is_some() {
            return;
        }
        // A driven speed stands already.
        if find(geometry, link, 0).is_some_and(|start| start.speed.is_some()) {
            let first = link.first_speed;
            (self.v[first], self.held_v[first]) = wished_speed(geometry, link, 0);
        }
    }

    /// Speeds of ball and free links are absolute: what the parent carries plus what the file demands.
    fn absolute_speeds(&mut self, geometry: &Geometry<'g>) {
        let (g, linkage) = (geometry.g, geometry.linkage);
        let poses = Poses::new(*geometry, &self.q);
        for (at, link) in linkage.links.iter().enumerate() {
            if !matches!(link.freedom, Freedom::Ball | Freedom::Free) {
                continue;
            }
            let (wished, held): (Vec<Expr<'g>>, Vec<bool>) =
                (0..link.freedom.speeds()).map(|i| wished_speed(geometry, link, i)).unzip();
            let relative = Vec3::first_of(&wished);
            let is_reversed = linkage.reversed[link.joint.index()];
            let all = twists(&poses, &self.v);
            let parent = link.parent.map_or_else(|| Twist::none(g), |parent| all[parent]);
            let carried = carried_twist(parent, &poses.relative[at]);
            // Wished components are along axes that move with the joint's parent and are parallel to W at the reference pose.
            let along = |vector: Vec3<'g>| geometry.turn(&link.frame, vector);
            let turning = match is_reversed {
                true => -along(relative),
                false => poses.relative[at].inwards(geometry.turn(&linkage.frame(link.parent), relative)),
            };
            let omega = carried.omega + turning;
            let mut speeds = omega.0.to_vec();
            if link.freedom == Freedom::Free {
                let wished = Vec3::first_of(&wished[3..]);
                let place = Vec3::first_of(&self.q[link.first_coordinate + 4..]);
                // How the ground moves as a body sees it that moves and turns.
                speeds.extend(match is_reversed {
                    true => {
                        -(along(wished)
                            + omega.cross(poses.world[at].inwards(origin_of(geometry, link) - place)))
                    }
                    false => poses.world[at].inwards(wished),
                });
            }
            self.v[link.speeds()].copy_from_slice(&speeds);
            self.held_v[link.speeds()].copy_from_slice(&held);
        }
    }
}
