//! Which joints carry the bodies (the spanning tree) and which close loops (the cuts).
//! In: [`Mechanism`]. Out: [`Topology`]. Never knows equations.
//!
//! The tree grows from the ground by the best joint at its rim: guides with clearance, then driven, coupled and stopped joints and others with clearance first (their
//! coordinates are asked for, so they must be coordinates), then joints with start values, then those with more constraint
//! rows, so that the cuts take few (an RSSR is cut at a spherical joint), then those with damping, springs
//! or a part in some formula; among equals the one nearer to the ground, then the first in the file. Long mechanisms: equals that keep loops short.

use super::local_loops::with_local_loops;
use super::{Carrier, Closure, Formula, Joint, Mechanism, Passive, Position, Term, Topology, TreeJoint};
use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::id::{BodyId, JointId};

/// Preference of a joint for the tree: smaller is better.
type Class = (bool, bool, bool, usize, bool);

/// Mechanisms with no more speeds keep the tree as it grows: its coordinates are those that users know.
const MOST_AS_GROWN: usize = 40;

/// Chooses tree joints and cuts. The diagnostics have places but no file yet: see [`Diagnostics::located`].
///
/// # Errors
/// If a body can be reached only through joints that must be cut, if driven joints close a loop among
/// themselves or must be cut, if a cut joint has a start value or is coupled.
pub fn spanning_tree(mechanism: &Mechanism) -> Result<Topology, Diagnostics> {
    let classes = classes(mechanism);
    let may_carry: Vec<bool> = mechanism.joints.iter().map(|joint| !must_cut(mechanism, joint)).collect();
    let mut faults = driven_cuts(mechanism, &may_carry);
    let (mut tree, depths) = grown(mechanism, &classes, &may_carry);
    if speeds(mechanism, &tree) > MOST_AS_GROWN {
        // What the file asks for stays where it is: joints change places with their equals alone.
        let carries = with_local_loops(mechanism, &tree, |cut, joint| {
            let (_, plain, unstarted, ..) = classes[cut];
            may_carry[cut] && plain && unstarted && classes[cut] == classes[joint]
        });
        (tree, _) = grown(mechanism, &classes, &carries);
    }
    let topology = with_cuts(mechanism, tree);
    faults.extend(unreached(mechanism, &depths));
    if faults.is_empty() {
        faults.extend(driven_loops(mechanism, &topology));
        faults.extend(coupled_cuts(mechanism, &topology));
        faults.extend(stopped_cuts(mechanism, &topology));
        faults.extend(loose_cuts(mechanism, &topology));
        faults.extend(starts_on_cuts(mechanism, &topology));
    }
    if faults.is_empty() { Ok(topology) } else { Err(Diagnostics::from_list(faults)) }
}

fn with_cuts(mechanism: &Mechanism, tree: Vec<TreeJoint>) -> Topology {
    let carries = |joint: &JointId| tree.iter().any(|step: &TreeJoint| step.joint == *joint);
    let cuts: Vec<JointId> =
        (0..mechanism.joints.len()).map(JointId::new).filter(|joint| !carries(joint)).collect();
    Topology { tree, cuts, rows_in_ground: false, rows_off_balls: false }
}

/// The tree of these joints; nothing if they reach not all bodies.
pub(super) fn grown_by(mechanism: &Mechanism, carries: &[bool]) -> Option<Topology> {
    let (tree, depths) = grown(mechanism, &classes(mechanism), carries);
    depths.iter().all(Option::is_some).then(|| with_cuts(mechanism, tree))
}

/// By joint, whether nothing asks for its coordinates and nothing asks for its cut.
pub(super) fn carries_at_will(mechanism: &Mechanism) -> Vec<bool> {
    let unasked = |(joint, class): (&Joint, Class)| {
        let (no_guide, plain, unstarted, _, unused) = class;
        no_guide && plain && unstarted && unused && !must_cut(mechanism, joint)
    };
    mechanism.joints.iter().zip(classes(mechanism)).map(unasked).collect()
}

/// The tree that grows from the ground, and how far from it each body is, if it is reached.
fn grown(
    mechanism: &Mechanism,
    classes: &[Class],
    may_carry: &[bool],
) -> (Vec<TreeJoint>, Vec<Option<usize>>) {
    let mut depths: Vec<Option<usize>> = vec![None; mechanism.bodies.len()];
    let mut tree = Vec::with_capacity(mechanism.bodies.len());
    while let Some(step) = best_step(mechanism, classes, may_carry, &depths) {
        depths[step.outboard.index()] = Some(depth(step.inboard, &depths).unwrap_or(0) + 1);
        tree.push(step);
    }
    (tree, depths)
}

/// Speeds of a tree, those of modes left out.
fn speeds(mechanism: &Mechanism, tree: &[TreeJoint]) -> usize {
    tree.iter().map(|step| 6 - mechanism.joint(step.joint).model.rows()).sum()
}

fn depth(carrier: Carrier, depths: &[Option<usize>]) -> Option<usize> {
    match carrier {
        Carrier::Ground => Some(0),
        Carrier::Body(id) => depths[id.index()],
    }
}

/// The best joint with exactly one side in the tree.
fn best_step(
    mechanism: &Mechanism,
    classes: &[Class],
    may_carry: &[bool],
    depths: &[Option<usize>],
) -> Option<TreeJoint> {
    let mut best: Option<((Class, usize), TreeJoint)> = None;
    for (position, joint) in mechanism.joints.iter().enumerate() {
        if !may_carry[position] {
            continue;
        }
        let (inboard, outboard, reversed) =
            match (depth(joint.parent, depths), depth(joint.child, depths), joint.parent, joint.child) {
                (Some(_), None, inboard, Carrier::Body(outboard)) => (inboard, outboard, false),
                (None, Some(_), Carrier::Body(outboard), inboard) => (inboard, outboard, true),
                _ => continue,
            };
        let key = (classes[position], depth(inboard, depths).unwrap_or(0));
        if best.as_ref().is_none_or(|(least, _)| key < *least) {
            best = Some((key, TreeJoint { joint: JointId::new(position), inboard, outboard, reversed }));
        }
    }
    best.map(|(_, step)| step)
}

fn classes(mechanism: &Mechanism) -> Vec<Class> {
    let mut started = vec![false; mechanism.joints.len()];
    mechanism.starts.iter().for_each(|start| started[start.joint.index()] = true);
    let (mentioned, coupled) = (mentioned(mechanism), coupled(mechanism));
    let class = |(position, joint): (usize, &Joint)| {
        let passive = !joint.passive.is_empty() || mentioned[position];
        (
            !joint.model.is_loose_guide(),
            joint.drives.is_empty() && joint.clearance.is_none() && !coupled[position],
            !started[position],
            6 - joint.model.rows(),
            !passive,
        )
    };
    mechanism.joints.iter().enumerate().map(class).collect()
}

/// Joints whose coordinates occur in couplings or are stopped.
fn coupled(mechanism: &Mechanism) -> Vec<bool> {
    let mut coupled = vec![false; mechanism.joints.len()];
    let terms = mechanism.couplings.iter().flat_map(|coupling| &coupling.terms);
    terms.for_each(|term| coupled[term.joint.index()] = true);
    mechanism.stops.iter().for_each(|stop| coupled[stop.joint.index()] = true);
    coupled
}

/// Joints whose coordinates occur in the formulas of forces and states.
fn mentioned(mechanism: &Mechanism) -> Vec<bool> {
    let mut mentioned = vec![false; mechanism.joints.len()];
    let mut note = |formula: &Formula| {
        formula.term.visit(&mut |term| {
            let joint = match term {
                Term::JointPosition(id, _) | Term::JointSpeed(id, _) => Some(*id),
                Term::Response(response) => response.coordinate_of(),
                _ => None,
            };
            if let Some(joint) = joint {
                mentioned[joint.index()] = true;
            }
        });
    };
    for passive in mechanism.joints.iter().flat_map(|joint| &joint.passive) {
        if let Passive::Actuator { force, .. } = passive {
            note(force);
        }
    }
    for force in &mechanism.forces {
        force.formulas.iter().for_each(&mut note);
    }
    mechanism.states.iter().flat_map(|state| [&state.rate].into_iter().chain(&state.next)).for_each(note);
    mentioned
}

/// Whether the joint is described differently on its two sides, or the user wants it cut.
fn must_cut(mechanism: &Mechanism, joint: &Joint) -> bool {
    joint.cut || joint.surface.is_some() || is_open(mechanism, joint)
}

/// Whether the branches on the two sides of the joint are described open.
pub(super) fn is_open(mechanism: &Mechanism, joint: &Joint) -> bool {
    let axes = joint.model.axes.iter().any(|axis| axis.parent != axis.child);
    let point = match &mechanism.point(joint.at).position {
        Position::Shared(_) => false,
        Position::PerBody(list) => {
            [joint.parent, joint.child].iter().all(|side| list.iter().any(|(body, _)| body == side))
        }
    };
    axes || point
}

fn why_cut(mechanism: &Mechanism, joint: &Joint) -> &'static str {
    if is_open(mechanism, joint) {
        "its point or axis is given per body, so the loop is open there"
    } else if joint.surface.is_some() {
        "a joint of its kind holds the place of a point and carries no body"
    } else {
        "it has `cut = true`"
    }
}

fn driven_cuts(mechanism: &Mechanism, may_carry: &[bool]) -> Vec<Diagnostic> {
    let wrong =
        mechanism.joints.iter().zip(may_carry).filter(|(joint, may)| !joint.drives.is_empty() && !**may);
    wrong
        .map(|(joint, _)| {
            let why = why_cut(mechanism, joint);
            Diagnostic::new(
                Code::DrivenCut,
                format!("joint `{}` is driven, but must be cut: {why}", joint.name),
            )
            .at(joint.span, "")
            .help("open the loop at another of its joints")
        })
        .collect()
}

fn unreached(mechanism: &Mechanism, depths: &[Option<usize>]) -> Vec<Diagnostic> {
    let lost: Vec<BodyId> =
        (0..depths.len()).filter(|body| depths[*body].is_none()).map(BodyId::new).collect();
    let Some(first) = lost.first() else { return Vec::new() };
    let names =
        lost.iter().map(|body| format!("`{}`", mechanism.body(*body).name)).collect::<Vec<_>>().join(", ");
    let is_reached = |carrier: Carrier| depth(carrier, depths).is_some();
    let rim = mechanism.joints.iter().find(|joint| is_reached(joint.parent) != is_reached(joint.child));
    let Some(joint) = rim else {
        let message = format!("no chain of joints connects {names} to the ground");
        return vec![Diagnostic::new(Code::Disconnected, message).at(mechanism.body(*first).span, "")];
    };
    let message = format!(
        "joint `{}` must be cut, but nothing else carries {names}: {}",
        joint.name,
        why_cut(mechanism, joint)
    );
    vec![
        Diagnostic::new(Code::CutDisconnects, message)
            .at(joint.span, "")
            .help(if joint.surface.is_some() {
                "give the body a joint that carries it besides, at least a `free` one to the ground"
            } else {
                "a joint outside a loop cannot be cut: take `cut = true` away, or give its point and axis once for both bodies; or the joint is missing that carries them"
            }),
    ]
}

fn driven_loops(mechanism: &Mechanism, topology: &Topology) -> Vec<Diagnostic> {
    let cut = topology.cuts.iter().map(|id| mechanism.joint(*id)).filter(|joint| !joint.drives.is_empty());
    cut.map(|joint| {
        let path = topology.between(joint);
        let names =
            path.iter().map(|id| format!("`{}`", mechanism.joint(*id).name)).collect::<Vec<_>>().join(", ");
        let message = format!("the driven joints {names} and `{}` close a loop on their own", joint.name);
        let mut fault = Diagnostic::new(Code::DrivenLoop, message).at(joint.span, "");
        for id in &path {
            fault = fault.also(mechanism.joint(*id).span, "");
        }
        fault.help("leave one joint of the loop without a drive: its motion follows from the others")
    })
    .collect()
}

/// An angle across a cut is known up to whole turns only; a coupling counts them.
fn coupled_cuts(mechanism: &Mechanism, topology: &Topology) -> Vec<Diagnostic> {
    let mut faults = Vec::new();
    for coupling in mechanism.couplings.iter().filter(|_| mechanism.closure == Closure::Joint) {
        let cut = coupling.terms.iter().find(|term| topology.cuts.contains(&term.joint));
        let Some(joint) = cut.map(|term| mechanism.joint(term.joint)) else { continue };
        let why = if must_cut(mechanism, joint) {
            why_cut(mechanism, joint)
        } else {
            "all joints of its loop are driven, coupled or have clearance"
        };
        let message =
            format!("joint `{}` is in the coupling `{}`, but is cut: {why}", joint.name, coupling.name);
        faults.push(
            Diagnostic::new(Code::CoupledCut, message)
                .at(coupling.span, "")
                .also(joint.span, "cut here")
                .help("open the loop at a joint that is in no coupling: write `cut = true` there"),
        );
    }
    faults
}

/// An angle across a cut jumps at half a turn: so would the force of a stop.
fn stopped_cuts(mechanism: &Mechanism, topology: &Topology) -> Vec<Diagnostic> {
    let cut = mechanism.stops.iter().filter(|stop| stop.angular && topology.cuts.contains(&stop.joint));
    cut.map(|stop| {
        let joint = mechanism.joint(stop.joint);
        let why = if must_cut(mechanism, joint) {
            why_cut(mechanism, joint)
        } else {
            "all joints of its loop are driven, coupled, stopped or have clearance"
        };
        let message = format!("the angle of joint `{}` is stopped, but it is cut: {why}", joint.name);
        Diagnostic::new(Code::BadStop, message)
            .at(stop.span, "")
            .also(joint.span, "cut here")
            .help("open the loop at a joint that has no stop: write `cut = true` there")
    })
    .collect()
}

/// The offset of a rod in its bush is a coordinate: across a cut it would have the rounding of the whole loop.
fn loose_cuts(mechanism: &Mechanism, topology: &Topology) -> Vec<Diagnostic> {
    let cuts = topology.cuts.iter().map(|id| mechanism.joint(*id));
    let loose = cuts.filter(|joint| joint.model.is_loose_guide() && mechanism.closure == Closure::Joint);
    loose
        .map(|joint| {
            let why = if must_cut(mechanism, joint) {
                why_cut(mechanism, joint)
            } else {
                "all joints of its loop are guides with clearance"
            };
            let message = format!("joint `{}` is a guide with clearance, but is cut: {why}", joint.name);
            Diagnostic::new(Code::BadClearance, message)
                .at(joint.span, "")
                .help("open the loop at another of its joints: write `cut = true` there")
        })
        .collect()
}

impl Topology {
    /// The tree joints between the two bodies of a joint.
    pub fn between(&self, joint: &Joint) -> Vec<JointId> {
        let to_ground = |mut carrier: Carrier| {
            let mut path = Vec::new();
            while let Some(step) = self.tree.iter().find(|step| Carrier::Body(step.outboard) == carrier) {
                path.push(step.joint);
                carrier = step.inboard;
            }
            path
        };
        let (parent, child) = (to_ground(joint.parent), to_ground(joint.child));
        let own = |path: &[JointId], other: &[JointId]| -> Vec<JointId> {
            path.iter().filter(|id| !other.contains(id)).copied().collect()
        };
        [own(&parent, &child), own(&child, &parent)].concat()
    }
}

fn starts_on_cuts(mechanism: &Mechanism, topology: &Topology) -> Vec<Diagnostic> {
    let first = |cut: &JointId| mechanism.starts.iter().find(|start| start.joint == *cut);
    topology
        .cuts
        .iter()
        .filter_map(first)
        .map(|start| {
            let joint = mechanism.joint(start.joint);
            let why = if must_cut(mechanism, joint) {
                why_cut(mechanism, joint)
            } else {
                "the other joints of its loop have start values or drives too"
            };
            Diagnostic::new(
                Code::StartOnCut,
                format!("joint `{}` has a start value, but is cut: {why}", joint.name),
            )
            .at(start.span, "")
            .also(joint.span, "cut here")
            .help(
                "give start values of the other joints of the loop; this one follows when the loop is closed",
            )
        })
        .collect()
}
