//! A spanning tree whose loops are as short as exchanges of cuts with tree joints make them.
//! In: [`Mechanism`], a tree. Out: which joints are in a better one. Never knows which joints may change places.
//!
//! Short loops keep the equations of long mechanisms sparse: a row has entries by the speeds of its loop alone.

use super::{Carrier, Mechanism, TreeJoint};

/// Rounds of exchanges at most; a lattice of loops takes one, and a second that finds nothing.
const ROUNDS: usize = 3;

/// Joints as a set, by number.
#[derive(Clone)]
struct Set(Vec<u64>);

impl Set {
    const BITS: usize = u64::BITS as usize;

    fn new(count: usize) -> Self {
        Self(vec![0; count.div_ceil(Self::BITS)])
    }

    fn has(&self, joint: usize) -> bool {
        self.0[joint / Self::BITS] >> (joint % Self::BITS) & 1 == 1
    }

    fn flip(&mut self, joint: usize) {
        self.0[joint / Self::BITS] ^= 1 << (joint % Self::BITS);
    }

    fn len(&self) -> usize {
        self.0.iter().map(|word| word.count_ones() as usize).sum()
    }

    /// Joints in one of both.
    fn sum(&self, other: &Self) -> Self {
        Self(self.0.iter().zip(&other.0).map(|(a, b)| a ^ b).collect())
    }
}

/// Joints of each joint's loop with the tree, itself included; nothing for those of the tree.
fn loops(ends: &[[usize; 2]], in_tree: &[bool]) -> Vec<Option<Set>> {
    let carriers = ends.iter().flatten().max().map_or(1, |last| last + 1);
    let mut beside = vec![Vec::new(); carriers];
    for (joint, [a, b]) in ends.iter().enumerate().filter(|(joint, _)| in_tree[*joint]) {
        beside[*a].push((joint, *b));
        beside[*b].push((joint, *a));
    }
    // Joints from the ground to each carrier.
    let mut ways: Vec<Option<Set>> = vec![None; carriers];
    ways[0] = Some(Set::new(ends.len()));
    let mut stack = vec![0];
    while let Some(carrier) = stack.pop() {
        let Some(way) = ways[carrier].clone() else { continue };
        for (joint, next) in &beside[carrier] {
            if ways[*next].is_none() {
                let mut further = way.clone();
                further.flip(*joint);
                ways[*next] = Some(further);
                stack.push(*next);
            }
        }
    }
    let of_joint = |(joint, [a, b]): (usize, &[usize; 2])| {
        let (Some(a), Some(b), false) = (&ways[*a], &ways[*b], in_tree[joint]) else { return None };
        let mut joints = a.sum(b);
        joints.flip(joint);
        Some(joints)
    };
    ends.iter().enumerate().map(of_joint).collect()
}

/// By joint, whether it carries a body after the exchanges. `may` says of a cut and a tree joint, by number, whether they may
/// change places.
pub fn with_local_loops(
    mechanism: &Mechanism,
    tree: &[TreeJoint],
    may: impl Fn(usize, usize) -> bool,
) -> Vec<bool> {
    let number = |carrier: Carrier| match carrier {
        Carrier::Ground => 0,
        Carrier::Body(body) => body.index() + 1,
    };
    let joints = mechanism.joints.iter();
    let ends: Vec<[usize; 2]> = joints.map(|joint| [number(joint.parent), number(joint.child)]).collect();
    let mut in_tree = vec![false; ends.len()];
    tree.iter().for_each(|step| in_tree[step.joint.index()] = true);
    exchanged(&ends, in_tree, may)
}

/// Exchanges cuts, in their order, each with the joint of its loop that makes all loops together the shortest. `ends`: the
/// ground is carrier 0.
fn exchanged(ends: &[[usize; 2]], mut in_tree: Vec<bool>, may: impl Fn(usize, usize) -> bool) -> Vec<bool> {
    let mut loops = loops(ends, &in_tree);
    for _ in 0..ROUNDS {
        let mut changed = false;
        for cut in 0..ends.len() {
            let Some(own) = loops[cut].clone() else { continue };
            let saved = |joint: usize| {
                let others = loops.iter().flatten().filter(|other| other.has(joint) && !other.has(cut));
                others.map(|other| other.len() as isize - other.sum(&own).len() as isize).sum::<isize>()
            };
            let joints = (0..ends.len()).filter(|joint| *joint != cut && own.has(*joint) && may(cut, *joint));
            let savings = joints.map(|joint| (saved(joint), joint)).filter(|(saved, _)| *saved > 0);
            // Of equals the first.
            let Some((_, joint)) = savings.max_by_key(|(saved, joint)| (*saved, std::cmp::Reverse(*joint)))
            else {
                continue;
            };
            loops[cut] = None;
            for other in loops.iter_mut().flatten().filter(|other| other.has(joint)) {
                *other = other.sum(&own);
            }
            loops[joint] = Some(own);
            (in_tree[cut], in_tree[joint]) = (true, false);
            changed = true;
        }
        if !changed {
            break;
        }
    }
    in_tree
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two uprights of `cells` links each, tied by a rung per cell; the ground is their foot.
    fn ladder(cells: usize) -> Vec<[usize; 2]> {
        let mut ends = vec![[0, 1], [0, 2]];
        for cell in 1..cells {
            let [left, right] = [2 * cell - 1, 2 * cell];
            ends.extend([[left, left + 2], [right, right + 2], [left, right]]);
        }
        ends.push([2 * cells - 1, 2 * cells]);
        ends
    }

    fn lengths(ends: &[[usize; 2]], in_tree: &[bool]) -> Vec<usize> {
        loops(ends, in_tree).iter().flatten().map(Set::len).collect()
    }

    #[test]
    fn loops_of_a_ladder_become_its_cells() {
        let ends = ladder(20);
        let rung = |joint: usize| ends[joint][0] % 2 == 1 && ends[joint][1] == ends[joint][0] + 1;
        let tree: Vec<bool> = (0..ends.len()).map(|joint| !rung(joint)).collect();
        assert_eq!(lengths(&ends, &tree).iter().max(), Some(&41));
        let better = exchanged(&ends, tree.clone(), |_, _| true);
        assert!(lengths(&ends, &better).iter().all(|length| *length <= 4));
        // As many joints carry as before.
        assert_eq!(
            better.iter().filter(|carries| **carries).count(),
            tree.iter().filter(|carries| **carries).count()
        );
        assert_eq!(exchanged(&ends, tree.clone(), |_, _| false), tree);
    }
}
