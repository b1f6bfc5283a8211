//! Which functions are lowered together, and on which cores. In: functions, how one is lowered. Out: tapes, in the order of the
//! functions. Never knows graphs.

use std::thread::available_parallelism;

use crate::derive::{Equations, Function};

use super::cut::{Joined, cut};
use super::{Tape, side_by_side, verify};

/// A function, and the one that goes on from it.
pub type Group<'a> = (&'a Function, Option<&'a Function>);

/// All functions, in order.
pub fn groups(equations: &Equations) -> Vec<Group<'_>> {
    let mut functions = equations.functions.iter().peekable();
    let mut groups = Vec::new();
    while let Some(function) = functions.next() {
        groups.push((function, functions.next_if(|next| next.goes_on)));
    }
    groups
}

/// Every group by itself, some of them on other cores: which are changes no byte.
pub fn in_threads(groups: &[Group<'_>], lower: &(dyn Fn(&Function) -> Tape + Sync)) -> Vec<Tape> {
    let cores = available_parallelism().map_or(1, usize::from);
    side_by_side(groups, cores, |group| of_group(*group, lower)).into_iter().flatten().collect()
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
