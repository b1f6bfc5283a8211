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
    /// What each deciding component is in the state beside the begin that differs in it, and storage for such a state and its slopes.
    others: Vec<f64>,
    storage: Vec<f64>,
    /// Reciprocals of the differences, that of the times last; zero to the end of a row.
    per_widths: Vec<f64>,
    /// Of every component a row: its slopes in those states, and then a little later; derivatives after that.
    slopes: Vec<f64>,
    /// The last column of them.
    by_time: Vec<f64>,
    followers: Vec<Follower>,
    /// The components that the matrix is of: one by one, and in runs of neighbours.
    rest: Vec<usize>,
    runs: Vec<Range<usize>>,
    /// `gamma h`.
    scale: f64,
    /// Derivatives of the rest's slopes by every follower.
    by_followers: Vec<f64>,
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
        for (place, (other, value)) in self.others.iter_mut().zip(step.y).enumerate() {
            *other = value + DIFFERENCE * value.abs().max(problem.scale(place));
        }
        // Of a step however short the time is another one.
        let later = step.t + (DIFFERENCE * step.length).max(4.0 * f64::EPSILON * step.t.abs());
        let beside = Beside { t: step.t, y: step.y, others: &self.others, later };
        problem.derivatives(&beside, &mut self.storage, &mut self.slopes)?;
        // What the widths are after rounding.
        let widths = self.others.iter().zip(step.y).map(|(other, value)| other - value);
        let widths = widths.chain([later - step.t]);
        self.per_widths.iter_mut().zip(widths).for_each(|(reciprocal, width)| *reciprocal = 1.0 / width);
        for (row, slope) in self.slopes.chunks_exact_mut(self.per_widths.len()).zip(slope) {
            row.iter_mut().zip(&self.per_widths).for_each(|(value, per)| *value = (*value - slope) * per);
        }
        let rows = || self.slopes.chunks_exact(self.per_widths.len());
        self.by_time.iter_mut().zip(rows()).for_each(|(value, row)| *value = row[self.others.len()]);
        self.by_followers.clear();
        for follower in &self.followers {
            let columns = self.runs.iter().flat_map(|run| rows().skip(run.start).take(run.len()));
            self.by_followers.extend(columns.map(|row| row[follower.component]));
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
        self.others = vec![0.0; deciding];
        self.storage = vec![0.0; 2 * dimension];
        self.per_widths = vec![0.0; Beside::row(deciding)];
        self.slopes = vec![0.0; self.per_widths.len() * dimension];
        self.by_time = vec![0.0; dimension];
        self.right = vec![0.0; size];
        self.lu = Some(Lu::new(size));
    }

    /// Factors the matrix for a step: `gamma h`.
    pub(super) fn factor(&mut self, scale: f64) {
        let (row, size) = (self.per_widths.len(), self.rest.len());
        self.scale = scale;
        let per_scale = 1.0 / scale;
        let Some(lu) = &mut self.lu else { return };
        lu.factor_columns(|j, column| {
            for (place, component) in column.iter_mut().zip(&self.rest) {
                *place = -self.slopes[component * row + self.rest[j]];
            }
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
        &self.by_time
    }

    /// Solves for the right-hand side `b`.
    pub(super) fn solve(&mut self, b: &[f64], solution: &mut [f64]) {
        let (size, deciding) = (self.rest.len(), self.others.len());
        let mut places = &mut self.right[..];
        for run in &self.runs {
            let (of_run, others) = places.split_at_mut(run.len());
            of_run.copy_from_slice(&b[run.clone()]);
            places = others;
        }
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
        let rows = self.slopes.chunks_exact(self.per_widths.len()).skip(deciding);
        for ((integral, row), b) in integrals.iter_mut().zip(rows).zip(&b[deciding..]) {
            *integral = self.scale * (b + dot(&row[..deciding], state));
        }
    }
}
