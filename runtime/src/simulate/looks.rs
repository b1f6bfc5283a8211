//! Looks at the columns of states that need no answer at once: several are observed together. In: states with their forward
//! dynamics. Out: columns to a [`Collector`], in the order of time. Allocates only when made.

use super::extremes::Collector;
use super::slopes::Slopes;
use crate::clearance_joint::Channels;
use crate::evaluate::Evaluator;
use crate::system::{Entry, STATES, SideBySide, System};

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
    /// Forward dynamics of several states at once.
    slopes: Option<Slopes<'a>>,
}

impl<'a> Looks<'a> {
    /// For so many columns; none if the system observes one state after the other.
    pub(super) fn new(
        system: &'a dyn System<f64>,
        evaluator: &Evaluator<'_>,
        columns: usize,
    ) -> Option<Self> {
        let (observer, sizes) = (system.side_by_side()?, evaluator.sizes());
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
            slopes: Slopes::new(observer, evaluator),
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
        self.count_in(t, collector);
    }

    fn count_in(&mut self, t: f64, collector: &mut Collector) {
        self.times[self.count] = t;
        self.count += 1;
        if self.count == STATES {
            self.finish(collector);
        }
    }

    /// Evaluates the forward dynamics of several flat states at once; whether the system can, and all are finite.
    pub(super) fn evaluate(
        &mut self,
        evaluator: &mut Evaluator<'_>,
        times: &[f64; STATES],
        states: &[[f64; STATES]],
    ) -> bool {
        self.slopes.as_mut().is_some_and(|slopes| slopes.evaluate(evaluator, times, states))
    }

    /// Loop pivots of one of them.
    pub(super) fn pivots(&self, lane: usize) -> impl Iterator<Item = f64> + '_ {
        self.slopes.iter().flat_map(move |slopes| {
            let [_, _, _, pivots] = slopes.forward(lane);
            pivots
        })
    }

    /// Looks at one of them.
    pub(super) fn look_at(
        &mut self,
        evaluator: &Evaluator<'_>,
        (lane, t): (usize, f64),
        collector: &mut Collector,
    ) {
        let Some(slopes) = &self.slopes else { return };
        let sizes = evaluator.sizes();
        let (known, rest) = self.question.split_at_mut(sizes.input(Entry::Energy));
        known.iter_mut().zip(slopes.question(lane)).for_each(|(place, value)| place[self.count] = value);
        let [accelerations, multipliers, drives, _] = slopes.forward(lane);
        let (of_accelerations, rest) = rest.split_at_mut(sizes.speeds);
        of_accelerations.iter_mut().zip(accelerations).for_each(|(place, value)| place[self.count] = value);
        let (of_rows, rest) = rest.split_at_mut(sizes.all_rows);
        of_rows.iter_mut().for_each(|place| place[self.count] = 0.0);
        for (row, value) in evaluator.kept().iter().zip(multipliers) {
            of_rows[*row][self.count] = value;
        }
        rest.iter_mut().zip(drives).for_each(|(place, value)| place[self.count] = value);
        self.count_in(t, collector);
    }

    /// Observes what waits.
    pub(super) fn finish(&mut self, collector: &mut Collector) {
        let count = std::mem::take(&mut self.count);
        let Self { observer, times, question, generated, columns, workspace, .. } = self;
        if count == STATES
            && let Some(room) = collector.room(times)
        {
            let (room, of_contacts) = room.split_at_mut(*generated);
            observer.evaluate(Entry::Observe, question, room, workspace);
            of_contacts.copy_from_slice(&columns[*generated..]);
        } else if count > 0 {
            // Places without a state hold an older one, or zeros, and nobody reads what they give.
            observer.evaluate(Entry::Observe, question, columns, workspace);
            collector.note_several(&times[..count], columns);
        }
    }
}
