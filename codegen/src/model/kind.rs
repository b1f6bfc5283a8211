//! What each kind of joint leaves free and takes away.

use super::JointKind;
use crate::spec::Dimension;

/// What a joint coordinate is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coordinate {
    /// An angle [rad].
    Angle,
    /// A length [m].
    Length,
}

impl Coordinate {
    /// Dimension of the position.
    #[must_use]
    pub const fn dimension(self) -> Dimension {
        match self {
            Self::Angle => Dimension::NONE,
            Self::Length => Dimension::LENGTH,
        }
    }

    /// Dimension of the speed.
    #[must_use]
    pub const fn speed(self) -> Dimension {
        match self {
            Self::Angle => Dimension::of(0, 0, -1),
            Self::Length => Dimension::of(1, 0, -1),
        }
    }

    /// Dimension of the force along the coordinate.
    #[must_use]
    pub const fn force(self) -> Dimension {
        match self {
            Self::Angle => Dimension::TORQUE,
            Self::Length => Dimension::FORCE,
        }
    }

    /// Dimension of force over speed.
    #[must_use]
    pub const fn damping(self) -> Dimension {
        match self {
            Self::Angle => Dimension::of(2, 1, -1),
            Self::Length => Dimension::of(0, 1, -1),
        }
    }

    /// Dimension of force over position.
    #[must_use]
    pub const fn stiffness(self) -> Dimension {
        match self {
            Self::Angle => Dimension::TORQUE,
            Self::Length => Dimension::of(0, 1, -2),
        }
    }
}

impl JointKind {
    /// As written in a file.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Revolute(_) => "revolute",
            Self::Prismatic(_) => "prismatic",
            Self::Cylindrical(_) => "cylindrical",
            Self::Screw(..) => "screw",
            Self::Universal(..) => "universal",
            Self::Spherical => "spherical",
            Self::Planar { .. } => "planar",
            Self::Journal { .. } => "revolute",
            Self::Socket => "spherical",
            Self::Fixed => "fixed",
            Self::Free => "free",
        }
    }

    /// The scalar coordinates; none for spherical and free joints, whose position is no list of scalars.
    #[must_use]
    pub const fn coordinates(&self) -> &'static [Coordinate] {
        use Coordinate::{Angle, Length};
        match self {
            Self::Revolute(_) | Self::Screw(..) | Self::Journal { .. } => &[Angle],
            Self::Prismatic(_) => &[Length],
            Self::Cylindrical(_) => &[Angle, Length],
            Self::Universal(..) => &[Angle, Angle],
            Self::Planar { .. } => &[Length, Length, Angle],
            Self::Spherical | Self::Socket | Self::Fixed | Self::Free => &[],
        }
    }

    /// The values that a start position consists of: the coordinates; for a spherical joint a rotation
    /// vector; for a free joint a rotation vector and the displacement of the joint's point.
    #[must_use]
    pub const fn start_values(&self) -> &'static [Coordinate] {
        use Coordinate::{Angle, Length};
        match self {
            Self::Spherical | Self::Socket => &[Angle, Angle, Angle],
            Self::Free => &[Angle, Angle, Angle, Length, Length, Length],
            _ => self.coordinates(),
        }
    }

    /// Whether the joint constrains the relative orientation of its bodies.
    #[must_use]
    pub const fn holds_orientation(&self) -> bool {
        !matches!(self, Self::Spherical | Self::Socket | Self::Free)
    }

    /// Number of constraint rows of the joint when it is cut.
    #[must_use]
    pub const fn rows(&self) -> usize {
        match self {
            Self::Fixed => 6,
            Self::Revolute(_) | Self::Prismatic(_) | Self::Screw(..) => 5,
            Self::Cylindrical(_) | Self::Universal(..) => 4,
            Self::Spherical | Self::Planar { .. } | Self::Journal { .. } => 3,
            Self::Free | Self::Socket => 0,
        }
    }

    /// Name of a coordinate's position among the members: `q`, or `q1`, `q2`.
    #[must_use]
    pub fn position_name(&self, coordinate: usize) -> String {
        if self.start_values().len() == 1 { "q".into() } else { format!("q{}", coordinate + 1) }
    }
}
