//! What a run gives back: samples with the names of their columns, its cost and quality, turns of contacts.

use super::extremes::{Extremes, Peak};
use super::warning::RunWarning;
use crate::description::Channel;
use crate::error::{NoColumn, RunError};
use crate::wear::ContactMeasure;

/// What a run cost and how well it kept its laws. Covers settling too.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[allow(non_snake_case, reason = "units at the end of a name keep their case")]
pub struct Statistics {
    /// Accepted steps.
    pub steps: u64,
    /// Of these, where a run takes its steps by an explicit method or an implicit one, those by the implicit one.
    pub implicit_steps: u64,
    /// Steps tried and not accepted.
    pub rejected: u64,
    /// Evaluations of the forward dynamics (for generalised-alpha: of the equations of motion).
    pub evaluations: u64,
    /// Projections that had something to correct, at steps and samples.
    pub projections: u64,
    /// Forward dynamics that needed the rank-revealing solve.
    pub rank_revealing_solves: u64,
    /// Newton iterations of an implicit method.
    pub newton_iterations: u64,
    /// Largest loop residual in metres at any step or sample, dropped rows too [m].
    pub max_loop_error_m: f64,
    /// The same of the rows in radians [rad].
    pub max_loop_error_rad: f64,
    /// Largest |E - E0 - supplied + dissipated| at any step or sample [J]; E with the energy stored in contacts,
    /// dissipated with what damping and friction of contacts took.
    pub energy_error_J: f64,
    /// What went through: sum over the steps of |work supplied| + |work dissipated| + |change of kinetic
    /// energy| + |lost in contacts| [J]; the measure for the error.
    pub energy_throughput_J: f64,
}

impl Statistics {
    /// Of a run and the one that went on from its end.
    pub(crate) fn and(&self, later: &Self) -> Self {
        Self {
            steps: self.steps + later.steps,
            implicit_steps: self.implicit_steps + later.implicit_steps,
            rejected: self.rejected + later.rejected,
            evaluations: self.evaluations + later.evaluations,
            projections: self.projections + later.projections,
            rank_revealing_solves: self.rank_revealing_solves + later.rank_revealing_solves,
            newton_iterations: self.newton_iterations + later.newton_iterations,
            max_loop_error_m: self.max_loop_error_m.max(later.max_loop_error_m),
            max_loop_error_rad: self.max_loop_error_rad.max(later.max_loop_error_rad),
            energy_error_J: self.energy_error_J.max(later.energy_error_J),
            energy_throughput_J: self.energy_throughput_J + later.energy_throughput_J,
        }
    }
}

/// A finished run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Run {
    /// Columns of the rows: those of the mechanism, then those of its contacts.
    pub channels: Vec<Channel>,
    /// Times of the samples [s].
    pub times: Vec<f64>,
    /// One row per sample, one value per channel; angles that wrap are unwrapped along time.
    pub rows: Vec<Vec<f64>>,
    /// What every channel went through, by the integrator's steps; rows have no part in it. Of methods of fixed step,
    /// whose steps end on the rows, rows change it as they change the steps.
    pub extremes: Vec<Extremes>,
    /// Peak loads of every joint that has a wrench, by the integrator's steps.
    pub peaks: Vec<Peak>,
    /// Cost and quality.
    pub statistics: Statistics,
    /// For every full turn after settling, what every joint with clearance did in it: by turn, then by joint.
    pub turns: Vec<Vec<ContactMeasure>>,
    /// Where the result is not to be trusted.
    pub warnings: Vec<RunWarning>,
    /// Why the run ended before its time, if it did.
    pub stopped: Option<RunError>,
}

impl Run {
    /// Values of a column at all samples, in its unit.
    ///
    /// # Errors
    /// [`NoColumn`] with the nearest name if there is none of this name.
    pub fn column(&self, name: &str) -> Result<Vec<f64>, NoColumn> {
        let at = self.index(name)?;
        Ok(self.rows.iter().map(|row| row[at]).collect())
    }

    /// Smallest and largest value of a column between the first row and the last, by the integrator's steps.
    ///
    /// # Errors
    /// As [`Self::column`].
    pub fn range(&self, name: &str) -> Result<&Extremes, NoColumn> {
        self.index(name).map(|at| &self.extremes[at])
    }

    /// Values of three columns that end in `x`, `y`, `z` after a stem, as `R1.F` or `A.`, at all samples.
    ///
    /// # Errors
    /// As [`Self::column`].
    pub fn vector(&self, stem: &str) -> Result<Vec<[f64; 3]>, NoColumn> {
        let [x, y, z] = ["x", "y", "z"].map(|axis| self.index(&format!("{stem}{axis}")));
        let (x, y, z) = (x?, y?, z?);
        Ok(self.rows.iter().map(|row| [row[x], row[y], row[z]]).collect())
    }

    /// Place of a column in the rows.
    ///
    /// # Errors
    /// As [`Self::column`].
    pub fn index(&self, name: &str) -> Result<usize, NoColumn> {
        self.channels.iter().position(|channel| channel.name == name).ok_or_else(|| {
            let names = self.channels.iter().map(|channel| channel.name.as_ref());
            let nearest = names.min_by_key(|known| distance(known, name)).map(str::to_owned);
            NoColumn { name: name.to_owned(), nearest }
        })
    }
}

/// Letters to insert, delete or replace to turn one name into another (Levenshtein).
fn distance(a: &str, b: &str) -> usize {
    let mut row: Vec<usize> = (0..=b.chars().count()).collect();
    for (i, letter) in a.chars().enumerate() {
        let mut diagonal = std::mem::replace(&mut row[0], i + 1);
        for (j, other) in b.chars().enumerate() {
            let replaced = diagonal + usize::from(letter != other);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[row.len() - 1]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_found_by_name_and_a_wrong_name_tells_the_nearest() {
        let channel = |name: &'static str| Channel { name: name.into(), unit: "N".into(), wraps: false };
        let channels = ["R1.Fx", "R1.Fy", "R1.Fz"].map(channel).to_vec();
        let run = Run { channels, times: vec![0.0], rows: vec![vec![1.0, 2.0, 3.0]], ..Run::default() };
        assert_eq!(run.column("R1.Fy"), Ok(vec![2.0]));
        assert_eq!(run.vector("R1.F"), Ok(vec![[1.0, 2.0, 3.0]]));
        let error = run.column("R.Fz").unwrap_err();
        assert_eq!(error.to_string(), "the run has no column `R.Fz`; did you mean `R1.Fz`?");
        assert_eq!(distance("kitten", "sitting"), 3);
    }
}
