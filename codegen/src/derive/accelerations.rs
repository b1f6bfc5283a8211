//! Accelerations of all links by recursion from the ground, [CS (5)].
//! In: poses, twists, derivatives of speeds. Out: [`Acceleration`]s. Never knows forces.

use crate::expr::{Expr, Vec3};

use super::attachment::{NodeMotion, NodePose};
use super::kinematics::{Acceleration, Pose, Poses, Twist};
use super::linkage::Freedom;
use super::turned::{Lever, Turned, spin};

/// Accelerations of all links for given speeds and speed derivatives. `ground` is the acceleration of
/// the ground: minus gravity, so that weight is carried along.
pub fn accelerations<'g>(
    poses: &Poses<'g>,
    twists: &[Twist<'g>],
    (v, v_dot): (&[Expr<'g>], &[Expr<'g>]),
    ground: Vec3<'g>,
) -> Vec<Acceleration<'g>> {
    let g = poses.geometry.g;
    let still = Acceleration {
        spin: g.matrix([[0.0; 3]; 3]),
        alpha: g.zero_vector(),
        origin: ground,
        turned: Turned::zero(g),
    };
    let mut list: Vec<Acceleration<'g>> = Vec::new();
    for (at, link) in poses.geometry.linkage.links.iter().enumerate() {
        let (speed, rate) = (&v[link.speeds()], &v_dot[link.speeds()]);
        let (twist, pose) = (twists[at], &poses.relative[at]);
        let (outer, parent) = match link.parent {
            Some(parent) => (twists[parent], list[parent]),
            None => (Twist::none(g), still),
        };
        let (alpha, origin) = if let (Some(node), Some(shape)) = (&poses.nodes[at], &link.node) {
            let moved = node.acceleration(shape, speed, rate);
            let velocity = node.velocity(speed);
            if link.freedom == Freedom::Node {
                node_acceleration(node, (outer, parent), velocity, moved)
            } else {
                floating_acceleration(node, (pose, twist), parent, velocity, moved)
            }
        } else if link.freedom == Freedom::Free {
            let turned = twist.omega.cross(twist.origin);
            // Speeds are true velocities; the ground's share of gravity is added in this frame.
            let weight = poses.world[at].inwards(ground);
            (Vec3::first_of(rate), Vec3::first_of(&rate[3..]) + turned + weight)
        } else {
            relative_acceleration(link.freedom, pose, (outer, parent), (speed, rate))
        };
        let slide = link.freedom.screw().map_or_else(
            || g.zero_vector(),
            |[_, slide]| {
                let slide = g.vector(slide);
                coriolis(twist.omega, speed[0] * slide) + rate[0] * slide
            },
        );
        let without = origin - poses.world[at].inwards(ground);
        let lever =
            Lever::of_acceleration(poses.world_of(g, link.parent).rotation, outer.omega, parent.alpha);
        let turned = poses.passed_on(at, without, (parent.turned, &lever, slide));
        list.push(Acceleration { spin: spin(twist.omega, alpha), alpha, origin, turned });
    }
    list
}

/// Angular acceleration of a section and acceleration of its node, in the section's frame.
fn node_acceleration<'g>(
    node: &NodePose<'g>,
    (twist, floating): (Twist<'g>, Acceleration<'g>),
    velocity: NodeMotion<'g>,
    moved: NodeMotion<'g>,
) -> (Vec3<'g>, Vec3<'g>) {
    let origin = floating.at(node.place) + coriolis(twist.omega, velocity.slide) + moved.slide;
    let alpha = floating.alpha + (twist.omega.cross(velocity.turn) + moved.turn);
    (node.to_section(alpha), node.to_section(origin))
}

/// Angular acceleration of a floating frame and acceleration of its origin, in its frame, from those of the
/// link that holds its inboard node.
fn floating_acceleration<'g>(
    node: &NodePose<'g>,
    (pose, twist): (&Pose<'g>, Twist<'g>),
    holder: Acceleration<'g>,
    velocity: NodeMotion<'g>,
    moved: NodeMotion<'g>,
) -> (Vec3<'g>, Vec3<'g>) {
    let alpha = pose.inwards(holder.alpha) - (twist.omega.cross(velocity.turn) + moved.turn);
    let at_node = pose.inwards(holder.origin);
    let turned = spin(twist.omega, alpha) * node.place;
    (alpha, at_node - (turned + coriolis(twist.omega, velocity.slide) + moved.slide))
}

/// Angular acceleration and acceleration of the origin of a jointed link, in its frame.
fn relative_acceleration<'g>(
    freedom: Freedom,
    pose: &Pose<'g>,
    (twist, parent): (Twist<'g>, Acceleration<'g>),
    (speed, rate): (&[Expr<'g>], &[Expr<'g>]),
) -> (Vec3<'g>, Vec3<'g>) {
    let g = twist.omega.scope();
    let at_joint = parent.at(pose.offset);
    let (omega, alpha) = (pose.inwards(twist.omega), pose.inwards(parent.alpha));
    let carried = pose.inwards(at_joint);
    match (freedom, freedom.screw()) {
        (Freedom::Ball, _) => (Vec3::first_of(rate), carried),
        (_, Some(screw)) => {
            let [turn, slide] = screw.map(|axis| g.vector(axis));
            let turned = alpha + omega.cross(speed[0] * turn) + rate[0] * turn;
            let moved = carried + coriolis(omega, speed[0] * slide) + rate[0] * slide;
            (turned, moved)
        }
        (_, None) => (alpha, carried),
    }
}

/// Coriolis acceleration of a relative velocity `slide` in a frame that turns with `omega`.
fn coriolis<'g>(omega: Vec3<'g>, slide: Vec3<'g>) -> Vec3<'g> {
    let two = omega.scope().number(2.0);
    two * omega.cross(slide)
}
