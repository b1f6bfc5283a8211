//! Poses, velocities and accelerations of all links by recursion from the ground, [CS (1), (2), (5)].
//! In: a [`Linkage`], coordinates and speeds. Out: expressions in each link's own frame.
//! Never knows forces. Twists are (omega, v of the link's origin); docs/notation.md.

use crate::expr::{Expr, Mat3, Scope, Vec3};

use super::attachment::{NodePose, NodeShape};
use super::frame::Frame;
use super::geometry::Geometry;
use super::linkage::{Freedom, LinkIndex};
use super::orientation::rotation_of_quaternion;
use super::turned::{Lever, Turned};

/// Pose of a link relative to its parent link or to W.
#[derive(Clone, Copy, Debug)]
pub struct Pose<'g> {
    /// Takes components in this link's frame to the parent's.
    pub rotation: Mat3<'g>,
    /// Position of the origin from the parent's origin, in the parent's frame [m].
    pub offset: Vec3<'g>,
}

/// Twist of a link, in its own frame [rad/s, m/s].
#[derive(Clone, Copy, Debug)]
pub struct Twist<'g> {
    pub omega: Vec3<'g>,
    pub origin: Vec3<'g>,
    /// Velocity of the origin summed from the ground outwards: parts that branches share are one.
    pub turned: Turned<'g>,
}

/// Inertial acceleration of a link, in its own frame [rad/s², m/s²].
#[derive(Clone, Copy, Debug)]
pub struct Acceleration<'g> {
    /// `skew(omega_dot) + skew(omega)²` [1/s²]: acceleration of the point r is `origin + spin r`.
    pub spin: Mat3<'g>,
    pub alpha: Vec3<'g>,
    pub origin: Vec3<'g>,
    /// Acceleration of the origin without the ground's, summed from the ground outwards.
    pub turned: Turned<'g>,
}

/// Poses of all links for given coordinates.
#[derive(Clone)]
pub struct Poses<'g> {
    /// The links and the places of their joints.
    pub geometry: Geometry<'g>,
    pub relative: Vec<Pose<'g>>,
    /// Constant part of the relative offsets: where the joints are mounted [m].
    pub mounts: Vec<Vec3<'g>>,
    /// What the coordinates add to it [m].
    pub moved: Vec<Vec3<'g>>,
    pub world: Vec<Pose<'g>>,
    /// World offsets from where the link's chain is mounted on the ground [m].
    from_mount: Vec<Vec3<'g>>,
    /// Of floating frames and node links: the node's motion relative to the floating frame.
    pub nodes: Vec<Option<NodePose<'g>>>,
}

impl<'g> Pose<'g> {
    /// Position in the parent's frame of a point in this frame [m].
    pub fn position(&self, point: Vec3<'g>) -> Vec3<'g> {
        let carried = self.rotation * point;
        self.offset + carried
    }

    /// Components in this frame of a vector in the parent's.
    pub fn inwards(&self, vector: Vec3<'g>) -> Vec3<'g> {
        self.rotation.transpose() * vector
    }

    /// The screw of a speed that moves the parent link as `turn` and `slide` say, in this frame. What a ball carries does not turn
    /// with what is inboard of it, and what is free does not move with it.
    pub fn screw_outboard(&self, freedom: Freedom, [turn, slide]: [Vec3<'g>; 2]) -> [Vec3<'g>; 2] {
        let (zero, moved) = (turn.scope().zero_vector(), self.inwards(slide + turn.cross(self.offset)));
        match freedom {
            Freedom::Free => [zero, zero],
            Freedom::Ball => [zero, moved],
            _ => [self.inwards(turn), moved],
        }
    }

    /// Pose relative to where this one is taken from, of a frame given relative to this one.
    fn then(&self, inner: Self) -> Self {
        let carried = self.rotation * inner.offset;
        Self { rotation: self.rotation * inner.rotation, offset: self.offset + carried }
    }
}

impl<'g> Twist<'g> {
    pub fn none(g: &'g Scope) -> Self {
        Self { omega: g.zero_vector(), origin: g.zero_vector(), turned: Turned::zero(g) }
    }

    /// Velocity of a point of the link, in the link's frame.
    pub fn at(&self, point: Vec3<'g>) -> Vec3<'g> {
        self.origin + self.omega.cross(point)
    }
}

impl<'g> Acceleration<'g> {
    /// Acceleration of a point of the link, in the link's frame.
    pub fn at(&self, point: Vec3<'g>) -> Vec3<'g> {
        self.origin + self.spin * point
    }
}

/// Rotation about e_z by an angle, [CS (2)] for a screw through the origin.
fn rotation_about_z(angle: Expr<'_>) -> Mat3<'_> {
    let (s, c) = (angle.sin(), angle.cos());
    let (zero, one) = (angle.scope().zero(), angle.scope().number(1.0));
    Mat3([Vec3([c, -s, zero]), Vec3([s, c, zero]), Vec3([zero, zero, one])])
}

impl<'g> Poses<'g> {
    pub fn new(geometry: Geometry<'g>, q: &[Expr<'g>]) -> Self {
        let Geometry { g, linkage, .. } = geometry;
        let mut poses = Self {
            geometry,
            relative: Vec::new(),
            mounts: Vec::new(),
            moved: Vec::new(),
            world: Vec::new(),
            from_mount: Vec::new(),
            nodes: Vec::new(),
        };
        for (at, link) in linkage.links.iter().enumerate() {
            let q = &q[link.coordinates()];
            let node = link.node.as_ref().map(|shape| NodePose::new(g, shape, q));
            // A free link's coordinates are its place in W.
            let mount = if link.freedom == Freedom::Free { g.zero_vector() } else { geometry.mount(at) };
            let (moved, relative, world) = if let Freedom::Ball | Freedom::Free = link.freedom {
                let moved = if q.len() == 7 { Vec3::first_of(&q[4..]) } else { g.zero_vector() };
                let (relative, world) = poses.absolute(link.parent, mount + moved, q);
                (moved, relative, world)
            } else {
                let local = match &node {
                    Some(node) => node_pose(g, link.freedom, &link.mount, node),
                    None => local_pose(g, link.freedom, &link.mount, q),
                };
                let relative = Pose { offset: mount + local.offset, ..local };
                let world = link.parent.map_or(relative, |parent| poses.world[parent].then(relative));
                (local.offset, relative, world)
            };
            poses.relative.push(relative);
            poses.from_mount.push(link.parent.map_or(moved, |parent| {
                let carried = poses.world[parent].rotation * relative.offset;
                poses.from_mount[parent] + carried
            }));
            poses.mounts.push(mount);
            poses.moved.push(moved);
            poses.world.push(world);
            poses.nodes.push(node);
        }
        poses
    }

    /// A ball or free link: its orientation (and position) is a coordinate itself.
    fn absolute(&self, parent: LinkIndex, offset: Vec3<'g>, q: &[Expr<'g>]) -> (Pose<'g>, Pose<'g>) {
        let rotation = rotation_of_quaternion([q[0], q[1], q[2], q[3]]);
        let Some(parent) = parent else {
            let pose = Pose { rotation, offset };
            return (pose, pose);
        };
        let outer = self.world[parent];
        let relative = Pose { rotation: outer.rotation.transpose() * rotation, offset };
        (relative, Pose { rotation, offset: outer.position(offset) })
    }

    /// Rate of a link's origin, in which `origin` is the whole along its own axes: its parent's with what turning the parent
    /// adds, and the link's own slide. Where it moves otherwise, the whole is turned.
    pub fn passed_on(
        &self,
        at: usize,
        origin: Vec3<'g>,
        (parent, lever, slide): (Turned<'g>, &Lever<'g>, Vec3<'g>),
    ) -> Turned<'g> {
        let link = &self.geometry.linkage.links[at];
        if link.freedom == Freedom::Free || link.node.as_ref().is_some_and(NodeShape::moves) {
            return Turned::own(origin);
        }
        let (place, turn) = (self.relative[at].offset, self.world_of(slide.scope(), link.parent).rotation);
        let carried = match link.freedom {
            Freedom::Translation { .. } => parent.at_parallel(lever, place),
            Freedom::Flexible { .. } | Freedom::Node if link.mount == Frame::IDENTITY => {
                parent.at_parallel(lever, place)
            }
            _ => parent.at(turn, lever, place).left(turn),
        };
        carried.plus(slide)
    }

    /// World pose; identity for the ground.
    pub fn world_of(&self, g: &'g Scope, link: LinkIndex) -> Pose<'g> {
        match link {
            Some(at) => self.world[at],
            None => Pose { rotation: g.identity(), offset: g.zero_vector() },
        }
    }

    /// Where the chain of a link is mounted on the ground, and the offset of the link's origin from there, both in W [m].
    pub fn mount_and_offset(&self, at: usize) -> [Vec3<'g>; 2] {
        let linkage = self.geometry.linkage;
        let root = linkage.between(Some(at), None).last().unwrap_or(at);
        [self.mounts[root], self.from_mount[at]]
    }

    /// Takes components in the frame of `from` to the frame of `to`, along the tree.
    pub fn rotation_between(&self, from: LinkIndex, to: LinkIndex) -> Mat3<'g> {
        let top = self.geometry.linkage.common_ancestor(from, to);
        let down = self.rotation_up(from, top);
        self.rotation_up(to, top).transpose() * down
    }

    /// Takes components in the frame of `from` to that of its ancestor `to`.
    fn rotation_up(&self, from: LinkIndex, to: LinkIndex) -> Mat3<'g> {
        let Geometry { g, linkage, .. } = self.geometry;
        if to.is_none() {
            return self.world_of(g, from).rotation;
        }
        linkage.between(from, to).fold(g.identity(), |turn, at| self.relative[at].rotation * turn)
    }

    /// Position in W of a point given in a link's frame [m].
    pub fn position(&self, link: LinkIndex, point: Vec3<'g>) -> Vec3<'g> {
        link.map_or(point, |at| self.world[at].position(point))
    }
}

/// Pose relative to the place where the joint is mounted.
fn local_pose<'g>(g: &'g Scope, freedom: Freedom, mount: &Frame, q: &[Expr<'g>]) -> Pose<'g> {
    match freedom {
        Freedom::Rotation { offset, advance } => {
            let turn = rotation_about_z(q[0] + offset);
            let rotation = g.matrix(mount.0) * turn;
            let moved = (advance * q[0]) * g.vector(mount.axis(2));
            Pose { rotation, offset: moved }
        }
        Freedom::Translation { axis } => {
            let moved = q[0] * g.vector(axis);
            Pose { rotation: g.identity(), offset: moved }
        }
        _ => Pose { rotation: g.matrix(mount.0), offset: g.zero_vector() },
    }
}

/// Pose of a node in its floating frame, or of the floating frame behind its inboard node.
fn node_pose<'g>(g: &'g Scope, freedom: Freedom, mount: &Frame, node: &NodePose<'g>) -> Pose<'g> {
    let rotation = node.rotation.unwrap_or_else(|| g.identity());
    if freedom == Freedom::Node {
        return Pose { rotation, offset: node.place };
    }
    let rotation = g.matrix(mount.0) * rotation.transpose();
    Pose { rotation, offset: -(rotation * node.place) }
}

/// Twists of all links for given speeds.
pub fn twists<'g>(poses: &Poses<'g>, v: &[Expr<'g>]) -> Vec<Twist<'g>> {
    let Geometry { g, linkage, .. } = poses.geometry;
    let mut twists: Vec<Twist<'g>> = Vec::new();
    for (at, link) in linkage.links.iter().enumerate() {
        let v = &v[link.speeds()];
        let parent = link.parent.map_or_else(|| Twist::none(g), |parent| twists[parent]);
        let carried = || carried_twist(parent, &poses.relative[at]);
        let slide = link.freedom.screw().map_or_else(|| g.zero_vector(), |[_, slide]| v[0] * g.vector(slide));
        let [omega, origin] = match link.freedom {
            Freedom::Free => [Vec3::first_of(v), Vec3::first_of(&v[3..])],
            Freedom::Ball => [Vec3::first_of(v), carried().origin],
            _ => match (&poses.nodes[at], link.freedom.screw()) {
                (Some(node), _) => deformed_twist(link.freedom, carried(), node, v),
                (None, Some([turn, _])) => {
                    let carried = carried();
                    [carried.omega + v[0] * g.vector(turn), carried.origin + slide]
                }
                (None, None) => [carried().omega, carried().origin],
            },
        };
        let lever = Lever::of_velocity(poses.world_of(g, link.parent).rotation, parent.omega);
        let turned = poses.passed_on(at, origin, (parent.turned, &lever, slide));
        twists.push(Twist { omega, origin, turned });
    }
    twists
}

/// Twist of a node, or of a floating frame behind its inboard node, from what it would be without modal speeds.
fn deformed_twist<'g>(
    freedom: Freedom,
    carried: Carried<'g>,
    node: &NodePose<'g>,
    v: &[Expr<'g>],
) -> [Vec3<'g>; 2] {
    let rate = node.velocity(v);
    if freedom == Freedom::Node {
        let (turn, slide) = (node.to_section(rate.turn), node.to_section(rate.slide));
        return [carried.omega + turn, carried.origin + slide];
    }
    let moved = rate.turn.cross(node.place) - rate.slide;
    [carried.omega - rate.turn, carried.origin + moved]
}

/// Angular velocity, and velocity of the origin, that a link would have if it were fixed to its parent.
pub struct Carried<'g> {
    pub omega: Vec3<'g>,
    origin: Vec3<'g>,
}

/// Twist that a link would have if it were fixed to its parent, in its frame.
pub fn carried_twist<'g>(parent: Twist<'g>, pose: &Pose<'g>) -> Carried<'g> {
    let at_joint = parent.at(pose.offset);
    Carried { omega: pose.inwards(parent.omega), origin: pose.inwards(at_joint) }
}
