//! Forces that depend on the angle of a cut joint are right, or the run ends where the angle would jump.

mod bars;

use std::f64::consts::TAU;

use bars::{compiled, four_bar_text};
use linkwear_runtime::{
    Integrator, Run, RunError, SINGULAR_PIVOT, Settings, Span, TurnRunner, Watch, simulate,
};

const METHODS: [Integrator; 3] = [
    Integrator::Dopri5 { tolerance: 1e-9, max_step: None },
    Integrator::Rk4 { step: 1e-3 },
    Integrator::GeneralizedAlpha { step: 1e-3, rho: 0.8 },
];

const SPRING: &str = ", spring = { stiffness = \"2 N m/rad\", rest = \"0 rad\" }";

/// A crank on a long ground; `own` is what the pin between crank and coupler does, `more` follows.
fn crank(cut: &str, own: &str, more: &str) -> String {
    // A crank of 0.1 m with a coupler and a rocker of 0.3 m: the crank turns against the coupler once in its turn.
    let corners = [[0.1, 0.0], [0.2, 0.08_f64.sqrt()], [0.3, 0.0]];
    let drive = ", drive = \"10 rad/s*t\"";
    let pin = "at = \"A\", axis = [0, 0, 1]";
    let text = four_bar_text(corners, drive, if cut == "R4" { ", cut = true" } else { "" }, more);
    let cut = if cut == "R2" { ", cut = true" } else { "" };
    text.replace(pin, &format!("{pin}{own}{cut}"))
}

/// One turn of it.
fn turn(cut: &str, own: &str, more: &str, method: Integrator) -> Run {
    let compiled = compiled(crank(cut, own, more)).expect("it is taken");
    let settings = Settings::new(method, Span::Time(TAU / 10.0), 101);
    let system = compiled.interpreter();
    simulate(&system, compiled.description(), &compiled.parameters(), &settings, Watch::NONE)
        .expect("it starts")
}

#[test]
fn a_spring_on_the_angle_of_a_cut_joint_ends_the_run_at_half_a_turn() {
    for method in METHODS {
        let in_the_tree = turn("R4", SPRING, "", method);
        assert_eq!(in_the_tree.stopped, None, "{method:?}");
        let cut = turn("R2", SPRING, "", method);
        let Some(RunError::AngleJumps { t, angle }) = &cut.stopped else {
            panic!("{method:?}: {:?}", cut.stopped)
        };
        assert_eq!(angle, "R2.q");
        let angles = in_the_tree.column("R2.q").expect("it is there");
        let row = angles.iter().position(|angle| angle.abs() > 0.5 * TAU).expect("it turns round");
        let times = &in_the_tree.times;
        assert!(times[row - 1] <= *t && *t <= times[row], "{method:?}: {t}, not {}", times[row]);
        // Up to there both are the same, by methods that are good to 1e-5 of a torque of 6 N m at least.
        let drive = in_the_tree.column("R1.drive").expect("it is driven");
        let same = cut.column("R1.drive").expect("it is driven").into_iter().zip(drive);
        same.for_each(|(cut, tree)| assert!((cut - tree).abs() < 1e-4, "{method:?}: {cut} {tree}"));
    }
}

#[test]
fn a_force_that_repeats_every_turn_passes_half_a_turn() {
    let actuator = |law: &str| format!(", force = \"{law}\"");
    for method in METHODS {
        let repeats = turn("R2", &actuator("1 N m*sin(R2.q)"), "", method);
        assert_eq!(repeats.stopped, None, "{method:?}");
        let grows = turn("R2", &actuator("1 N m*R2.q/(1 rad)"), "", method).stopped;
        assert!(matches!(grows, Some(RunError::AngleJumps { .. })), "{method:?}: {grows:?}");
        assert_eq!(turn("R2", "", "", method).stopped, None);
    }
}

#[test]
fn a_turn_that_goes_on_where_the_first_one_ended_is_looked_at_too() {
    // A wheel turns four times while the crank turns once: its second turn has the half turn of the pin.
    let wheel = "[bodies]\nwheel = { mass = \"1 kg\", centre = \"O\", inertia = [\"1 kg m^2\", \"1 kg m^2\", \"1 kg m^2\"] }\n";
    let joint = "[joints]\nW = { revolute = [\"ground\", \"wheel\"], at = \"O\", axis = [0, 0, 1], drive = \"40 rad/s*t\" }\n";
    let text = crank("R2", SPRING, "").replace("[bodies]\n", wheel).replace("[joints]\n", joint);
    let compiled = compiled(text).expect("it is taken");
    let system = compiled.interpreter();
    let (description, parameters) = (compiled.description(), compiled.parameters());
    let mut runner =
        TurnRunner::new(&system, description, &parameters, METHODS[0], SINGULAR_PIVOT).expect("it starts");
    assert!(runner.measure(Watch::NONE).is_ok());
    let second = runner.measure(Watch::NONE);
    assert!(matches!(&second, Err(RunError::AngleJumps { angle, .. }) if angle == "R2.q"), "{second:?}");
}

/// At the dead centre of a yoke, where the angle of its slot passes half a turn, the damper's force is all there is and goes through zero.
#[test]
fn a_force_that_goes_through_zero_at_half_a_turn_is_no_jump() {
    for resistance in ["damping = \"5 N s/m\"", "dry_friction = { coefficient = 0.2, onset = \"50 mm/s\" }"] {
        let text = format!(
            "spec = 1\nname = \"yoke\"\ngravity = [0, \"-9.81 m/s^2\", 0]\n[points]\nO = [0, 0, 0]\nP = [\"50 mm\", 0, 0]\n\
             Y = [\"80 mm\", 0, 0]\n[bodies]\n\
             crank = {{ mass = \"1 kg\", centre = \"O\", inertia = [\"1 g m^2\", \"1 g m^2\", \"2 g m^2\"] }}\n\
             yoke = {{ mass = \"1.5 kg\", centre = \"Y\", inertia = [\"1 g m^2\", \"1 g m^2\", \"2 g m^2\"] }}\n[joints]\n\
             R = {{ revolute = [\"ground\", \"crank\"], at = \"O\", axis = [0, 0, 1], drive = \"10 rad/s*t\" }}\n\
             G = {{ prismatic = [\"ground\", \"yoke\"], at = \"Y\", axis = [1, 0, 0], {resistance} }}\n\
             S = {{ slot = [\"yoke\", \"crank\"], at = \"P\", axis = [0, 0, 1], first = [0, 1, 0] }}\n"
        );
        let compiled = compiled(text).expect("it is taken");
        assert!(compiled.warnings.iter().all(|warning| warning.code.as_str() != "W0118"), "{resistance}");
        let settings = Settings::new(METHODS[0], Span::Time(TAU / 10.0), 101);
        let system = compiled.interpreter();
        let run = simulate(&system, compiled.description(), &compiled.parameters(), &settings, Watch::NONE);
        assert_eq!(run.expect("it starts").stopped, None, "{resistance}");
    }
}
