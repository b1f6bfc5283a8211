//! Start values of joints with clearance between two moving bodies: they are those of the ideal joint.

mod simulated;

use linkwear_codegen::diagnostic::Label;
use linkwear_runtime::{Integrator, Settings, Span};
use simulated::{compiled, refused, run_with};

/// A body on another that a drive turns about the vertical; the joint between them, its start and its clearance.
fn turning(joint: &str, start: &str, clearance: &str) -> String {
    format!(
        r#"gravity = [0, 0, "-9.81 m/s^2"]
[points]
O = [0, 0, 0]
C = {{ at = [0, 0, "-0.1 m"], on = "body" }}
P = {{ at = ["1 m", 0, "-0.1 m"], on = "body" }}
Q = {{ at = [0, "1 m", "-0.1 m"], on = "body" }}
[bodies]
base = {{ mass = "1 kg", centre = "O", inertia = ["0.01 kg m^2", "0.01 kg m^2", "0.01 kg m^2"] }}
body = {{ mass = "5 kg", centre = "C", inertia = ["0.01 kg m^2", "0.012 kg m^2", "0.015 kg m^2"] }}
[joints]
D = {{ revolute = ["ground", "base"], at = "O", axis = [0, 0, 1], drive = "0.4 rad + 2 rad/s*t" }}
S = {{ {joint}, at = "O" }}
[initial]
S = {start}
{clearance}
"#
    )
}

/// The body's x and y axis in the ground frame at the start, and its angular velocity [rad/s].
fn start(text: &str) -> Vec<f64> {
    let integrator = Integrator::Dopri5 { tolerance: 1e-8, max_step: None };
    let run = run_with(text, &Settings::new(integrator, Span::Time(1e-6), 2));
    let first = |name: &str| run.column(name).expect(name)[0];
    let axis = |point: &str, along: &str| first(&format!("{point}.{along}")) - first(&format!("C.{along}"));
    let axes = ["P", "Q"].map(|point| ["x", "y", "z"].map(|along| axis(point, along)));
    let turning = ["body.wx", "body.wy", "body.wz"].map(first);
    [axes.concat(), turning.to_vec()].concat()
}

/// Kind, further keys, what its clearance needs besides, and start values.
const JOINTS: &[(&str, &str, &str, &str)] = &[
    ("spherical", "", "", r#"["5 deg", "-10 deg", "20 deg"]"#),
    ("spherical", "", "", r#"{ q1 = "30 deg", v1 = "1 rad/s", v2 = "-2 rad/s", v3 = "3 rad/s" }"#),
    ("universal", "axes = [[1, 0, 0], [0, 1, 0]]", "", r#"{ q1 = "10 deg", v2 = "1 rad/s" }"#),
    ("revolute", "axis = [1, 0, 0]", "length = \"20 mm\"", r#"{ q = "10 deg", v = "1 rad/s" }"#),
    (
        "cylindrical",
        r#"axis = [1, 0, 0], spring = { q2 = { stiffness = "1e4 N/m" } }"#,
        "length = \"50 mm\"\nends = \"bearing\"",
        r#"{ q1 = "10 deg", v1 = "1 rad/s" }"#,
    ),
];

#[test]
fn a_loose_joint_between_bodies_starts_as_the_ideal_one() {
    for (kind, keys, more, values) in JOINTS {
        for bodies in [r#"["base", "body"]"#, r#"["body", "base"]"#] {
            let keys = if keys.is_empty() { String::new() } else { format!(", {keys}") };
            let joint = format!("{kind} = {bodies}{keys}");
            let clearance = format!(
                "[clearance.S]\nradial = \"50 um\"\njournal_radius = \"10 mm\"\nmodulus = \"100 GPa\"\nrestitution = 0.5\n{more}"
            );
            let [loose, ideal] = ["", &clearance].map(|clearance| start(&turning(&joint, values, clearance)));
            // Where the load presses the journal turns nothing, but for one that tilts: by its play over half its length.
            let tilt = if *kind == "cylindrical" { 0.1 / 25.0 } else { 0.0 };
            // A length of a metre to rounding, and a rate of some rad/s times the tilt.
            let allowed = 1e-12 + 5.0 * tilt;
            for (at, (loose, ideal)) in loose.iter().zip(&ideal).enumerate() {
                assert!((loose - ideal).abs() < allowed, "{joint}, {values}, {at}: {loose} is not {ideal}");
            }
        }
    }
}

#[test]
fn a_loose_ball_hangs_by_a_joint_as_the_ideal_one() {
    let clearance = "[clearance.S]\nradial = \"50 um\"\njournal_radius = \"10 mm\"\nmodulus = \"100 GPa\"";
    let [loose, ideal] = [clearance, ""].map(|clearance| {
        let text = turning("spherical = [\"base\", \"body\"]", "{ v1 = \"1 rad/s\" }", clearance);
        let warnings = compiled(&text).warnings;
        warnings
            .into_iter()
            .find(|warning| warning.code.as_str() == "W0115")
            .expect("two freedoms have no start")
            .labels
    });
    let texts = |labels: Vec<Label>| labels.into_iter().map(|label| label.text).collect::<Vec<_>>();
    assert_eq!(texts(loose), texts(ideal));
}

#[test]
fn a_free_joint_between_bodies_takes_none() {
    let text = turning("free = [\"base\", \"body\"]", "{ v1 = \"1 rad/s\" }", "");
    assert!(refused(&text).contains("is between two bodies, and has start values"));
}
