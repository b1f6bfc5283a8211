//! How well loops close, and how long the rows of their Jacobian are. In: states. Out: [`Closure`], scales of rows.

use super::{Closure, Evaluator};
use crate::row_scales::{note_lengths, scale_rows};
use crate::system::Entry;

impl Evaluator<'_> {
    /// Residuals of the loops and their Jacobian.
    pub fn closure(&mut self, t: f64, q: &[f64], v: &[f64]) -> Closure<'_> {
        self.questions.ask(Entry::Closure, t, &[q, v]);
        self.note_row_lengths();
        self.last_closure()
    }

    /// Factors that make the kept rows of the Jacobian at most about as long as one, so that metres and
    /// radians count alike when rank is judged. They follow the longest each row has been: a row that
    /// vanishes at a singular position must not be blown up.
    pub fn row_scales(&self) -> &[f64] {
        &self.row_scales
    }

    /// Passes all numbers that an answer can depend on besides its question, to be read or written.
    pub(crate) fn visit_memory(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        self.row_lengths.iter_mut().chain(&mut self.row_scales).for_each(visit);
    }

    /// Longest length that each kept row of the Jacobian has had.
    pub(crate) fn row_lengths(&self) -> &[f64] {
        &self.row_lengths
    }

    /// Takes over the Jacobian of a state that was evaluated elsewhere.
    pub(crate) fn take_over_rows(&mut self, jacobian: impl Iterator<Item = f64>) {
        let first = self.sizes.all_rows + self.sizes.rows;
        let places = &mut self.questions.last_mut(Entry::Closure)[first..];
        places.iter_mut().zip(jacobian).for_each(|(place, value)| *place = value);
        self.note_row_lengths();
    }

    fn note_row_lengths(&mut self) {
        let n = self.sizes.speeds;
        let first = self.sizes.all_rows + self.sizes.rows;
        let jacobian = &self.questions.last(Entry::Closure)[first..];
        if note_lengths(&mut self.row_lengths, jacobian, n) {
            let rows = &self.description.rows;
            let kinds = self.kept.iter().enumerate().map(|(kept, row)| (kept, rows[*row].angular));
            scale_rows(&mut self.row_scales, &self.row_lengths, kinds);
        }
    }

    /// The last answer of [`Self::closure`].
    pub fn last_closure(&self) -> Closure<'_> {
        let (positions, rest) = self.questions.last(Entry::Closure).split_at(self.sizes.all_rows);
        let (speeds, jacobian) = rest.split_at(self.sizes.rows);
        Closure { positions, speeds, jacobian }
    }
}
