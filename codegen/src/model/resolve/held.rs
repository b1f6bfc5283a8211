//! How a beam is held: as the file says, else so that static deflections need few modes. Out: [`Hold`].

use super::flexible::Bending;
use super::held_places::{HeldPlace, PLANES, SQUARE, held_places};
use super::inertia;
use super::resolver::Resolver;
use super::section::SAME_PLACE;
use crate::diagnostic::Code;
use crate::flexible::{Attachment, Hold};
use crate::spec::HeldSpec;

impl Resolver<'_> {
    /// The hold of a link with this frame and length; `along` has the places of the points in use [m].
    pub(super) fn hold(
        &mut self,
        of: Bending<'_>,
        along: &[f64],
        frame: &[[f64; 3]; 3],
        length: f64,
    ) -> Option<Hold> {
        let written = of.spec.value.held.as_ref();
        let places = held_places(of, along, frame, length);
        let near = SAME_PLACE * length;
        let apart = |a: f64, b: f64| (a - b).abs() > near;
        let clamps: Vec<f64> = places.iter().filter(|place| place.clamps()).map(|place| place.x).collect();
        let default = match (clamps.len(), places.len()) {
            (1, 1 | 2) => HeldSpec::Clamped,
            (_, 0) => HeldSpec::Free,
            // Turned about somewhere else than at its first end: the mean axes favour no place.
            (_, 1) if apart(places[0].x, 0.0) => HeldSpec::Free,
            (_, 1) => HeldSpec::Clamped,
            (0, 2) => HeldSpec::Pinned,
            _ => HeldSpec::CraigBampton,
        };
        let hold = match written.map_or(default, |held| held.value) {
            HeldSpec::Clamped => {
                let at =
                    clamps.first().copied().filter(|x| written.is_none() && apart(*x, 0.0)).unwrap_or(0.0);
                let others = places.iter().map(|place| place.x).filter(|x| apart(*x, at));
                Hold::Clamped { at, far: others.max_by(|a, b| (a - at).abs().total_cmp(&(b - at).abs())) }
            }
            HeldSpec::Free => Hold::Free,
            HeldSpec::Pinned if places.len() >= 2 => {
                Hold::Pinned(Some([places[0].x, places[places.len() - 1].x]))
            }
            HeldSpec::Pinned => Hold::Pinned(None),
            HeldSpec::CraigBampton if places.len() >= 2 => {
                // Shapes of the turns of ends that only pins and balls hold cost modes, and loads in the plane of the
                // pins do not ask for them: the file may.
                let with_ends = written.is_some() || !clamps.is_empty();
                let inner = 1..places.len() - 1;
                let attachment = |(index, place): (usize, &HeldPlace<'_>)| Attachment {
                    x: place.x,
                    rotation: if inner.contains(&index) {
                        [place.turns; 2]
                    } else {
                        place.moment.map(|passed| passed && with_ends)
                    },
                };
                Hold::CraigBampton(places.iter().enumerate().map(attachment).collect())
            }
            HeldSpec::CraigBampton => {
                let message = format!("`{}` is held at fewer than two places", of.name.value);
                self.refuse(Code::BadModes, written.map_or(of.name.span, |h| h.span), message)
                    .help("take `held` away");
                return None;
            }
        };
        self.warn_held_as_free(of, &places, &hold, frame, near);
        Some(hold)
    }

    /// Where a joint keeps a section from turning and the shapes do not: what they miss falls as one over the number of modes.
    fn warn_held_as_free(
        &mut self,
        of: Bending<'_>,
        places: &[HeldPlace<'_>],
        hold: &Hold,
        frame: &[[f64; 3]; 3],
        near: f64,
    ) {
        let size = inertia::dot(of.gravity, of.gravity).sqrt();
        let kept = |place: &HeldPlace<'_>, plane: usize| match hold {
            Hold::Clamped { at, .. } => (place.x - at).abs() <= near,
            Hold::CraigBampton(all) => all.iter().any(|own| own.x == place.x && own.rotation[plane]),
            Hold::Pinned(_) | Hold::Free => false,
        };
        // A pin that is not driven holds its link in a plane, across which few mechanisms are loaded.
        let loaded = |place: &HeldPlace<'_>, plane: usize| {
            let [deflection, _] = PLANES[plane];
            place.clamps() || inertia::dot(of.gravity, frame[deflection]).abs() > SQUARE * size
        };
        let free = |place: &&HeldPlace<'_>| {
            (0..2).any(|plane| place.firm[plane] && !kept(place, plane) && loaded(place, plane))
        };
        let Some(place) = places.iter().find(free) else { return };
        let written = of.spec.value.held.as_ref();
        let help = match places.len() {
            _ if place.clamps() => "take `held` away: what the joints hold decides then",
            // Held by a pin alone it turns about that.
            0 | 1 => return,
            _ => "write `held = \"craig_bampton\"`: it has a shape for every turn that the joints hold",
        };
        let joint = place.by.map_or("", |joint| &joint.name);
        let message = format!(
            "the shapes of `{}` turn freely where the joint `{joint}` keeps it from turning",
            of.name.value
        );
        let at = written.map_or(of.spec.span, |held| held.span);
        self.refuse(Code::HeldAsFree, at, message).help(help);
    }
}
