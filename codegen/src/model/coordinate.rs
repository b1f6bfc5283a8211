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
        self.choose(Dimension::NONE, Dimension::LENGTH)
    }

    /// Dimension of the speed.
    pub const fn speed(self) -> Dimension {
        self.choose(Dimension::of(0, 0, -1), Dimension::of(1, 0, -1))
    }

    /// Dimension of the force along the coordinate.
    pub const fn force(self) -> Dimension {
        self.choose(Dimension::TORQUE, Dimension::FORCE)
    }

    /// Dimension of force over speed.
    pub const fn damping(self) -> Dimension {
        self.choose(Dimension::of(2, 1, -1), Dimension::of(0, 1, -1))
    }

    /// Dimension of force over position.
    pub const fn stiffness(self) -> Dimension {
        self.choose(Dimension::TORQUE, Dimension::of(0, 1, -2))
    }

    const fn choose(self, angle: Dimension, length: Dimension) -> Dimension {
        match self {
            Self::Angle => angle,
            Self::Length => length,
        }
    }
}
