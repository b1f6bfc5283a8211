//! Cuts a tape into parts that compilers can swallow.
//! In: a tape. Out: parts and the workspace slots of values that cross from part to part.
//!
//! rustc 1.95 crashes in dev builds above about 2,900 `let`s in one function; parts of 1,000 cost a few
//! percent of run time and keep a margin of three.

use std::collections::BTreeMap;
use std::ops::Range;

use crate::operation::{Operand, Value};
use crate::tape::Tape;

/// Statements of a part at most.
pub const PART_LIMIT: usize = 1000;

/// One part of a tape.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    /// Its statements.
    pub statements: Range<usize>,
    /// Values to read from the workspace first: (value, slot).
    pub loads: Vec<(Value, u32)>,
    /// Values to leave in the workspace: (value, slot).
    pub saves: Vec<(Value, u32)>,
}

/// A tape cut into parts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Split {
    /// The parts, in order; at least one.
    pub parts: Vec<Part>,
    /// Number of workspace slots.
    pub slots: u32,
}

/// Cuts a tape into parts of at most `limit` statements, of equal length.
pub fn split(tape: &Tape, limit: usize) -> Split {
    let count = tape.statements.len().div_ceil(limit).max(1);
    let length = tape.statements.len().div_ceil(count).max(1);
    let part_of_statement = |at: usize| at / length;
    let mut home = vec![0_usize; tape.values as usize];
    let mut users: BTreeMap<Value, Vec<usize>> = BTreeMap::new();
    for (at, statement) in tape.statements.iter().enumerate() {
        let part = part_of_statement(at);
        for value in statement.results() {
            home[value as usize] = part;
        }
        for operand in statement.reads() {
            if let Operand::Value(value) = operand
                && home[value as usize] != part
            {
                let list = users.entry(value).or_default();
                if list.last() != Some(&part) {
                    list.push(part);
                }
            }
        }
    }
    let mut parts: Vec<Part> = (0..count)
        .map(|part| {
            let end = ((part + 1) * length).min(tape.statements.len());
            Part { statements: (part * length).min(end)..end, loads: Vec::new(), saves: Vec::new() }
        })
        .collect();
    let slots = assign_slots(&home, &users, &mut parts);
    Split { parts, slots }
}

/// A slot is taken when its value's part ends and free again after the last part that reads it.
fn assign_slots(home: &[usize], users: &BTreeMap<Value, Vec<usize>>, parts: &mut [Part]) -> u32 {
    let mut slots = 0;
    let mut free: Vec<u32> = Vec::new();
    let mut ending: Vec<Vec<u32>> = vec![Vec::new(); parts.len() + 1];
    let mut crossing: Vec<(usize, Value)> =
        users.keys().map(|value| (home[*value as usize], *value)).collect();
    crossing.sort_unstable();
    let mut freed_up_to = 0;
    for (part, value) in crossing {
        // Slots whose last reader ran before this part are free for what it saves.
        while freed_up_to < part {
            free.append(&mut ending[freed_up_to]);
            freed_up_to += 1;
        }
        let slot = free.pop().unwrap_or_else(|| {
            slots += 1;
            slots - 1
        });
        parts[part].saves.push((value, slot));
        for user in &users[&value] {
            parts[*user].loads.push((value, slot));
        }
        if let Some(last) = users[&value].last() {
            ending[*last].push(slot);
        }
    }
    slots
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::block::Block;
    use crate::operation::{Binary, Op};
    use crate::tape::Statement;

    /// A chain of additions, of which every one needs the one before.
    fn chain(length: u32) -> Tape {
        let link = |value: u32| {
            let before = value.checked_sub(1).map_or(Operand::Input(0), Operand::Value);
            let op = Op::Binary(Binary::Add, before, Operand::Constant(f64::from(value)));
            let stores = if value + 1 == length { vec![(0, Operand::Value(value))] } else { Vec::new() };
            Statement { op, first: value, labels: [None, None], section: 0, stores }
        };
        Tape {
            name: "chain".into(),
            doc: String::new(),
            inputs: vec![Block::vector("x", 1)],
            input_names: vec!["x".into()],
            outputs: vec![Block::vector("y", 1)],
            direct: Vec::new(),
            statements: (0..length).map(link).collect(),
            sections: vec![String::new()],
            values: length,
        }
    }

    #[test]
    fn parts_keep_the_limit_and_values_cross_once() {
        let tape = chain(200);
        let split = split(&tape, 30);
        assert!(split.parts.iter().all(|part| part.statements.len() <= 30));
        assert_eq!(
            split.parts.iter().map(|part| part.statements.len()).sum::<usize>(),
            tape.statements.len()
        );
        // A chain hands one value from part to part, and the slot is reused.
        assert!(split.parts.windows(2).all(|pair| pair[0].saves.len() == 1 && pair[1].loads.len() == 1));
        assert!(split.slots <= 2);
    }
}
