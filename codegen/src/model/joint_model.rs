//! What follows from a joint's kind by rule: constraint rows, coordinates, start values, the chain of links. In: a kind, directions in numbers.
//! Out: [`JointModel`]. Never knows which kinds there are.

use std::f64::consts::TAU;
use std::ops::Range;

use super::coordinate::Coordinate;
use super::joint_kind::Direction::{self, X, Y, Z};
use super::joint_kind::Primitive::{self, Ball, Pose, Shift, Slide, Thread, Turn};
use super::joint_kind::{DRIVEN_BALL, FREE, JointKind, PlaceKey, TILTING};
use crate::spec::Ends;

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
    /// Whether it stands for a joint whose kind the file does not say, which has been told.
    pub stands_in: bool,
}

impl JointModel {
    /// A joint without clearance.
    ///
    /// # Panics
    /// If no kind has this name.
    #[expect(clippy::expect_used, reason = "documented: names are written in code, never read from files")]
    pub fn new(name: &str, axes: &[Axis]) -> Self {
        let kind = JointKind::named(name).expect("the name of a kind of joint");
        Self { kind, axes: axes.to_vec(), lead: 0.0, clearance: false, tilt: None, stands_in: false }
    }

    /// In place of a joint whose kind is not known: it takes nothing away.
    pub fn stand_in() -> Self {
        Self { stands_in: true, ..Self::new(FREE, &[]) }
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
        self.numbered().find(|(_, primitive)| *primitive == wanted).map(|(number, _)| number)
    }

    /// Its primitives from parent to child, each with the number of its first coordinate.
    pub fn primitives(&self) -> Vec<(usize, Primitive)> {
        self.numbered().collect()
    }

    fn numbered(&self) -> impl Iterator<Item = (usize, Primitive)> {
        let number = |first: usize, list: &'static [Primitive]| {
            list.iter().scan(first, |next, primitive| {
                let number = *next;
                *next += primitive.values().len();
                Some((number, *primitive))
            })
        };
        // What clearance adds.
        let across = if self.clearance { self.kind.clearance } else { &[] };
        let tilting = if self.tilt.is_some() { TILTING } else { &[] };
        let (offsets, tilts) = match (across, tilting) {
            ([], []) => (0, 0),
            _ => (self.offsets().start, self.tilts().start),
        };
        let play = number(offsets, across).chain(number(tilts, tilting));
        // The ends of a journal go along with it: it slides along the axis of its bearing before it leaves that.
        let ends_go_along = self.tilt == Some(Ends::Journal);
        let before =
            move |(_, primitive): &(usize, Primitive)| ends_go_along && matches!(primitive, Slide(_));
        let own = number(0, self.kind.primitives);
        own.clone().filter(before).chain(play).chain(own.filter(move |one| !before(one)))
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
        Self { kind: &DRIVEN_BALL, axes, lead: 0.0, clearance: false, tilt: None, stands_in: false }
    }

    /// Whether it is one.
    pub fn is_driven_ball(&self) -> bool {
        *self.kind == DRIVEN_BALL
    }

    fn any(&self, wanted: impl Fn(Primitive) -> bool) -> bool {
        self.numbered().any(|(_, primitive)| wanted(primitive))
    }

    /// Whether the child can turn about any axis, its orientation being no list of scalars.
    pub fn turns_freely(&self) -> bool {
        self.any(|primitive| matches!(primitive, Ball | Pose))
    }

    /// Whether the joint's primitives take nothing away.
    pub fn is_free(&self) -> bool {
        self.any(|primitive| primitive == Pose)
    }

    /// Whether it leaves a body all freedoms; of one whose clearance does so besides its own, the ideal joint does not.
    pub fn flies(&self) -> bool {
        self.is_free() && !self.holds_place()
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
        self.turning().map(|(_, direction)| direction).collect()
    }

    /// The directions about which it turns by other coordinates than those `held`; nothing if it turns about any.
    pub fn turns_besides(&self, held: impl Fn(usize) -> bool) -> Option<Vec<Direction>> {
        let others = || self.turning().filter(|(number, _)| !held(*number));
        (!self.turns_freely()).then(|| others().map(|(_, direction)| direction).collect())
    }

    /// Each with the number of its coordinate.
    fn turning(&self) -> impl Iterator<Item = (usize, Direction)> {
        self.numbered().filter_map(|(number, primitive)| match primitive {
            Turn(direction) => Some((number, direction)),
            Thread => Some((number, Z)),
            Slide(_) | Ball | Shift | Pose => None,
        })
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
    use crate::model::joint_kind::JOINT_KINDS;

    #[test]
    fn rows_and_freedoms_are_six_together_and_coordinates_come_first() {
        for kind in JOINT_KINDS {
            let loose = [(!kind.clearance.is_empty(), None), (true, Some(Ends::Journal))];
            for (clearance, tilt) in
                [(false, None)].into_iter().chain(loose.into_iter().take(1 + usize::from(kind.tilts)))
            {
                let model =
                    JointModel { kind, axes: Vec::new(), lead: 1.0, clearance, tilt, stands_in: false };
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
