//! What force elements tell of themselves: names and dimensions of columns and of members in formulas. Never knows which kinds there are.

use super::dimension::Dimension;

/// What a kind of force element tells of itself, in columns and in formulas. All of it follows from positions and speeds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Told {
    /// Nothing.
    Nothing,
    /// The pull between two points, and their distance.
    Pull,
    /// Force and moment by the first body on the second, about the second's point, along the axes of the ground.
    Wrench,
}

impl Told {
    /// Names behind that of the element, dimensions.
    pub const fn columns(self) -> &'static [(&'static str, Dimension)] {
        match self {
            Self::Nothing => &[],
            Self::Pull => &[("F", Dimension::FORCE), ("length", Dimension::LENGTH)],
            Self::Wrench => &[
                ("Fx", Dimension::FORCE),
                ("Fy", Dimension::FORCE),
                ("Fz", Dimension::FORCE),
                ("Mx", Dimension::TORQUE),
                ("My", Dimension::TORQUE),
                ("Mz", Dimension::TORQUE),
            ],
        }
    }
}
