//! Poses, velocities and accelerations of all links by recursion from the ground, [CS (1), (2), (5)].
//! In: a [`Linkage`], coordinates and speeds. Out: expressions in each link's own frame.
//! Never knows forces. Twists are (omega, v of the link's origin); docs/notation.md.

use crate::expr::{ExprId, Mat3, Scope, Vec3, transpose};

use super::frame::Frame;
use super::linkage::{Freedom, LinkIndex, Linkage};
use super::node::{NodeMotion, NodePose};

/// Relative pose of a link to its parent link.
#[derive(Clone, Copy, Debug)]
pub struct Pose {
    /// Takes components in this link's frame to the parent's.
    pub rotation: Mat3,
    /// Position of the origin from the parent's origin, in the parent's frame [m].
    pub offset: Vec3,
}

/// Twist of a link, in its own frame.
#[derive(Clone, Copy, Debug)]
pub struct Twist {
    /// Angular velocity [rad/s].
    pub omega: Vec3,
    /// Velocity of the origin [m/s].
    pub origin: Vec3,
}

/// Inertial acceleration of a link, in its own frame.
#[derive(Clone, Copy, Debug)]
pub struct Acceleration {
    /// `skew(omega_dot) + skew(omega)²` [1/s²]: acceleration of the point r is `origin + spin r`.
    pub spin: Mat3,
    /// Angular acceleration [rad/s²].
    pub alpha: Vec3,
    /// Acceleration of the origin [m/s²].
    pub origin: Vec3,
}

/// Poses of all links for given coordinates.
#[derive(Clone, Debug)]
pub struct Poses {
    /// Relative to the parent link.
    pub relative: Vec<Pose>,
    /// Relative to W.
    pub world: Vec<Pose>,
    /// Of floating frames and node links: the node's motion relative to the floating frame.
    pub nodes: Vec<Option<NodePose>>,
}

/// Rotation matrix of a unit quaternion, scalar first.
pub fn rotation_of_quaternion(g: &Scope, [w, x, y, z]: [ExprId; 4]) -> Mat3 {
    let (one, two) = (g.one(), g.constant(2.0));
    let [x2, y2, z2] = [x, y, z].map(|c| g.mul(two, c));
    let [xx, yy, zz] = [(x, x2), (y, y2), (z, z2)].map(|(a, b)| g.mul(a, b));
    let [xy, xz, yz] = [(x, y2), (x, z2), (y, z2)].map(|(a, b)| g.mul(a, b));
    let [wx, wy, wz] = [x2, y2, z2].map(|c| g.mul(w, c));
    let diagonal = [(yy, zz), (xx, zz), (xx, yy)].map(|(a, b)| {
        let sum = g.add(a, b);
        g.sub(one, sum)
    });
    [
        [diagonal[0], g.sub(xy, wz), g.add(xz, wy)],
        [g.add(xy, wz), diagonal[1], g.sub(yz, wx)],
        [g.sub(xz, wy), g.add(yz, wx), diagonal[2]],
    ]
}

/// Rotation about e_z by an angle, [CS (2)] for a screw through the origin.
fn rotation_about_z(g: &Scope, angle: ExprId) -> Mat3 {
    let (s, c) = (g.sin(angle), g.cos(angle));
    let (zero, one, minus) = (g.zero(), g.one(), g.neg(s));
    [[c, minus, zero], [s, c, zero], [zero, zero, one]]
}

impl Poses {
    /// All poses. `mounts` are the positions of the joints in their parent links' frames.
    pub fn new(g: &Scope, linkage: &Linkage, mounts: &[Vec3], q: &[ExprId]) -> Self {
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
    fn absolute(&self, g: &Scope, parent: LinkIndex, mount: Vec3, q: &[ExprId]) -> (Pose, Pose) {
        let rotation = rotation_of_quaternion(g, [q[0], q[1], q[2], q[3]]);
        if q.len() == 7 {
            let pose = Pose { rotation, offset: [q[4], q[5], q[6]] };
            return (pose, pose);
        }
        let Some(parent) = parent else {
            let pose = Pose { rotation, offset: mount };
            return (pose, pose);
        };
        let outer = self.world[parent];
        let relative = Pose { rotation: g.mul_mat3(transpose(outer.rotation), rotation), offset: mount };
        let carried = g.mul_vec3(outer.rotation, mount);
        let world = Pose { rotation, offset: g.add3(outer.offset, carried) };
        (relative, world)
    }

    fn compose(&self, g: &Scope, parent: LinkIndex, relative: Pose) -> Pose {
        let Some(parent) = parent else { return relative };
        let outer = self.world[parent];
        let carried = g.mul_vec3(outer.rotation, relative.offset);
        Pose {
            rotation: g.mul_mat3(outer.rotation, relative.rotation),
            offset: g.add3(outer.offset, carried),
        }
    }

    /// World pose; identity for the ground.
    pub fn world_of(&self, g: &Scope, link: LinkIndex) -> Pose {
        match link {
            Some(at) => self.world[at],
            None => Pose { rotation: g.matrix(Frame::IDENTITY.0), offset: g.zero_vector() },
        }
    }

    /// Takes components in the frame of `from` to the frame of `to`, along the tree.
    pub fn rotation_between(&self, g: &Scope, linkage: &Linkage, from: LinkIndex, to: LinkIndex) -> Mat3 {
        let top = linkage.common_ancestor(from, to);
        let down = self.rotation_up(g, linkage, from, top);
        let up = self.rotation_up(g, linkage, to, top);
        g.mul_mat3(transpose(up), down)
    }

    /// Takes components in the frame of `from` to that of its ancestor `to`.
    fn rotation_up(&self, g: &Scope, linkage: &Linkage, from: LinkIndex, to: LinkIndex) -> Mat3 {
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
    pub fn position(&self, g: &Scope, link: LinkIndex, point: Vec3) -> Vec3 {
        let Some(at) = link else { return point };
        let carried = g.mul_vec3(self.world[at].rotation, point);
        g.add3(self.world[at].offset, carried)
    }
}

fn local_pose(g: &Scope, freedom: Freedom, mount: &Frame, origin: Vec3, q: &[ExprId]) -> Pose {
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
fn node_pose(g: &Scope, freedom: Freedom, mount: &Frame, node: &NodePose) -> Pose {
    let identity = g.matrix(Frame::IDENTITY.0);
    let rotation = node.rotation.unwrap_or(identity);
    if freedom == Freedom::Node {
        return Pose { rotation, offset: node.place };
    }
    let mount = g.matrix(mount.0);
    let rotation = g.mul_mat3(mount, transpose(rotation));
    let carried = g.mul_vec3(rotation, node.place);
    Pose { rotation, offset: g.neg3(carried) }
}

/// Velocity of a point of a link, in the link's frame.
pub fn point_velocity(g: &Scope, twist: &Twist, point: Vec3) -> Vec3 {
    let turned = g.cross3(twist.omega, point);
    g.add3(twist.origin, turned)
}

/// Acceleration of a point of a link, in the link's frame.
pub fn point_acceleration(g: &Scope, acceleration: &Acceleration, point: Vec3) -> Vec3 {
    let turned = g.mul_vec3(acceleration.spin, point);
    g.add3(acceleration.origin, turned)
}

/// Twists of all links for given speeds.
pub fn twists(g: &Scope, linkage: &Linkage, poses: &Poses, v: &[ExprId]) -> Vec<Twist> {
    let mut twists: Vec<Twist> = Vec::new();
    for (at, link) in linkage.links.iter().enumerate() {
        let own = &v[link.speeds()];
        let twist = if link.freedom == Freedom::Free {
            Twist { omega: [own[0], own[1], own[2]], origin: [own[3], own[4], own[5]] }
        } else {
            let carried = carried_twist(g, link.parent.map(|p| twists[p]), &poses.relative[at]);
            match link.freedom {
                Freedom::Ball => Twist { omega: [own[0], own[1], own[2]], origin: carried.origin },
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
fn deformed_twist(g: &Scope, freedom: Freedom, carried: Twist, node: &NodePose, v: &[ExprId]) -> Twist {
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
pub fn carried_twist(g: &Scope, parent: Option<Twist>, pose: &Pose) -> Twist {
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
pub fn spin(g: &Scope, omega: Vec3, alpha: Vec3) -> Mat3 {
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
pub fn accelerations(
    g: &Scope,
    linkage: &Linkage,
    poses: &Poses,
    twists: &[Twist],
    (v, v_dot): (&[ExprId], &[ExprId]),
    ground: Vec3,
) -> Vec<Acceleration> {
    let mut list: Vec<Acceleration> = Vec::new();
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
            let moved = g.add3([rate[3], rate[4], rate[5]], turned);
            ([rate[0], rate[1], rate[2]], g.add3(moved, weight))
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
fn node_acceleration(
    g: &Scope,
    node: &NodePose,
    (twist, floating): (Twist, Acceleration),
    velocity: NodeMotion,
    moved: NodeMotion,
) -> (Vec3, Vec3) {
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
fn floating_acceleration(
    g: &Scope,
    node: &NodePose,
    (pose, twist): (&Pose, Twist),
    holder: Acceleration,
    velocity: NodeMotion,
    moved: NodeMotion,
) -> (Vec3, Vec3) {
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
fn relative_acceleration(
    g: &Scope,
    freedom: Freedom,
    pose: &Pose,
    parent: Option<(Twist, Acceleration)>,
    ground: Vec3,
    (speed, rate): (&[ExprId], &[ExprId]),
) -> (Vec3, Vec3) {
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
        Freedom::Ball => ([rate[0], rate[1], rate[2]], carried),
        Freedom::Rotation { advance, .. } => {
            let own = [zero[0], zero[0], speed[0]];
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
fn sliding_acceleration(g: &Scope, carried: Vec3, omega: Vec3, slide: Vec3, two: ExprId) -> Vec3 {
    let turned = g.cross3(omega, slide);
    let coriolis = g.scale3(two, turned);
    g.add3(carried, coriolis)
}
