//! The kinds of joints as data: each is one row of [`JOINT_KINDS`], the primitives that it consists of in the order
//! from parent to child. Constraint rows, coordinates, start values and the chain of links follow by rule.

use std::f64::consts::TAU;
use std::ops::Range;

use self::Coordinate::{Angle, Length};
use self::Direction::{X, Y, Z};
use self::Primitive::{Ball, Pose, Shift, Slide, Thread, Turn};
use super::coordinate::Coordinate;
use crate::spec::Ends;

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
const TILTING: &[Primitive] = &[Turn(X), Turn(Y)];

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
    row("free", AxisKeys::None, &[Pose]),
];

/// A spherical joint whose rotation is prescribed: three turns, about x, the turned y and the twice turned z.
static DRIVEN_BALL: JointKind = row("spherical", AxisKeys::None, &[Turn(X), Turn(Y), Turn(Z)]);

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

/// A unit direction in W at the reference pose, as each side's branch describes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    /// As the parent's branch describes it.
    pub parent: [f64; 3],
    /// As the child's branch describes it.
    pub child: [f64; 3],
}

impl Axis {
    /// An axis that both branches describe alike.
    pub const fn both(direction: [f64; 3]) -> Self {
        Self { parent: direction, child: direction }
    }
}

/// The relative motion that one joint leaves: its kind, with directions in numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct JointModel {
    /// Its kind.
    pub kind: &'static JointKind,
    /// Its first and its second direction, as far as it has them.
    pub axes: Vec<Axis>,
    /// Advance of a thread [m] per turn, positive for a right-hand thread; else zero.
    pub lead: f64,
    /// Whether clearance adds its primitives. They have the last coordinates.
    pub clearance: bool,
    /// Whether the axis tilts within it besides, and which side has the ends that touch.
    pub tilt: Option<Ends>,
}

impl JointModel {
    /// A joint without clearance.
    ///
    /// # Panics
    /// If no kind has this name.
    #[expect(clippy::expect_used, reason = "documented: names are written in code, never read from files")]
    pub fn new(name: &str, axes: &[Axis]) -> Self {
        let kind = JointKind::named(name).expect("the name of a kind of joint");
        Self { kind, axes: axes.to_vec(), lead: 0.0, clearance: false, tilt: None }
    }

    /// A joint that takes nothing away.
    pub fn free() -> Self {
        Self::new("free", &[])
    }

    /// Number of its coordinate that turns about its axis.
    pub fn turn_about_axis(&self) -> Option<usize> {
        self.number_of(Turn(Z))
    }

    /// Number of its coordinate that slides along its axis.
    pub fn slide_along_axis(&self) -> Option<usize> {
        self.number_of(Slide(Z))
    }

    fn number_of(&self, wanted: Primitive) -> Option<usize> {
        let found = self.primitives().into_iter().find(|(_, primitive)| *primitive == wanted);
        found.map(|(number, _)| number)
    }

    /// Its primitives from parent to child, each with the number of its first coordinate.
    pub fn primitives(&self) -> Vec<(usize, Primitive)> {
        let number = |list: &[Primitive], mut first: usize| -> Vec<(usize, Primitive)> {
            let mut numbered = Vec::new();
            for primitive in list {
                numbered.push((first, *primitive));
                first += primitive.values().len();
            }
            numbered
        };
        let play = number(&self.play(), self.start_values().len());
        // The ends of a journal go along with it: it slides along the axis of its bearing before it leaves that.
        let before = |(_, primitive): &(usize, Primitive)| {
            self.tilt == Some(Ends::Journal) && matches!(primitive, Slide(_))
        };
        let (inner, outer): (Vec<_>, Vec<_>) = number(self.kind.primitives, 0).into_iter().partition(before);
        [inner, play, outer].concat()
    }

    /// What clearance adds.
    fn play(&self) -> Vec<Primitive> {
        let across = if self.clearance { self.kind.clearance } else { &[] };
        let tilting = if self.tilt.is_some() { TILTING } else { &[] };
        [across, tilting].concat()
    }

    /// The scalar coordinates; none for spherical and free joints, whose position is no list of scalars.
    pub fn coordinates(&self) -> Vec<Coordinate> {
        let scalars = self.kind.primitives.iter().filter(|primitive| primitive.values().len() == 1);
        scalars.flat_map(|primitive| primitive.values()).copied().collect()
    }

    /// The values that a start position consists of: the coordinates, and for a rotation about a point a rotation
    /// vector; for a free joint a rotation vector and the displacement of the joint's point. A joint that holds a place has none.
    pub fn start_values(&self) -> Vec<Coordinate> {
        if self.holds_place() {
            return Vec::new();
        }
        self.kind.primitives.iter().flat_map(|primitive| primitive.values()).copied().collect()
    }

    /// Numbers of the coordinates that clearance adds: the journal's offset.
    pub fn offsets(&self) -> Range<usize> {
        let first = self.start_values().len();
        let play: usize = self.kind.clearance.iter().map(|primitive| primitive.values().len()).sum();
        first..first + if self.clearance { play } else { 0 }
    }

    /// Numbers of the coordinates with which the axis tilts in its clearance: about the second direction, and about that at
    /// right angles to both.
    pub fn tilts(&self) -> Range<usize> {
        let first = self.offsets().end;
        first..first + if self.tilt.is_some() { TILTING.len() } else { 0 }
    }

    /// Numbers of all coordinates that clearance adds.
    pub fn loose(&self) -> Range<usize> {
        self.offsets().start..self.tilts().end
    }

    /// Whether it is loose along its whole length: a rod in a bush that touches round its axis and may slide along it or tilt.
    pub fn is_loose_guide(&self) -> bool {
        self.clearance && self.kind.tilts && (self.tilt.is_some() || !self.is_hinge())
    }

    /// A spherical joint whose rotation is prescribed, by three angles about axes that are those of W at the reference pose.
    pub fn driven_ball() -> Self {
        let axes = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]].map(Axis::both).to_vec();
        Self { kind: &DRIVEN_BALL, axes, lead: 0.0, clearance: false, tilt: None }
    }

    /// Whether it is one.
    pub fn is_driven_ball(&self) -> bool {
        *self.kind == DRIVEN_BALL
    }

    fn any(&self, wanted: impl Fn(Primitive) -> bool) -> bool {
        self.primitives().iter().any(|(_, primitive)| wanted(*primitive))
    }

    /// Whether the child can turn about any axis, its orientation being no list of scalars.
    pub fn turns_freely(&self) -> bool {
        self.any(|primitive| matches!(primitive, Ball | Pose))
    }

    /// Whether the joint's primitives take nothing away.
    pub fn is_free(&self) -> bool {
        self.any(|primitive| primitive == Pose)
    }

    /// Whether the joint is a ball in a socket.
    pub fn is_ball(&self) -> bool {
        self.kind.primitives == [Ball]
    }

    /// Whether the joint is a cross that turns about two axes.
    pub fn is_cross(&self) -> bool {
        matches!(self.kind.primitives, [Turn(_), Turn(_)])
    }

    /// Whether the joint's only coordinate is a plain angle.
    pub fn is_hinge(&self) -> bool {
        matches!(self.kind.primitives, [Turn(_)])
    }

    /// Whether the joint's only coordinate is a way along its axis, without a turn.
    pub fn is_guide(&self) -> bool {
        matches!(self.kind.primitives, [Slide(_)])
    }

    /// Whether the child's point leaves that of the parent by a coordinate.
    pub fn slides(&self) -> bool {
        self.any(|primitive| matches!(primitive, Slide(_) | Thread | Shift))
    }

    /// The directions about which the child turns.
    pub fn turns(&self) -> Vec<Direction> {
        let turn = |(_, primitive)| match primitive {
            Turn(direction) => Some(direction),
            Thread => Some(Z),
            Slide(_) | Ball | Shift | Pose => None,
        };
        self.primitives().into_iter().filter_map(turn).collect()
    }

    /// Advance of a thread per angle [m/rad]; nothing if the joint has none.
    pub fn thread(&self) -> Option<f64> {
        self.any(|primitive| primitive == Thread).then_some(self.lead / TAU)
    }

    /// Axes of the joint's frame along which nothing moves freely.
    pub fn held_axes(&self) -> Vec<usize> {
        let moves = |axis: usize| {
            self.any(|primitive| match primitive {
                Slide(direction) => direction.frame_axis() == axis,
                Thread => Z.frame_axis() == axis,
                Shift | Pose => true,
                Turn(_) | Ball => false,
            })
        };
        (0..3).filter(|axis| !moves(*axis)).collect()
    }

    /// Whether what it holds is fixed in the parent and turns against the child: a line or a plane that guides a ball, a slot
    /// that guides a pin, a surface.
    pub fn is_held_in_parent(&self) -> bool {
        let held = self.held_axes();
        let across = [X, Y].into_iter().filter(|direction| held.contains(&direction.frame_axis())).count();
        let guides = self.turns_freely() || (across == 1 && self.turns().contains(&Z));
        self.holds_place() || (self.rows() > 0 && self.slides() && guides)
    }

    /// Number of constraint rows of the joint when it is cut.
    pub fn rows(&self) -> usize {
        let turned = if self.turns_freely() { 3 } else { self.turns().len() };
        let others = [self.thread().is_some(), self.holds_place()];
        self.held_axes().len() + 3 - turned + others.map(usize::from).into_iter().sum::<usize>()
    }

    /// Whether it demands something of a place, which no coordinate of its own could leave free.
    pub fn holds_place(&self) -> bool {
        self.kind.place != PlaceKey::None
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

    #[test]
    fn rows_and_freedoms_are_six_together_and_coordinates_come_first() {
        for kind in JOINT_KINDS {
            let loose = [(!kind.clearance.is_empty(), None), (true, Some(Ends::Journal))];
            for (clearance, tilt) in
                [(false, None)].into_iter().chain(loose.into_iter().take(1 + usize::from(kind.tilts)))
            {
                let model = JointModel { kind, axes: Vec::new(), lead: 1.0, clearance, tilt };
                let freedoms = model.start_values().len() + model.offsets().len() + model.tilts().len();
                let numbers: Vec<usize> = model.primitives().iter().map(|(number, _)| *number).collect();
                assert_eq!(numbers.len(), numbers.iter().collect::<std::collections::BTreeSet<_>>().len());
                let left = if model.holds_place() { 5 } else { freedoms };
                assert_eq!(model.rows() + left, 6, "{}", kind.name);
                let coordinates = model.coordinates();
                assert_eq!(coordinates, model.start_values()[..coordinates.len()], "{}", kind.name);
            }
        }
    }
}
