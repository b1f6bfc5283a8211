//! A robot as links and joints in a tree, whatever format it came from. Never knows text.

use super::mass::Mass;
use super::place::Place;

/// Bodies that a robot may have.
pub const MOST: usize = 2_000;

/// Whether the root link is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Base {
    /// It is the ground.
    #[default]
    Fixed,
    /// It moves freely.
    Floating,
}

/// Links and joints, and what else moves them.
#[derive(Clone, Debug, PartialEq)]
pub struct Robot {
    pub name: String,
    pub links: Vec<Link>,
    /// In the order of the file.
    pub joints: Vec<Joint>,
    /// Link of no joint's child.
    pub root: usize,
    /// Whether the format says itself that the root is the ground.
    pub is_on_ground: bool,
    /// Acceleration of free fall [m/s^2]; None where the format has none.
    pub gravity: Option<[f64; 3]>,
    /// What closes loops.
    pub closures: Vec<Closure>,
    pub actuators: Vec<Actuator>,
}

/// A rigid part.
#[derive(Clone, Debug, PartialEq)]
pub struct Link {
    pub name: String,
    pub line: usize,
    /// None where it has no mass.
    pub mass: Option<Mass>,
    /// Whether it only stands between two joints of one body of the file, and so has no mass.
    pub is_between: bool,
}

/// How links move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Revolute,
    Prismatic,
    Planar,
    Spherical,
    Free,
    Fixed,
}

impl Kind {
    /// Whether it has one coordinate, an angle or a length.
    pub const fn is_single(self) -> bool {
        matches!(self, Self::Revolute | Self::Prismatic)
    }
}

/// A joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    pub name: String,
    pub kind: Kind,
    pub parent: usize,
    pub child: usize,
    /// Frame of the child link in that of the parent while the coordinate is 0.
    pub place: Place,
    /// The joint's point in the child's frame [m].
    pub at: [f64; 3],
    /// In the child's frame, of any length.
    pub axis: [f64; 3],
    /// Viscous [N m s/rad or N s/m]; 0: none.
    pub damping: f64,
    /// Spring along the coordinate.
    pub spring: Option<Spring>,
    /// Inertia that the coordinate has besides that of the links [kg m^2 or kg]: of a rotor behind a gear.
    pub armature: f64,
    /// Limits of what all its actuators give together [N m or N].
    pub actuated: Option<[f64; 2]>,
    /// The joint that it moves with.
    pub follows: Option<Follows>,
    /// Where the coordinate is held [rad or m].
    pub held: Option<f64>,
    /// What is told of it beside its equations.
    pub remarks: Vec<String>,
}

/// How a joint's coordinate follows from another: `times` of it and `plus`, in m and rad.
#[derive(Clone, Debug, PartialEq)]
pub struct Follows {
    pub leader: usize,
    pub times: f64,
    pub plus: f64,
}

/// A spring along a coordinate, or about any axis of a ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    /// [N m/rad or N/m]
    pub stiffness: f64,
    /// Coordinate at which it is unloaded [rad or m]; of a ball 0.
    pub rest: f64,
}

/// A joint that closes a loop.
#[derive(Clone, Debug, PartialEq)]
pub struct Closure {
    pub name: String,
    /// What it is called in the file.
    pub what: &'static str,
    /// Spherical or fixed.
    pub kind: Kind,
    pub links: [usize; 2],
    /// Its point in the frame of each link [m].
    pub at: [[f64; 3]; 2],
}

/// What a signal u from outside makes a joint feel: g clamp(gain clamp(u) + b_0 + b_1 (g q + length_0) + b_2 g v).
#[derive(Clone, Debug, PartialEq)]
pub struct Actuator {
    pub name: String,
    pub joint: usize,
    /// g.
    pub gear: f64,
    pub gain: f64,
    /// b.
    pub bias: [f64; 3],
    /// Length of the actuator while the coordinate is 0.
    pub length: f64,
    /// Limits of u.
    pub control: Option<[f64; 2]>,
    /// Limits of the force before the gear.
    pub force: Option<[f64; 2]>,
}

impl Robot {
    /// A tree of links and joints.
    pub fn new(name: String, links: Vec<Link>, joints: Vec<Joint>, root: usize) -> Self {
        Self {
            name,
            links,
            joints,
            root,
            is_on_ground: false,
            gravity: None,
            closures: Vec::new(),
            actuators: Vec::new(),
        }
    }

    /// Frame of every link in that of the root, all coordinates being 0. Links come behind their parents in `order`.
    pub fn places(&self) -> Vec<Place> {
        let mut places = vec![Place::default(); self.links.len()];
        for at in self.order() {
            let joint = &self.joints[at];
            places[joint.child] = places[joint.parent].then(&joint.place);
        }
        places
    }

    /// Joints, each behind that of its parent link.
    pub fn order(&self) -> Vec<usize> {
        let mut of_link = vec![Vec::new(); self.links.len()];
        for (at, joint) in self.joints.iter().enumerate() {
            of_link[joint.parent].push(at);
        }
        let mut order = Vec::with_capacity(self.joints.len());
        let mut next = vec![self.root];
        while let Some(link) = next.pop() {
            for at in of_link[link].iter().rev() {
                next.push(self.joints[*at].child);
            }
            order.extend(&of_link[link]);
        }
        order
    }
}
