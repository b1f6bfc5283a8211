//! Looks at the columns of states that need no answer at once: several are observed together. In: states with their forward
//! dynamics. Out: columns to a [`Collector`], in the order of time. Allocates only when made.

use super::extremes::Collector;
use crate::clearance_joint::Channels;
use crate::evaluate::Evaluator;
use crate::system::{Entry, STATES, SideBySide};

/// Looks that wait.
pub(super) struct Looks<'a> {
    observer: &'a dyn SideBySide<f64>,
    times: [f64; STATES],
    count: usize,
    question: Vec<[f64; STATES]>,
    /// How many columns are generated ones...
    generated: usize,
    /// ...which come before those that contacts add.
    columns: Vec<[f64; STATES]>,
    workspace: Vec<[f64; STATES]>,
}

impl<'a> Looks<'a> {
    /// For so many columns; none if the system observes one state after the other.
    pub(super) fn new(evaluator: &Evaluator<'a>, columns: usize) -> Option<Self> {
        let (observer, sizes) = (evaluator.side_by_side()?, evaluator.sizes());
        let mut question = vec![[0.0; STATES]; sizes.input(Entry::Observe)];
        for (place, value) in question.iter_mut().zip(evaluator.parameters()) {
            *place = [*value; STATES];
        }
        Some(Self {
            observer,
            times: [0.0; STATES],
            count: 0,
            question,
            generated: sizes.channels,
            columns: vec![[0.0; STATES]; columns],
            workspace: vec![[0.0; STATES]; observer.workspace()],
        })
    }

    /// Looks at the state of the last forward dynamics.
    pub(super) fn look(
        &mut self,
        evaluator: &mut Evaluator<'_>,
        (t, q, v): (f64, &[f64], &[f64]),
        channels: &Channels,
        collector: &mut Collector,
    ) {
        evaluator.write_question((t, q, v), self.count, &mut self.question);
        let of_contacts = channels.values(evaluator.clearances().contacts());
        for (column, value) in self.columns[self.generated..].iter_mut().zip(of_contacts) {
            column[self.count] = value;
        }
        self.times[self.count] = t;
        self.count += 1;
        if self.count == STATES {
            self.finish(collector);
        }
    }

    /// Observes what waits.
    pub(super) fn finish(&mut self, collector: &mut Collector) {
        let count = std::mem::take(&mut self.count);
        let Self { observer, times, question, generated, columns, workspace, .. } = self;
        if count == STATES
            && let Some(room) = collector.room(times)
        {
            let (room, of_contacts) = room.split_at_mut(*generated);
            observer.observe(question, room, workspace);
            of_contacts.copy_from_slice(&columns[*generated..]);
        } else if count > 0 {
            // Places without a state hold an older one, or zeros, and nobody reads what they give.
            observer.observe(question, columns, workspace);
            collector.note_several(&times[..count], columns);
        }
    }
}
