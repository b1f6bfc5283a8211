//! Whether the drivers can go where their laws lead them. In: the course of the motion. Out: warnings with the place where it
//! ends, and where it passes a singular position.

use crate::diagnostic::{Code, Diagnostic};
use crate::model::Mechanism;
use crate::source::Span;

use super::course::{Course, Driver, Waypoint};
use super::plausible::with_unit;
use super::subspace::{RANK_TOLERANCE, singular_values};

/// Positions whose loops are weaker than this part of the strongest are looked at closely ...
const WEAK: f64 = 0.2;
/// ... and singular below this one: 0.1 deg beside a singular position all are.
const SINGULAR: f64 = 1e-3;
/// Golden sections of ten degrees, down to a hundredth of one.
const SECTIONS: usize = 16;
const GOLDEN: f64 = 0.618_033_988_749_895;

/// Warns if the loops do not let the drivers go on, or if the motion passes a singular position.
pub fn turn_remark(mechanism: &Mechanism, course: &Course<'_>) -> Option<Diagnostic> {
    let last = course.waypoints.last()?.t;
    let spans = course.drivers().iter().map(|driver| driver.law.span);
    let place = |t: f64| match course.crank() {
        Some(crank) => degrees(course.position(crank, t).unwrap_or_default()),
        None => course
            .drivers()
            .iter()
            .map(|driver| told(mechanism, course, driver, t))
            .collect::<Vec<_>>()
            .join(", "),
    };
    if course.ends {
        let (message, label, help) = if let Some(crank) = course.crank() {
            let name = &mechanism.joint(crank.joint).name;
            let turned = course.position(crank, last)? - course.position(crank, 0.0)?;
            (
                format!(
                    "`{name}` turns only to {}: {} from its start the loops cannot be closed any more",
                    place(last),
                    degrees(turned.abs())
                ),
                "driven round and round",
                "shorten the crank or lengthen the other links, or drive it to and fro within its range",
            )
        } else {
            (
                format!(
                    "the loops let the drivers go on to about t = {} only: with {} they can hardly be closed any more",
                    with_unit(last, "s"),
                    place(last)
                ),
                "driven here",
                "shorten strokes or lengthen other links; a run that ends before then does not meet it",
            )
        };
        return Some(Diagnostic::new(Code::NoFullTurn, message).at_each(spans, label).help(help));
    }
    let singular = if course.determined { singular(course) } else { None };
    let Some(singular) = singular else { return course.is_lost.then(|| lost(last, spans)) };
    let passes = match course.crank() {
        Some(crank) => format!(
            "on its turn `{}` passes a singular position at {}",
            mechanism.joint(crank.joint).name,
            place(singular)
        ),
        None => format!(
            "at t = {}, with {}, the motion passes a singular position",
            with_unit(singular, "s"),
            place(singular)
        ),
    };
    let message = format!("{passes}: there its loop could go on in two ways, and forces have no bounds");
    Some(Diagnostic::new(Code::PassesSingular, message).at_each(spans, "driven through it").help(
        "motion and energy stay right there, peaks of forces depend on where steps fall; change a length, or add a \
         link that holds the loop there",
    ))
}

/// Drivers that could not be followed to their end.
fn lost(last: f64, laws: impl Iterator<Item = Span>) -> Diagnostic {
    let message = format!(
        "the motion could be looked at up to about t = {} only: there the laws of the drivers jump, or are no numbers",
        with_unit(last, "s")
    );
    Diagnostic::new(Code::NoFullTurn, message)
        .at_each(laws, "driven here")
        .help("let laws go on smoothly, or end runs before then; what the loops do later is not checked")
}

fn degrees(angle: f64) -> String {
    format!("{} deg", (angle.to_degrees() * 10.0).round() / 10.0 + 0.0)
}

/// Where a driver is, for people.
pub(super) fn told(mechanism: &Mechanism, course: &Course<'_>, driver: &Driver<'_>, t: f64) -> String {
    let name = &mechanism.joint(driver.joint).name;
    let position = course.position(driver, t).unwrap_or_default();
    if driver.angular {
        format!("`{name}` at {}", degrees(position))
    } else {
        format!("`{name}` at {}", with_unit(position, "m"))
    }
}

/// When on the way the free joints lose their hold on each other: what they are weakest in, where it is least.
fn singular(course: &Course<'_>) -> Option<f64> {
    let strengths: Vec<Vec<f64>> =
        course.waypoints.iter().map(|waypoint| strengths(course, waypoint)).collect();
    let ranks = strengths
        .iter()
        .map(|values| values.iter().filter(|value| **value > RANK_TOLERANCE * values[0]).count());
    let weakest = ranks.max()?.checked_sub(1)?;
    let best = strengths.iter().map(|values| values[weakest]).fold(0.0, f64::max);
    let dips = strengths.windows(3).zip(course.waypoints.windows(3)).filter(|(values, _)| {
        let [before, here, after] = [0, 1, 2].map(|at| values[at][weakest]);
        here <= before && here <= after && here < WEAK * best
    });
    dips.map(|(_, near)| {
        let strength = |t: f64| {
            course.at(&near[0], t).map_or(0.0, |waypoint| self::strengths(course, &waypoint)[weakest])
        };
        lowest(strength, (near[0].t, near[2].t))
    })
    .find_map(|(t, least)| (least < SINGULAR * best).then_some(t))
}

/// Singular values of the loops by the free speeds, the largest first.
fn strengths(course: &Course<'_>, waypoint: &Waypoint) -> Vec<f64> {
    singular_values(&course.loops(waypoint))
}

/// Where a function with one minimum is least, and its value there, by golden section.
fn lowest(value: impl Fn(f64) -> f64, (mut low, mut high): (f64, f64)) -> (f64, f64) {
    let inner = |low: f64, high: f64| [high - GOLDEN * (high - low), low + GOLDEN * (high - low)];
    let mut at = inner(low, high);
    let mut values = at.map(&value);
    for _ in 0..SECTIONS {
        if values[0] < values[1] {
            high = at[1];
            (at[1], values[1]) = (at[0], values[0]);
            at[0] = inner(low, high)[0];
            values[0] = value(at[0]);
        } else {
            low = at[0];
            (at[0], values[0]) = (at[1], values[1]);
            at[1] = inner(low, high)[1];
            values[1] = value(at[1]);
        }
    }
    if values[0] < values[1] { (at[0], values[0]) } else { (at[1], values[1]) }
}
