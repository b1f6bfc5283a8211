//! A spanning tree that carries flexible bodies where their sections may turn freely.
//! In: [`Mechanism`], [`Topology`]. Out: another one, if there is a choice. Never knows which of them makes the shorter equations.
//!
//! A section turns as its body bends. A joint that holds it turns all that it carries along with the modes; a ball does not feel it.

use std::cmp::Reverse;

use super::topology::{carries_at_will, grown_by, is_open};
use super::{Carrier, Joint, Mechanism, Topology};

/// The tree in which cuts that feel no modes have changed places with joints of their loops that feel the most; nothing if there
/// are none that may, or if the start might be another one.
pub fn with_free_sections(mechanism: &Mechanism, topology: &Topology) -> Option<Topology> {
    let felt: Vec<usize> = mechanism.joints.iter().map(|joint| modes_felt(mechanism, joint)).collect();
    // Most mechanisms are rigid, and long ones among them: their loops are not walked.
    if felt.iter().all(|modes| *modes == 0) || !starts_alike(mechanism) {
        return None;
    }
    let mut carries: Vec<bool> = vec![true; mechanism.joints.len()];
    topology.cuts.iter().for_each(|cut| carries[cut.index()] = false);
    let may = carries_at_will(mechanism);
    for cut in topology.cuts.iter().filter(|cut| may[cut.index()] && felt[cut.index()] == 0) {
        let others = topology.between(mechanism.joint(*cut)).into_iter();
        let others = others.filter(|id| may[id.index()] && carries[id.index()] && felt[id.index()] > 0);
        if let Some(most) = others.max_by_key(|id| (felt[id.index()], Reverse(*id))) {
            (carries[cut.index()], carries[most.index()]) = (true, false);
        }
    }
    let same = topology.cuts.iter().all(|cut| !carries[cut.index()]);
    if same { None } else { grown_by(mechanism, &carries) }
}

/// Whether a mechanism starts with the same motion by any tree: as it is drawn, so that nothing is looked for from guesses, and at rest
/// or with no freedom that drivers leave open, whose speed would be the least of the tree's.
fn starts_alike(mechanism: &Mechanism) -> bool {
    let parameters = mechanism.parameter_values();
    let drawn = mechanism.drives().all(|(_, drive)| drive.law.value_at_time(&parameters, 0.0) == Some(0.0));
    let closed = !mechanism.joints.iter().any(|joint| is_open(mechanism, joint));
    let drivers = mechanism.drives().count();
    let fixed = drivers == 0 || mechanism.grubler() <= drivers as i64;
    drawn && closed && fixed && mechanism.starts.is_empty()
}

/// How many modes of the bodies on its two sides turn their sections at a joint that holds them.
fn modes_felt(mechanism: &Mechanism, joint: &Joint) -> usize {
    if joint.model.turns_freely() {
        return 0;
    }
    let at = |(side, point)| {
        let Carrier::Body(body) = side else { return 0 };
        let flexible = mechanism.body(body).flexible.as_ref();
        flexible.map_or(0, |flexible| {
            flexible.node_at(point).rotation.iter().filter(|turn| **turn != [0.0; 3]).count()
        })
    };
    [joint.parent, joint.child].into_iter().zip(joint.points()).map(at).sum()
}
