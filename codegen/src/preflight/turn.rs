//! Whether a driven crank can turn once round: its loops are closed position by position, without forces or time.
//! In: closed positions of the released mechanism. Out: warnings with the angle where it ends.

use nalgebra::{DMatrix, DVector};

use crate::diagnostic::{Code, Diagnostic};
use crate::model::Coordinate;

use super::case::Case;
use super::resonance::turns_per_second;
use super::samples::{ClosedPositions, Walker, least_norm};

/// Speeds of the largest mechanism that is turned: above, each of some hundred decompositions takes a second.
const LARGEST: usize = 60;
/// Longest step of the crank [rad]: 5 degrees.
const LONGEST: f64 = std::f64::consts::PI / 36.0;
/// Shortest step [rad]: the angle where the turn ends is told to a quarter of a degree.
const SHORTEST: f64 = LONGEST / 20.0;
/// Steps over a position where the loops fold, in which Newton does not converge [rad].
const LEAPS: [f64; 3] = [SHORTEST * 3.0, SHORTEST * 10.0, LONGEST];
/// Loops are closed below this, in own units.
const CLOSED: f64 = 1e-9;
/// Newton either closes a loop within these from 5 degrees away, or it is open.
const ITERATIONS: usize = 25;

/// Warns if the one driver of a mechanism, a crank of constant speed, cannot turn once round.
pub fn short_turn(case: &Case<'_>, positions: &ClosedPositions) -> Option<Diagnostic> {
    let [(joint, speed)] = case.drivers()[..] else { return None };
    let (mechanism, sizes) = (case.mechanism, case.system.sizes());
    let joint = mechanism.joint(joint);
    let drive = joint.drives.first()?;
    turns_per_second(mechanism, &drive.law)?;
    let is_angle = joint.model.coordinates().get(drive.coordinate) == Some(&Coordinate::Angle);
    if !is_angle || sizes.all_speeds > LARGEST || sizes.all_rows == 0 {
        return None;
    }
    let loops = Loops::new(case, speed);
    // Closed without play: which side of its bearing a journal rests on is no matter of kinematics.
    let mut q = positions.positions.first()?.q.clone();
    for (_, coordinate) in play(case) {
        q[coordinate] = 0.0;
    }
    let values = mechanism.parameter_values();
    let at = |t: f64| drive.law.value_at_time(&values, t);
    let (start, sign) = (at(0.0)?, (at(1.0)? - at(0.0)?).signum());
    let turned = loops.turn(loops.close(q)?, sign)?;
    let span = drive.law.span;
    let degrees = |angle: f64| (angle.to_degrees() * 10.0).round() / 10.0;
    let message = format!(
        "`{}` turns only to {} deg: {} deg from its start the loops cannot be closed any more",
        joint.name,
        degrees(start + sign * turned),
        degrees(turned)
    );
    Some(
        Diagnostic::new(Code::NoFullTurn, message)
            .at(span, "driven round and round")
            .help("shorten the crank or lengthen the other links, or drive it to and fro within its range"),
    )
}

/// Speed and coordinate of every offset that clearance adds.
fn play<'a>(case: &'a Case<'_>) -> impl Iterator<Item = (usize, usize)> + 'a {
    let joints = case.mechanism.joints.iter().enumerate();
    let offsets = joints.flat_map(|(at, joint)| joint.model.offsets().map(move |offset| (at, offset)));
    offsets.filter_map(|(at, offset)| {
        let link = case.linkage.link_of_coordinate(crate::id::JointId::new(at), offset)?;
        let link = &case.linkage.links[link];
        Some((link.first_speed, link.first_coordinate))
    })
}

/// The loops of a mechanism, its crank and its clearances held.
struct Loops<'a> {
    walker: Walker<'a>,
    crank: usize,
    free: Vec<usize>,
}

impl<'a> Loops<'a> {
    fn new(case: &'a Case<'_>, crank: usize) -> Self {
        let walker = case.walker();
        let held: Vec<usize> = play(case).map(|(speed, _)| speed).chain([crank]).collect();
        let free = walker.joint_speeds.iter().copied().filter(|speed| !held.contains(speed)).collect();
        Self { walker, crank, free }
    }

    /// The shortest motion of the free speeds that takes the residual away.
    fn correct(
        &self,
        q: &mut [f64],
        jacobian: &DMatrix<f64>,
        residual: &DVector<f64>,
        crank: f64,
    ) -> Option<()> {
        let step = least_norm(&jacobian.select_columns(&self.free), residual)?;
        let units = &self.walker.units.speeds;
        let mut all = vec![0.0; units.len()];
        all[self.crank] = crank;
        for (speed, amount) in self.free.iter().zip(step.iter()) {
            all[*speed] = -amount * units[*speed];
        }
        self.walker.layout.advance(q, &all);
        Some(())
    }

    fn close(&self, mut q: Vec<f64>) -> Option<Vec<f64>> {
        for _ in 0..ITERATIONS {
            let (residual, jacobian, _) = self.walker.equations(&q);
            if residual.amax() < CLOSED {
                return Some(q);
            }
            self.correct(&mut q, &jacobian, &residual, 0.0)?;
        }
        None
    }

    /// Closed again after the crank has moved on.
    fn step(&self, from: &[f64], crank: f64) -> Option<Vec<f64>> {
        let mut q = from.to_vec();
        let (_, jacobian, _) = self.walker.equations(&q);
        let moved = jacobian.column(self.crank) * crank;
        self.correct(&mut q, &jacobian, &moved, crank)?;
        self.close(q)
    }

    /// How far the crank turns [rad]; nothing if once round.
    fn turn(&self, mut q: Vec<f64>, sign: f64) -> Option<f64> {
        let (mut turned, mut step) = (0.0, LONGEST);
        while turned < std::f64::consts::TAU {
            let tried = self.step(&q, sign * step).map(|next| (next, step));
            let shorter = tried.is_none() && step > SHORTEST;
            if shorter {
                step /= 2.0;
                continue;
            }
            let leap = || LEAPS.iter().find_map(|leap| Some((self.step(&q, sign * leap)?, *leap)));
            let Some((next, gained)) = tried.or_else(leap) else { return Some(turned) };
            (q, turned, step) = (next, turned + gained, (2.0 * step).min(LONGEST));
        }
        None
    }
}
