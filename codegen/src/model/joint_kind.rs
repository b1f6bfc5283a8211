//! The kinds of joints as data: each is one row of [`JOINT_KINDS`], the primitives that it consists of in the order
//! from parent to child. Out: [`JointKind`]. All else follows by rule, in [`super::joint_model`].

use self::Coordinate::{Angle, Length};
use self::Direction::{X, Y, Z};
use self::Primitive::{Ball, Pose, Shift, Slide, Thread, Turn};
use super::coordinate::Coordinate;

/// A direction of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// The (first) axis.
    Z,
    /// The second direction: at right angles to the axis, but for a universal joint, whose second axis it is.
    X,
    /// At right angles to both.
    Y,
}

impl Direction {
    /// Which axis of the joint's frame lies on it: e_z on the first axis, e_x as near to the second as possible.
    pub const fn frame_axis(self) -> usize {
        match self {
            X => 0,
            Y => 1,
            Z => 2,
        }
    }
}

/// A joint primitive: an elementary relative motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Primitive {
    /// Rotation about a direction.
    Turn(Direction),
    /// Translation along a direction.
    Slide(Direction),
    /// Rotation about the axis with proportional translation along it.
    Thread,
    /// Rotation about the joint's point.
    Ball,
    /// Translation in space, along three axes of the parent.
    Shift,
    /// Rotation and translation, relative to the ground where the joint is in the tree.
    Pose,
}

impl Primitive {
    /// What a start position of it consists of.
    pub const fn values(self) -> &'static [Coordinate] {
        match self {
            Turn(_) | Thread => &[Angle],
            Slide(_) => &[Length],
            Ball => &[Angle, Angle, Angle],
            Shift => &[Length, Length, Length],
            Pose => &[Angle, Angle, Angle, Length, Length, Length],
        }
    }
}

/// Which keys of a file describe the directions of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AxisKeys {
    /// None.
    None,
    /// `axis`.
    Axis,
    /// `axis`, the normal of a plane, and `first`, a direction in it.
    AxisAndFirst,
    /// `axes`, two.
    Axes,
}

/// Which key of a file says what a joint demands of the place of its child's point in the parent, besides what its
/// primitives take away.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlaceKey {
    /// None: it demands nothing.
    None,
    /// `length`: a constant distance from `origin`.
    Length,
    /// `equation`: over x, y, z, the place as seen from `origin`.
    Equation,
}

/// A kind of joint.
#[derive(Debug, PartialEq, Eq)]
pub struct JointKind {
    /// Key in a file.
    pub name: &'static str,
    /// How its directions are given.
    pub axes: AxisKeys,
    /// What it consists of, in the order from parent to child. Primitives with one coordinate come before [`Primitive::Ball`], so that
    /// coordinates and start values are numbered alike.
    pub primitives: &'static [Primitive],
    /// What clearance adds before them; none if such a joint cannot have clearance.
    pub clearance: &'static [Primitive],
    /// Whether its axis may tilt within the clearance.
    pub tilts: bool,
    /// What it demands of a place. Such a joint takes one freedom away and carries no body.
    pub place: PlaceKey,
}

const fn row(name: &'static str, axes: AxisKeys, primitives: &'static [Primitive]) -> JointKind {
    JointKind { name, axes, primitives, clearance: &[], tilts: false, place: PlaceKey::None }
}

/// A joint whose axis has room around it.
const fn round(name: &'static str, primitives: &'static [Primitive]) -> JointKind {
    JointKind { clearance: &[Slide(X), Slide(Y)], tilts: true, ..row(name, AxisKeys::Axis, primitives) }
}

/// What tilting adds behind the room around an axis.
pub(super) const TILTING: &[Primitive] = &[Turn(X), Turn(Y)];

/// The kind that takes nothing away.
pub(super) const FREE: &str = "free";

/// Every kind of joint.
pub static JOINT_KINDS: &[JointKind] = &[
    round("revolute", &[Turn(Z)]),
    round("prismatic", &[Slide(Z)]),
    round("cylindrical", &[Turn(Z), Slide(Z)]),
    row("screw", AxisKeys::Axis, &[Thread]),
    JointKind { clearance: &[Shift], ..row("universal", AxisKeys::Axes, &[Turn(Z), Turn(X)]) },
    JointKind { clearance: &[Shift], ..row("spherical", AxisKeys::None, &[Ball]) },
    row("inline", AxisKeys::Axis, &[Slide(Z), Ball]),
    row("planar", AxisKeys::AxisAndFirst, &[Slide(X), Slide(Y), Turn(Z)]),
    row("slot", AxisKeys::AxisAndFirst, &[Slide(X), Turn(Z)]),
    row("inplane", AxisKeys::AxisAndFirst, &[Slide(X), Slide(Y), Ball]),
    JointKind { place: PlaceKey::Length, ..row("distance", AxisKeys::None, &[Pose]) },
    JointKind { place: PlaceKey::Equation, ..row("on_surface", AxisKeys::None, &[Pose]) },
    row("fixed", AxisKeys::None, &[]),
    row(FREE, AxisKeys::None, &[Pose]),
];

/// A spherical joint whose rotation is prescribed: three turns, about x, the turned y and the twice turned z.
pub(super) static DRIVEN_BALL: JointKind = row("spherical", AxisKeys::None, &[Turn(X), Turn(Y), Turn(Z)]);

/// What a joint looks like in pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Look {
    /// A pin along its axis.
    Pin,
    /// A block that slides along its axis.
    Slider,
    /// A ball, perhaps on a rod.
    Ball,
    /// A short part along its first axis: two crossed pins, a plate.
    Short,
    /// A rod along its axis.
    Rod,
    /// A rod from the parent's point to the child's.
    Strut,
    /// Nothing that moves.
    Rigid,
}

impl Look {
    /// As scripts of a page know it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Pin => "pin",
            Self::Slider => "slider",
            Self::Ball => "ball",
            Self::Short => "short",
            Self::Rod => "rod",
            Self::Strut => "strut",
            Self::Rigid => "rigid",
        }
    }
}

impl JointKind {
    /// The kind with this key.
    pub fn named(name: &str) -> Option<&'static Self> {
        JOINT_KINDS.iter().find(|kind| kind.name == name)
    }

    /// Whether its second direction makes a difference beyond where its coordinates count from: of a slot, along which it
    /// slides and across which it does not.
    pub fn needs_first(&self) -> bool {
        self.primitives.contains(&Slide(X)) && !self.primitives.contains(&Slide(Y))
    }

    /// Whether its child slides along its axis.
    pub fn slides_along_axis(&self) -> bool {
        self.primitives.contains(&Slide(Z))
    }

    /// What it looks like, by what it consists of.
    pub fn look(&self) -> Look {
        match self.primitives {
            [] => Look::Rigid,
            [Turn(_)] => Look::Pin,
            [Slide(_)] => Look::Slider,
            _ if self.place == PlaceKey::Length => Look::Strut,
            _ if self.place == PlaceKey::Equation => Look::Ball,
            primitives if primitives.contains(&Ball) || *self == DRIVEN_BALL => Look::Ball,
            [.., Turn(_)] => Look::Short,
            _ => Look::Rod,
        }
    }

    /// Whether it leaves bodies in their planes, at right angles to its axis if it turns about one.
    pub fn is_plane(&self) -> bool {
        let turns = self.primitives.contains(&Turn(Z));
        self.primitives.iter().all(|primitive| match primitive {
            Turn(direction) => *direction == Z,
            Slide(direction) => !turns || *direction != Z,
            Thread | Ball | Shift | Pose => false,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_follow_from_what_a_kind_consists_of() {
        let looks = |name: &str| JointKind::named(name).map(|kind| (kind.look(), kind.is_plane()));
        for (name, look, is_plane) in [
            ("revolute", Look::Pin, true),
            ("prismatic", Look::Slider, true),
            ("cylindrical", Look::Rod, false),
            ("universal", Look::Short, false),
            ("spherical", Look::Ball, false),
            ("inline", Look::Ball, false),
            ("planar", Look::Short, true),
            ("slot", Look::Short, true),
            ("inplane", Look::Ball, false),
            ("distance", Look::Strut, false),
            ("on_surface", Look::Ball, false),
            ("fixed", Look::Rigid, true),
            ("free", Look::Rod, false),
        ] {
            assert_eq!(looks(name), Some((look, is_plane)), "{name}");
        }
    }
}
