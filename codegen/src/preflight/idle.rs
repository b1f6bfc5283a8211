//! Idle freedoms: a group of bodies between ball joints that can spin while everything else rests.
//! In: null space of the loops with drivers held. Out: sentences. Never changes the mechanism.

use linkwear_runtime::Layout;
use nalgebra::{DMatrix, DVector};

use crate::model::{Carrier, Joint, Mechanism};

use super::case::Case;
use super::samples::ClosedPositions;
use super::subspace::{null_space, right_singular_vectors};

/// Motions smaller than this share of the largest count as rest; rounding leaves 1e-12.
const REST: f64 = 1e-7;

/// A power below this share of what the forces of the whole mechanism could do is none; rounding leaves 1e-14.
const UNLOADED: f64 = 1e-9;

/// Angles [rad] at which a spin is asked for loads: a spring off the axis is at rest at two of any three at most.
const ANGLES: [f64; 3] = [0.0, 0.9, 2.1];

/// Names every idle freedom.
pub fn idle_freedoms(case: &Case<'_>, positions: &ClosedPositions) -> Vec<String> {
    let mechanism = case.mechanism;
    let groups = groups(mechanism);
    if groups.is_empty() {
        return Vec::new();
    }
    let effect = Effect::new(case, positions);
    let idle = groups.into_iter().filter(|group| {
        let spins = effect.resting(&group.resting_rows(case, &effect));
        spins.iter().any(|spin| !effect.loaded(case, spin))
    });
    idle.map(|group| group.sentence(mechanism)).collect()
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

    /// What rests while the group spins: all other bodies, its own balls, and its bodies among each other.
    fn resting_rows(&self, case: &Case<'_>, effect: &Effect) -> Vec<DVector<f64>> {
        let mechanism = case.mechanism;
        let turn = |body: usize| case.turn_channels(Carrier::Body(crate::id::BodyId::new(body)));
        let row = |channel: usize| effect.row(channel);
        let others = (0..mechanism.bodies.len()).filter(|body| !self.bodies.contains(body));
        let mut rows: Vec<_> = others.clone().filter_map(turn).flatten().map(row).collect();
        if let Some(first) = turn(self.bodies[0]) {
            let within = self.bodies[1..].iter().filter_map(|body| turn(*body));
            rows.extend(within.flat_map(|own| [0, 1, 2].map(|axis| row(own[axis]) - row(first[axis]))));
        }
        let of_others =
            |carrier: Carrier| matches!(carrier, Carrier::Body(body) if !self.bodies.contains(&body.index()));
        for (index, joint) in mechanism.joints.iter().enumerate() {
            if of_others(joint.parent) || of_others(joint.child) || self.ball_joints.contains(&index) {
                let point = &mechanism.point(joint.at).name;
                let velocity =
                    ["vx", "vy", "vz"].iter().filter_map(|c| case.channel(&format!("{point}.{c}")));
                rows.extend(velocity.map(row));
            }
        }
        rows
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
    /// Where: the assembled start.
    q: Vec<f64>,
    /// The speeds of each freedom, SI.
    freedoms: Vec<DVector<f64>>,
    /// Columns: one per freedom; rows: one per channel, in own units.
    matrix: DMatrix<f64>,
}

impl Effect {
    fn new(case: &Case<'_>, positions: &ClosedPositions) -> Self {
        let sizes = case.system.sizes();
        let start = &positions.positions[0];
        let driven: Vec<usize> = case.drivers().into_iter().map(|(_, speed)| speed).collect();
        let mut free = case.linkage.joint_speeds();
        free.retain(|speed| !driven.contains(speed));
        let freedoms: Vec<DVector<f64>> = null_space(&start.jacobian.select_columns(&free))
            .column_iter()
            .map(|amounts| DVector::from_vec(case.speeds_of(&free, amounts.iter())))
            .collect();
        let observe = |v: &[f64]| case.observe(&start.q, v, &vec![0.0; sizes.rows]);
        let still = observe(&vec![0.0; sizes.speeds]);
        let columns: Vec<Vec<f64>> = freedoms.iter().map(|v| observe(v.as_slice())).collect();
        let matrix = DMatrix::from_fn(sizes.channels, columns.len(), |i, j| {
            (columns[j][i] - still[i]) / case.units.channels[i]
        });
        Self { q: start.q.clone(), freedoms, matrix }
    }

    fn row(&self, channel: usize) -> DVector<f64> {
        self.matrix.row(channel).transpose()
    }

    /// Speeds of the independent motions that leave all the given rows at rest.
    fn resting(&self, rows: &[DVector<f64>]) -> Vec<DVector<f64>> {
        let count = self.freedoms.len();
        if count == 0 {
            return Vec::new();
        }
        let chosen = DMatrix::from_fn(rows.len(), count, |i, j| rows[i][j]);
        let (values, v_t) = right_singular_vectors(chosen);
        let still = (0..count).filter(|i| values[*i] <= REST);
        let speeds = |i: usize| {
            let mut v = DVector::zeros(self.freedoms[0].len());
            self.freedoms.iter().enumerate().for_each(|(j, freedom)| v += freedom * v_t[(i, j)]);
            v
        };
        still.map(speeds).collect()
    }

    /// Whether a spring, a weight or a force turns a body that spins to some angle. Friction only slows it down: where
    /// it ends stays open.
    fn loaded(&self, case: &Case<'_>, spin: &DVector<f64>) -> bool {
        let layout = Layout::new(&case.description.motions);
        let still = vec![0.0; spin.len()];
        let mut q = self.q.clone();
        let mut turned = 0.0;
        ANGLES.iter().any(|angle| {
            layout.advance(&mut q, (spin * (angle - turned)).as_slice());
            turned = *angle;
            let forces = case.resistance(0.0, &q, &still);
            let largest = forces.iter().fold(0.0_f64, |most, force| most.max(force.abs()));
            let amounts = spin.iter().zip(&case.units.speeds).map(|(speed, unit)| speed / unit);
            let power: f64 = amounts.zip(&forces).map(|(amount, force)| amount * force).sum();
            power.abs() > UNLOADED * largest
        })
    }
}
