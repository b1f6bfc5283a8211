//! Poses, velocities and accelerations of all links by recursion from the ground, [CS (1), (2), (5)].
//! In: a [`Linkage`], coordinates and speeds. Out: expressions in each link's own frame.
//! Never knows forces. Twists are (omega, v of the link's origin); docs/notation.md.

use crate::expr::{Expr, Mat3, Scope, Vec3};

use super::frame::Frame;
use super::linkage::{Freedom, LinkIndex, Linkage};
use super::node::{NodeMotion, NodePose};

/// Relative pose of a link to its parent link.
#[derive(Clone, Copy, Debug)]
pub struct Pose<'g> {
    /// Takes components in this link's frame to the parent's.
    pub rotation: Mat3<'g>,
    /// Position of the origin from the parent's origin, in the parent's frame [m].
    pub offset: Vec3<'g>,
}

/// Twist of a link, in its own frame.
#[derive(Clone, Copy, Debug)]
pub struct Twist<'g> {
    /// Angular velocity [rad/s].
    pub omega: Vec3<'g>,
    /// Velocity of the origin [m/s].
    pub origin: Vec3<'g>,
}

/// Inertial acceleration of a link, in its own frame.
#[derive(Clone, Copy, Debug)]
pub struct Acceleration<'g> {
    /// `skew(omega_dot) + skew(omega)²` [1/s²]: acceleration of the point r is `origin + spin r`.
    pub spin: Mat3<'g>,
    /// Angular acceleration [rad/s²].
    pub alpha: Vec3<'g>,
    /// Acceleration of the origin [m/s²].
    pub origin: Vec3<'g>,
}

/// Poses of all links for given coordinates.
#[derive(Clone, Debug)]
pub struct Poses<'g> {
    /// Relative to the parent link.
    pub relative: Vec<Pose<'g>>,
    /// Relative to W.
    pub world: Vec<Pose<'g>>,
    /// Of floating frames and node links: the node's motion relative to the floating frame.
    pub nodes: Vec<Option<NodePose<'g>>>,
}

/// Rotation matrix of a unit quaternion, scalar first.
pub fn rotation_of_quaternion<'g>([w, x, y, z]: [Expr<'g>; 4]) -> Mat3<'g> {
    let (one, two) = (w.scope().number(1.0), w.scope().number(2.0));
    let [x2, y2, z2] = [x, y, z].map(|c| two * c);
    let [xx, yy, zz] = [x * x2, y * y2, z * z2];
    let [xy, xz, yz] = [x * y2, x * z2, y * z2];
    let [wx, wy, wz] = [w * x2, w * y2, w * z2];
    let diagonal = [one - (yy + zz), one - (xx + zz), one - (xx + yy)];
    Mat3([
        Vec3([diagonal[0], xy - wz, xz + wy]),
        Vec3([xy + wz, diagonal[1], yz - wx]),
        Vec3([xz - wy, yz + wx, diagonal[2]]),
    ])
}

/// Rotation about e_z by an angle, [CS (2)] for a screw through the origin.
fn rotation_about_z<'g>(g: &'g Scope, angle: Expr<'g>) -> Mat3<'g> {
    let (s, c) = (g.sin(angle), g.cos(angle));
    let (zero, one, minus) = (g.zero(), g.one(), g.neg(s));
    Mat3([Vec3([c, minus, zero]), Vec3([s, c, zero]), Vec3([zero, zero, one])])
}

impl<'g> Poses<'g> {
    /// All poses. `mounts` are the positions of the joints in their parent links' frames.
    pub fn new(g: &'g Scope, linkage: &Linkage, mounts: &[Vec3<'g>], q: &[Expr<'g>]) -> Self {
        let mut poses = Self { relative: Vec::new(), world: Vec::new(), nodes: Vec::new() };
        for (at, link) in linkage.links.iter().enumerate() {
            let own = &q[link.coordinates()];
            let node = link.node.as_ref().map(|shape| NodePose::new(g, shape, own));
            let (relative, world) = match (link.freedom, &node) {
                (Freedom::Ball | Freedom::Free, _) => poses.absolute(g, link.parent, mounts[at], own),
                (freedom, Some(node)) => {
                    let relative = node_pose(g, freedom, &link.mount, node);
                    (relative, poses.compose(g, link.parent, relative))
                }
                _ => {
                    let relative = local_pose(g, link.freedom, &link.mount, mounts[at], own);
                    (relative, poses.compose(g, link.parent, relative))
                }
            };
            poses.relative.push(relative);
            poses.world.push(world);
            poses.nodes.push(node);
        }
        poses
    }

    /// A ball or free link: its orientation (and position) is a coordinate itself.
    fn absolute(
        &self,
        g: &'g Scope,
        parent: LinkIndex,
        mount: Vec3<'g>,
        q: &[Expr<'g>],
    ) -> (Pose<'g>, Pose<'g>) {
        let rotation = rotation_of_quaternion([q[0], q[1], q[2], q[3]]);
        if q.len() == 7 {
            let pose = Pose { rotation, offset: Vec3::first_of(&q[4..]) };
            return (pose, pose);
        }
        let Some(parent) = parent else {
            let pose = Pose { rotation, offset: mount };
            return (pose, pose);
        };
        let outer = self.world[parent];
        let relative = Pose { rotation: g.mul_mat3(outer.rotation.transpose(), rotation), offset: mount };
        let carried = g.mul_vec3(outer.rotation, mount);
        let world = Pose { rotation, offset: g.add3(outer.offset, carried) };
        (relative, world)
    }

    fn compose(&self, g: &'g Scope, parent: LinkIndex, relative: Pose<'g>) -> Pose<'g> {
        let Some(parent) = parent else { return relative };
        let outer = self.world[parent];
        let carried = g.mul_vec3(outer.rotation, relative.offset);
        Pose {
            rotation: g.mul_mat3(outer.rotation, relative.rotation),
            offset: g.add3(outer.offset, carried),
        }
    }

    /// World pose; identity for the ground.
    pub fn world_of(&self, g: &'g Scope, link: LinkIndex) -> Pose<'g> {
        match link {
            Some(at) => self.world[at],
            None => Pose { rotation: g.matrix(Frame::IDENTITY.0), offset: g.zero_vector() },
        }
    }

    /// Takes components in the frame of `from` to the frame of `to`, along the tree.
    pub fn rotation_between(
        &self,
        g: &'g Scope,
        linkage: &Linkage,
        from: LinkIndex,
        to: LinkIndex,
    ) -> Mat3<'g> {
        let top = linkage.common_ancestor(from, to);
        let down = self.rotation_up(g, linkage, from, top);
        let up = self.rotation_up(g, linkage, to, top);
        g.mul_mat3(up.transpose(), down)
    }

    /// Takes components in the frame of `from` to that of its ancestor `to`.
    fn rotation_up(&self, g: &'g Scope, linkage: &Linkage, from: LinkIndex, to: LinkIndex) -> Mat3<'g> {
        if to.is_none() {
            return self.world_of(g, from).rotation;
        }
        let mut rotation = g.matrix(Frame::IDENTITY.0);
        let mut at = from;
        while at != to {
            let link = at.expect("the ancestor lies on the path to the ground");
            rotation = g.mul_mat3(self.relative[link].rotation, rotation);
            at = linkage.links[link].parent;
        }
        rotation
    }

    /// Position in W of a point given in a link's frame [m].
    pub fn position(&self, g: &'g Scope, link: LinkIndex, point: Vec3<'g>) -> Vec3<'g> {
        let Some(at) = link else { return point };
        let carried = g.mul_vec3(self.world[at].rotation, point);
        g.add3(self.world[at].offset, carried)
    }
}

fn local_pose<'g>(
    g: &'g Scope,
    freedom: Freedom,
    mount: &Frame,
    origin: Vec3<'g>,
    q: &[Expr<'g>],
) -> Pose<'g> {
    match freedom {
        Freedom::Rotation { offset, advance } => {
            let offset_angle = g.constant(offset);
            let angle = g.add(q[0], offset_angle);
            let turn = rotation_about_z(g, angle);
            let canonical = g.matrix(mount.0);
            let rotation = g.mul_mat3(canonical, turn);
            let rate = g.constant(advance);
            let stroke = g.mul(rate, q[0]);
            let axis = g.vector(mount.axis(2));
            let moved = g.scale3(stroke, axis);
            Pose { rotation, offset: g.add3(origin, moved) }
        }
        Freedom::Translation { axis } => {
            let axis = g.vector(axis);
            let moved = g.scale3(q[0], axis);
            Pose { rotation: g.matrix(Frame::IDENTITY.0), offset: g.add3(origin, moved) }
        }
        _ => Pose { rotation: g.matrix(mount.0), offset: origin },
    }
}

/// Pose of a node in its floating frame, or of the floating frame behind its inboard node.
fn node_pose<'g>(g: &'g Scope, freedom: Freedom, mount: &Frame, node: &NodePose<'g>) -> Pose<'g> {
    let identity = g.matrix(Frame::IDENTITY.0);
    let rotation = node.rotation.unwrap_or(identity);
    if freedom == Freedom::Node {
        return Pose { rotation, offset: node.place };
    }
    let mount = g.matrix(mount.0);
    let rotation = g.mul_mat3(mount, rotation.transpose());
    let carried = g.mul_vec3(rotation, node.place);
    Pose { rotation, offset: g.neg3(carried) }
}

/// Velocity of a point of a link, in the link's frame.
pub fn point_velocity<'g>(g: &'g Scope, twist: &Twist<'g>, point: Vec3<'g>) -> Vec3<'g> {
    let turned = g.cross3(twist.omega, point);
    g.add3(twist.origin, turned)
}

/// Acceleration of a point of a link, in the link's frame.
pub fn point_acceleration<'g>(g: &'g Scope, acceleration: &Acceleration<'g>, point: Vec3<'g>) -> Vec3<'g> {
    let turned = g.mul_vec3(acceleration.spin, point);
    g.add3(acceleration.origin, turned)
}

/// Twists of all links for given speeds.
pub fn twists<'g>(g: &'g Scope, linkage: &Linkage, poses: &Poses<'g>, v: &[Expr<'g>]) -> Vec<Twist<'g>> {
    let mut twists: Vec<Twist<'g>> = Vec::new();
    for (at, link) in linkage.links.iter().enumerate() {
        let own = &v[link.speeds()];
        let twist = if link.freedom == Freedom::Free {
            Twist { omega: Vec3::first_of(own), origin: Vec3::first_of(&own[3..]) }
        } else {
            let carried = carried_twist(g, link.parent.map(|p| twists[p]), &poses.relative[at]);
            match link.freedom {
                Freedom::Ball => Twist { omega: Vec3::first_of(own), origin: carried.origin },
                Freedom::Rotation { advance, .. } => {
                    let rate = g.constant(advance);
                    let slide = g.mul(rate, own[0]);
                    let mut moved = carried;
                    moved.omega[2] = g.add(moved.omega[2], own[0]);
                    moved.origin[2] = g.add(moved.origin[2], slide);
                    moved
                }
                Freedom::Translation { axis } => {
                    let axis = g.vector(axis);
                    let slide = g.scale3(own[0], axis);
                    Twist { omega: carried.omega, origin: g.add3(carried.origin, slide) }
                }
                Freedom::Flexible { .. } | Freedom::Node => {
                    let node = poses.nodes[at].as_ref().expect("a floating frame or node has shapes");
                    deformed_twist(g, link.freedom, carried, node, own)
                }
                Freedom::Weld | Freedom::Free => carried,
            }
        };
        twists.push(twist);
    }
    twists
}

/// Twist of a node, or of a floating frame behind its inboard node, from what it would be without modal speeds.
fn deformed_twist<'g>(
    g: &'g Scope,
    freedom: Freedom,
    carried: Twist<'g>,
    node: &NodePose<'g>,
    v: &[Expr<'g>],
) -> Twist<'g> {
    let rate = node.velocity(g, v);
    if freedom == Freedom::Node {
        let (turn, slide) = (node.to_section(g, rate.turn), node.to_section(g, rate.slide));
        return Twist { omega: g.add3(carried.omega, turn), origin: g.add3(carried.origin, slide) };
    }
    let lever = g.cross3(rate.turn, node.place);
    let moved = g.sub3(lever, rate.slide);
    Twist { omega: g.sub3(carried.omega, rate.turn), origin: g.add3(carried.origin, moved) }
}

/// Twist that a link would have if it were fixed to its parent.
pub fn carried_twist<'g>(g: &'g Scope, parent: Option<Twist<'g>>, pose: &Pose<'g>) -> Twist<'g> {
    let Some(parent) = parent else {
        let zero = g.zero_vector();
        return Twist { omega: zero, origin: zero };
    };
    let at_joint = point_velocity(g, &parent, pose.offset);
    Twist {
        omega: g.transpose_mul_vec3(pose.rotation, parent.omega),
        origin: g.transpose_mul_vec3(pose.rotation, at_joint),
    }
}

/// `skew(alpha) + skew(omega)²`.
pub fn spin<'g>(g: &'g Scope, omega: Vec3<'g>, alpha: Vec3<'g>) -> Mat3<'g> {
    let squares = omega.map(|c| g.square(c));
    let mut matrix = g.matrix([[0.0; 3]; 3]);
    for i in 0..3 {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let sum = g.add(squares[j], squares[k]);
        matrix[i][i] = g.neg(sum);
        let product = g.mul(omega[i], omega[j]);
        matrix[i][j] = g.sub(product, alpha[k]);
        matrix[j][i] = g.add(product, alpha[k]);
    }
    matrix
}

/// Accelerations of all links for given speeds and speed derivatives. `ground` is the acceleration of
/// the ground: minus gravity, so that weight is carried along.
pub fn accelerations<'g>(
    g: &'g Scope,
    linkage: &Linkage,
    poses: &Poses<'g>,
    twists: &[Twist<'g>],
    (v, v_dot): (&[Expr<'g>], &[Expr<'g>]),
    ground: Vec3<'g>,
) -> Vec<Acceleration<'g>> {
    let mut list: Vec<Acceleration<'g>> = Vec::new();
    for (at, link) in linkage.links.iter().enumerate() {
        let (speed, rate) = (&v[link.speeds()], &v_dot[link.speeds()]);
        let twist = twists[at];
        let (alpha, origin) = if let Some(node) = &poses.nodes[at] {
            let parent = link.parent.expect("a floating frame or node has an inboard link");
            let shape = link.node.as_ref().expect("it has shapes");
            let moved = node.acceleration(g, shape, speed, rate);
            let velocity = node.velocity(g, speed);
            let carried = (twists[parent], list[parent]);
            if link.freedom == Freedom::Node {
                node_acceleration(g, node, carried, velocity, moved)
            } else {
                floating_acceleration(g, node, (&poses.relative[at], twist), carried.1, velocity, moved)
            }
        } else if link.freedom == Freedom::Free {
            let turned = g.cross3(twist.omega, twist.origin);
            // Speeds are true velocities; the ground's share of gravity is added in this frame.
            let weight = g.transpose_mul_vec3(poses.world[at].rotation, ground);
            let moved = g.add3(Vec3::first_of(&rate[3..]), turned);
            (Vec3::first_of(rate), g.add3(moved, weight))
        } else {
            let parent = link.parent.map(|p| (twists[p], list[p]));
            relative_acceleration(g, link.freedom, &poses.relative[at], parent, ground, (speed, rate))
        };
        let spin = spin(g, twist.omega, alpha);
        list.push(Acceleration { spin, alpha, origin });
    }
    list
}

/// Angular acceleration of a section and acceleration of its node, in the section's frame.
fn node_acceleration<'g>(
    g: &'g Scope,
    node: &NodePose<'g>,
    (twist, floating): (Twist<'g>, Acceleration<'g>),
    velocity: NodeMotion<'g>,
    moved: NodeMotion<'g>,
) -> (Vec3<'g>, Vec3<'g>) {
    let carried = point_acceleration(g, &floating, node.place);
    let two = g.constant(2.0);
    let turning = sliding_acceleration(g, carried, twist.omega, velocity.slide, two);
    let origin = g.add3(turning, moved.slide);
    let swung = g.cross3(twist.omega, velocity.turn);
    let relative = g.add3(swung, moved.turn);
    let alpha = g.add3(floating.alpha, relative);
    (node.to_section(g, alpha), node.to_section(g, origin))
}

/// Angular acceleration of a floating frame and acceleration of its origin, in its frame, from those of the
/// link that holds its inboard node.
fn floating_acceleration<'g>(
    g: &'g Scope,
    node: &NodePose<'g>,
    (pose, twist): (&Pose<'g>, Twist<'g>),
    holder: Acceleration<'g>,
    velocity: NodeMotion<'g>,
    moved: NodeMotion<'g>,
) -> (Vec3<'g>, Vec3<'g>) {
    let outer = g.transpose_mul_vec3(pose.rotation, holder.alpha);
    let swung = g.cross3(twist.omega, velocity.turn);
    let relative = g.add3(swung, moved.turn);
    let alpha = g.sub3(outer, relative);
    let at_node = g.transpose_mul_vec3(pose.rotation, holder.origin);
    let spin = spin(g, twist.omega, alpha);
    let turned = g.mul_vec3(spin, node.place);
    let two = g.constant(2.0);
    let gone = sliding_acceleration(g, turned, twist.omega, velocity.slide, two);
    let gone = g.add3(gone, moved.slide);
    (alpha, g.sub3(at_node, gone))
}

/// Angular acceleration and acceleration of the origin of a jointed link, in its frame.
fn relative_acceleration<'g>(
    g: &'g Scope,
    freedom: Freedom,
    pose: &Pose<'g>,
    parent: Option<(Twist<'g>, Acceleration<'g>)>,
    ground: Vec3<'g>,
    (speed, rate): (&[Expr<'g>], &[Expr<'g>]),
) -> (Vec3<'g>, Vec3<'g>) {
    let zero = g.zero_vector();
    let (outer_omega, outer_alpha, at_joint) = match parent {
        Some((twist, acceleration)) => {
            let at_joint = point_acceleration(g, &acceleration, pose.offset);
            let omega = g.transpose_mul_vec3(pose.rotation, twist.omega);
            (omega, g.transpose_mul_vec3(pose.rotation, acceleration.alpha), at_joint)
        }
        None => (zero, zero, ground),
    };
    let carried = g.transpose_mul_vec3(pose.rotation, at_joint);
    let two = g.constant(2.0);
    match freedom {
        Freedom::Ball => (Vec3::first_of(rate), carried),
        Freedom::Rotation { advance, .. } => {
            let own = Vec3([zero[0], zero[0], speed[0]]);
            let turned = g.cross3(outer_omega, own);
            let mut alpha = g.add3(outer_alpha, turned);
            alpha[2] = g.add(alpha[2], rate[0]);
            let lead = g.constant(advance);
            let slide = g.scale3(lead, own);
            let mut origin = sliding_acceleration(g, carried, outer_omega, slide, two);
            let rate_along = g.mul(lead, rate[0]);
            origin[2] = g.add(origin[2], rate_along);
            (alpha, origin)
        }
        Freedom::Translation { axis } => {
            let axis = g.vector(axis);
            let slide = g.scale3(speed[0], axis);
            let origin = sliding_acceleration(g, carried, outer_omega, slide, two);
            let along = g.scale3(rate[0], axis);
            (outer_alpha, g.add3(origin, along))
        }
        Freedom::Weld | Freedom::Free | Freedom::Flexible { .. } | Freedom::Node => (outer_alpha, carried),
    }
}

/// Coriolis acceleration of a relative velocity `slide` added to the carried acceleration.
fn sliding_acceleration<'g>(
    g: &'g Scope,
    carried: Vec3<'g>,
    omega: Vec3<'g>,
    slide: Vec3<'g>,
    two: Expr<'g>,
) -> Vec3<'g> {
    let turned = g.cross3(omega, slide);
    let coriolis = g.scale3(two, turned);
    g.add3(carried, coriolis)
}
