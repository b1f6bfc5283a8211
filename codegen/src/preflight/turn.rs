//! Whether a driven crank can turn once round: its loops are closed position by position, without forces or time.
//! In: closed positions of the released mechanism. Out: warnings with the angle where it ends.

use linkwear_runtime::CLOSED_AT_START;
use nalgebra::{DMatrix, DVector};

use crate::diagnostic::{Code, Diagnostic};
use crate::model::Coordinate;

use super::case::Case;
use super::resonance::turns_per_second;
use super::samples::{ClosedPositions, Walker};
use super::subspace::{RANK_TOLERANCE, least_norm, singular_values};

/// Speeds of the largest mechanism that is turned: above, each of some hundred decompositions takes a second.
const LARGEST: usize = 60;
/// Longest step of the crank [rad]: 5 degrees.
const LONGEST: f64 = std::f64::consts::PI / 36.0;
/// Shortest step [rad]: the angle where the turn ends is told to a quarter of a degree.
const SHORTEST: f64 = LONGEST / 20.0;
/// Steps over a position where the loops fold, in which Newton does not converge [rad].
const LEAPS: [f64; 3] = [SHORTEST * 3.0, SHORTEST * 10.0, LONGEST];
/// Positions whose loops are weaker than this part of the strongest are looked at closely ...
const WEAK: f64 = 0.2;
/// ... and singular below this one: 0.1 deg beside a singular position all are.
const SINGULAR: f64 = 1e-3;
/// Golden sections of ten degrees, down to a hundredth of one.
const SECTIONS: usize = 16;
const GOLDEN: f64 = 0.618_033_988_749_895;
/// Newton either closes a loop within these from 5 degrees away, or it is open.
const ITERATIONS: usize = 25;

/// Warns if the one driver of a mechanism, a crank of constant speed, cannot turn once round, or passes a singular position.
pub fn turn_remark(case: &Case<'_>, positions: &ClosedPositions) -> Option<Diagnostic> {
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
    let span = drive.law.span;
    let degrees = |angle: f64| (angle.to_degrees() * 10.0).round() / 10.0;
    let turned = match loops.turn(loops.close(q)?, sign) {
        Turn::Ends { turned } => turned,
        Turn::Round { singular } => {
            let message = format!(
                "on its turn `{}` passes a singular position at {} deg: there its loop could go on in two ways, and forces \
                 have no bounds",
                joint.name,
                degrees(start + sign * singular?)
            );
            return Some(Diagnostic::new(Code::PassesSingular, message).at(span, "driven through it").help(
                "motion and energy stay right there, peaks of forces depend on where steps fall; change a length, or add a \
                 link that holds the loop there",
            ));
        }
    };
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

/// What a crank met on its way round.
enum Turn {
    /// It came no further than this angle from its start [rad].
    Ends { turned: f64 },
    /// It came round; past a singular position at this angle from its start [rad], if there was one.
    Round { singular: Option<f64> },
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
            if residual.amax() < CLOSED_AT_START {
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

    fn turn(&self, mut q: Vec<f64>, sign: f64) -> Turn {
        let (mut turned, mut step) = (0.0, LONGEST);
        let mut visited = vec![(turned, q.clone())];
        while turned < std::f64::consts::TAU {
            let tried = self.step(&q, sign * step).map(|next| (next, step));
            let shorter = tried.is_none() && step > SHORTEST;
            if shorter {
                step /= 2.0;
                continue;
            }
            let leap = || LEAPS.iter().find_map(|leap| Some((self.step(&q, sign * leap)?, *leap)));
            let Some((next, gained)) = tried.or_else(leap) else { return Turn::Ends { turned } };
            (q, turned, step) = (next, turned + gained, (2.0 * step).min(LONGEST));
            visited.push((turned, q.clone()));
        }
        Turn::Round { singular: self.singular(&visited, sign) }
    }

    /// Where on the way the free joints lose their hold on each other: what they are weakest in, where it is least.
    fn singular(&self, visited: &[(f64, Vec<f64>)], sign: f64) -> Option<f64> {
        let strengths: Vec<Vec<f64>> = visited.iter().map(|(_, q)| self.strengths(q)).collect();
        let ranks = strengths
            .iter()
            .map(|values| values.iter().filter(|value| **value > RANK_TOLERANCE * values[0]).count());
        let weakest = ranks.max()?.checked_sub(1)?;
        let best = strengths.iter().map(|values| values[weakest]).fold(0.0, f64::max);
        let dips = strengths.windows(3).zip(visited.windows(3)).filter(|(values, _)| {
            let [before, here, after] = [0, 1, 2].map(|at| values[at][weakest]);
            here <= before && here <= after && here < WEAK * best
        });
        dips.map(|(_, near)| {
            let (from, q) = &near[0];
            let strength = |turned: f64| {
                self.step(q, sign * (turned - from)).map_or(0.0, |q| self.strengths(&q)[weakest])
            };
            lowest(strength, (*from, near[2].0))
        })
        .find_map(|(turned, least)| (least < SINGULAR * best).then_some(turned))
    }

    /// Singular values of the loops by the free speeds, the largest first.
    fn strengths(&self, q: &[f64]) -> Vec<f64> {
        let (_, jacobian, _) = self.walker.equations(q);
        singular_values(&jacobian.select_columns(&self.free))
    }
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
