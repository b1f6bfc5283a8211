//! Generic rank of the constraint rows, a well-conditioned independent subset, drivers in conflict.
//! In: Jacobians at closed positions. Out: which rows to keep. Never knows joints.

use std::cell::OnceCell;

use linkwear_runtime::linear::{Entries, add_products, length, subtract};

use crate::sparse_rows::SparseRows;

use super::samples::ClosedPositions;
use super::subspace::{RANK_TOLERANCE, Strength, rank, singular_values, strength};

/// A start is singular below this share of the rank's weakest direction elsewhere. At a double root assembly ends within
/// the square root of rounding, 1e-8; up to 1e-5 rad beside it a step of usual length goes wrong by tenths of a radian
/// while its energy is off by a part in a thousand only; and a drawing of four digits is 1e-4 away.
const SINGULAR: f64 = 1e-4;

/// What is left of the rows of a position without the directions of those that are kept.
struct Rests {
    rows: Vec<Entries>,
    lengths: Vec<f64>,
    /// By speed, the rows that have or had an entry there.
    at_speed: Vec<Vec<usize>>,
    work: Entries,
}

impl Rests {
    fn new(all: &SparseRows, chosen: &[usize]) -> Self {
        let rows: Vec<Entries> = chosen.iter().map(|row| all.row(*row).to_vec()).collect();
        let mut at_speed = vec![Vec::new(); all.ncols()];
        for (at, row) in rows.iter().enumerate() {
            row.iter().for_each(|(speed, _)| at_speed[*speed].push(at));
        }
        let lengths = rows.iter().map(|row| length(row)).collect();
        Self { rows, lengths, at_speed, work: Vec::new() }
    }

    /// Takes the direction of a row out of all. Few rows have a speed in common with it. Out: those that it changed.
    fn take_out(&mut self, kept: usize) -> Vec<usize> {
        let whole = std::mem::take(&mut self.lengths[kept]);
        // Rounding is all that would be left of it.
        let mut direction = std::mem::take(&mut self.rows[kept]);
        direction.iter_mut().for_each(|(_, entry)| *entry /= whole);
        let mut near: Vec<usize> =
            direction.iter().flat_map(|(speed, _)| &self.at_speed[*speed]).copied().collect();
        near.sort_unstable();
        near.dedup();
        let mut changed = vec![kept];
        for at in near {
            let row = &mut self.rows[at];
            let along = add_products(0.0, &direction, row);
            if along != 0.0 {
                subtract(row, (along, &direction), &mut self.work, |speed| self.at_speed[speed].push(at));
                self.lengths[at] = length(row);
                changed.push(at);
            }
        }
        changed
    }
}

/// Normalised rows at every position tried.
pub struct Rows {
    samples: Vec<SparseRows>,
    driven: Vec<usize>,
    strengths: OnceCell<Vec<Strength>>,
}

impl Rows {
    /// Scales every row to its largest length over all positions, so that rad and m compare.
    pub fn new(positions: &ClosedPositions, driven: Vec<usize>) -> Self {
        let m = positions.positions.first().map_or(0, |position| position.jacobian.nrows());
        let jacobians = || positions.positions.iter().map(|position| &position.jacobian);
        let length = |row: usize| jacobians().map(|jacobian| jacobian.length(row)).fold(0.0, f64::max);
        let lengths: Vec<f64> = (0..m).map(length).collect();
        let longest = lengths.iter().copied().fold(0.0, f64::max);
        // A row of rounding errors says nothing; scaled up it would look like any other.
        let scale = |length: &f64| if *length > RANK_TOLERANCE * longest { 1.0 / length } else { 0.0 };
        let scales: Vec<f64> = lengths.iter().map(scale).collect();
        let samples = jacobians().map(|jacobian| jacobian.clone().scaled(|row, _| scales[row])).collect();
        Self { samples, driven, strengths: OnceCell::new() }
    }

    /// The rows by some speeds only.
    pub fn of_speeds(positions: &ClosedPositions, speeds: &[usize]) -> Self {
        let mut chosen = Self::new(positions, Vec::new());
        for sample in &mut chosen.samples {
            *sample = sample.select_columns(speeds);
        }
        chosen
    }

    fn strengths(&self) -> &[Strength] {
        self.strengths.get_or_init(|| self.samples.iter().map(strength).collect())
    }

    /// Generic rank.
    pub fn rank(&self) -> usize {
        self.strengths().iter().map(|strength| strength.rank).max().unwrap_or(0)
    }

    /// How many combinations of rows no motion changes in any position: the same ones everywhere.
    pub fn unmoved(&self) -> usize {
        let Some(first) = self.samples.first() else { return 0 };
        // Of all positions side by side.
        let motions = self.samples.iter().map(SparseRows::transpose);
        let all = motions.reduce(|above, below| above.stack(&below));
        first.nrows() - all.map_or(0, |all| rank(&all))
    }

    /// Greedy choice: the row that adds most to those kept, judged where it adds least among the positions of
    /// full rank; so the kept rows stay independent along the motion.
    pub fn independent(&self) -> Vec<bool> {
        let m = self.samples.first().map_or(0, SparseRows::nrows);
        let generic = self.generic_samples();
        // Rows of zeros, which planar mechanisms have many of, are never kept.
        let rows: Vec<usize> =
            (0..m).filter(|row| generic.iter().any(|at| !self.samples[*at].row(*row).is_empty())).collect();
        let mut rests: Vec<Rests> = generic.iter().map(|at| Rests::new(&self.samples[*at], &rows)).collect();
        let mut keep = vec![false; m];
        let gain = |rests: &[Rests], at: usize| {
            rests.iter().map(|rest| rest.lengths[at]).fold(f64::INFINITY, f64::min)
        };
        let mut gains: Vec<f64> = (0..rows.len()).map(|at| gain(&rests, at)).collect();
        loop {
            // Rows within a tenth of the best count as equal: the first in the file's order wins.
            let best = gains.iter().copied().fold(0.0, f64::max);
            let next = match gains.iter().position(|gain| *gain > 0.9 * best) {
                Some(next) if best > RANK_TOLERANCE => next,
                _ => return keep,
            };
            keep[rows[next]] = true;
            let changed: Vec<usize> = rests.iter_mut().flat_map(|rest| rest.take_out(next)).collect();
            for at in changed {
                gains[at] = if keep[rows[at]] { 0.0 } else { gain(&rests, at) };
            }
        }
    }

    /// Positions where the rank is highest.
    fn generic_samples(&self) -> Vec<usize> {
        let (strengths, highest) = (self.strengths(), self.rank());
        (0..strengths.len()).filter(|at| strengths[*at].rank == highest).collect()
    }

    /// What the start lacks of the rank that other positions have: that of the rows, or of the rows together with what
    /// moves each of these speeds.
    pub fn lost_at_start(&self, held: &[usize]) -> Option<Lost> {
        if singular_start(&self.samples, self.strengths()) {
            return Some(Lost::Rows);
        }
        let alone = |speed: usize| {
            let with: Vec<_> = self.samples.iter().map(|sample| with_speeds(sample, &[speed])).collect();
            singular_start(&with, &with.iter().map(strength).collect::<Vec<_>>())
        };
        let lost: Vec<usize> = (0..held.len()).filter(|at| alone(held[*at])).collect();
        (!lost.is_empty()).then_some(Lost::Held(lost))
    }

    /// Groups of drivers that the loops couple, each as small as one driver that breaks independence together
    /// with those it depends on.
    pub fn driver_conflicts(&self) -> Vec<Vec<usize>> {
        if self.driven.is_empty() {
            return Vec::new();
        }
        // A driver at its dead point is coupled with nothing elsewhere.
        let with_drivers = |at: &usize| rank(&with_speeds(&self.samples[*at], &self.driven));
        let best = self.generic_samples().into_iter().rev().max_by_key(with_drivers);
        let Some(at) = best else { return Vec::new() };
        let mut rows = self.samples[at].clone();
        let mut taken: Vec<usize> = Vec::new();
        let mut conflicts = Vec::new();
        for (driver, speed) in self.driven.iter().enumerate() {
            let before = rank(&rows);
            let with = with_speeds(&rows, &[*speed]);
            if rank(&with) > before {
                rows = with;
                taken.push(driver);
                continue;
            }
            let mut group: Vec<usize> =
                taken.iter().copied().filter(|other| self.coupled(at, &taken, *other, *speed)).collect();
            group.push(driver);
            conflicts.push(group);
        }
        conflicts
    }

    /// Whether releasing driver `other` frees the speed again.
    fn coupled(&self, at: usize, taken: &[usize], other: usize, speed: usize) -> bool {
        let held: Vec<usize> =
            taken.iter().copied().filter(|d| *d != other).map(|d| self.driven[d]).collect();
        let rows = with_speeds(&self.samples[at], &held);
        rank(&with_speeds(&rows, &[speed])) > rank(&rows)
    }
}

/// What a singular start lacks.
#[derive(Clone, Debug, PartialEq)]
pub enum Lost {
    /// Rank of the rows.
    Rows,
    /// These of the held speeds, by index, move nothing there.
    Held(Vec<usize>),
}

/// Whether the first of the matrices has a lower rank than others. Their weakest direction is compared, because
/// what is weak everywhere is no singular position.
fn singular_start(samples: &[SparseRows], strengths: &[Strength]) -> bool {
    let rank = strengths.iter().map(|strength| strength.rank).max().unwrap_or(0);
    if rank == 0 {
        return false;
    }
    if clearly_regular(strengths, rank) {
        return false;
    }
    let weakest = |matrix: &SparseRows| singular_values(matrix)[rank - 1];
    let best = samples.iter().map(weakest).fold(0.0, f64::max);
    weakest(&samples[0]) < SINGULAR * best
}

/// Whether bounds of the weakest directions tell that the first is none of a singular position. Where the rank is lower,
/// the direction in question is none.
fn clearly_regular(strengths: &[Strength], rank: usize) -> bool {
    let mut full = strengths.iter().filter(|strength| strength.rank == rank);
    let best = full.try_fold(0.0_f64, |best, strength| Some(best.max(strength.weakest?.1)));
    let (Some(first), Some(best)) = (strengths.first(), best) else { return false };
    first.rank == rank && first.weakest.is_some_and(|(least, _)| least > SINGULAR * best)
}

/// With a row for each of the speeds, that this one moves.
fn with_speeds(rows: &SparseRows, speeds: &[usize]) -> SparseRows {
    rows.stack(&SparseRows::units(rows.ncols(), speeds))
}

#[cfg(test)]
mod tests {
    use nalgebra::DVector;

    use super::super::samples::Position;
    use super::*;

    #[test]
    fn a_row_of_rounding_errors_is_dropped() {
        let sample = |noise: f64| SparseRows::from_entries(2, &[1.0, 2.0, noise, 3.0 * noise]);
        let positions =
            [1e-16, -2e-16].map(|noise| Position::new(Vec::new(), DVector::zeros(2), sample(noise)));
        let rows = Rows::new(
            &ClosedPositions { positions: positions.to_vec(), arm: 1.0, open: Vec::new() },
            vec![1],
        );
        assert_eq!(rows.independent(), [true, false]);
        assert!(rows.driver_conflicts().is_empty());
    }

    #[test]
    fn a_row_that_repeats_another_is_dropped_and_the_first_kept() {
        let sample = SparseRows::from_entries(3, &[1.0, 2.0, 0.0, 2.0, 4.0, 0.0, 0.0, 0.0, 1.0]);
        let rows = Rows { samples: vec![sample], driven: vec![2], strengths: OnceCell::new() };
        assert_eq!(rows.independent().iter().filter(|kept| **kept).count(), 2);
        // The third speed is held by the third row: driving it is a conflict of one.
        assert_eq!(rows.driver_conflicts(), vec![vec![0]]);
    }
}
