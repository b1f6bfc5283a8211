//! A robot as links and joints in a tree, whatever format it came from. Never knows text.

use super::place::{Matrix, Place};

/// Whether the root link is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Base {
    /// It is the ground.
    #[default]
    Fixed,
    /// It moves freely.
    Floating,
}

/// Links and joints.
#[derive(Clone, Debug, PartialEq)]
pub struct Robot {
    pub name: String,
    pub links: Vec<Link>,
    /// In the order of the file.
    pub joints: Vec<Joint>,
    /// Link of no joint's child.
    pub root: usize,
}

/// A rigid part.
#[derive(Clone, Debug, PartialEq)]
pub struct Link {
    pub name: String,
    pub line: usize,
    /// None where it has no mass.
    pub mass: Option<Mass>,
}

/// Mass of a part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mass {
    /// [kg]
    pub mass: f64,
    /// In the link's frame [m].
    pub centre: [f64; 3],
    /// About the centre, by axes parallel to the link's frame [kg m^2].
    pub inertia: Matrix,
}

/// How links move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Revolute,
    Prismatic,
    Planar,
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
    /// In the child's frame, of any length.
    pub axis: [f64; 3],
    /// Viscous [N m s/rad or N s/m]; 0: none.
    pub damping: f64,
    /// The joint that it moves with.
    pub follows: Option<Follows>,
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

impl Robot {
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
