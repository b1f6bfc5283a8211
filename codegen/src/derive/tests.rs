//! The derivation on a mechanism built by hand, evaluated by the graph's own evaluator.

use linkwear_runtime::Entry;

use super::*;
use crate::id::{BodyId, JointId, PointId};
use crate::model::*;
use crate::source::Span;
use crate::spec::Dimension;

fn f(value: f64) -> Formula {
    Formula::number(value, Dimension::default())
}

fn point(name: &str, at: [f64; 3]) -> Point {
    let position = Position::Shared(at.map(f));
    Point { name: name.into(), position, carrier: Carrier::Ground, assumed: false, span: Span::default() }
}

fn rod(name: &str, a: usize, b: usize) -> Body {
    let inertia = Inertia::Rod {
        ends: [PointId::new(a), PointId::new(b)],
        radius: f(0.006),
        inner_radius: f(0.0),
        amount: Amount::Density(f(7850.0)),
    };
    Body { name: name.into(), inertia, flexible: None, span: Span::default() }
}

fn joint(name: &str, model: JointModel, parent: Carrier, child: usize, at: usize) -> Joint {
    Joint {
        name: name.into(),
        model,
        parent,
        child: Carrier::Body(BodyId::new(child)),
        at: PointId::new(at),
        cut: false,
        drives: Vec::new(),
        passive: Vec::new(),
        clearance: None,
        surface: None,
        span: Span::default(),
    }
}

fn damping(coefficient: f64) -> Passive {
    Passive::Damping { coordinate: 0, coefficient: f(coefficient) }
}

/// RSSR four-bar of the case study: crank, coupler, rocker.
fn rssr(closure: Closure) -> (Mechanism, Topology) {
    let body = |i: usize| Carrier::Body(BodyId::new(i));
    let axis = |a: [f64; 3]| Axis { parent: a, child: a };
    let mut b = point("B", [0.0; 3]);
    b.position =
        Position::PerBody(vec![(body(1), [0.54, 0.0, 0.0].map(f)), (body(2), [0.61, 0.05, -0.3].map(f))]);
    b.carrier = body(1);
    let mut a = point("A", [0.12, 0.0, 0.0]);
    a.carrier = body(0);
    let mut r1 = joint("R1", JointModel::new("revolute", &[axis([0.0, 0.0, 1.0])]), Carrier::Ground, 0, 0);
    let law = Term::Mul(Box::new(Term::Number(4.0 * std::f64::consts::PI)), Box::new(Term::Time));
    r1.drives.push(Drive { coordinate: 0, law: Formula { term: law, ..f(0.0) } });
    let mut s2 = joint("S2", JointModel::new("spherical", &[]), body(0), 1, 1);
    s2.passive.push(damping(1e-4));
    let mut r4 = joint("R4", JointModel::new("revolute", &[axis([0.0, 1.0, 0.0])]), Carrier::Ground, 2, 2);
    r4.passive.push(damping(2.0));
    let mut s3 = joint("S3", JointModel::new("spherical", &[]), body(1), 2, 3);
    s3.passive.push(damping(1e-4));
    let start = Start {
        joint: JointId::new(2),
        coordinate: 0,
        position: Some(f(-0.84)),
        speed: None,
        held: false,
        span: Span::default(),
    };
    let mechanism = Mechanism {
        name: "rssr".into(),
        parameters: Vec::new(),
        gravity: [0.0, 0.0, -9.81].map(f),
        bodies: vec![rod("crank", 0, 1), rod("coupler", 1, 3), rod("rocker", 2, 3)],
        points: vec![point("O", [0.0; 3]), a, point("P4", [0.35, 0.05, -0.3]), b],
        joints: vec![r1, s2, r4, s3],
        couplings: Vec::new(),
        stops: Vec::new(),
        forces: Vec::new(),
        states: Vec::new(),
        samplers: Vec::new(),
        sensors: Vec::new(),
        missions: Vec::new(),
        closure,
        allowed: Vec::new(),
        starts: vec![start],
        attached: Vec::new(),
        sources: crate::source::Sources::default(),
    };
    let tree = |joint: usize, inboard, outboard| TreeJoint {
        joint: JointId::new(joint),
        inboard,
        outboard: BodyId::new(outboard),
        reversed: false,
    };
    let topology = Topology {
        tree: vec![tree(0, Carrier::Ground, 0), tree(2, Carrier::Ground, 2), tree(1, body(0), 1)],
        cuts: vec![JointId::new(3)],
        rows_in_ground: false,
        rows_off_balls: false,
    };
    (mechanism, topology)
}

/// Evaluates one function for a flat input.
fn run(derived: &Derived, entry: Entry, input: &[f64]) -> Vec<Vec<f64>> {
    let (graph, function) = derived.equations.function(entry).unwrap();
    let mut symbols = vec![0.0; graph.uses(&[]).len()];
    let names: Vec<_> = function.inputs.iter().flat_map(|block| block.entries.iter()).collect();
    assert_eq!(names.len(), input.len());
    for (id, value) in names.into_iter().zip(input) {
        symbols[graph.as_symbol(*id).unwrap().index()] = *value;
    }
    let values = graph.evaluate_all(&symbols);
    function.outputs.iter().map(|block| block.entries.iter().map(|id| values[id.index()]).collect()).collect()
}

fn channel(derived: &Derived, values: &[f64], name: &str) -> f64 {
    values[derived.description.channels.iter().position(|c| c.name == name).expect(name)]
}

#[test]
fn rssr_at_the_start_moves_as_the_independent_solution_and_both_closures_have_its_forces() {
    let mut known: Option<Vec<f64>> = None;
    for closure in [Closure::Joint, Closure::Log] {
        let (mechanism, topology) = rssr(closure);
        let derived = derive(&mechanism, &topology, None, Purpose::Run);
        let (nq, nv, m) = (derived.sizes.coordinates, derived.sizes.speeds, derived.sizes.rows);
        let start = run(&derived, Entry::Start, &[0.0]);
        let mut q = start[0].clone();
        let mut v = vec![0.0; nv];
        let state = |q: &[f64], v: &[f64]| [&[0.0], q, v].concat();
        let jacobian = |values: &[f64]| nalgebra::DMatrix::from_row_slice(m, nv, values);
        for _ in 0..30 {
            let out = run(&derived, Entry::Closure, &state(&q, &v));
            let phi = nalgebra::DVector::from_column_slice(&out[0]);
            if phi.amax() < 1e-14 {
                break;
            }
            let step = jacobian(&out[2]).svd(true, true).solve(&-phi, 1e-12).unwrap();
            let rates = run(&derived, Entry::Rates, &[state(&q, step.as_slice()), vec![0.0]].concat());
            for i in 0..nq {
                q[i] += rates[0][i];
            }
            for first in derived.description.quaternions.iter() {
                let norm = q[*first..first + 4].iter().map(|x| x * x).sum::<f64>().sqrt();
                q[*first..first + 4].iter_mut().for_each(|x| *x /= norm);
            }
        }
        let out = run(&derived, Entry::Closure, &state(&q, &v));
        assert!(out[0].iter().all(|x| x.abs() < 1e-13), "{closure:?}: not closed {:?}", out[0]);
        let rates = nalgebra::DVector::from_column_slice(&out[1]);
        let step = jacobian(&out[2]).svd(true, true).solve(&-rates, 1e-12).unwrap();
        v.copy_from_slice(step.as_slice());
        let forward = run(&derived, Entry::ForwardDynamics, &state(&q, &v));
        let input = [state(&q, &v), forward[0].clone(), forward[1].clone(), forward[2].clone()].concat();
        let channels = &run(&derived, Entry::Observe, &input)[0];
        // Thirteen digits are given.
        for (name, expected) in
            [("R4.q", -0.841367928986), ("R4.v", 0.7807881280214), ("R4.a", -102.7996573292)]
        {
            let value = channel(&derived, channels, name);
            assert!((value / expected - 1.0).abs() < 1e-12, "{closure:?} {name}: {value}, not {expected}");
        }
        // The forces themselves are held against another solution in `tests/rssr_reference.rs`.
        let forces = ["R1.Fx", "R1.Fy", "R1.Fz", "R1.Mx", "R1.drive", "R4.Mz", "S2.Fx", "S3.Fz"];
        let forces = forces.map(|name| channel(&derived, channels, name)).to_vec();
        if let Some(known) = &known {
            let differences = forces.iter().zip(known).map(|(a, b)| (a - b).abs());
            // Rounding of forces of some newtons by the condition of the loops.
            assert!(differences.fold(0.0, f64::max) < 1e-12, "{forces:?}, not {known:?}");
        }
        known = Some(forces);
    }
}

/// N four-bar: N + 1 uprights on the ground, N couplers between their tops.
fn n_four_bar(n: usize) -> (Mechanism, Topology) {
    let body = |i: usize| Carrier::Body(BodyId::new(i));
    let z = Axis { parent: [0.0, 0.0, 1.0], child: [0.0, 0.0, 1.0] };
    let mut points = Vec::new();
    let mut bodies = Vec::new();
    let mut joints = Vec::new();
    let mut tree = Vec::new();
    let mut cuts = Vec::new();
    for i in 0..=n {
        points.push(point(&format!("A{i}"), [i as f64, 0.0, 0.0]));
        points.push(point(&format!("B{i}"), [i as f64, 1.0, 0.0]));
        bodies.push(rod(&format!("u{i}"), 2 * i, 2 * i + 1));
        joints.push(joint(&format!("G{i}"), JointModel::new("revolute", &[z]), Carrier::Ground, i, 2 * i));
        tree.push(TreeJoint {
            joint: JointId::new(i),
            inboard: Carrier::Ground,
            outboard: BodyId::new(i),
            reversed: false,
        });
    }
    for i in 0..n {
        bodies.push(rod(&format!("c{i}"), 2 * i + 1, 2 * i + 3));
        let id = joints.len();
        joints.push(joint(
            &format!("L{i}"),
            JointModel::new("revolute", &[z]),
            body(i),
            n + 1 + i,
            2 * i + 1,
        ));
        tree.push(TreeJoint {
            joint: JointId::new(id),
            inboard: body(i),
            outboard: BodyId::new(n + 1 + i),
            reversed: false,
        });
        joints.push(joint(
            &format!("R{i}"),
            JointModel::new("revolute", &[z]),
            body(n + 1 + i),
            i + 1,
            2 * i + 3,
        ));
        cuts.push(JointId::new(id + 1));
    }
    let mechanism = Mechanism {
        name: "n".into(),
        parameters: Vec::new(),
        gravity: [0.0, -9.81, 0.0].map(f),
        bodies,
        points,
        joints,
        couplings: Vec::new(),
        stops: Vec::new(),
        forces: Vec::new(),
        states: Vec::new(),
        samplers: Vec::new(),
        sensors: Vec::new(),
        missions: Vec::new(),
        closure: Closure::Joint,
        allowed: Vec::new(),
        starts: Vec::new(),
        attached: Vec::new(),
        sources: crate::source::Sources::default(),
    };
    (mechanism, Topology { tree, cuts, rows_in_ground: false, rows_off_balls: false })
}

fn live_operations(derived: &Derived, entry: Entry) -> usize {
    let (graph, function) = derived.equations.function(entry).unwrap();
    let mut live = std::collections::HashSet::new();
    let mut stack: Vec<_> = function.outputs.iter().flat_map(|b| b.entries.clone()).collect();
    let mut count = 0;
    while let Some(id) = stack.pop() {
        if !live.insert(id) {
            continue;
        }
        match graph.node(id) {
            crate::expr::Node::Unary(_, a) => {
                stack.push(a);
                count += 1;
            }
            crate::expr::Node::Binary(_, a, b) => {
                stack.extend([a, b]);
                count += 1;
            }
            _ => {}
        }
    }
    count
}

#[test]
fn operations_of_the_n_four_bar_grow_no_faster_than_n_to_the_1_3() {
    let mut counts = Vec::new();
    for n in [2, 10, 40] {
        let (mechanism, topology) = n_four_bar(n);
        // Of the five rows of every cut revolute the two in the plane are kept.
        let keep: Vec<bool> = (0..5 * n).map(|row| row % 5 < 2).collect();
        let guide = Guide { keep, ..Guide::default() };
        let derived = derive(&mechanism, &topology, Some(&guide), Purpose::Run);
        counts.push(live_operations(&derived, Entry::ForwardDynamics) as f64);
    }
    let exponent = (counts[2] / counts[0]).ln() / 20.0_f64.ln();
    assert!(exponent < 1.3, "operations {counts:?}");
}
