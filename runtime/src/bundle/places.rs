//! Where numbers of a step lie in the arena. In: counts. Out: places. Never knows what is done with them.

use std::ops::Range;

use super::{TOTALS, WORKS};
use crate::flat_laws::{CONTACT_ANSWER, CONTACT_MEMORY, Next};
use crate::ledger::Ledger;
use crate::system::{Entry, Sizes};

/// Places in the arena, in order.
#[derive(Clone, Debug)]
pub(crate) struct Places {
    pub(crate) parameters: Range<usize>,
    /// Time at which the step begins [s], its length [s], time at which it ends [s].
    pub(crate) begin: usize,
    pub(crate) length: usize,
    pub(crate) end: usize,
    /// The flat state at its beginning, and the slope there.
    pub(crate) y: Range<usize>,
    pub(crate) slope: Range<usize>,
    /// [`CONTACT_MEMORY`] numbers of every joint with clearance.
    pub(crate) memory: Range<usize>,
    /// The largest value that each loop pivot has had before the step.
    pub(crate) pivots: Range<usize>,
    /// The largest square of a length of each row of the Jacobian that is no longer than the longest so far.
    pub(crate) row_squares: Range<usize>,
    /// Factor on how far loops may stay open.
    pub(crate) looseness: usize,
    /// Tolerance of the error, relative to sizes; the error of the last accepted step, 1 just accepted.
    pub(crate) tolerance: usize,
    pub(crate) last_error: usize,
    /// Natural sizes of coordinates and speeds, in their units; of energies [J].
    pub(crate) scales: Range<usize>,
    pub(crate) energy_scale: usize,
    /// [`CONTACT_ANSWER`] numbers of every joint with clearance at the beginning; up to which penetration nobody has to look at it.
    pub(crate) touches: Range<usize>,
    pub(crate) watched: Range<usize>,
    /// What the trajectory has added up so far.
    pub(crate) ledger: Range<usize>,
    /// The flat state at the end, with quaternions of unit length. From here on: what an attempt answers.
    pub(crate) next: Range<usize>,
    /// The coordinates as the method has them.
    pub(crate) raw: Range<usize>,
    /// The slope at the last inner stage.
    pub(crate) last_slope: Range<usize>,
    /// The largest pivots, those of the inner stages included.
    pub(crate) grown_pivots: Range<usize>,
    /// How regular the loops were at the last inner stage; the least of all of them, no number if one was infinite or none.
    pub(crate) nearness: usize,
    pub(crate) least_nearness: usize,
    /// 1 where residuals of positions and speeds are such that nothing has to be moved, else 0.
    pub(crate) is_untouched: usize,
    /// 1 where a row of the Jacobian is longer than ever, else 0.
    pub(crate) has_longer_row: usize,
    /// How far loops are open at the end [m], [rad], no number if that is none.
    pub(crate) open: [usize; 2],
    /// Squares of the lengths of the Jacobian's rows at the end.
    pub(crate) squares_at_end: Range<usize>,
    /// Residuals of all rows there.
    pub(crate) residuals: Range<usize>,
    /// What is at the end.
    pub(crate) conclusion: Conclusion,
}

impl Places {
    pub(crate) fn new(sizes: &Sizes) -> Self {
        let Sizes { coordinates, speeds, rows, .. } = *sizes;
        let flat = sizes.flat_state();
        let mut next = Next(0);
        Self {
            parameters: next.some(sizes.parameters),
            begin: next.one(),
            length: next.one(),
            end: next.one(),
            y: next.some(flat),
            slope: next.some(flat),
            memory: next.some(CONTACT_MEMORY * sizes.contacts),
            pivots: next.some(rows),
            row_squares: next.some(rows),
            looseness: next.one(),
            tolerance: next.one(),
            last_error: next.one(),
            scales: next.some(coordinates + speeds),
            energy_scale: next.one(),
            touches: next.some(CONTACT_ANSWER * sizes.contacts),
            watched: next.some(sizes.contacts),
            ledger: next.some(Ledger::<f64>::len(sizes.contacts)),
            next: next.some(flat),
            raw: next.some(coordinates),
            last_slope: next.some(flat),
            grown_pivots: next.some(rows),
            nearness: next.one(),
            least_nearness: next.one(),
            is_untouched: next.one(),
            has_longer_row: next.one(),
            open: [next.one(), next.one()],
            squares_at_end: next.some(rows),
            residuals: next.some(sizes.all_rows),
            conclusion: Conclusion::new(sizes, next),
        }
    }

    /// Length of the question of a step.
    pub(crate) fn question(&self) -> usize {
        self.next.start
    }
}

/// Places of what is at the end, in order.
#[derive(Clone, Debug)]
pub(crate) struct Conclusion {
    /// The slope at the end.
    pub(crate) slope: Range<usize>,
    /// [`CONTACT_ANSWER`] numbers of every joint with clearance.
    pub(crate) contacts: Range<usize>,
    /// Kinetic and potential energy [J].
    pub(crate) energy: Range<usize>,
    /// The largest value that each pivot has had.
    pub(crate) pivots: Range<usize>,
    /// 1 where one has grown in the step, else 0.
    pub(crate) has_grown: usize,
    /// How regular the loops are at the end, no number if an answer is infinite or none.
    pub(crate) nearness: usize,
    /// The natural size of energies [J], and what the trajectory has added up, if the step counts.
    pub(crate) energy_scale: usize,
    pub(crate) ledger: Range<usize>,
    /// 1 where nothing happened in the step that a trajectory would have to look at, else 0.
    pub(crate) is_quiet: usize,
    /// The error of the step, 1 just accepted; by how much the next one may be longer.
    pub(crate) error: usize,
    pub(crate) growth: usize,
    /// Where all of the arena ends.
    pub(crate) all: usize,
}

impl Conclusion {
    fn new(sizes: &Sizes, mut next: Next) -> Self {
        let mut places = Self {
            slope: next.some(sizes.flat_state()),
            contacts: next.some(CONTACT_ANSWER * sizes.contacts),
            energy: next.some(sizes.output(Entry::Energy)),
            pivots: next.some(sizes.rows),
            has_grown: next.one(),
            nearness: next.one(),
            energy_scale: next.one(),
            ledger: next.some(Ledger::<f64>::len(sizes.contacts)),
            is_quiet: next.one(),
            error: next.one(),
            growth: next.one(),
            all: 0,
        };
        places.all = next.0;
        places
    }

    pub(crate) fn start(&self) -> usize {
        self.slope.start
    }

    /// Where the totals of a joint are among slopes.
    pub(crate) fn totals(sizes: &Sizes, joint: usize) -> usize {
        sizes.coordinates + sizes.speeds + WORKS + TOTALS * joint
    }
}
