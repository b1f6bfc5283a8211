//! How beams are held unless the file says so: static deflections with few modes against closed forms of the theory of
//! Euler and Bernoulli.

mod simulated;

use std::f64::consts::PI;

use linkwear_codegen::compile::{Compiled, Options, compile};
use linkwear_runtime::{Integrator, Settings, Span};
use simulated::{at_end, compiled, run_with, source};

const LENGTH: f64 = 0.5;
const RADIUS: f64 = 5e-3;
const YOUNG: f64 = 210e9;
const DENSITY: f64 = 7850.0;
const GRAVITY: f64 = 9.81;
/// Bending stiffness [N m²].
const STIFFNESS: f64 = YOUNG * PI * RADIUS * RADIUS * RADIUS * RADIUS / 4.0;
/// Weight of the rod per length [N/m].
const WEIGHT: f64 = DENSITY * PI * RADIUS * RADIUS * GRAVITY;

/// What hangs on the tip [N].
const LOAD: f64 = 2.0 * GRAVITY;

/// A rod from O to A, or the other way, with `modes` bending modes, and joints.
fn beam(ends: &str, flexible: &str, rest: &str) -> String {
    format!(
        r#"gravity = [0, 0, "-9.81 m/s^2"]
[points]
O = [0, 0, 0]
A = ["0.5 m", 0, 0]
M = {{ at = ["0.25 m", 0, 0], on = "b" }}
[bodies]
b = {{ rod = {ends}, radius = "5 mm", density = "7850 kg/m^3", flexible = {{ young = "210 GPa", damping = 3, theory = "euler_bernoulli", {flexible} }} }}
{rest}
[sensors]
tip = "A.z"
middle = "M.z"
"#
    )
}

/// A mass of 2 kg that the end A carries by a weld, and the weld that holds O.
const LOADED: &str = r#"load = { mass = "2 kg", centre = "A", inertia = ["1e-4 kg m^2", "1e-4 kg m^2", "1e-4 kg m^2"] }
[joints]
wall = { fixed = ["ground", "b"], at = "O" }
grip = { fixed = ["b", "load"], at = "A" }"#;

/// Where a column comes to rest.
fn at_rest(text: &str, column: &str) -> f64 {
    // Loaded by its mass the link moves at some 6 Hz, with 0.15 of critical damping at least: e^-17 of its way is left.
    let integrator = Integrator::Rodas5P { tolerance: 1e-9, max_step: None };
    at_end(&run_with(text, &Settings::new(integrator, Span::Time(3.0), 2)), column)
}

fn assert_near(found: f64, exact: f64, relative: f64) {
    assert!((found / exact - 1.0).abs() < relative, "{found:e} is not {exact:e}");
}

/// Tip of a cantilever under a mass and its own weight.
fn loaded_sag() -> f64 {
    -(LOAD * LENGTH.powi(3) / 3.0 + WEIGHT * LENGTH.powi(4) / 8.0) / STIFFNESS
}

#[test]
fn a_welded_beam_that_carries_a_mass_sags_as_a_cantilever() {
    let both =
        [r#"["O", "A"]"#, r#"["A", "O"]"#].map(|ends| at_rest(&beam(ends, "modes = 4", LOADED), "tip.value"));
    // Of the compliance of the tip, 12/k⁴ for each mode, two modes in the plane leave 0.5 %, from k = 7.85 on.
    assert_near(both[0], loaded_sag(), 0.01);
    // Drawn from its free end it is the same beam: what is left is how near it is to rest.
    assert_near(both[1], both[0], 1e-6);
}

#[test]
fn a_beam_welded_at_its_second_end_sags_as_one_welded_at_its_first() {
    let wall = "[joints]\nwall = { fixed = [\"ground\", \"b\"], at = \"O\" }";
    let sag = at_rest(&beam(r#"["A", "O"]"#, "modes = 4", wall), "tip.value");
    // Uniform loads fall on higher modes like k⁻⁵: a thousandth.
    assert_near(sag, -WEIGHT * LENGTH.powi(4) / 8.0 / STIFFNESS, 2e-3);
}

#[test]
fn a_shaft_in_a_bearing_and_on_a_line_sags_as_clamped_and_pinned() {
    let joints = r#"[joints]
J = { revolute = ["ground", "b"], at = "O", axis = [1, 0, 0] }
K = { inline = ["ground", "b"], at = "A", axis = [1, 0, 0] }"#;
    let exact = -WEIGHT * LENGTH.powi(4) / 192.0 / STIFFNESS;
    // Cantilever modes come near the line at A by themselves like n⁻³; shapes that lie on it leave the third alone.
    for (flexible, relative) in
        [("modes = 4", 0.02), ("modes = 8", 0.01), ("modes = 4, held = \"craig_bampton\"", 0.01)]
    {
        for ends in [r#"["O", "A"]"#, r#"["A", "O"]"#] {
            for drive in ["", ", drive = \"1 rad*tanh(t/(0.1 s))\""] {
                let text = beam(
                    ends,
                    flexible,
                    &joints.replace("axis = [1, 0, 0] }\nK", &format!("axis = [1, 0, 0]{drive} }}\nK")),
                );
                let found = at_rest(&text, "middle.value");
                assert_near(found, exact, relative);
            }
        }
    }
}

#[test]
fn a_beam_held_in_two_bearings_sags_as_clamped_at_both_ends() {
    let joints = r#"[joints]
J = { fixed = ["ground", "b"], at = "O" }
K = { cylindrical = ["ground", "b"], at = "A", axis = [1, 0, 0] }"#;
    let exact = -WEIGHT * LENGTH.powi(4) / 384.0 / STIFFNESS;
    let found = at_rest(&beam(r#"["O", "A"]"#, "modes = 4", joints), "middle.value");
    // The first even mode: 1.3 % more, which the third takes back.
    assert_near(found, exact, 0.02);
}

#[test]
fn a_clamped_beam_on_a_support_takes_a_load_beyond_it_exactly() {
    let prop = "prop = { inline = [\"ground\", \"b\"], at = \"M\", axis = [1, 0, 0] }\ngrip =";
    let found = at_rest(&beam(r#"["O", "A"]"#, "modes = 4", &LOADED.replace("grip =", prop)), "tip.value");
    let (a, b) = (LENGTH / 2.0, LENGTH / 2.0);
    // What lies beyond the support turns it by its moment times a / 4 E I; the weight before it turns it back.
    let moment = LOAD * b + WEIGHT * b * b / 2.0;
    let sum = LOAD * b.powi(3) / 3.0 + WEIGHT * b.powi(4) / 8.0 + moment * a * b / 4.0
        - WEIGHT * a.powi(3) * b / 48.0;
    // Turns and deflections of all places have static shapes; the tip comes nearer to the wall as it sags, (w/L)².
    assert_near(found, -sum / STIFFNESS, 1e-4);
}

#[test]
fn a_clamped_beam_stretches_as_its_load_asks() {
    let text = beam(r#"["O", "A"]"#, "modes = 0, axial = 1", LOADED)
        .replace("[0, 0, \"-9.81 m/s^2\"]", "[\"9.81 m/s^2\", 0, 0]")
        .replace("tip = \"A.z\"", "tip = \"A.x - 0.5 m\"");
    let exact = (LOAD + WEIGHT * LENGTH / 2.0) * LENGTH / (YOUNG * PI * RADIUS * RADIUS);
    // The difference of half a metre and as much with less than a micrometre more: rounding.
    assert_near(at_rest(&text, "tip.value"), exact, 1e-8);
}

/// Wave number times length, squared, of the first mode.
const CLAMPED: f64 = 3.516_015_269;
const PINNED: f64 = PI * PI;
const FREE: f64 = 22.373_285_448;

/// The first frequency of the link `b` as a square of its wave number times its length.
fn first_square(of: &Compiled) -> f64 {
    let flexible = of.mechanism.bodies[0].flexible.as_ref().expect("it bends");
    let unit = (STIFFNESS / (WEIGHT / GRAVITY)).sqrt() / (LENGTH * LENGTH);
    flexible.data.modes[0].frequency * 2.0 * PI / unit
}

/// Joints at the ends O and A, of which `load` and `more` are further bodies, and the square of the wave number.
const HELD: &[(&str, &str, f64)] = &[
    (
        r#"revolute = ["ground", "b"], at = "O", axis = [0, 1, 0]"#,
        r#"spherical = ["b", "load"], at = "A""#,
        PINNED,
    ),
    (
        r#"revolute = ["ground", "b"], at = "O", axis = [0, 1, 0]"#,
        r#"revolute = ["b", "load"], at = "A", axis = [0, 1, 0]"#,
        PINNED,
    ),
    // What hangs on the tip follows it.
    (
        r#"revolute = ["ground", "b"], at = "O", axis = [0, 1, 0]"#,
        r#"fixed = ["b", "load"], at = "A""#,
        PINNED,
    ),
    (r#"spherical = ["ground", "b"], at = "O""#, r#"fixed = ["b", "load"], at = "A""#, PINNED),
    (
        r#"universal = ["ground", "b"], at = "O", axes = [[0, 1, 0], [0, 0, 1]]"#,
        r#"spherical = ["b", "load"], at = "A""#,
        PINNED,
    ),
    (
        r#"universal = ["ground", "b"], at = "O", axes = [[1, 0, 0], [0, 0, 1]]"#,
        r#"spherical = ["b", "load"], at = "A""#,
        PINNED,
    ),
    (
        r#"inline = ["ground", "b"], at = "O", axis = [1, 0, 0]"#,
        r#"spherical = ["b", "load"], at = "A""#,
        PINNED,
    ),
    // A drive holds its pin.
    (
        r#"revolute = ["ground", "b"], at = "O", axis = [0, 1, 0], drive = "1 rad/s*t""#,
        r#"spherical = ["b", "load"], at = "A""#,
        CLAMPED,
    ),
    (
        r#"revolute = ["ground", "b"], at = "O", axis = [1, 0, 0]"#,
        r#"spherical = ["b", "load"], at = "A""#,
        CLAMPED,
    ),
    (
        r#"prismatic = ["ground", "b"], at = "O", axis = [0, 1, 0]"#,
        r#"fixed = ["b", "load"], at = "A""#,
        CLAMPED,
    ),
    (
        r#"fixed = ["b", "ground"], at = "O""#,
        r#"revolute = ["load", "b"], at = "A", axis = [0, 1, 0]"#,
        CLAMPED,
    ),
    (r#"fixed = ["b", "load"], at = "O""#, r#"fixed = ["ground", "b"], at = "A""#, CLAMPED),
];

#[test]
fn moments_that_joints_pass_decide_how_a_link_is_held() {
    for (at_first, at_second, expected) in HELD {
        let rest = format!(
            "load = {{ mass = \"2 kg\", centre = \"A\", inertia = [\"1e-3 kg m^2\", \"1e-3 kg m^2\", \"1e-3 kg m^2\"] }}\n\
             [joints]\nJ = {{ {at_first} }}\nK = {{ {at_second} }}"
        );
        // Rounding of a dense eigenproblem; the numbers above have ten digits.
        assert_near(first_square(&compiled(&beam(r#"["O", "A"]"#, "modes = 2", &rest))), *expected, 1e-8);
    }
}

#[test]
fn a_link_held_at_one_place_is_clamped_where_its_joint_clamps_it() {
    for (joint, expected) in [
        (r#"revolute = ["ground", "b"], at = "O", axis = [0, 1, 0]"#, CLAMPED),
        (r#"revolute = ["ground", "b"], at = "A", axis = [0, 1, 0]"#, FREE),
        (r#"fixed = ["ground", "b"], at = "A""#, CLAMPED),
    ] {
        let rest = format!("[joints]\nJ = {{ {joint} }}");
        assert_near(first_square(&compiled(&beam(r#"["O", "A"]"#, "modes = 2", &rest))), expected, 1e-8);
    }
}

#[test]
fn shapes_that_turn_where_a_joint_does_not_are_told() {
    let said = |text: &str| {
        let all = compile(&source(text), &Options::default()).expect("a mechanism").warnings;
        all.iter().filter(|warning| warning.code.as_str() == "W0122").count()
    };
    let ends = r#"["O", "A"]"#;
    for (flexible, expected) in [
        ("modes = 4", 0),
        ("modes = 4, held = \"clamped\"", 0),
        ("modes = 4, held = \"craig_bampton\"", 0),
        ("modes = 4, held = \"pinned\"", 1),
        ("modes = 4, held = \"free\"", 1),
    ] {
        assert_eq!(said(&beam(ends, flexible, LOADED)), expected, "{flexible}");
    }
    assert_eq!(said(&beam(r#"["A", "O"]"#, "modes = 4, held = \"clamped\"", LOADED)), 1);
    // An upright pin bears the weight across it, a level one does not.
    let pins = |axis: &str| {
        LOADED.replace(
            "fixed = [\"ground\", \"b\"], at = \"O\"",
            &format!("revolute = [\"ground\", \"b\"], at = \"O\", axis = {axis}"),
        )
    };
    assert_eq!(said(&beam(ends, "modes = 4", &pins("[0, 0, 1]"))), 1);
    assert_eq!(said(&beam(ends, "modes = 4", &pins("[0, 1, 0]"))), 0);
    let cured = at_rest(&beam(ends, "modes = 4, held = \"craig_bampton\"", &pins("[0, 0, 1]")), "tip.value");
    // The static shape of the turn at its root is there; the tip comes nearer to the wall as it sags, (w/L)².
    assert_near(cured, loaded_sag(), 1e-3);
}

/// A run by the integrator that such mechanisms have unless told otherwise.
fn run_by_default(text: &str, seconds: f64) -> linkwear_runtime::Run {
    let compiled = compiled(text);
    let integrator = Integrator::adaptive(compiled.description(), None);
    let settings = Settings::new(integrator, Span::Time(seconds), 5);
    let (system, parameters) = (compiled.interpreter(), compiled.parameters());
    let watch = linkwear_runtime::Watch::NONE;
    linkwear_runtime::simulate(&system, compiled.description(), &parameters, &settings, watch)
        .expect("it starts")
}

#[test]
fn a_beam_that_nothing_loads_moves_in_long_steps() {
    let ends = r#"["O", "A"]"#;
    let turned = "[joints]\nF = { free = [\"ground\", \"b\"], at = \"O\" }\n\
                  [forces]\nq = { torque = \"b\", components = [0, 0, \"0.1 N m\"] }";
    for (flexible, rest) in [
        ("modes = 4", "[joints]\nR = { prismatic = [\"ground\", \"b\"], at = \"O\", axis = [0, 0, 1] }"),
        ("modes = 2", "[joints]\nF = { free = [\"ground\", \"b\"], at = \"O\" }"),
        // By the mean axes a torque turns all of it alike.
        ("modes = 6, held = \"free\"", turned),
    ] {
        let text = beam(ends, flexible, rest).replace("damping = 3", "damping = 0.01");
        let run = run_by_default(&text, 1.0);
        assert_eq!(run.stopped, None, "{rest}");
        // Tens and a thousand; by rounding they were hundreds of thousands.
        assert!(run.statistics.steps < 5000, "{rest}: {}", run.statistics.steps);
        let fallen = at_end(&run, "b.modal_energy");
        assert!(fallen.abs() < 1e-3, "{rest}: {fallen}");
    }
}

#[test]
fn a_link_that_bends_beyond_what_linear_shapes_are_good_for_is_told_and_ends() {
    let spun = |hertz: f64, order: u32| {
        let flexible = format!("modes = 6, order = {order}");
        let rest = format!(
            "[joints]\nh = {{ revolute = [\"ground\", \"b\"], at = \"O\", axis = [0, 1, 0], drive = \"2*pi*{hertz} Hz*t\" }}"
        );
        beam(r#"["O", "A"]"#, &flexible, &rest).replace("damping = 3", "damping = 0").replace("0.5 m", "1 m")
    };
    let told = |hertz: f64, order: u32| {
        let text = spun(hertz, order);
        let said = compiled(&text).warnings.iter().any(|warning| warning.code.as_str() == "W0124");
        let run = run_by_default(&text, 1.0);
        let bends =
            |one: &linkwear_runtime::RunWarning| matches!(one, linkwear_runtime::RunWarning::BentFar { .. });
        let is_over = run
            .stopped
            .as_ref()
            .is_some_and(|error| error.to_string().contains("the flexible body `b` bends by"));
        (said, run.warnings.iter().any(bends), is_over)
    };
    // Its first frequency is 7.2 Hz, at 5 Hz one of 5.2 is left: the weight that turns about it then meets resonance.
    assert_eq!(told(1.0, 1), (false, false, false));
    assert_eq!(told(5.0, 1), (true, true, false));
    assert!(told(10.0, 1).2);
    assert_eq!(told(10.0, 2), (false, false, false));
}
