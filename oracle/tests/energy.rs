//! Energy balance of the oracle: what is supplied, dissipated and stored adds up, for every joint kind
//! and force element.

mod sketch;

use linkwear_codegen::model::{Carrier, Force, Function, JointModel, Passive, Term};
use linkwear_oracle::{BodyState, Oracle};
use nalgebra::Vector3;
use sketch::{Sketch, axis, formula, law, number};

/// All joint kinds, oblique axes.
fn kinds() -> Vec<JointModel> {
    let main = axis([0.3, -0.5, 0.8]);
    vec![
        JointModel::new("revolute", &[main]),
        JointModel::new("prismatic", &[main]),
        JointModel::new("cylindrical", &[main]),
        JointModel { lead: 0.7, ..JointModel::new("screw", &[main]) },
        JointModel::new("universal", &[main, axis([0.9, 0.4, -0.2])]),
        JointModel::new("spherical", &[]),
        JointModel::new("inline", &[main]),
        JointModel::new("planar", &[main, axis([0.8, 0.0, -0.3])]),
        JointModel::new("fixed", &[]),
        JointModel::new("free", &[]),
    ]
}

/// Ground - spherical - body - `kind` - body, everything applied at once.
fn two_bodies(model: JointModel) -> Oracle {
    let mut s = Sketch::new([0.4, -9.0, 1.0]);
    let a = s.body(1.2, [0.2, -0.1, 0.3], [0.03, 0.05, 0.04]);
    let b = s.body(0.7, [0.6, 0.1, 0.2], [0.02, 0.01, 0.025]);
    let ball = s.joint(JointModel::new("spherical", &[]), Carrier::Ground, a, [0.0; 3]);
    s.passive(ball, Passive::Damping { coordinate: 0, coefficient: number(0.05) });
    let count = model.coordinates().len();
    let round = model.is_ball();
    let at = [0.4, 0.0, 0.25];
    let joint = s.joint(model, a, b, at);
    for k in 0..count {
        let k64 = k as f64;
        s.passive(joint, Passive::Damping { coordinate: k, coefficient: number(0.1 + 0.02 * k64) });
        let rest = number(0.1 * k64);
        s.passive(
            joint,
            Passive::Spring { coordinate: k, stiffness: number(3.0 + k64), rest, preload: number(0.3) },
        );
        s.passive(joint, Passive::Actuator { coordinate: k, force: law(0.2, 0.1, 0.3) });
    }
    if round {
        s.passive(joint, Passive::Damping { coordinate: 0, coefficient: number(0.1) });
    }
    let (p, q) = (s.point([0.3, 0.2, 0.1]), s.point([0.9, -0.2, 0.4]));
    s.force(Force::new("spring", [a, b], [p, q], [20.0, 0.4, 0.6, 1.5].map(number).to_vec()));
    let by_axis = [30.0, 12.0, 7.0, 0.3, 0.2, 0.4, 2.0, 0.7, 1.1, 0.03, 0.05, 0.02];
    let preload = [0.2, -0.1, 0.3, 0.02, 0.01, -0.03];
    // Matrices of stiffness and damping that couple the ways along and about the axes.
    let coupled = |size: f64| (0..36).map(move |at| if (at / 6) + (at % 6) == 5 { size } else { 0.0 });
    let values =
        by_axis.into_iter().chain(preload).chain(coupled(0.2)).chain(coupled(0.01)).map(number).collect();
    let directions = [[0.6, 0.8, 0.0], [-0.8, 0.6, 0.0], [0.0, 0.0, 1.0]];
    s.force(Force { directions, ..Force::new("bushing", [a, b], [p, p], values) });
    let speed = Term::PointSpeed(q, 1);
    let slowing = formula(Term::Neg(Box::new(Term::Call(Function::Tanh, vec![speed]))));
    let components = vec![law(0.5, 0.0, 1.0), slowing, number(0.3)];
    s.force(Force { axes: a, ..Force::new("force", [b, a], [q, q], components) });
    let components = vec![number(0.1), law(0.0, 0.0, 0.2), number(-0.1)];
    s.force(Force { axes: b, ..Force::new("torque", [a, b], [q, q], components) });
    Oracle::with_defaults(&s.0).expect("a sound sketch")
}

fn moving(oracle: &Oracle) -> Vec<BodyState> {
    let mut guess = oracle.reference_states();
    for (k, state) in guess.iter_mut().enumerate() {
        let k = k as f64;
        state.omega = Vector3::new(0.5 - k, 1.1, 0.3 + 0.4 * k);
        state.velocity = Vector3::new(0.2, -0.3 * k, 0.7);
    }
    oracle.assemble(0.0, &guess, &[]).expect("one joint in reach of the reference pose")
}

/// Power balance at one state: d/dt (T + V) by central difference along the motion.
fn imbalance(oracle: &Oracle, t: f64, states: &[BodyState]) -> f64 {
    let solution = oracle.accelerations(t, states);
    let shifted = |h: f64| -> Vec<BodyState> {
        let step = |(body, s): (usize, &BodyState)| {
            let (alpha, acceleration) = (solution.alpha[body], solution.acceleration[body]);
            let turn = h * s.omega + 0.5 * h * h * alpha;
            let rotation = nalgebra::Rotation3::from_scaled_axis(turn).into_inner() * s.rotation;
            BodyState {
                rotation,
                centre: s.centre + h * s.velocity + 0.5 * h * h * acceleration,
                omega: s.omega + h * alpha,
                velocity: s.velocity + h * acceleration,
            }
        };
        states.iter().enumerate().map(step).collect()
    };
    let energy = |h: f64| {
        let states = shifted(h);
        oracle.kinetic_energy(&states) + oracle.potential_energy(t, &states)
    };
    // Richardson's fourth-order difference: the shifted states lack jerk, an error of order h².
    let h = 1e-4;
    let slope = |h: f64| (energy(h) - energy(-h)) / (2.0 * h);
    (4.0 * slope(h) - slope(2.0 * h)) / 3.0 - (solution.power_supplied - solution.power_dissipated)
}

#[test]
fn power_is_balanced_for_every_joint_kind() {
    for kind in kinds() {
        let oracle = two_bodies(kind.clone());
        let states = moving(&oracle);
        assert!(oracle.power_dissipated(0.0, &states) > 0.0);
        // Difference of joules of order 10: rounding / h is 1e-11, h⁴ times fifth derivatives is less.
        let off = imbalance(&oracle, 0.3, &states);
        assert!(off.abs() < 1e-9, "{kind:?}: {off} W");
    }
}

#[test]
fn joints_move_as_drives_say_and_drives_pay_for_it() {
    for kind in kinds().into_iter().filter(|kind| !kind.coordinates().is_empty()) {
        let mut sketch = two_bodies(kind.clone()).mechanism;
        let count = kind.coordinates().len();
        for k in 0..count {
            let law = law(0.0, 0.3, 0.2 + 0.1 * k as f64);
            sketch.joints[1].drives.push(linkwear_codegen::model::Drive { coordinate: k, law });
        }
        let oracle = Oracle::with_defaults(&sketch).expect("a sound sketch");
        let states = moving(&oracle);
        let off = imbalance(&oracle, 0.0, &states);
        // As above.
        assert!(off.abs() < 1e-9, "{kind:?}: {off} W");
        let solution = oracle.accelerations(0.0, &states);
        assert_eq!(solution.drives.len(), count);
        assert_eq!(solution.rank, solution.rows, "{kind:?}");
    }
}

#[test]
fn conservative_motion_keeps_its_energy_along_a_trajectory() {
    let mut mechanism = two_bodies(kinds()[4].clone()).mechanism;
    for joint in &mut mechanism.joints {
        joint.passive.retain(|passive| matches!(passive, Passive::Spring { .. }));
    }
    mechanism.forces.clear();
    let oracle = Oracle::with_defaults(&mechanism).expect("a sound sketch");
    let start = moving(&oracle);
    let total = |t: f64, s: &[BodyState]| oracle.kinetic_energy(s) + oracle.potential_energy(t, s);
    let end = oracle.integrate(0.0, 1.0, &start, linkwear_oracle::Tolerance(1e-12)).expect("smooth");
    // 1e-12 per step, some ten steps, joules of order 10.
    assert!((total(1.0, &end) - total(0.0, &start)).abs() < 1e-9);
    assert!(oracle.constraint_residual(1.0, &end) < 1e-12);
    assert!(oracle.velocity_residual(1.0, &end) < 1e-10);
}
