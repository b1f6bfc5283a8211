//! What a joint coordinate is, and the dimensions that follow from it.

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
    pub const fn dimension(self) -> Dimension {
        match self {
            Self::Angle => Dimension::NONE,
            Self::Length => Dimension::LENGTH,
        }
    }

    /// Dimension of the speed.
    pub const fn speed(self) -> Dimension {
        match self {
            Self::Angle => Dimension::of(0, 0, -1),
            Self::Length => Dimension::of(1, 0, -1),
        }
    }

    /// Dimension of the force along the coordinate.
    pub const fn force(self) -> Dimension {
        match self {
            Self::Angle => Dimension::TORQUE,
            Self::Length => Dimension::FORCE,
        }
    }

    /// Dimension of force over speed.
    pub const fn damping(self) -> Dimension {
        match self {
            Self::Angle => Dimension::of(2, 1, -1),
            Self::Length => Dimension::of(0, 1, -1),
        }
    }

    /// Dimension of force over position.
    pub const fn stiffness(self) -> Dimension {
        match self {
            Self::Angle => Dimension::TORQUE,
            Self::Length => Dimension::of(0, 1, -2),
        }
    }
}
