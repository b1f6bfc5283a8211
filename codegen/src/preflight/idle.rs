//! Idle freedoms: a group of bodies between ball joints that can spin while everything else rests.
//! In: null space of the loops with drivers held. Out: sentences. Never changes the mechanism.

use nalgebra::{DMatrix, DVector};

use crate::id::JointId;
use crate::model::{Carrier, Joint, Mechanism};

use super::case::Case;
use super::samples::{ClosedPositions, null_space};

/// Motions smaller than this share of the largest count as rest; rounding leaves 1e-12.
const REST: f64 = 1e-7;

/// Names every idle freedom.
pub fn idle_freedoms(case: &Case<'_>, positions: &ClosedPositions) -> Vec<String> {
    let mechanism = case.mechanism;
    let groups = groups(mechanism);
    if groups.is_empty() {
        return Vec::new();
    }
    let effect = Effect::new(case, positions);
    let mut sentences = Vec::new();
    for group in groups {
        let others: Vec<usize> = (0..mechanism.bodies.len()).filter(|b| !group.bodies.contains(b)).collect();
        let rows: Vec<usize> = others.iter().flat_map(|b| effect.rows_of(mechanism, *b)).collect();
        let count = effect.resting(&rows);
        if count > 0 {
            sentences.push(group.sentence(mechanism));
        }
    }
    sentences
}

/// Bodies joined by anything but ball joints, held by two ball joints or more.
struct Group {
    bodies: Vec<usize>,
    ball_joints: Vec<usize>,
}

impl Group {
    fn sentence(&self, mechanism: &Mechanism) -> String {
        let bodies: Vec<&str> = self.bodies.iter().map(|b| mechanism.bodies[*b].name.as_str()).collect();
        let joints: Vec<&str> = self.ball_joints.iter().map(|j| mechanism.joints[*j].name.as_str()).collect();
        let verb = if bodies.len() == 1 { "spins" } else { "spin together" };
        format!("{} {verb} freely about the line through {}", bodies.join(" and "), joints.join(" and "))
    }
}

/// Whether the joint holds a point of its child, and nothing but that. A ball that clearance lets move holds nothing.
fn is_ball(joint: &Joint) -> bool {
    joint.model.turns_freely() && !joint.model.is_free() && joint.clearance.is_none()
}

fn groups(mechanism: &Mechanism) -> Vec<Group> {
    let count = mechanism.bodies.len();
    // Ground is the last entry.
    let mut label: Vec<usize> = (0..=count).collect();
    let place = |carrier: Carrier| match carrier {
        Carrier::Ground => count,
        Carrier::Body(body) => body.index(),
    };
    for joint in &mechanism.joints {
        if is_ball(joint) {
            continue;
        }
        let (a, b) = (label[place(joint.parent)], label[place(joint.child)]);
        for entry in &mut label {
            if *entry == a {
                *entry = b;
            }
        }
    }
    let mut groups = Vec::new();
    for first in 0..count {
        if label[first] == label[count] || label[..first].contains(&label[first]) {
            continue;
        }
        let bodies: Vec<usize> = (0..count).filter(|b| label[*b] == label[first]).collect();
        let touches = |carrier: Carrier| bodies.contains(&place(carrier));
        let ball_joints: Vec<usize> = (0..mechanism.joints.len())
            .filter(|j| {
                let joint = &mechanism.joints[*j];
                is_ball(joint) && touches(joint.parent) != touches(joint.child)
            })
            .collect();
        if ball_joints.len() >= 2 {
            groups.push(Group { bodies, ball_joints });
        }
    }
    groups
}

/// How output columns change with the freedoms that are left when the drivers hold still.
struct Effect {
    /// Columns: one per freedom; rows: one per channel.
    matrix: DMatrix<f64>,
    names: Vec<String>,
}

impl Effect {
    fn new(case: &Case<'_>, positions: &ClosedPositions) -> Self {
        let sizes = case.system.sizes();
        let start = &positions.positions[0];
        let driven: Vec<usize> = case.drivers().into_iter().map(|(_, speed)| speed).collect();
        let mut free = case.linkage.joint_speeds();
        free.retain(|speed| !driven.contains(speed));
        let freedoms = null_space(&start.jacobian.select_columns(&free));
        let observe = |v: &[f64]| DVector::from_vec(case.observe(&start.q, v, &vec![0.0; sizes.rows]));
        let still = observe(&vec![0.0; sizes.speeds]);
        let columns: Vec<DVector<f64>> = freedoms
            .column_iter()
            .map(|amounts| {
                let mut v = vec![0.0; sizes.speeds];
                for (speed, amount) in free.iter().zip(amounts.iter()) {
                    v[*speed] = *amount;
                }
                observe(&v) - &still
            })
            .collect();
        let matrix = DMatrix::from_fn(sizes.channels, columns.len(), |i, j| columns[j][i]);
        let names = case.description.channels.iter().map(|channel| channel.name.to_string()).collect();
        Self { matrix, names }
    }

    /// Channels that tell whether a body moves: its angular velocity and its joints' points.
    fn rows_of(&self, mechanism: &Mechanism, body: usize) -> Vec<usize> {
        let mut wanted: Vec<String> =
            ["wx", "wy", "wz"].iter().map(|c| format!("{}.{c}", mechanism.bodies[body].name)).collect();
        for index in 0..mechanism.joints.len() {
            let joint = mechanism.joint(JointId::new(index));
            let own = |carrier: Carrier| matches!(carrier, Carrier::Body(b) if b.index() == body);
            if own(joint.parent) || own(joint.child) {
                let point = &mechanism.point(joint.at).name;
                wanted.extend(["vx", "vy", "vz"].iter().map(|c| format!("{point}.{c}")));
            }
        }
        (0..self.names.len()).filter(|i| wanted.contains(&self.names[*i])).collect()
    }

    /// Number of independent freedoms that leave all the given channels at rest.
    fn resting(&self, rows: &[usize]) -> usize {
        let freedoms = self.matrix.ncols();
        let chosen = DMatrix::from_fn(rows.len().max(1), freedoms, |i, j| {
            rows.get(i).map_or(0.0, |row| self.matrix[(*row, j)])
        });
        if freedoms == 0 {
            return 0;
        }
        let values = chosen.singular_values();
        let moving = values.iter().filter(|value| **value > REST).count();
        freedoms - moving
    }
}
