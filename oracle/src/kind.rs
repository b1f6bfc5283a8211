//! The kinds of joints as the oracle knows them. Of a kind it takes from the description nothing but its name.

use linkwear_codegen::model::JointModel;

/// A joint kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "named as in the file format")]
pub enum Kind {
    Revolute,
    Prismatic,
    Cylindrical,
    Screw,
    Universal,
    Spherical,
    Inline,
    Planar,
    Slot,
    Inplane,
    Fixed,
    Free,
    Distance,
    OnSurface,
}

impl Kind {
    /// Kinds that hold the place of a point and place no body.
    pub const OF_PLACES: [Self; 2] = [Self::Distance, Self::OnSurface];

    /// Every kind that can carry a body.
    pub const ALL: [Self; 12] = [
        Self::Revolute,
        Self::Prismatic,
        Self::Cylindrical,
        Self::Screw,
        Self::Universal,
        Self::Spherical,
        Self::Inline,
        Self::Planar,
        Self::Slot,
        Self::Inplane,
        Self::Fixed,
        Self::Free,
    ];

    /// The kind of a described joint.
    ///
    /// # Panics
    /// If the joint has clearance, or is of a kind that the oracle does not know.
    pub fn of(model: &JointModel) -> Self {
        assert!(!model.clearance, "the oracle knows ideal joints only");
        let known = Self::ALL.into_iter().chain(Self::OF_PLACES).find(|kind| kind.key() == model.kind.name);
        known.unwrap_or_else(|| panic!("the oracle knows no {} joint", model.kind.name))
    }

    /// Key in the file.
    pub const fn key(self) -> &'static str {
        match self {
            Self::Revolute => "revolute",
            Self::Prismatic => "prismatic",
            Self::Cylindrical => "cylindrical",
            Self::Screw => "screw",
            Self::Universal => "universal",
            Self::Spherical => "spherical",
            Self::Inline => "inline",
            Self::Planar => "planar",
            Self::Slot => "slot",
            Self::Inplane => "inplane",
            Self::Fixed => "fixed",
            Self::Free => "free",
            Self::Distance => "distance",
            Self::OnSurface => "on_surface",
        }
    }

    /// Rotations and pure translations it leaves; of those that hold a place as far as it leaves them everywhere.
    pub const fn freedoms(self) -> [usize; 2] {
        match self {
            Self::Revolute | Self::Screw => [1, 0],
            Self::Prismatic => [0, 1],
            Self::Cylindrical | Self::Slot => [1, 1],
            Self::Universal => [2, 0],
            Self::Spherical => [3, 0],
            Self::Inline => [3, 1],
            Self::Inplane => [3, 2],
            Self::Planar => [1, 2],
            Self::Fixed => [0, 0],
            Self::Free => [3, 3],
            Self::Distance | Self::OnSurface => [3, 2],
        }
    }

    /// Whether the child turns in space: its orientation is a quaternion.
    pub const fn is_round(self) -> bool {
        self.freedoms()[0] == 3 && !matches!(self, Self::Distance | Self::OnSurface)
    }

    /// Three freedoms about a point or in a plane; two such joints in a loop leave one of them idle.
    pub const fn is_wide(self) -> bool {
        matches!(self, Self::Spherical | Self::Inline | Self::Inplane | Self::Planar)
    }

    /// Scalar coordinates that can be driven, sprung and damped; true for an angle.
    pub const fn coordinates(self) -> &'static [bool] {
        match self {
            Self::Revolute | Self::Screw => &[true],
            Self::Prismatic | Self::Inline => &[false],
            Self::Cylindrical => &[true, false],
            Self::Universal => &[true, true],
            Self::Planar => &[false, false, true],
            Self::Slot => &[false, true],
            Self::Inplane => &[false, false],
            Self::Spherical | Self::Fixed | Self::Free | Self::Distance | Self::OnSurface => &[],
        }
    }
}
