//! The oracle against the closed-form RSSR four-bar in tests/reference (see its README).

mod sketch;

use linkwear_codegen::id::{BodyId, JointId, PointId};
use linkwear_codegen::model::{Amount, Body, Carrier, Inertia, JointModel, Passive, Position, Start};
use linkwear_codegen::source::Span;
use linkwear_oracle::{BodyState, Oracle, Tolerance};
use nalgebra::Vector3;
use sketch::{Sketch, axis, law, number};

const L1: f64 = 0.12;
const L2: f64 = 0.42;
const L3: f64 = 0.26;
const P4: [f64; 3] = [0.35, 0.05, -0.3];

/// The case study: steel rods of radius 6 mm, damper in R4, friction in both balls; branches described open.
fn rssr(turns_per_second: f64) -> Oracle {
    let mut s = Sketch::new([0.0, 0.0, -9.81]);
    let [crank, coupler, rocker] = [0, 1, 2].map(|k| Carrier::Body(BodyId::new(k)));
    let o = s.point([0.0; 3]);
    let a = s.point([L1, 0.0, 0.0]);
    let p4 = s.point(P4);
    let b = s.point([L1 + L2, 0.0, 0.0]);
    let tip = [P4[0] + L3, P4[1], P4[2]];
    s.0.points[b.index()].position =
        Position::PerBody(vec![(coupler, [L1 + L2, 0.0, 0.0].map(number)), (rocker, tip.map(number))]);
    for (name, ends) in [("crank", [o, a]), ("coupler", [a, b]), ("rocker", [p4, b])] {
        let density = Amount::Density(number(7850.0));
        let inertia =
            Inertia::Rod { ends, radius: number(0.006), inner_radius: number(0.0), amount: density };
        s.0.bodies.push(Body { name: name.to_owned(), inertia, flexible: None, span: Span::default() });
    }
    let mut joint = |kind, parent, child, at: PointId| {
        let id = s.joint(kind, parent, child, [0.0; 3]);
        s.0.joints[id.index()].at = at;
        id
    };
    let r1 = joint(JointModel::new("revolute", &[axis([0.0, 0.0, 1.0])]), Carrier::Ground, crank, o);
    let s2 = joint(JointModel::new("spherical", &[]), crank, coupler, a);
    let r4 = joint(JointModel::new("revolute", &[axis([0.0, 1.0, 0.0])]), Carrier::Ground, rocker, p4);
    let s3 = joint(JointModel::new("spherical", &[]), coupler, rocker, b);
    s.drive(r1, 0, law(0.0, std::f64::consts::TAU * turns_per_second, 0.0));
    s.passive(r4, Passive::Damping { coordinate: 0, coefficient: number(2.0) });
    for ball in [s2, s3] {
        s.passive(ball, Passive::Damping { coordinate: 0, coefficient: number(1e-4) });
    }
    s.0.starts.push(Start {
        joint: r4,
        coordinate: 0,
        position: Some(number(-48_f64.to_radians())),
        speed: None,
        held: false,
        span: Span::default(),
    });
    Oracle::with_defaults(&s.0).expect("a sound sketch")
}

struct Table {
    names: Vec<String>,
    rows: Vec<Vec<f64>>,
}

impl Table {
    fn read(file: &str) -> Self {
        let path = format!("{}/../tests/reference/rssr/{file}", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(path).expect("a reference file of this repository");
        let mut lines = text.lines();
        let names = lines.next().expect("a header").split(',').map(str::to_owned).collect();
        let number = |cell: &str| cell.parse::<f64>().expect("a number");
        Self { names, rows: lines.map(|line| line.split(',').map(number).collect()).collect() }
    }

    fn column(&self, name: &str) -> Vec<f64> {
        let at = self.names.iter().position(|n| n == name).expect("a column of the file");
        self.rows.iter().map(|row| row[at]).collect()
    }

    /// Largest difference to `values`, as a share of the column's largest magnitude.
    fn error(&self, name: &str, values: &[f64]) -> f64 {
        let column = self.column(name);
        let peak = column.iter().fold(0.0_f64, |top, x| top.max(x.abs()));
        column.iter().zip(values).fold(0.0_f64, |worst, (a, b)| worst.max((a - b).abs())) / peak
    }
}

fn compare(oracle: &Oracle, table: &Table) {
    let start = oracle.start().expect("the branch with the rocker at -48 degrees");
    let tolerance = Tolerance(1e-12);
    // The coupler's spin starts at rest and settles by friction: a time constant below 0.1 s.
    let settled = oracle.integrate(0.0, 2.0, &start, tolerance).expect("a smooth motion");
    let times: Vec<f64> = table.column("t").iter().map(|t| 2.0 + t).collect();
    let path = oracle.trajectory(&times, &settled, tolerance).expect("a smooth motion");
    let solutions: Vec<_> =
        times.iter().zip(&path).map(|(t, states)| oracle.accelerations(*t, states)).collect();
    let check = |name: &str, limit: f64, value: &dyn Fn(usize, &[BodyState]) -> f64| {
        let values: Vec<f64> = path.iter().enumerate().map(|(k, states)| value(k, states)).collect();
        let error = table.error(name, &values);
        assert!(error < limit, "{name}: {error:.2e}");
    };
    let r4 = JointId::new(2);
    // The file prints 13 digits; positions near zero lose some to the peak.
    check("phi", 1e-11, &|_, s| oracle.joint_motion(r4, s).position[0]);
    check("phi_dot", 1e-11, &|_, s| oracle.joint_motion(r4, s).speed[0]);
    check("phi_ddot", 1e-11, &|k, _| solutions[k].alpha[2].y);
    check("Bx", 1e-11, &|_, s| oracle.joint_point(JointId::new(3), s).x);
    // Forces and the coupler's spin feel what is left of the start and 1e-12 per step.
    for (k, component) in ["x", "y", "z"].into_iter().enumerate() {
        check(&format!("om2{component}"), 1e-9, &|_, s| s[1].omega[k]);
        check(&format!("R1_F{component}"), 1e-9, &|i, _| solutions[i].wrenches[0].force[k]);
        check(&format!("S2_F{component}"), 1e-9, &|i, _| solutions[i].wrenches[1].force[k]);
        check(&format!("S3_F{component}"), 1e-9, &|i, _| -solutions[i].wrenches[3].force[k]);
        check(&format!("R4_F{component}"), 1e-9, &|i, _| solutions[i].wrenches[2].force[k]);
    }
    check("T_drive", 1e-9, &|k, _| solutions[k].drives[0]);
    let moment = |k: usize, joint: usize| -> Vector3<f64> { solutions[k].wrenches[joint].moment };
    check("R1_Mx", 1e-9, &|k, _| moment(k, 0).x);
    check("R1_My", 1e-9, &|k, _| moment(k, 0).y);
    check("R4_Mx", 1e-9, &|k, _| moment(k, 2).x);
    check("R4_Mz", 1e-9, &|k, _| moment(k, 2).z);
}

#[test]
fn rssr_at_two_turns_per_second_agrees_with_closed_forms() {
    compare(&rssr(2.0), &Table::read("rigid_2hz.csv"));
}

#[test]
fn rssr_at_ten_turns_per_second_agrees_with_closed_forms() {
    compare(&rssr(10.0), &Table::read("rigid_10hz.csv"));
}
