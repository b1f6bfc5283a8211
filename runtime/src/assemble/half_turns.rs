//! Closed positions in which no joint is turned half round. Rows of angles are sines, which vanish half a turn off as well.
//! In: an attempt to close the loops. Out: what it finds, turned back where need be. Never judges how far loops are open.
//!
//! How rows change with the speeds ([`crate::Entry::Closure`]) is how joints turn ([`crate::Entry::EquationsOfMotion`], whose
//! Jacobian is that of closed positions) times a cosine: the same where the joint is as meant, the opposite half a turn off. Of three
//! rows that let nothing turn, half a turn about `n` leaves `-n nᵀ`.

use core::f64::consts::{FRAC_PI_2, PI};
use core::ops::Range;

use super::newton::Newton;
use crate::error::AssemblyError;
use crate::evaluate::{Evaluator, put_back};
use crate::linear::{dot, largest};
use crate::tables::Motion;

/// Closed positions from which joints are turned back: more than one where turning one back turns another.
const ROUNDS: usize = 3;
/// Squares of the motion of rows below this are that of none: their differences have errors of 1e-10.
const AT_REST: f64 = 1e-12;
/// Part of the motion as meant that rows have at least: they have all of it, or none and less.
const AS_MEANT: f64 = 0.5;

/// A joint that is turned half round.
struct Turned {
    /// Its rows of angles.
    rows: Range<usize>,
    /// Axes, along the rows, about which half a turn puts it right.
    axes: Vec<Vec<f64>>,
}

/// A closed position with joints that are turned.
struct Found {
    joints: Vec<Turned>,
    /// How all rows would change with the free speeds, pure numbers, if every joint were as it is drawn.
    meant: Vec<f64>,
}

/// The closed position that Newton finds, in which all joints are as they are drawn.
pub(super) fn as_drawn(mut newton: Newton<'_, '_>) -> Result<Vec<f64>, AssemblyError> {
    let mut q = newton.run()?;
    let Some(mut found) = turned(&mut newton, &q) else { return Ok(q) };
    for _ in 0..ROUNDS {
        let mut next = None;
        for step in ways_back(&mut newton, &q, &found) {
            newton.set_out(&q, &step);
            let Ok(reached) = newton.run() else { continue };
            match turned(&mut newton, &reached) {
                None => return Ok(reached),
                Some(other) => next = next.or(Some((reached, other))),
            }
        }
        match next {
            Some(next) => (q, found) = next,
            None => break,
        }
    }
    let joint = newton.evaluator().joint_of_row(found.joints[0].rows.start);
    Err(AssemblyError::TurnedRound { joint })
}

/// Whether all angles together are less than a quarter of a turn away from the drawing, where no joint is turned: none can be half
/// round. Links bend by less than joints turn.
fn is_near_drawing(evaluator: &mut Evaluator<'_>, t: f64, q: &[f64]) -> bool {
    let description = evaluator.description();
    let free: f64 = evaluator
        .layout()
        .free()
        .map(|group| match group.motion {
            Motion::Scalar { .. } if description.coordinates[group.coordinate].unit == "rad" => {
                q[group.coordinate].abs()
            }
            Motion::Scalar { .. } => 0.0,
            // The sine of half the angle is at least a pi-th of the angle.
            Motion::Rotation | Motion::Pose => {
                PI * q[group.coordinate + 1..group.coordinate + 4].iter().map(|part| part.abs()).sum::<f64>()
            }
        })
        .sum();
    let prescribed = evaluator.prescribed(t).chunks_exact(3).zip(&*description.drivers);
    let driven: f64 = prescribed.filter(|(_, driver)| driver.angular).map(|(at, _)| at[0].abs()).sum();
    free + driven < FRAC_PI_2
}

/// Joints that are turned half round.
fn turned(newton: &mut Newton<'_, '_>, q: &[f64]) -> Option<Found> {
    let t = newton.time();
    if is_near_drawing(newton.evaluator(), t, q) {
        return None;
    }
    // A look around leaves no trace in what a run computes.
    let mut memory = Vec::new();
    newton.evaluator().visit_memory(&mut |number| memory.push(*number));
    let changes = newton.full_jacobian(q);
    let evaluator = newton.evaluator();
    evaluator.visit_memory(&mut put_back(&memory));
    let n = evaluator.sizes().speeds;
    let rows = &evaluator.description().rows;
    let of_joints: Vec<Range<usize>> = rows
        .chunk_by(|a, b| a.angular && b.angular && a.joint == b.joint)
        .scan(0, |first, joint| {
            let rows = *first..*first + joint.len();
            *first = rows.end;
            Some((rows, joint[0].angular))
        })
        .filter_map(|(rows, angular)| angular.then_some(rows))
        .collect();
    let entries = |rows: &Range<usize>| rows.start * n..rows.end * n;
    // Rows that no motion changes, as those out of the plane of plane linkages, are as they are drawn.
    let moves = |rows_of_joint: &Range<usize>| {
        let changes = &changes[entries(rows_of_joint)];
        rows[rows_of_joint.clone()].iter().any(|row| row.kept.is_some()) || dot(changes, changes) > AT_REST
    };
    if !of_joints.iter().any(moves) {
        return None;
    }
    let meant = meant(newton, q);
    let is_turned = |rows: &Range<usize>| {
        let (changes, meant) = (&changes[entries(rows)], &meant[entries(rows)]);
        let square = dot(meant, meant);
        square > AT_REST && dot(changes, meant) < AS_MEANT * square
    };
    let joints: Vec<Turned> = of_joints
        .into_iter()
        .filter(is_turned)
        .map(|rows| Turned { axes: axes(&changes[entries(&rows)], n), rows })
        .collect();
    (!joints.is_empty()).then_some(Found { joints, meant })
}

/// How all rows would change with the free speeds, pure numbers, if every joint were as it is drawn.
fn meant(newton: &mut Newton<'_, '_>, q: &[f64]) -> Vec<f64> {
    let t = newton.time();
    let evaluator = newton.evaluator();
    let sizes = evaluator.sizes();
    let (mut all_q, mut all_v) = (vec![0.0; sizes.all_coordinates], vec![0.0; sizes.all_speeds]);
    evaluator.expand(t, q, &vec![0.0; sizes.speeds], &mut all_q, &mut all_v);
    let (free, _) = evaluator.layout().speed_places(sizes.drivers);
    let jacobian = evaluator.equations(t, &all_q, &all_v).jacobian;
    let rows = jacobian.chunks_exact(sizes.all_speeds.max(1));
    let mut meant: Vec<f64> = rows.flat_map(|row| free.iter().map(|speed| row[*speed])).collect();
    newton.units().scale(&mut meant, 0..sizes.all_rows);
    meant
}

/// About which axes joints can be turned back whose rows change like this.
fn axes(changes: &[f64], n: usize) -> Vec<Vec<f64>> {
    let rows: Vec<&[f64]> = changes.chunks_exact(n).collect();
    let strongest = rows.iter().max_by(|a, b| dot(a, a).total_cmp(&dot(b, b)));
    let along: Vec<f64> =
        rows.iter().map(|row| strongest.map_or(0.0, |strongest| dot(row, strongest))).collect();
    let length = dot(&along, &along).sqrt().max(f64::MIN_POSITIVE);
    let mut axes = vec![along.iter().map(|part| part / length).collect()];
    if let [_, _] = rows[..] {
        // An axis that lies the other way round is put right by half a turn about any axis across it.
        axes.extend([vec![1.0, 0.0], vec![0.0, 1.0]]);
    }
    axes
}

/// Steps, pure numbers, that turn joints back: the shortest that leave the other rows alone, the shortest of all, and those of one
/// joint of the tree alone; on the way towards the drawing first.
fn ways_back(newton: &mut Newton<'_, '_>, q: &[f64], Found { joints, meant }: &Found) -> Vec<Vec<f64>> {
    let n = newton.evaluator().sizes().speeds;
    let of_joints = of_joints(newton.evaluator());
    let mut steps = Vec::new();
    for choice in 0..joints.iter().map(|joint| joint.axes.len()).max().unwrap_or(0) {
        let mut wanted = vec![0.0; meant.len() / n];
        for joint in joints {
            let axis = &joint.axes[choice.min(joint.axes.len() - 1)];
            wanted[joint.rows.clone()].iter_mut().zip(axis).for_each(|(wanted, part)| *wanted = PI * part);
        }
        let own: Vec<usize> = joints.iter().flat_map(|joint| joint.rows.clone()).collect();
        let rows: Vec<f64> = own.iter().flat_map(|row| &meant[row * n..(row + 1) * n]).copied().collect();
        let rows = masked(&rows, n, &of_joints);
        let right: Vec<f64> = own.iter().map(|row| wanted[*row]).collect();
        let all = newton.shortest(q, masked(meant, n, &of_joints), &wanted);
        let alone = newton.shortest(q, rows.clone(), &right);
        let one = of_strongest(newton.evaluator(), &alone).map(|strongest| {
            let only: Vec<bool> = (0..n).map(|speed| strongest.contains(&speed)).collect();
            newton.shortest(q, masked(&rows, n, &only), &right)
        });
        steps.extend([all, alone].into_iter().chain(one));
    }
    let layout = newton.evaluator().layout();
    let outwards = |step: &[f64]| {
        let scalars = layout.free().filter(|group| matches!(group.motion, Motion::Scalar { .. }));
        scalars.map(|group| step[group.speed] * q[group.coordinate]).sum::<f64>() > 0.0
    };
    let both = steps.into_iter().filter(|step| largest(step) > 0.0).map(|step| {
        let other = step.iter().map(|part| -part).collect();
        if outwards(&step) { [other, step] } else { [step, other] }
    });
    both.flatten().collect()
}

/// Rows with zeros where a speed is not among the chosen ones.
fn masked(rows: &[f64], n: usize, chosen: &[bool]) -> Vec<f64> {
    rows.iter().enumerate().map(|(at, entry)| if chosen[at % n] { *entry } else { 0.0 }).collect()
}

/// Which free speeds move joints: journals do not go round in their clearance, and links do not bend by half a turn.
fn of_joints(evaluator: &Evaluator<'_>) -> Vec<bool> {
    let mut chosen = vec![false; evaluator.sizes().speeds];
    for group in evaluator.layout().free() {
        let name = &evaluator.description().coordinates[group.coordinate].name;
        let is_of_joint = name.rsplit('.').next().is_some_and(|own| own.starts_with('q'));
        chosen[group.speed..group.speed + group.motion.lengths().1].fill(is_of_joint);
    }
    chosen
}

/// The speeds of the joint of the tree that a step turns most.
fn of_strongest(evaluator: &Evaluator<'_>, step: &[f64]) -> Option<Range<usize>> {
    let speeds = evaluator.layout().free().map(|group| group.speed..group.speed + group.motion.lengths().1);
    speeds.max_by(|a, b| largest(&step[a.clone()]).total_cmp(&largest(&step[b.clone()])))
}
