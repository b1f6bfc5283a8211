//! The linear system that every stage of a Rosenbrock method solves: `(1 / (gamma h) - J) k = b`, where `J` has the derivatives of the
//! slopes by the state. In: a problem and where a step begins. Out: solutions. Never knows the method.
//!
//! Plain integrals, which no slope depends on, follow from the others. So does a component whose slope is another component, as a
//! coordinate follows from its speed: the matrix that is factored has the rest alone.

use core::ops::Range;

use super::adaptive::Step;
use super::problem::{Beside, Problem};
use crate::error::RunError;
use crate::linear::{Lu, add_scaled, dot};

/// Widths of the difference quotients beside natural sizes: rounding and curvature both leave some 1e-8 of a derivative.
const DIFFERENCE: f64 = 1e-7;

/// A component whose slope is another component.
#[derive(Clone, Copy, Debug)]
struct Follower {
    component: usize,
    /// The place of that other one in the matrix.
    of: usize,
}

/// Matrix and storage.
#[derive(Clone, Debug, Default)]
pub(super) struct StageSystem {
    /// Where the step begins that the derivatives are for.
    known_at: Option<f64>,
    /// What each deciding component is in the state beside the begin that differs in it, and storage for such a state.
    others: Vec<f64>,
    state: Vec<f64>,
    /// Slopes in those states, and then a little later; derivatives after that.
    slopes: Vec<f64>,
    followers: Vec<Follower>,
    /// The components that the matrix is of: one by one, and in runs of neighbours.
    rest: Vec<usize>,
    runs: Vec<Range<usize>>,
    dimension: usize,
    /// `gamma h`.
    scale: f64,
    /// Derivatives of the rest's slopes by every follower, and of the integrals' slopes by every component.
    by_followers: Vec<f64>,
    of_integrals: Vec<f64>,
    lu: Option<Lu>,
    right: Vec<f64>,
}

impl StageSystem {
    /// The derivatives are those of another step.
    pub(super) fn forget(&mut self) {
        self.known_at = None;
    }

    /// Derivatives of the slopes where a step begins, `slope` there; not again for a shorter one.
    pub(super) fn linearise(
        &mut self,
        problem: &mut dyn Problem,
        step: Step<'_>,
        slope: &[f64],
    ) -> Result<(), RunError> {
        if self.known_at == Some(step.t) {
            return Ok(());
        }
        if self.lu.is_none() {
            self.prepare(problem, step.y.len());
        }
        let all = self.dimension;
        let deciding = self.others.len();
        for (place, (other, value)) in self.others.iter_mut().zip(step.y).enumerate() {
            *other = value + DIFFERENCE * value.abs().max(problem.scale(place));
        }
        // Of a step however short the time is another one.
        let later = step.t + (DIFFERENCE * step.length).max(4.0 * f64::EPSILON * step.t.abs());
        let beside = Beside { t: step.t, y: step.y, others: &self.others, later };
        problem.derivatives(&beside, &mut self.state, &mut self.slopes)?;
        // What the widths are after rounding.
        let widths = self.others.iter().zip(step.y).map(|(other, value)| other - value);
        let widths = widths.chain([later - step.t]);
        for (column, width) in self.slopes.chunks_exact_mut(all).zip(widths) {
            let per_width = 1.0 / width;
            column.iter_mut().zip(slope).for_each(|(value, slope)| *value = (*value - slope) * per_width);
        }
        self.of_integrals.clear();
        for integral in deciding..all {
            let columns = self.slopes.chunks_exact(all).take(deciding);
            self.of_integrals.extend(columns.map(|column| column[integral]));
        }
        self.by_followers.clear();
        for follower in &self.followers {
            let column = &self.slopes[follower.component * all..][..all];
            self.runs.iter().for_each(|run| self.by_followers.extend_from_slice(&column[run.clone()]));
        }
        self.known_at = Some(step.t);
        Ok(())
    }

    fn prepare(&mut self, problem: &dyn Problem, dimension: usize) {
        let deciding = problem.deciding(dimension);
        // One that follows a follower stays in the matrix.
        let followed = |component| problem.follows(component).filter(|of| problem.follows(*of).is_none());
        let followed: Vec<Option<usize>> = (0..deciding).map(followed).collect();
        self.rest = (0..deciding).filter(|component| followed[*component].is_none()).collect();
        self.runs =
            self.rest.chunk_by(|a, b| a + 1 == *b).map(|run| run[0]..run[run.len() - 1] + 1).collect();
        let place = |of: usize| self.rest.iter().position(|component| *component == of);
        let followers = followed
            .iter()
            .enumerate()
            .filter_map(|(component, of)| Some(Follower { component, of: place((*of)?)? }));
        self.followers = followers.collect();
        let size = self.rest.len();
        self.dimension = dimension;
        self.others = vec![0.0; deciding];
        self.state = vec![0.0; dimension];
        self.slopes = vec![0.0; (deciding + 1) * dimension];
        self.right = vec![0.0; size];
        self.lu = Some(Lu::new(size));
    }

    /// Factors the matrix for a step: `gamma h`.
    pub(super) fn factor(&mut self, scale: f64) {
        let (all, size) = (self.dimension, self.rest.len());
        self.scale = scale;
        let per_scale = 1.0 / scale;
        let Some(lu) = &mut self.lu else { return };
        lu.factor_columns(|j, column| {
            let slopes = &self.slopes[self.rest[j] * all..][..all];
            of_runs(&self.runs, column, slopes, |place, slope| *place = -slope);
            column[j] += per_scale;
            let mut by_followers = &self.by_followers[..];
            for follower in &self.followers {
                let (slopes, others) = by_followers.split_at(size);
                by_followers = others;
                if follower.of == j {
                    add_scaled(column, -scale, slopes);
                }
            }
        });
    }

    /// Derivative of the slopes by time.
    pub(super) fn by_time(&self) -> &[f64] {
        &self.slopes[self.others.len() * self.dimension..]
    }

    /// Solves for the right-hand side `b`.
    pub(super) fn solve(&mut self, b: &[f64], solution: &mut [f64]) {
        let (size, deciding) = (self.rest.len(), self.others.len());
        of_runs(&self.runs, &mut self.right, b, |right, b| *right = b);
        if size > 0 {
            for (follower, column) in self.followers.iter().zip(self.by_followers.chunks_exact(size)) {
                add_scaled(&mut self.right, self.scale * b[follower.component], column);
            }
        }
        if let Some(lu) = &mut self.lu {
            lu.solve(&mut self.right);
        }
        let mut solved = &self.right[..];
        for run in &self.runs {
            let (run_solved, others) = solved.split_at(run.len());
            solution[run.clone()].copy_from_slice(run_solved);
            solved = others;
        }
        for Follower { component, of } in &self.followers {
            solution[*component] = self.scale * (b[*component] + self.right[*of]);
        }
        let (state, integrals) = solution.split_at_mut(deciding);
        let rows = self.of_integrals.chunks_exact(deciding.max(1));
        for ((integral, row), b) in integrals.iter_mut().zip(rows).zip(&b[deciding..]) {
            *integral = self.scale * (b + dot(row, state));
        }
    }
}

/// What is done with every number and with that of all components which belongs to it: those of runs, one behind the other.
#[inline(always)]
fn of_runs(runs: &[Range<usize>], mut numbers: &mut [f64], all: &[f64], write: impl Fn(&mut f64, f64)) {
    for run in runs {
        let (of_run, others) = numbers.split_at_mut(run.len());
        of_run.iter_mut().zip(&all[run.clone()]).for_each(|(number, value)| write(number, *value));
        numbers = others;
    }
}
