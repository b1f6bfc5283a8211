//! Whether forces jump where an angle that is known only up to whole turns passes half a turn. In: the step in which it
//! does. Out: an error, if they do. Never counts turns.
//!
//! Where the angle jumps, nothing else does: of two states next to each other, one on either side, a spring or a formula that uses the angle gives two forces, and one that repeats every turn gives the same.

use super::angles::{Angles, Crossing};
use super::motion::ConstrainedMotion;
use crate::error::RunError;
use crate::jump::{NEIGHBOURS, forces_jump};

/// States beside the half turn, as a part of the step: the angle of a column and the one in a force may round differently.
const ASIDE: f64 = 1e-10;
/// Such states are some last places of the time apart at least.
const LAST_PLACES: f64 = 64.0 * f64::EPSILON;

/// Writes the state at a time within the step.
type Within<'a> = &'a dyn Fn(f64, &mut [f64]);

/// Looks at one crossing.
///
/// # Errors
/// [`RunError::AngleJumps`].
pub(super) fn check(
    motion: &mut ConstrainedMotion<'_>,
    angles: &Angles,
    crossing: &Crossing,
    (within, size): (Within<'_>, usize),
    name: &str,
) -> Result<(), RunError> {
    let mut state = vec![0.0; size];
    let (mut before, mut after) = crossing.between;
    loop {
        let middle = 0.5 * (before + after);
        if middle <= before || middle >= after {
            break;
        }
        within(middle, &mut state);
        let (q, v, _) = motion.split(&state);
        // Angles and rates have no part in forces, so that those of another state do no harm.
        let columns = motion.dynamics.evaluator.observe(middle, q, v);
        if angles.level(crossing.place, middle, columns) == crossing.level {
            before = middle;
        } else {
            after = middle;
        }
    }
    let (from, to) = crossing.between;
    // A step may be so short that a part of it is no other time: the jump itself shortens it.
    let aside = (ASIDE * (to - from)).max(LAST_PLACES * to.abs());
    let mut at = |t: f64| {
        within(t, &mut state);
        forces(motion, t, &state)
    };
    let ends = [from, to].map(&mut at);
    let [one, other] = [before - aside, after + aside].map(&mut at);
    let neighbours = || {
        [(before, -aside), (after, aside)].map(|(place, away)| -> Vec<Vec<f64>> {
            (2..=NEIGHBOURS).map(|step| at(place + away * f64::from(step))).collect()
        })
    };
    if forces_jump([&one, &other], &ends, neighbours) {
        return Err(RunError::AngleJumps { t: after, angle: name.to_owned() });
    }
    Ok(())
}

/// Forces on all speeds at a state, without those of joints.
fn forces(motion: &mut ConstrainedMotion<'_>, t: f64, state: &[f64]) -> Vec<f64> {
    let (q, v, _) = motion.split(state);
    let evaluator = &mut motion.dynamics.evaluator;
    let sizes = evaluator.sizes();
    let (mut all_q, mut all_v) = (vec![0.0; sizes.all_coordinates], vec![0.0; sizes.all_speeds]);
    evaluator.expand(t, q, v, &mut all_q, &mut all_v);
    evaluator.equations(t, &all_q, &all_v).bias.to_vec()
}
