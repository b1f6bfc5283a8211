//! Which functions are lowered together, and what is made of them when. In: functions, how one is lowered. Out: tapes, in the order of the
//! functions. Never knows graphs.

use std::sync::OnceLock;

use linkwear_runtime::Entry;

use crate::derive::{Equations, Function};
use crate::expr::Graph;

use super::cut::{Joined, cut};
use super::{Tape, verify};

/// A function, and the one that goes on from it.
pub type Group<'a> = (&'a Function, Option<&'a Function>);

/// The function of an entry and the one that goes on from it, with their graph.
pub fn group(equations: &Equations, entry: Entry) -> Option<(&Graph, Group<'_>)> {
    let (graph, function) = equations.function(entry)?;
    Some((graph, (function, equations.next(entry))))
}

/// All functions, in order, with their graphs.
pub fn groups(equations: &Equations) -> impl Iterator<Item = (&Graph, Group<'_>)> {
    let first = Entry::ALL.into_iter().filter(|entry| !equations.goes_on(*entry));
    first.filter_map(|entry| group(equations, entry))
}

/// What is made of every function when it is first asked for, and of the one that goes on from it with it.
#[derive(Clone, Debug)]
pub struct WhenAsked<T>([OnceLock<Vec<T>>; Entry::ALL.len()]);

impl<T> Default for WhenAsked<T> {
    fn default() -> Self {
        Self(Default::default())
    }
}

impl<T> WhenAsked<T> {
    /// Of the function of an entry.
    pub fn get(
        &self,
        equations: &Equations,
        entry: Entry,
        make: impl FnOnce((&Graph, Group<'_>)) -> Vec<T>,
    ) -> Option<&T> {
        let place = usize::from(equations.goes_on(entry));
        let first = entry as usize - place;
        let made = || group(equations, Entry::ALL[first]).map(make).unwrap_or_default();
        self.0[first].get_or_init(made).get(place)
    }

    /// Of the functions of a group, by its first entry, if they were asked for.
    pub fn known(&self, first: Entry) -> Option<&[T]> {
        self.0[first as usize].get().map(Vec::as_slice)
    }
}

/// One tape for every function: of a function and the one that goes on from it as one, then cut.
pub fn of_group((function, next): Group<'_>, lower: &dyn Fn(&Function) -> Tape) -> Vec<Tape> {
    let Some(next) = next else { return vec![lower(function)] };
    let outputs = function.outputs.iter().chain(&next.outputs).cloned().collect();
    let tape = lower(&Function { outputs, ..next.clone() });
    let parts = cut(Joined { tape, functions: [function, next] });
    debug_assert!(parts.iter().all(|tape| verify(tape) == Ok(())));
    parts.into()
}
