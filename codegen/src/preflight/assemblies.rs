//! Other ways to put a mechanism together: closed positions on other branches, with the drivers where they start.
//! In: the mechanism as it runs. Out: the start's joint coordinates and those of other branches. Finds some, claims no
//! completeness.

use std::f64::consts::{PI, TAU};

use linkwear_runtime::{
    Description, Evaluator, Motion, Sizes, System, assemble_with, close_loops, rows_of_free_offsets,
};

use crate::sparse_rows::SparseRows;

use super::case::Case;
use super::plausible::with_unit;
use super::samples::{ClosedPositions, random};
use super::subspace::rank;

/// Speeds of the largest mechanism that is tried: an attempt to assemble then takes a millisecond.
const LARGEST: usize = 30;
/// Starts tried: of a four-bar about half of them lead to the other branch.
const TRIES: usize = 16;
/// Other branches told, at most.
const MOST: usize = 3;
/// Positions nearer than this [rad, longest lever arms] are one.
const SAME: f64 = 0.02;
/// Angles are told to a tenth of a degree, lengths to a thousandth of the longest lever arm.
const TOLD_ANGLE: f64 = PI / 1800.0;
const TOLD_LENGTH: f64 = 1e-3;

/// A joint coordinate.
#[derive(Clone, Debug, PartialEq)]
pub struct Coordinate {
    /// The joint.
    pub joint: String,
    /// `q`, or `q1`, `q2` of several.
    pub name: String,
    /// Its value [rad or m], rounded so that assembly still finds the branch from it.
    pub value: f64,
    /// True for an angle, false for a length.
    pub angular: bool,
}

/// What `[assembly]` says for a way to close the loops: `R2 = "55.8 deg", C = { q1 = "10 deg", q2 = "0.1 m" }`.
pub fn as_guesses(way: &[Coordinate]) -> String {
    let value = |at: &Coordinate| match at.angular {
        true => format!("\"{:.1} deg\"", at.value.to_degrees() + 0.0),
        false => format!("\"{}\"", with_unit(at.value, "m")),
    };
    let joints = way.chunk_by(|a, b| a.joint == b.joint).map(|joint| match joint {
        [only] if only.name == "q" => format!("{} = {}", only.joint, value(only)),
        several => {
            let pairs: Vec<_> = several.iter().map(|at| format!("{} = {}", at.name, value(at))).collect();
            format!("{} = {{ {} }}", several[0].joint, pairs.join(", "))
        }
    });
    joints.collect::<Vec<_>>().join(", ")
}

/// How the loops close at the start.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Assemblies {
    /// Where assembly put the joints that neither drivers nor the file hold.
    pub taken: Vec<Coordinate>,
    /// The same of other branches that were found; as guesses in `[assembly]` they lead there.
    pub others: Vec<Vec<Coordinate>>,
}

/// Whether a mechanism of this size is tried.
pub fn are_looked_for(sizes: Sizes) -> bool {
    sizes.all_rows > 0 && sizes.all_speeds <= LARGEST
}

/// Looks for other branches; nothing for a mechanism without loops, too large, or whose start has none to choose.
pub fn assemblies(description: &Description, system: &dyn System<f64>) -> Assemblies {
    let parameters: Vec<f64> = description.parameters.iter().map(|parameter| parameter.default).collect();
    if !are_looked_for(system.sizes()) {
        return Assemblies::default();
    }
    let search = Evaluator::new(system, description, &parameters).ok().and_then(Search::new);
    search.map(|mut search| search.run()).unwrap_or_default()
}

struct Search<'a> {
    evaluator: Evaluator<'a>,
    start: Vec<f64>,
    arm: f64,
    /// Coordinates that stay where they start: drivers are no coordinates, so these are modes, play and further freedoms.
    held: Vec<bool>,
    /// Speeds that these hold.
    rest: Vec<usize>,
    /// Rank of the loops with them.
    rank: usize,
    /// Coordinates that choose the branch, and whether they are angles.
    asked: Vec<(usize, bool)>,
}

impl<'a> Search<'a> {
    fn new(mut evaluator: Evaluator<'a>) -> Option<Self> {
        let state = assemble_with(&mut evaluator, 0.0).ok()?;
        let arm = evaluator.longest_arm(0.0, &state.q, &state.v);
        let description = evaluator.description();
        let coordinates = &description.coordinates;
        let scalars: Vec<(usize, usize)> = evaluator
            .layout()
            .free()
            .filter(|group| matches!(group.motion, Motion::Scalar { .. }))
            .map(|group| (group.coordinate, group.speed))
            .collect();
        let of_joint = |at: usize| is_of_joint(description, at);
        let mut held: Vec<bool> = coordinates.iter().map(|info| info.held).collect();
        let loops = loops(&mut evaluator, &state.q);
        let mut rest = Vec::new();
        let mut hold = |speed: usize| {
            let before = rank(&with_rest(&loops, &rest));
            rest.push(speed);
            let more = rank(&with_rest(&loops, &rest)) > before;
            if !more {
                rest.pop();
            }
            more
        };
        for (at, speed) in &scalars {
            if !of_joint(*at) {
                held[*at] = true;
                hold(*speed);
            }
        }
        // Freedoms that no driver holds would let every branch drift: as many joints as there are of them stay.
        for (at, speed) in &scalars {
            held[*at] |= of_joint(*at) && hold(*speed);
        }
        let asked: Vec<_> = scalars
            .iter()
            .filter(|(at, _)| of_joint(*at) && !held[*at])
            .map(|(at, _)| (*at, coordinates[*at].unit == "rad"))
            .collect();
        let rank = rank(&with_rest(&loops, &rest));
        (!asked.is_empty()).then_some(Self { start: state.q, arm, held, rest, rank, asked, evaluator })
    }

    fn run(&mut self) -> Assemblies {
        let mut found: Vec<Vec<f64>> = Vec::new();
        let mut generator = 0x9E37_79B9_7F4A_7C15_u64;
        for attempt in 0..TRIES {
            let guess = self.guess(attempt, &mut generator);
            let Ok(q) = close_loops(&mut self.evaluator, 0.0, &guess, &self.held) else { continue };
            let known = found.iter().chain([&self.start]).any(|other| self.distance(&q, other) < SAME);
            if !known && self.is_isolated(&q) && self.leads_to(&q) {
                found.push(q);
            }
            if found.len() == MOST {
                break;
            }
        }
        Assemblies { taken: self.told(&self.start), others: found.iter().map(|q| self.told(q)).collect() }
    }

    /// Somewhere else: all joints anywhere; balls too, every other time.
    fn guess(&self, attempt: usize, generator: &mut u64) -> Vec<f64> {
        let mut step = vec![0.0; self.evaluator.sizes().speeds];
        for group in self.evaluator.layout().free() {
            match group.motion {
                Motion::Scalar { .. } => {
                    if let Some((_, angular)) = self.asked.iter().find(|(at, _)| *at == group.coordinate) {
                        step[group.speed] = random(generator) * if *angular { PI } else { self.arm };
                    }
                }
                Motion::Rotation if attempt % 2 == 1 => {
                    (0..3).for_each(|axis| step[group.speed + axis] = 0.5 * PI * random(generator));
                }
                Motion::Rotation | Motion::Pose => {}
            }
        }
        let mut guess = self.start.clone();
        self.evaluator.layout().advance(&mut guess, &step);
        guess
    }

    /// Whether the loops hold the mechanism there as at the start: what can drift is no branch of its own.
    fn is_isolated(&mut self, q: &[f64]) -> bool {
        rank(&with_rest(&loops(&mut self.evaluator, q), &self.rest)) >= self.rank
    }

    /// Whether assembly goes there from the values that are told.
    fn leads_to(&mut self, q: &[f64]) -> bool {
        let mut guess = self.evaluator.start(0.0).0.to_vec();
        self.evaluator.layout().normalize(&mut guess);
        self.asked.iter().for_each(|(at, angular)| guess[*at] = self.rounded(q[*at], *angular));
        let description = self.evaluator.description();
        let held: Vec<bool> = description.coordinates.iter().map(|info| info.held).collect();
        let reached = close_loops(&mut self.evaluator, 0.0, &guess, &held);
        reached.is_ok_and(|reached| self.distance(&reached, q) < self.distance(&reached, &self.start))
    }

    fn distance(&self, a: &[f64], b: &[f64]) -> f64 {
        let apart = |at: usize| a[at] - b[at];
        let apart = self.asked.iter().map(|(at, angular)| {
            if *angular {
                (apart(*at) - TAU * (apart(*at) / TAU).round()).abs()
            } else {
                apart(*at).abs() / self.arm
            }
        });
        apart.fold(0.0, f64::max)
    }

    fn rounded(&self, value: f64, angular: bool) -> f64 {
        rounded(value, angular, self.arm)
    }

    fn told(&self, q: &[f64]) -> Vec<Coordinate> {
        told(self.evaluator.description(), &self.asked, (q, self.arm))
    }
}

/// Guesses from which the loops close where drivers and the file hold the start, if those of the file do not lead there: found
/// from positions that the loops let the mechanism take.
pub fn guesses_that_close(case: &Case<'_>, positions: &ClosedPositions) -> Option<Vec<Coordinate>> {
    if !are_looked_for(case.system.sizes()) {
        return None;
    }
    let mut evaluator = Evaluator::new(case.system, case.description, &case.parameters()).ok()?;
    let mut start = evaluator.start(0.0).0.to_vec();
    let layout = evaluator.layout().clone();
    layout.normalize(&mut start);
    let coordinates = &case.description.coordinates;
    let held: Vec<bool> = coordinates.iter().map(|info| info.held).collect();
    let scalars = layout.free().filter(|group| matches!(group.motion, Motion::Scalar { .. }));
    let asked: Vec<_> = scalars
        .map(|group| group.coordinate)
        .filter(|at| !held[*at] && is_of_joint(case.description, *at))
        .map(|at| (at, coordinates[at].unit == "rad"))
        .collect();
    positions.positions.iter().find_map(|position| {
        let mut guess = start.clone();
        let free = (0..guess.len()).filter(|at| !held[*at]);
        free.for_each(|at| guess[at] = position.q[at]);
        let q = close_loops(&mut evaluator, 0.0, &guess, &held).ok()?;
        let mut guess = start.clone();
        asked.iter().for_each(|(at, angular)| guess[*at] = rounded(q[*at], *angular, positions.arm));
        close_loops(&mut evaluator, 0.0, &guess, &held).ok()?;
        Some(told(case.description, &asked, (&q, positions.arm)))
    })
}

/// Whether a coordinate is one of a joint, no play of it and no mode.
fn is_of_joint(description: &Description, at: usize) -> bool {
    description.coordinates[at].name.rsplit('.').next().unwrap_or_default().starts_with('q')
}

fn rounded(value: f64, angular: bool, arm: f64) -> f64 {
    let unit = if angular { TOLD_ANGLE } else { TOLD_LENGTH * arm };
    let value = if angular { value - TAU * (value / TAU).round() } else { value };
    (value / unit).round() * unit
}

fn told(description: &Description, asked: &[(usize, bool)], (q, arm): (&[f64], f64)) -> Vec<Coordinate> {
    let coordinate = |(at, angular): &(usize, bool)| {
        let full = description.coordinates[*at].name.to_string();
        let (joint, name) = full.rsplit_once('.').unwrap_or((&full, "q"));
        let value = rounded(q[*at], *angular, arm);
        Coordinate { joint: joint.to_owned(), name: name.to_owned(), value, angular: *angular }
    };
    asked.iter().map(coordinate).collect()
}

/// The rows of the loops at a position, those of joints with clearance as if they had none.
fn loops(evaluator: &mut Evaluator<'_>, q: &[f64]) -> SparseRows {
    let n = evaluator.sizes().speeds;
    let mut jacobian = rows_of_free_offsets(evaluator, 0.0, q);
    jacobian.extend(evaluator.closure(0.0, q, &vec![0.0; n]).jacobian);
    SparseRows::from_entries(n, &jacobian)
}

/// The rows of the loops, and below them one for every speed that rests.
fn with_rest(loops: &SparseRows, rest: &[usize]) -> SparseRows {
    loops.stack(&SparseRows::units(loops.ncols(), rest))
}
