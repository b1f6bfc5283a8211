//! Whether forces would jump on the way, where an angle that is known only up to whole turns passes half a turn. In: the course
//! of the motion. Out: warnings. Never knows which forces there are: two positions next to each other, one on either side,
//! tell.

use std::f64::consts::PI;

use linkwear_runtime::jump::{NEIGHBOURS, forces_jump};

use crate::diagnostic::{Code, Diagnostic};
use crate::model::Mechanism;

use super::case::Case;
use super::course::{Course, Waypoint};
use super::plausible::with_unit;
use super::turn::told;

/// Halvings of a step of 5 degrees: the positions on both sides are 1e-12 rad apart, what forces differ by else.
const HALVINGS: usize = 36;

/// Warns for every angle of a cut joint that would make a force jump.
pub fn angle_jumps(case: &Case<'_>, course: &Course<'_>) -> Vec<Diagnostic> {
    let channels = case.description.channels.iter().enumerate();
    let wrapping: Vec<usize> =
        channels.filter(|(_, channel)| channel.wraps).map(|(place, _)| place).collect();
    if wrapping.is_empty() {
        return Vec::new();
    }
    let angles: Vec<Vec<f64>> = course.waypoints.iter().map(|waypoint| columns(case, waypoint)).collect();
    let jumps = wrapping.iter().filter_map(|place| {
        let steps = angles.windows(2).zip(course.waypoints.windows(2));
        let crossings = steps.filter(|(angles, _)| (angles[1][*place] - angles[0][*place]).abs() > PI);
        let t = crossings.filter_map(|(_, ends)| jump(case, course, (&ends[0], ends[1].t), *place)).next()?;
        Some(warning(case.mechanism, course, &case.description.channels[*place].name, t))
    });
    jumps.collect()
}

fn columns(case: &Case<'_>, waypoint: &Waypoint) -> Vec<f64> {
    let sizes = case.system.sizes();
    case.observe(&waypoint.q, &vec![0.0; sizes.all_speeds], &vec![0.0; sizes.rows])
}

/// When the angle passes half a turn between a waypoint and a time, if forces jump there.
fn jump(case: &Case<'_>, course: &Course<'_>, (from, end): (&Waypoint, f64), place: usize) -> Option<f64> {
    let angle = |waypoint: &Waypoint| columns(case, waypoint)[place];
    let before = angle(from);
    let (mut low, mut high) = (from.t, end);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if (angle(&course.exactly_at(from, middle)?) - before).abs() > PI {
            high = middle;
        } else {
            low = middle;
        }
    }
    let forces = |t: f64| {
        let waypoint = course.exactly_at(from, t)?;
        Some(case.resistance(t, &waypoint.q, &course.speeds(&waypoint)?))
    };
    let (one, other) = (forces(low)?, forces(high)?);
    let ends: Vec<Vec<f64>> = [forces(from.t), forces(end)].into_iter().flatten().collect();
    let neighbours = || {
        [(low, low - high), (high, high - low)].map(|(place, away)| -> Vec<Vec<f64>> {
            (1..NEIGHBOURS).filter_map(|step| forces(place + away * f64::from(step))).collect()
        })
    };
    forces_jump([&one, &other], &ends, neighbours).then_some(high)
}

fn warning(mechanism: &Mechanism, course: &Course<'_>, angle: &str, t: f64) -> Diagnostic {
    let places: Vec<_> = course.drivers().iter().map(|driver| told(mechanism, course, driver, t)).collect();
    let message = format!(
        "at t = {}, with {}, `{angle}` passes half a turn, and a force that depends on it would jump: runs end there",
        with_unit(t, "s"),
        places.join(", ")
    );
    let joint =
        angle.rsplit_once('.').and_then(|(name, _)| mechanism.joints.iter().find(|joint| joint.name == name));
    Diagnostic::new(Code::AngleJumps, message).at_each(joint.map(|joint| joint.span), "closes a loop").help(
        "the angle of a joint that closes a loop is known only up to whole turns; write `cut = true` to another joint of \
         that loop",
    )
}
