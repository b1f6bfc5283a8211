//! What files mean: every joint kind and force element, formulas, repeated cells, spanning trees.

use linkwear_codegen::diagnostic::{Code, Diagnostics};
use linkwear_codegen::id::{BodyId, JointId, PointId};
use linkwear_codegen::input::Reach;
use linkwear_codegen::model::topology::spanning_tree;
use linkwear_codegen::model::{
    Amount, Axis, Carrier, Closure, Force, Function, Inertia, Joint, JointModel, Mechanism, Overrides,
    Passive, Position, Term, resolve,
};
use linkwear_codegen::source::SourceFile;
use linkwear_codegen::spec;

fn try_read(text: &str) -> Result<Mechanism, Diagnostics> {
    let text = format!("spec = 1\nname = \"test\"\ngravity = [0, 0, 0]\n{text}");
    let source = SourceFile { name: "test.toml".into(), text };
    Ok(resolve(&spec::parse(&source)?, &Overrides::default(), Reach::Below)?.0)
}

fn read(text: &str) -> Mechanism {
    try_read(text).unwrap_or_else(|errors| panic!("{errors}"))
}

fn joint<'a>(mechanism: &'a Mechanism, name: &str) -> &'a Joint {
    mechanism.joints.iter().find(|joint| joint.name == name).unwrap()
}

fn force<'a>(mechanism: &'a Mechanism, name: &str) -> &'a Force {
    mechanism.forces.iter().find(|force| force.name == name).unwrap()
}

fn body(index: usize) -> Carrier {
    Carrier::Body(BodyId::new(index))
}

fn both(direction: [f64; 3]) -> Axis {
    Axis { parent: direction, child: direction }
}

const X: [f64; 3] = [1.0, 0.0, 0.0];
const Y: [f64; 3] = [0.0, 1.0, 0.0];
const Z: [f64; 3] = [0.0, 0.0, 1.0];

/// Nine bodies `b1` to `b9`, each a ball at A, and a joint of every kind.
const ALL_JOINTS: &str = r#"
[parameters]
k = { value = "3 N m/rad", tunable = true }
pitch = "4 mm"

[points]
A = ["1 m", 0, 0]

[repeat.ball]
count = 9
bodies = { "b{i}" = { mass = "1 kg", centre = "A", inertia = ["1 kg m^2", "1 kg m^2", "1 kg m^2"] } }

[joints]
R = { revolute = ["ground", "b1"], at = "A", axis = [0, 0, 3], damping = "2 N m s", friction = "1 N m s", spring = { stiffness = "k", rest = "10 deg" }, force = "-k*sin(R.q) + 1 N m s*Y.v2" }
P = { prismatic = ["ground", "b2"], at = "A", axis = ["L", 0, "-L"], drive = "0.1 m*sin(3 rad/s*t)" }
C = { cylindrical = ["ground", "b3"], at = "A", axis = [0, 0, 1], damping = { q1 = "2 N m s", q2 = "3 N s/m" }, drive = { q2 = "1 mm/s*t" } }
H = { screw = ["b1", "b4"], at = "A", axis = [1, 0, 0], lead = "-pitch" }
Y = { universal = ["b2", "b5"], at = "A", axes = [[1, 0, 0], [0, 1, 0]], spring = { q2 = { stiffness = "k" } } }
S = { spherical = ["b3", "b6"], at = "A", damping = "1e-4 N m s/rad", cut = false }
E = { planar = ["ground", "b7"], at = "A", axis = [0, 0, 1], first = [1, 1, 5], force = { q3 = "-1 N m*E.v3/(1 rad/s)" } }
W = { fixed = ["b7", "b8"], at = "A" }
F = { free = ["ground", "b9"], at = "A" }

[initial]
R = "10 deg"
C = { q1 = "1 rad", v1 = "2 rad/s" }
S = ["0 deg", "0 deg", "30 deg"]
F = { v3 = "1 rad/s", q4 = "2 mm" }

[assembly]
E = ["1 mm", "2 mm", "3 deg"]
"#;

fn all_joints() -> Mechanism {
    read(&ALL_JOINTS.replace("[parameters]", "[parameters]\nL = \"2 m\""))
}

#[test]
fn every_joint_kind_is_read_with_unit_axes() {
    let m = all_joints();
    assert_eq!(joint(&m, "R").model, JointModel::new("revolute", &[both(Z)]));
    let axis = joint(&m, "P").model.axes[0];
    let half = 0.5f64.sqrt();
    // One rounding in each of the norm and the division.
    assert!((axis.parent[0] - half).abs() < 2e-16 && (axis.parent[2] + half).abs() < 2e-16);
    assert_eq!(joint(&m, "C").model, JointModel::new("cylindrical", &[both(Z)]));
    assert_eq!(joint(&m, "H").model, JointModel { lead: -0.004, ..JointModel::new("screw", &[both(X)]) });
    assert_eq!(joint(&m, "Y").model, JointModel::new("universal", &[both(X), both(Y)]));
    assert_eq!(joint(&m, "S").model, JointModel::new("spherical", &[]));
    let [normal, first] = joint(&m, "E").model.axes[..] else { panic!() };
    assert_eq!(normal, both(Z));
    assert!(
        (first.parent[0] - half).abs() < 2e-16 && first.parent[2].abs() < 2e-16,
        "made to lie in the plane"
    );
    assert_eq!(joint(&m, "W").model, JointModel::new("fixed", &[]));
    assert_eq!(joint(&m, "F").model, JointModel::new("free", &[]));
    assert_eq!((joint(&m, "H").parent, joint(&m, "H").child), (body(0), body(3)));
    assert!(m.joints.iter().all(|joint| joint.at == PointId::new(0) && !joint.cut));
}

#[test]
fn passive_elements_and_drives_belong_to_coordinates() {
    let m = all_joints();
    let values = m.parameter_values();
    let damping = |name: &str| -> Vec<(usize, f64)> {
        let damping = joint(&m, name).passive.iter().filter_map(|passive| match passive {
            Passive::Damping { coordinate, coefficient } => {
                Some((*coordinate, coefficient.value(&values).unwrap()))
            }
            _ => None,
        });
        damping.collect()
    };
    assert_eq!(damping("R"), [(0, 2.0), (0, 1.0)]);
    assert_eq!(damping("C"), [(0, 2.0), (1, 3.0)]);
    assert_eq!(damping("S"), [(0, 1e-4)]);
    let Passive::Spring { coordinate: 0, stiffness, rest, .. } = &joint(&m, "R").passive[2] else { panic!() };
    assert!(stiffness.depends_on(&|id| m.parameter(id).tunable));
    assert_eq!(rest.value(&values), Some(10.0 * std::f64::consts::PI / 180.0));
    assert!(matches!(&joint(&m, "Y").passive[0], Passive::Spring { coordinate: 1, .. }));
    let drives = &joint(&m, "C").drives;
    assert_eq!((drives.len(), drives[0].coordinate), (1, 1));
    assert_eq!(drives[0].law.value_at_time(&values, 2.0), Some(0.002));
}

#[test]
fn actuators_may_use_coordinates_and_speeds_of_any_joint() {
    let m = all_joints();
    let Passive::Actuator { coordinate: 0, force } = joint(&m, "R").passive.last().unwrap() else { panic!() };
    let mut found = Vec::new();
    force.term.visit(&mut |term| match term {
        Term::JointPosition(id, at) => found.push(('q', id.index(), *at)),
        Term::JointSpeed(id, at) => found.push(('v', id.index(), *at)),
        _ => {}
    });
    assert_eq!(found, [('q', 0, 0), ('v', 4, 1)]);
    assert_eq!(force.value(&m.parameter_values()), None, "not known before the motion");
}

#[test]
fn start_values_go_by_coordinate() {
    let m = all_joints();
    let values = m.parameter_values();
    let starts: Vec<_> = m
        .starts
        .iter()
        .map(|start| {
            let value = |formula: &Option<linkwear_codegen::model::Formula>| {
                formula.as_ref().map(|formula| formula.value(&values).unwrap())
            };
            let joint = m.joint(start.joint).name.as_str();
            (joint, start.coordinate, value(&start.position), value(&start.speed), start.held)
        })
        .collect();
    let deg = |x: f64| Some(x * std::f64::consts::PI / 180.0);
    assert_eq!(
        starts,
        [
            ("E", 0, Some(0.001), None, false),
            ("E", 1, Some(0.002), None, false),
            ("E", 2, deg(3.0), None, false),
            ("R", 0, deg(10.0), None, true),
            ("C", 0, Some(1.0), Some(2.0), true),
            ("S", 0, Some(0.0), None, true),
            ("S", 1, Some(0.0), None, true),
            ("S", 2, deg(30.0), None, true),
            ("F", 2, None, Some(1.0), true),
            ("F", 3, Some(0.002), None, true),
        ]
    );
}

#[test]
fn tree_of_all_joints_has_no_cut_and_starts_with_drives() {
    let m = all_joints();
    let topology = spanning_tree(&m).unwrap();
    let order: Vec<_> = topology.tree.iter().map(|step| m.joint(step.joint).name.as_str()).collect();
    assert!(topology.cuts.is_empty());
    // Driven (C, P), then with start values (by rows, then nearer to the ground), then by rows: W 6, H 5, Y 4.
    assert_eq!(order, ["C", "P", "R", "E", "S", "F", "W", "H", "Y"]);
}

const BAR: &str = r#"
[points]
O = [0, 0, 0]
A = ["1 m", 0, 0]
[bodies]
bar = { rod = ["O", "A"], radius = "5 mm", density = "7850 kg/m^3" }
[joints]
hinge = { revolute = ["ground", "bar"], at = "O", axis = [0, 0, 1] }
"#;

#[test]
fn force_elements_are_read_with_defaults() {
    let m = read(&format!(
        r#"{BAR}
[forces]
coil = {{ spring = ["ground", "bar"], at = ["O", "A"], stiffness = "5 N/mm", length = "20 cm" }}
push = {{ force = "bar", at = "A", components = ["1 N", 0, "-2 N*A.x/(1 m)"], axes = "bar" }}
turn = {{ torque = "bar", components = [0, 0, "1 N m*cos(2*pi*t*1 Hz)"] }}
"#
    ));
    let values = m.parameter_values();
    let coil = force(&m, "coil");
    assert_eq!((coil.bodies, coil.at), ([Carrier::Ground, body(0)], [PointId::new(0), PointId::new(1)]));
    let numbers = coil.numbers().map(|formula| formula.value(&values).unwrap());
    assert_eq!(numbers, [5000.0, 0.2, 0.0, 0.0]);
    let push = force(&m, "push");
    assert_eq!((push.kind.name, push.bodies, push.axes), ("force", [body(0), Carrier::Ground], body(0)));
    assert_eq!(push.formulas[0].value(&values), Some(1.0));
    let turn = force(&m, "turn");
    assert_eq!((turn.kind.name, turn.axes), ("torque", Carrier::Ground));
    let [components] = turn.triples();
    assert_eq!(components[2].value_at_time(&values, 0.5), Some(-1.0));
    let mut calls = 0;
    components[2].term.visit(&mut |term| calls += usize::from(matches!(term, Term::Call(Function::Cos, _))));
    assert_eq!(calls, 1);
}

#[test]
fn every_description_of_a_body_is_read() {
    let m = read(
        r#"
closure = "log"
[points]
O = [0, 0, 0]
A = ["1 m", 0, 0]
[bodies]
tube = { tube = ["O", "A"], radius = "5 mm", inner_radius = "4 mm", mass = "2 kg" }
beam = { box = ["O", "A"], width = ["5 mm", "8 mm"], width_axis = [3, 0, 4], density = "7850 kg/m^3" }
bar = { box = ["O", "A"], width = "5 mm", density = "7850 kg/m^3" }
lump = { mass = "1 kg", centre = ["1 m", "2 m", 0], inertia = ["1 kg m^2", "2 kg m^2", "3 kg m^2"], axes = [[0, 2, 0], [0, 0, 1]] }
dot = { mass = "1 kg", centre = "A" }
[joints]
J1 = { fixed = ["ground", "tube"], at = "O" }
J2 = { fixed = ["ground", "beam"], at = "O" }
J3 = { fixed = ["ground", "bar"], at = "O" }
J4 = { fixed = ["ground", "lump"], at = "O" }
J5 = { fixed = ["ground", "dot"], at = "O" }
"#,
    );
    assert_eq!(m.closure, Closure::Log);
    let values = m.parameter_values();
    let Inertia::Rod { inner_radius, amount: Amount::Mass(mass), .. } = &m.bodies[0].inertia else {
        panic!()
    };
    assert_eq!((inner_radius.value(&values), mass.value(&values)), (Some(0.004), Some(2.0)));
    let Inertia::Box { width_axis, .. } = &m.bodies[1].inertia else { panic!() };
    assert_eq!(*width_axis, Z, "made to be at right angles to the long edge");
    let Inertia::Box { width, width_axis, .. } = &m.bodies[2].inertia else { panic!() };
    assert_eq!(width[1].value(&values), Some(0.005));
    assert_eq!(width_axis[0], 0.0);
    let Inertia::Given { centre, axes, .. } = &m.bodies[3].inertia else { panic!() };
    // The x, y and z axis: as written, and their cross product.
    assert_eq!(*axes, [Y, Z, X]);
    let point = m.point(*centre);
    assert_eq!((point.name.as_str(), point.carrier), ("lump_centre", body(3)));
    let Inertia::Given { inertia, .. } = &m.bodies[4].inertia else { panic!() };
    assert!(inertia.iter().all(|entry| entry.value(&values) == Some(0.0)), "a point mass");
}

#[test]
fn parameters_follow_from_each_other_and_tunable_ones_stay_symbolic() {
    let m = read(
        r#"
[parameters]
double = "2*base"
fixed = "3*width"
base = { value = "10 mm", tunable = true }
width = "1 m"
[points]
O = [0, 0, 0]
A = ["fixed + double", 0, 0]
[bodies]
bar = { rod = ["O", "A"], radius = "base", density = "7850 kg/m^3" }
[joints]
hinge = { revolute = ["ground", "bar"], at = "O", axis = [0, 0, 1] }
"#,
    );
    let mut values = m.parameter_values();
    assert_eq!(values, [0.02, 3.0, 0.01, 1.0]);
    let Position::Shared([x, ..]) = &m.points[1].position else { panic!() };
    assert_eq!(x.value(&values), Some(3.02));
    // What follows from a tunable parameter is written out: changing it later changes the point.
    values[2] = 0.5;
    assert_eq!(x.value(&values), Some(4.0));
}

/// The N four-bar of the IFToMM benchmark A02, as cells.
const N_FOUR_BAR: &str = r#"
[parameters]
N = 40
I = "1/12 * 1 kg * (1 m)^2"
[points]
A0 = [0, 0, 0]
B0 = [0, "1 m", 0]
C0 = [0, "0.5 m", 0]
[bodies]
bar0 = { mass = "1 kg", centre = "C0", inertia = ["I", 0, "I"] }
[joints]
R0 = { revolute = ["ground", "bar0"], at = "A0", axis = [0, 0, 1] }
[repeat.cell]
count = "N"
[repeat.cell.points]
"A{i}" = ["{i} m", 0, 0]
"B{i}" = ["{i} m", "1 m", 0]
"C{i}" = ["{i} m", "0.5 m", 0]
"D{i}" = ["({2*i - 1}/2) * 1 m", "1 m", 0]
[repeat.cell.bodies]
"bar{i}" = { mass = "1 kg", centre = "C{i}", inertia = ["I", 0, "I"] }
"link{i}" = { mass = "1 kg", centre = "D{i}", inertia = [0, "I", "I"] }
[repeat.cell.joints]
"R{i}" = { revolute = ["ground", "bar{i}"], at = "A{i}", axis = [0, 0, 1] }
"P{i}" = { revolute = ["bar{i-1}", "link{i}"], at = "B{i-1}", axis = [0, 0, 1] }
"Q{i}" = { revolute = ["link{i}", "bar{i}"], at = "B{i}", axis = [0, 0, 1] }
"#;

#[test]
fn cells_are_repeated_with_their_index_in_names_and_numbers() {
    let m = read(N_FOUR_BAR);
    assert_eq!((m.bodies.len(), m.joints.len()), (81, 121));
    let values = m.parameter_values();
    let d7 = m.points.iter().find(|point| point.name == "D7").unwrap();
    assert_eq!(d7.position_for(Carrier::Ground)[0].value(&values), Some(6.5));
    assert_eq!(m.carrier_name(d7.carrier), "link7");
    assert_eq!(m.carrier_name(joint(&m, "P1").parent), "bar0");
    let topology = spanning_tree(&m).unwrap();
    let cuts: Vec<_> = topology.cuts.iter().map(|id| m.joint(*id).name.clone()).collect();
    let expected: Vec<_> = (1..=40).map(|i| format!("Q{i}")).collect();
    assert_eq!(cuts, expected, "one cut a cell, and short branches");
}

#[test]
fn a_fault_in_a_cell_is_reported_once_with_the_number_of_others() {
    let text = N_FOUR_BAR.replace("link{i}\", \"bar{i}\"]", "link{i}\", \"baz{i}\"]");
    let errors = try_read(&text).unwrap_err();
    assert_eq!(errors.list().len(), 1, "{errors}");
    assert_eq!(errors.list()[0].code, Code::UnknownName);
    assert!(errors.list()[0].help.iter().any(|help| help == "39 more cells have the same fault"));
}

/// Faults of several stages (keys, units, names, mechanics) come in one run.
#[test]
fn faults_of_all_stages_come_together() {
    let text =
        BAR.replace("radius", "radus").replace("\"1 m\"", "\"1 kg\"").replace("at = \"O\"", "at = \"P\"");
    let text = text.replace("axis = [0, 0, 1]", "axis = [0, 0, 0]");
    let codes: Vec<_> = try_read(&text).unwrap_err().list().iter().map(|d| d.code).collect();
    assert_eq!(codes, [Code::UnitMismatch, Code::UnknownKey, Code::UnknownName, Code::ZeroAxis]);
}

#[test]
fn tables_under_headers_are_read_as_inline_ones() {
    let headers = r#"
[points.O]
at = [0, 0, 0]
[points.A]
at = ["1 m", 0, 0]
[bodies.bar]
rod = ["O", "A"]
radius = "5 mm"
density = "7850 kg/m^3"
[joints.hinge]
revolute = ["ground", "bar"]
at = "O"
axis = [0, 0, 1]
[joints.hinge.spring]
stiffness = "1 N m"
"#;
    assert_eq!(read(headers).joints[0].passive.len(), 1);
    let errors = try_read(&headers.replace("radius", "radus").replace("axis", "axs")).unwrap_err();
    let codes: Vec<_> = errors.list().iter().map(|d| d.code).collect();
    assert_eq!(codes, [Code::UnknownKey, Code::UnknownKey], "what is missing is misspelt: {errors}");
}

/// A closed four-bar with joints as given: R1 at O, then the joints at A, B, D.
fn loop_with(joints: &str) -> Mechanism {
    read(&format!(
        r#"
[points]
O = [0, 0, 0]
A = ["1 m", 0, 0]
B = ["1 m", "1 m", 0]
D = [0, "1 m", 0]
[bodies]
crank = {{ rod = ["O", "A"], radius = "5 mm", mass = "1 kg" }}
coupler = {{ rod = ["A", "B"], radius = "5 mm", mass = "1 kg" }}
rocker = {{ rod = ["D", "B"], radius = "5 mm", mass = "1 kg" }}
[joints]
{joints}
"#
    ))
}

fn cut_of(mechanism: &Mechanism) -> Vec<&str> {
    let topology = spanning_tree(mechanism).unwrap();
    topology.cuts.iter().map(|id: &JointId| mechanism.joint(*id).name.as_str()).collect()
}

#[test]
fn the_cut_takes_few_rows() {
    let m = loop_with(
        r#"
R1 = { revolute = ["ground", "crank"], at = "O", axis = [0, 0, 1] }
S2 = { spherical = ["crank", "coupler"], at = "A" }
U3 = { universal = ["coupler", "rocker"], at = "B", axes = [[1, 0, 0], [0, 0, 1]] }
R4 = { revolute = ["ground", "rocker"], at = "D", axis = [0, 0, 1] }
"#,
    );
    assert_eq!(cut_of(&m), ["S2"]);
    let topology = spanning_tree(&m).unwrap();
    let last = topology.tree.last().unwrap();
    assert!(last.reversed, "U3 is met from its child, the rocker");
    assert_eq!((last.inboard, last.outboard), (body(2), BodyId::new(1)));
}

#[test]
fn among_equals_the_joint_with_a_spring_or_a_mention_stays_in_the_tree() {
    let plain = r#"
R1 = { revolute = ["ground", "crank"], at = "O", axis = [0, 0, 1] }
R2 = { revolute = ["crank", "coupler"], at = "A", axis = [0, 0, 1] }
R3 = { revolute = ["coupler", "rocker"], at = "B", axis = [0, 0, 1] }
R4 = { revolute = ["ground", "rocker"], at = "D", axis = [0, 0, 1] }
"#;
    assert_eq!(cut_of(&loop_with(plain)), ["R3"]);
    let at_b = "at = \"B\", axis = [0, 0, 1]";
    assert_eq!(cut_of(&loop_with(&plain.replace(at_b, &format!("{at_b}, damping = \"1 N m s\"")))), ["R2"]);
    let mentioned =
        format!("{plain}\n[forces]\nturn = {{ torque = \"crank\", components = [0, 0, \"1 N m*R3.q\"] }}");
    assert_eq!(cut_of(&loop_with(&mentioned)), ["R2"]);
    let started = format!("{plain}\n[initial]\nR3 = \"1 deg\"");
    assert_eq!(cut_of(&loop_with(&started)), ["R2"]);
    assert_eq!(cut_of(&loop_with(&plain.replace("at = \"O\"", "cut = true, at = \"O\""))), ["R1"]);
}

#[test]
fn an_axis_given_per_body_opens_the_loop() {
    let m = loop_with(
        r#"
R1 = { revolute = ["ground", "crank"], at = "O", axis = [0, 0, 1] }
R2 = { revolute = ["crank", "coupler"], at = "A", axis = { crank = [0, 0, 1], coupler = [0, 1, 0] } }
R3 = { revolute = ["coupler", "rocker"], at = "B", axis = [0, 0, 1] }
R4 = { revolute = ["ground", "rocker"], at = "D", axis = [0, 0, 1] }
"#,
    );
    assert_eq!(joint(&m, "R2").model, JointModel::new("revolute", &[Axis { parent: Z, child: Y }]));
    assert_eq!(cut_of(&m), ["R2"]);
}

#[test]
fn the_same_file_gives_the_same_mechanism_every_time() {
    let text = format!("{:?}", all_joints());
    assert_eq!(text, format!("{:?}", all_joints()));
}
