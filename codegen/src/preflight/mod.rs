//! What numbers say about a mechanism before code is emitted: does it close, how many freedoms has it,
//! which constraint rows are redundant, which freedoms are idle, which reactions are not unique.
//! In: a derivation with all rows kept, run by the interpreter. Out: [`Analysis`] and the rows to keep.
//! Never knows Rust syntax.

mod analysis;
mod angle_jumps;
mod assemblies;
mod case;
mod contact_resonance;
mod course;
mod cycles;
mod exactness;
mod failures;
mod fast;
mod friction;
mod idle;
mod immobile;
mod immovable;
mod losses;
mod own_units;
mod plausible;
mod prescribed;
mod rank;
mod reactions;
mod resonance;
mod samples;
mod start;
mod stopped;
mod stretched;
mod subspace;
mod turn;
mod without_play;

use linkwear_runtime::AssemblyError;

use crate::derive::Guide;
use crate::diagnostic::{Diagnostic, Diagnostics};

pub use analysis::{Analysis, Redundant};
pub use assemblies::{Assemblies, Coordinate, are_looked_for, as_guesses, assemblies};
pub use case::{Case, released};
pub use contact_resonance::contacts_near_modes;
pub use course::Waypoint;
pub use failures::beyond_numbers;
pub use fast::fast_drives;
pub use own_units::OwnUnits;
pub use prescribed::check_prescribed;
pub use start::{assembled, check_start};
pub use without_play::check_without_play;

use course::Course;
use rank::Rows;
use samples::ClosedPositions;

/// What is known after the analysis.
#[derive(Clone, Debug)]
pub struct Findings {
    /// For people and reports.
    pub analysis: Analysis,
    /// Which constraint rows to keep, and numbers at closed positions.
    pub guide: Guide,
    /// Remarks.
    pub warnings: Vec<Diagnostic>,
    /// Positions of the motion, the start first, if drivers alone tell it.
    pub waypoints: Vec<Waypoint>,
}

/// Analyses a mechanism.
///
/// # Errors
/// If loops cannot close, nothing can move, drivers contradict the loops or each other, or a motion has no inertia.
pub fn analyse(case: &Case<'_>) -> Result<Findings, Diagnostics> {
    let (mechanism, description) = (case.mechanism, case.description);
    let sizes = case.system.sizes();
    let drivers = case.drivers();
    let mut analysis = Analysis {
        coordinates: sizes.all_coordinates,
        speeds: sizes.all_speeds,
        constraint_rows: sizes.all_rows,
        grubler: mechanism.grubler(),
        drivers: drivers.iter().map(|(joint, _)| mechanism.joint(*joint).name.clone()).collect(),
        cuts: case.topology.cuts.iter().map(|cut| mechanism.joint(*cut).name.clone()).collect(),
        ..Analysis::default()
    };
    let opens = |opening| vec![failures::opens_along_motion(mechanism, description, &opening)];
    let fail = |errors| Err(Diagnostics::from_list(errors).located(case.source));
    let (positions, refusal) = match case.closed_positions() {
        Ok(found) => found,
        Err(error) => return fail(vec![failures::cannot_close(mechanism, &error)]),
    };
    let rows = Rows::new(&positions, drivers.iter().map(|(_, speed)| *speed).collect());
    if let Some(row) = stretched::stretched(case, &positions) {
        return fail(vec![immovable::stretched(mechanism, &description.rows[row].joint)]);
    }
    let keep = rows.independent();
    analysis.independent_rows = keep.iter().filter(|kept| **kept).count();
    let joint_speeds = case.linkage.joint_speeds();
    analysis.modes = analysis.speeds - joint_speeds.len();
    let of_joints =
        if analysis.modes == 0 { rows.rank() } else { Rows::of_speeds(&positions, &joint_speeds).rank() };
    analysis.unmoved_rows = rows.unmoved();
    analysis.mobility = joint_speeds.len() - of_joints;
    for (info, _) in description.rows.iter().zip(&keep).filter(|(_, kept)| !**kept) {
        analysis.redundant.push(Redundant {
            joint: info.joint.to_string(),
            row: info.meaning.to_string(),
            reason: "in every position tried, the other rows of its loops already forbid it".to_owned(),
        });
    }
    let misses = |speed| case.walker().driver_misses(&positions.positions[0], speed, &[]);
    let rigid = || immobile::rigid_joints(case, &positions);
    let mut errors = immovable::conflicts(mechanism, &drivers, &rows, (&misses, &rigid));
    if analysis.speeds == analysis.independent_rows {
        errors.insert(0, immovable::locked(mechanism, &analysis));
    }
    if errors.is_empty() {
        errors.extend(start_fault(case, &analysis, (&rows, &positions), refusal.as_ref()));
        if errors.is_empty() {
            errors = exactness::opens(case, &positions, &keep).map_or(errors, opens);
        }
    } else {
        let singular = rows.lost_at_start(&[]);
        if let Some(opening) = exactness::nearly_moves(case, &positions, singular.is_some()) {
            errors = opens(opening);
        } else if let Some(lost) = singular {
            // From there the walk may have gone where the drivers cannot.
            errors = vec![failures::singular_start(mechanism, &analysis, &[], (&lost, None))];
        }
    }
    if let Some((joint, body)) = immobile::massless(case, &positions).filter(|_| errors.is_empty()) {
        errors.push(failures::massless(mechanism, joint, &body));
    }
    if errors.is_empty() {
        errors = stopped::starts_beyond(case, &positions.positions[0]);
    }
    if !errors.is_empty() {
        return fail(errors);
    }
    let rigid = rigid();
    let mut warnings =
        if rigid.is_empty() { Vec::new() } else { vec![immovable::rigid_part(mechanism, &rigid)] };
    warnings.extend(resonance::near_resonance(mechanism));
    warnings.extend(resonance::fast_for_linear_shapes(mechanism));
    analysis.idle = idle::idle_freedoms(case, &positions);
    analysis.non_unique = reactions::non_unique(case, &positions);
    warnings.extend(plausible::remarks(mechanism, &analysis));
    warnings.extend(cycles::remark(mechanism));
    warnings.extend(fast::fast_starts(mechanism));
    warnings.extend(friction::remarks(mechanism, &analysis));
    let course = Course::follow(case, &positions, analysis.idle.len());
    if let Some(course) = &course {
        warnings.extend(turn::turn_remark(mechanism, course));
    }
    // Elsewhere forces decide where the mechanism is.
    let told = course.filter(|course| course.determined);
    warnings.extend(told.iter().flat_map(|course| angle_jumps::angle_jumps(case, course)));
    let waypoints = told.map(|course| course.waypoints).unwrap_or_default();
    let jacobians = positions.positions.into_iter().map(|position| position.jacobian).collect();
    Ok(Findings { analysis, guide: Guide { keep, jacobians, ..Guide::default() }, warnings, waypoints })
}

/// What is wrong with a start that loops as such allow: out of reach, or singular.
fn start_fault(
    case: &Case<'_>,
    analysis: &Analysis,
    (rows, positions): (&Rows, &ClosedPositions),
    refusal: Option<&AssemblyError>,
) -> Option<Diagnostic> {
    let drivers = case.drivers();
    let mut held = drivers.clone();
    if refusal.is_some() {
        held.extend(case.demanded());
    }
    let (joints, speeds): (Vec<_>, Vec<_>) = held.into_iter().unzip();
    match (rows.lost_at_start(&speeds), refusal) {
        (Some(lost), _) => {
            Some(failures::singular_start(case.mechanism, analysis, &joints, (&lost, refusal)))
        }
        (None, Some(error)) => {
            let guesses = assemblies::guesses_that_close(case, positions);
            Some(failures::out_of_reach(case.mechanism, &drivers, (error, guesses.as_deref())))
        }
        (None, None) => None,
    }
}
