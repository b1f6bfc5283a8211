//! Numbers that are equal but for rounding become one, so that what is made of them is one, too.

use std::collections::BTreeMap;

use super::program::{Program, Whole};
use super::rebuild::copy;
use crate::expr::{ExprId, Node};

/// A few roundings of a change of frame; a result that this changes is no better known before.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// The function alone, with one number in the place of all that are equal but for rounding: the one made first.
pub fn merged(whole: &Whole<'_>) -> Program {
    let uses = whole.graph.uses(whole.roots);
    // By magnitude: bits of positive numbers are ordered as they are.
    let mut first_made: BTreeMap<u64, usize> = BTreeMap::new();
    for (index, _) in uses.iter().enumerate().filter(|(_, used)| **used > 0) {
        if let Some(number) = whole.graph.as_constant(ExprId::new(index)) {
            first_made.entry(number.abs().to_bits()).or_insert(index);
        }
    }
    let mut common: BTreeMap<u64, f64> = BTreeMap::new();
    let list: Vec<(f64, usize)> = first_made.iter().map(|(bits, at)| (f64::from_bits(*bits), *at)).collect();
    // Measured from the smallest of a group, so that a chain of neighbours does not grow.
    for group in groups(&list) {
        let chosen = group.iter().min_by_key(|(_, at)| *at).map_or(0.0, |(number, _)| *number);
        common.extend(group.iter().map(|(number, _)| (number.to_bits(), chosen)));
    }
    copy(whole, |rebuild, id| match rebuild.old.node(id) {
        Node::Constant(bits) => {
            let number = f64::from_bits(bits);
            let size = common.get(&number.abs().to_bits()).copied().unwrap_or(number.abs());
            rebuild.set(id, rebuild.scope.number(size.copysign(number)));
        }
        _ => rebuild.again(id),
    })
}

/// Cuts an ascending list into groups that are equal but for rounding.
fn groups(list: &[(f64, usize)]) -> Vec<&[(f64, usize)]> {
    let mut groups = Vec::new();
    let mut rest = list;
    while let Some((smallest, _)) = rest.first() {
        let end = rest.partition_point(|(number, _)| number - smallest <= ROUNDING * smallest);
        let (group, left) = rest.split_at(end.max(1));
        groups.push(group);
        rest = left;
    }
    groups
}
