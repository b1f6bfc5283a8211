//! The motion that drivers prescribe, position by position: the loops are closed at one time after the other, without forces.
//! In: closed positions of the released mechanism, and the laws of its drivers. Out: positions with their times, and whether
//! the loops let the drivers go on. Never judges.

use std::f64::consts::{PI, TAU};

use linkwear_runtime::CLOSED_AT_START;
use nalgebra::DVector;

use crate::id::JointId;
use crate::model::{Coordinate, Formula};
use crate::sparse_rows::SparseRows;

use super::case::Case;
use super::resonance::turns_per_second;
use super::samples::{ClosedPositions, Walker};
use super::subspace::{least_norm, null_space};

/// Speeds of the largest mechanism that is moved: above, each of some hundred decompositions takes a second.
const LARGEST: usize = 60;
/// Longest step of the fastest driver [rad, own units]: 5 degrees.
const LONGEST: f64 = PI / 36.0;
/// Shortest part of such a step: where the motion ends is told to a quarter of a degree.
const SHORTEST: f64 = 1.0 / 20.0;
/// Steps over a position where the loops fold, in which Newton does not converge.
const LEAPS: [f64; 3] = [SHORTEST * 3.0, SHORTEST * 10.0, 1.0];
/// Newton either closes a loop within these from 5 degrees away, or it is open.
const ITERATIONS: usize = 25;
/// Steps of the fastest driver at most: four turns.
const STEPS: usize = 288;
/// Drivers that have not moved in so many first steps of time, each twice the last, rest for good.
const RESTING: usize = 60;
/// First step of time that is tried [s]; the laws tell how long the next ones are.
const FIRST: f64 = 1e-6;
/// Halvings, in the logarithm, of the times between which a driver makes its longest step: those of neighbours differ by a factor of ten
/// at most, and 60 are left of rounding.
const HALVINGS: usize = 60;
/// Part of the longest step that a step has at least: less is left of it where a law jumps.
const LEAST: f64 = 0.5;
/// Places within a step of time at which drivers are looked at, so that none goes to and fro in it unseen.
const WITHIN: usize = 4;

/// A position of the motion.
#[derive(Clone, Debug)]
pub struct Waypoint {
    /// Time [s].
    pub t: f64,
    /// All coordinates.
    pub q: Vec<f64>,
}

/// What the laws of the drivers say of the next step.
enum Next {
    /// The time that it takes [s], and how far the fastest driver goes in it.
    Step { span: f64, far: f64 },
    /// The drivers rest for good.
    Rest,
    /// They jump, or are no numbers.
    Unknown,
}

/// The motion as far as it was followed.
pub struct Course<'a> {
    case: &'a Case<'a>,
    walker: Walker<'a>,
    drivers: Vec<Driver<'a>>,
    free: Vec<usize>,
    /// Positions in the order of time.
    pub waypoints: Vec<Waypoint>,
    /// Whether the loops cannot be closed after the last of them.
    pub ends: bool,
    /// Whether the laws of the drivers do not tell how the motion goes on after the last of them: they jump there, or are no numbers.
    pub is_lost: bool,
    /// Whether drivers alone tell the positions, but for idle freedoms; else others go as little as they can.
    pub determined: bool,
}

/// A prescribed coordinate.
pub struct Driver<'a> {
    /// Its joint.
    pub joint: JointId,
    /// Its law.
    pub law: &'a Formula,
    /// Whether it is an angle, else a length.
    pub angular: bool,
    speed: usize,
}

impl<'a> Course<'a> {
    /// Follows the drivers from the start: until those of constant speed have turned once round, or else until the fastest
    /// has gone as far as a turn. Nothing, if there is no driver, no loop or too many speeds.
    pub fn follow(case: &'a Case<'a>, positions: &ClosedPositions, idle: usize) -> Option<Self> {
        let sizes = case.system.sizes();
        let speeds = case.drivers();
        if speeds.is_empty() || sizes.all_speeds > LARGEST || sizes.all_rows == 0 {
            return None;
        }
        let drives = case.mechanism.drives().zip(speeds);
        let drivers = drives.map(|((joint, drive), (_, speed))| {
            let coordinates = case.mechanism.joint(joint).model.coordinates();
            let angular = coordinates.get(drive.coordinate) == Some(&Coordinate::Angle);
            Driver { joint, law: &drive.law, angular, speed }
        });
        let drivers: Vec<_> = drivers.collect();
        let walker = case.walker();
        let play: Vec<_> = case.play().collect();
        let held = |speed: &usize| {
            play.iter().any(|(offset, _)| offset == speed)
                || drivers.iter().any(|driver| driver.speed == *speed)
        };
        let free: Vec<usize> = walker.joint_speeds.iter().copied().filter(|speed| !held(speed)).collect();
        let start = positions.positions.first()?;
        let determined = null_space(&start.jacobian.select_columns(&free)).ncols() <= idle;
        // Closed without play: which side of its bearing a journal rests on is no matter of kinematics.
        let mut q = start.q.clone();
        play.iter().for_each(|(_, coordinate)| q[*coordinate] = 0.0);
        let mut course = Self {
            case,
            walker,
            drivers,
            free,
            waypoints: Vec::new(),
            ends: false,
            is_lost: false,
            determined,
        };
        let first = course.close(q)?;
        course.waypoints.push(Waypoint { t: 0.0, q: first });
        course.go_on();
        Some(course)
    }

    /// The drivers, in the order of the file.
    pub fn drivers(&self) -> &[Driver<'a>] {
        &self.drivers
    }

    /// The one driver, if it is a crank of constant speed.
    pub fn crank(&self) -> Option<&Driver<'a>> {
        let [driver] = &self.drivers[..] else { return None };
        (driver.angular && self.turn(driver).is_some()).then_some(driver)
    }

    /// Where a driver is at a time [rad, m].
    pub fn position(&self, driver: &Driver<'_>, t: f64) -> Option<f64> {
        driver.law.value_at_time(&self.case.mechanism.parameter_values(), t)
    }

    /// How long a driver takes for a turn [s], if its speed is constant.
    fn turn(&self, driver: &Driver<'_>) -> Option<f64> {
        turns_per_second(self.case.mechanism, driver.law).map(f64::recip)
    }

    fn go_on(&mut self) {
        let turning = self.drivers.iter().filter(|driver| driver.angular);
        let end = turning.filter_map(|driver| self.turn(driver)).reduce(f64::max);
        let (mut gone, mut part) = (0.0, 1.0);
        let mut span = FIRST;
        for _ in 0..STEPS {
            let Some(last) = self.waypoints.last() else { return };
            if end.map_or(gone >= TAU, |end| last.t >= end) {
                return;
            }
            let (whole, moved) = match self.next_span(last.t, span) {
                Next::Step { span, far } => (span, far),
                Next::Rest => return,
                Next::Unknown => {
                    self.is_lost = true;
                    return;
                }
            };
            let tried = loop {
                let next = self.over(last, last.t, part * whole);
                if next.is_some() || part <= SHORTEST {
                    break next.map(|next| (next, part));
                }
                part /= 2.0;
            };
            // On the fold itself loops do not tell how the motion goes on: the position before it does.
            let before = self.waypoints.len().checked_sub(2).map(|before| &self.waypoints[before]);
            let leap = || {
                let over = |from: &Waypoint, leap: f64| Some((self.over(from, last.t, leap * whole)?, leap));
                std::iter::once(last)
                    .chain(before)
                    .find_map(|from| LEAPS.iter().find_map(|leap| over(from, *leap)))
            };
            let Some((next, gained)) = tried.or_else(leap) else {
                self.ends = true;
                return;
            };
            (span, gone) = (whole, gone + gained * moved);
            part = (2.0 * part).min(1.0);
            self.waypoints.push(next);
        }
    }

    /// The time in which the fastest driver makes its longest step, and how far it goes in it. A driver that slows down or
    /// turns back makes a shorter one in at most twice the last time.
    fn next_span(&self, t: f64, last: f64) -> Next {
        let is_first = self.waypoints.len() == 1;
        let mut span = last;
        let mut rests = true;
        for _ in 0..RESTING {
            let Some(far) = self.moved(t, span) else { return self.between(t, last) };
            rests &= far == 0.0;
            let ratio = if far > 0.0 { LONGEST / far } else { 2.0 };
            // Rounding of the laws.
            let fits = (1.0 - 1e-9..1.0 + 1e-9).contains(&ratio);
            let longer = ratio > 1.0 && !is_first && span >= 2.0 * last;
            if fits || longer {
                return Next::Step { span, far };
            }
            span *= if is_first { ratio.clamp(0.1, 1e3) } else { ratio.clamp(0.1, 2.0) };
            if !is_first && ratio > 1.0 {
                span = span.min(2.0 * last);
            }
        }
        if rests {
            return Next::Rest;
        }
        match self.moved(t, span) {
            Some(far) if far > 0.0 && far <= 1.5 * LONGEST => Next::Step { span, far },
            _ => self.between(t, last),
        }
    }

    /// The same by halving, for laws like `t^3`: in these a part of the step is made in a far larger part of the time, which the
    /// search by proportion leaps over.
    fn between(&self, t: f64, last: f64) -> Next {
        let is_short = |span: f64| self.moved(t, span).is_some_and(|far| far <= LONGEST);
        let (mut low, mut high) = (last, last);
        for _ in 0..RESTING {
            match (is_short(low), is_short(high)) {
                (false, _) => (low, high) = (0.1 * low, low),
                (true, true) => (low, high) = (high, 10.0 * high),
                (true, false) => break,
            }
        }
        for _ in 0..HALVINGS {
            let middle = (low * high).sqrt();
            if is_short(middle) { low = middle } else { high = middle }
        }
        match self.moved(t, low) {
            Some(far) if (LEAST * LONGEST..=LONGEST).contains(&far) => Next::Step { span: low, far },
            Some(0.0) => Next::Rest,
            _ => Next::Unknown,
        }
    }

    /// How far the fastest driver goes at most in some time from a time on [rad, own units].
    fn moved(&self, t: f64, span: f64) -> Option<f64> {
        let from = self.positions(t)?;
        let mut most = 0.0_f64;
        for part in 1..=WITHIN {
            let to = self.positions(t + span * part as f64 / WITHIN as f64)?;
            let differences = self.drivers.iter().zip(to.iter().zip(&from));
            let own = |driver: &Driver<'_>| self.walker.units.speeds[driver.speed];
            most = differences.fold(most, |most, (driver, (a, b))| most.max((a - b).abs() / own(driver)));
        }
        most.is_finite().then_some(most)
    }

    fn positions(&self, t: f64) -> Option<Vec<f64>> {
        self.drivers.iter().map(|driver| self.position(driver, t).filter(|at| at.is_finite())).collect()
    }

    /// The position at another time, from that of a near waypoint.
    pub fn at(&self, from: &Waypoint, t: f64) -> Option<Waypoint> {
        let (before, after) = (self.positions(from.t)?, self.positions(t)?);
        let driven: Vec<f64> = after.iter().zip(&before).map(|(a, b)| a - b).collect();
        let mut q = from.q.clone();
        let (_, jacobian) = self.walker.equations(&q);
        self.walker.layout.advance(&mut q, &self.following(&jacobian, &driven)?);
        Some(Waypoint { t, q: self.close(q)? })
    }

    /// The position a step of time after another one, if loops close halfway, too: drivers that turn round in between may come back from
    /// where loops cannot follow. That is seen from beyond, as a fold between both hides it from before.
    fn over(&self, from: &Waypoint, t: f64, step: f64) -> Option<Waypoint> {
        let next = self.at(from, t + step)?;
        self.at(&next, t + 0.5 * step).map(|_| next)
    }

    /// The same to rounding.
    pub fn exactly_at(&self, from: &Waypoint, t: f64) -> Option<Waypoint> {
        let mut waypoint = self.at(from, t)?;
        let (residual, jacobian) = self.walker.equations(&waypoint.q);
        self.correct(&mut waypoint.q, &jacobian, &residual)?;
        Some(waypoint)
    }

    /// All speeds at a waypoint, SI.
    pub fn speeds(&self, waypoint: &Waypoint) -> Option<Vec<f64>> {
        let (_, jacobian) = self.walker.equations(&waypoint.q);
        let (after, before) = (self.positions(waypoint.t + FIRST)?, self.positions(waypoint.t - FIRST)?);
        let rates: Vec<f64> = after.iter().zip(&before).map(|(a, b)| (a - b) / (2.0 * FIRST)).collect();
        self.following(&jacobian, &rates)
    }

    /// The Jacobian of the loops by the speeds that no driver has, in own units.
    pub fn loops(&self, waypoint: &Waypoint) -> SparseRows {
        self.walker.equations(&waypoint.q).1.select_columns(&self.free)
    }

    /// All speeds when the drivers have these, SI.
    fn following(&self, jacobian: &SparseRows, driven: &[f64]) -> Option<Vec<f64>> {
        let units = &self.walker.units.speeds;
        let mut moved = DVector::zeros(jacobian.ncols());
        for (driver, amount) in self.drivers.iter().zip(driven) {
            moved[driver.speed] += amount / units[driver.speed];
        }
        let opened = jacobian.times(&moved);
        let mut all = self.closing(jacobian, &opened)?;
        for (driver, amount) in self.drivers.iter().zip(driven) {
            all[driver.speed] = *amount;
        }
        Some(all)
    }

    /// The shortest motion of the free speeds that takes a residual away.
    fn closing(&self, jacobian: &SparseRows, residual: &DVector<f64>) -> Option<Vec<f64>> {
        let step = least_norm(&jacobian.select_columns(&self.free), residual)?;
        let units = &self.walker.units.speeds;
        let mut all = vec![0.0; units.len()];
        for (speed, amount) in self.free.iter().zip(step.iter()) {
            all[*speed] = -amount * units[*speed];
        }
        Some(all)
    }

    fn correct(&self, q: &mut [f64], jacobian: &SparseRows, residual: &DVector<f64>) -> Option<()> {
        self.walker.layout.advance(q, &self.closing(jacobian, residual)?);
        Some(())
    }

    fn close(&self, mut q: Vec<f64>) -> Option<Vec<f64>> {
        for _ in 0..ITERATIONS {
            let (residual, jacobian) = self.walker.equations(&q);
            if residual.amax() < CLOSED_AT_START {
                return Some(q);
            }
            self.correct(&mut q, &jacobian, &residual)?;
        }
        None
    }
}
