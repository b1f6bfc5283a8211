//! Where joints hold a beam, and which bending moments they pass there. Out: [`HeldPlace`]s in rising order.
//! Never knows which shapes follow.

use super::flexible::Bending;
use super::inertia;
use super::section::SAME_PLACE;
use crate::id::PointId;
use crate::model::{Carrier, Direction, Joint};

/// Cosine below which two directions are at right angles: written with six digits they are that far off.
pub(super) const SQUARE: f64 = 1e-6;

/// The bending planes by axes of the floating frame: that of the deflection, and the one about which sections turn.
pub(super) const PLANES: [[usize; 2]; 2] = [[1, 2], [2, 1]];

/// A place where joints hold the link.
pub(super) struct HeldPlace<'a> {
    /// Along the link [m].
    pub(super) x: f64,
    /// A joint here constrains orientation.
    pub(super) turns: bool,
    /// In which planes a joint here passes a bending moment.
    pub(super) moment: [bool; 2],
    /// In which of them it passes one to what stands without the link: a body that hangs on this place alone follows it.
    pub(super) firm: [bool; 2],
    /// The first joint that makes it firm.
    pub(super) by: Option<&'a Joint>,
}

impl HeldPlace<'_> {
    /// Whether it keeps the section from turning in both planes.
    pub(super) fn clamps(&self) -> bool {
        self.firm == [true; 2]
    }
}

/// The places: `along` has those of the points in use, in their order [m].
pub(super) fn held_places<'a>(
    of: Bending<'a>,
    along: &[f64],
    frame: &[[f64; 3]; 3],
    length: f64,
) -> Vec<HeldPlace<'a>> {
    let near = SAME_PLACE * length;
    let mut places: Vec<HeldPlace<'a>> = Vec::new();
    for (own, x) in of.uses.iter().zip(along).filter(|(own, _)| own.held) {
        match places.iter_mut().find(|known| (known.x - x).abs() < near) {
            Some(known) => known.turns |= own.turns,
            None => places.push(HeldPlace {
                x: *x,
                turns: own.turns,
                moment: [false; 2],
                firm: [false; 2],
                by: None,
            }),
        }
    }
    places.sort_by(|a, b| a.x.total_cmp(&b.x));
    let place_of = |joint: &Joint| {
        let point = point_on(joint, of.carrier)?;
        let own = of.uses.iter().position(|own| own.point == point)?;
        places.iter().position(|place| (place.x - along[own]).abs() < near)
    };
    let located: Vec<(&Joint, usize)> =
        of.joints.iter().filter_map(|joint| Some((joint, place_of(joint)?))).collect();
    for (joint, at) in &located {
        let elsewhere: Vec<Carrier> = located
            .iter()
            .filter(|(_, other)| other != at)
            .map(|(other, _)| beyond(other, of.carrier))
            .collect();
        let stands = stands(beyond(joint, of.carrier), of.carrier, of.joints, &elsewhere);
        let place = &mut places[*at];
        for (plane, passed) in moments(joint, of.carrier, frame).into_iter().enumerate() {
            place.moment[plane] |= passed;
            place.firm[plane] |= passed && stands;
            place.by = place.by.or((passed && stands).then_some(*joint));
        }
    }
    places
}

/// Where a joint is on a body; nothing if it is not on it.
fn point_on(joint: &Joint, carrier: Carrier) -> Option<PointId> {
    let [on_parent, on_child] = joint.points();
    if joint.parent == carrier { Some(on_parent) } else { (joint.child == carrier).then_some(on_child) }
}

/// What a joint joins to a body.
fn beyond(joint: &Joint, carrier: Carrier) -> Carrier {
    if joint.parent == carrier { joint.child } else { joint.parent }
}

/// In which planes a joint passes a bending moment: where nothing of it turns freely about the axis of the sections' turn.
/// What a drive prescribes does not turn freely.
fn moments(joint: &Joint, carrier: Carrier, frame: &[[f64; 3]; 3]) -> [bool; 2] {
    let driven = |number: usize| joint.drives.iter().any(|drive| drive.coordinate == number);
    let Some(directions) = joint.model.turns_besides(driven) else { return [false; 2] };
    let axes = directions.into_iter().map(|direction| match direction {
        Direction::Z => joint.model.axes.first(),
        Direction::X => joint.model.axes.get(1),
        // Only what tilts turns about it, and about the second direction besides.
        Direction::Y => None,
    });
    let Some(axes) = axes.collect::<Option<Vec<_>>>() else { return [false; 2] };
    let free = axes.iter().map(|axis| if joint.child == carrier { axis.child } else { axis.parent });
    let free: Vec<[f64; 3]> = free.collect();
    PLANES.map(|[_, turn]| free.iter().all(|axis| inertia::dot(*axis, frame[turn]).abs() < SQUARE))
}

/// Whether a body is joined to the ground, or to one of `also`, without the link `without`.
fn stands(body: Carrier, without: Carrier, joints: &[Joint], also: &[Carrier]) -> bool {
    let mut reached = vec![body];
    let mut next = 0;
    while let Some(body) = reached.get(next).copied() {
        if body == Carrier::Ground || also.contains(&body) {
            return true;
        }
        for joint in joints.iter().filter(|joint| joint.parent != without && joint.child != without) {
            for (from, to) in [(joint.parent, joint.child), (joint.child, joint.parent)] {
                if from == body && !reached.contains(&to) {
                    reached.push(to);
                }
            }
        }
        next += 1;
    }
    false
}
