//! How well loops close, and how long the rows of their Jacobian are. In: states. Out: [`Closure`], scales of rows.

use super::{Closure, Evaluator};
use crate::row_scales::{RowScales, square_of};
use crate::system::Entry;

impl Evaluator<'_> {
    /// Residuals of the loops and their Jacobian.
    pub fn closure(&mut self, t: f64, q: &[f64], v: &[f64]) -> Closure<'_> {
        let closure = self.questions.ask(Entry::Closure, t, &[q, v]);
        let jacobian = &closure[self.sizes.all_rows + self.sizes.rows..];
        self.rows.note_squares(jacobian.chunks_exact(self.sizes.speeds.max(1)).map(square_of));
        self.last_closure()
    }

    /// Factors that make the kept rows of the Jacobian at most about as long as one, so that metres and
    /// radians count alike when rank is judged. They follow the longest each row has been: a row that
    /// vanishes at a singular position must not be blown up.
    pub fn row_scales(&self) -> &[f64] {
        self.rows.scales()
    }

    /// Passes all numbers that an answer can depend on besides its question, to be read or written.
    pub(crate) fn visit_memory(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        self.rows.visit_memory(visit);
    }

    /// What rows are scaled by.
    pub(crate) fn rows(&self) -> &RowScales {
        &self.rows
    }

    /// Takes over the squares of the rows' lengths at a state that was evaluated elsewhere.
    pub(crate) fn take_over_rows(&mut self, squares: impl Iterator<Item = f64>) {
        self.rows.note_squares(squares);
    }

    /// The last answer of [`Self::closure`].
    pub fn last_closure(&self) -> Closure<'_> {
        let (positions, rest) = self.questions.last(Entry::Closure).split_at(self.sizes.all_rows);
        let (speeds, jacobian) = rest.split_at(self.sizes.rows);
        Closure { positions, speeds, jacobian }
    }
}

/// What puts numbers back into the places that a visit shows, one after the other.
pub(crate) fn put_back(numbers: &[f64]) -> impl FnMut(&mut f64) + '_ {
    let mut numbers = numbers.iter();
    move |place| *place = numbers.next().copied().unwrap_or(*place)
}
