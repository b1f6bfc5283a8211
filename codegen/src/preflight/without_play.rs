//! What a mechanism would be if its joints had no clearance: play gives every loop freedoms that hide an extra driver, a
//! wrong axis or a wrong length.
//! In: the mechanism with its clearances closed, and the analysis with them open. Out: errors and warnings.

use linkwear_runtime::AssemblyError;

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::Mechanism;

use super::analysis::Analysis;
use super::case::Case;
use super::course::Course;
use super::rank::{Lost, Rows};
use super::samples::ClosedPositions;
use super::{failures, idle, immobile, immovable, turn};

/// Checks drivers, freedoms and loops of the case of [`Mechanism::with_clearances_closed`].
///
/// # Errors
/// If a driver has nothing to drive but play, or starts at its dead point. Loops that miss closure by more than their
/// clearances are found where a run starts.
pub fn check_without_play(
    case: &Case<'_>,
    loose: &Mechanism,
    with_play: &Analysis,
) -> Result<Vec<Diagnostic>, Diagnostics> {
    let mechanism = case.mechanism;
    let fail = |errors: Vec<Diagnostic>| {
        let errors = errors.into_iter().map(failures::with_closed_clearances).collect();
        Err(Diagnostics::from_list(errors).located(case.source))
    };
    let by_clearance = |reason: &str| vec![failures::moves_by_clearance(loose, reason)];
    let play = play(loose);
    let within = |error: &AssemblyError| {
        matches!(error, AssemblyError::NoConvergence { residual_m, residual_rad, .. }
        | AssemblyError::HeldPositions { residual_m, residual_rad, .. } if residual_m + residual_rad * case.units.length <= play)
    };
    const MISSES: &str = "without them its loops stay open, by less than the clearances";
    let drivers = case.drivers();
    let (positions, refusal) = match case.closed_positions() {
        Ok(found) => found,
        Err(error) if within(&error) => return Ok(by_clearance(MISSES)),
        // The start with the clearances open says which journal is out of reach.
        Err(_) => return Ok(Vec::new()),
    };
    let (joints, speeds): (Vec<_>, Vec<usize>) = drivers.iter().copied().unzip();
    let rows = Rows::new(&positions, speeds.clone());
    let conflicts = rows.driver_conflicts();
    // A linkage that its clearances let follow the driver is no structure, however its ideal twin would jam.
    let follows = |group: &Vec<usize>| {
        let [driver] = group.as_slice() else { return false };
        case.walker().driver_misses(&positions.positions[0], speeds[*driver], &speeds) * case.units.length
            <= play
    };
    if conflicts.iter().any(|group| !follows(group)) {
        let rigid = || immobile::rigid_joints(case, &positions);
        return fail(immovable::conflicts(mechanism, &drivers, &rows, (&|_| f64::INFINITY, &rigid)));
    }
    if !conflicts.is_empty() {
        return Ok(by_clearance("without them its drivers would be blocked"));
    }
    if let Some(error) = &refusal {
        return Ok(if within(error) { by_clearance(MISSES) } else { Vec::new() });
    }
    if let Some(lost @ Lost::Held(_)) = rows.lost_at_start(&speeds) {
        return fail(vec![failures::singular_start(mechanism, with_play, &joints, (&lost, None))]);
    }
    let sizes = case.system.sizes();
    let rank = rows.rank();
    if rank == sizes.all_speeds {
        return Ok(by_clearance("without them it is a structure"));
    }
    // What holds a plane linkage in its plane is redundant whatever its lengths are; play of a journal that tilts makes it none.
    let redundant = |all: usize, independent: usize, unmoved: usize| all - independent - unmoved;
    let of_play = redundant(with_play.constraint_rows, with_play.independent_rows, with_play.unmoved_rows);
    let more = redundant(sizes.all_rows, rank, rows.unmoved()).saturating_sub(of_play);
    Ok(match more {
        0 => turn_remarks(case, &positions),
        1 => by_clearance(
            "without them one more constraint of its loops is redundant, and they close only if made exactly",
        ),
        _ => by_clearance(&format!(
            "without them {more} more constraints of its loops are redundant, and they close only if made exactly"
        )),
    })
}

/// Whether the drivers can go where their laws lead them, as far as loops tell it that close by joints with clearance: open, those
/// have no rows.
fn turn_remarks(case: &Case<'_>, positions: &ClosedPositions) -> Vec<Diagnostic> {
    let idle = idle::idle_freedoms(case, positions).len();
    let course = Course::follow(case, positions, idle);
    course.and_then(|course| turn::turn_remark(case.mechanism, &course)).into_iter().collect()
}

/// Sum of all radial clearances [m].
fn play(mechanism: &Mechanism) -> f64 {
    let parameters = mechanism.parameter_values();
    let clearances = mechanism.joints.iter().filter_map(|joint| joint.clearance.as_ref());
    clearances.filter_map(|clearance| clearance.radial.value(&parameters)).sum()
}
