//! Starts that C takes with other parameters beside those that the runtime assembles.

use linkwear_codegen::{Compiled, Options, SourceFile, compile};
use linkwear_runtime::assemble;

use super::compiler::build;
use super::run::filled;
use super::shipped;

/// What C has to say.
const DONE: f64 = 0.0;
const OTHER_START: f64 = 4.0;

fn written(name: &str, text: &str) -> Compiled {
    let source = SourceFile { name: format!("{name}.toml"), text: text.to_owned() };
    compile(&source, &Options::default()).unwrap()
}

/// Coordinates and speeds of an assembled start.
fn assembled(compiled: &Compiled, parameters: &[f64], t: f64) -> Vec<f64> {
    let start = assemble(&compiled.interpreter(), compiled.description(), parameters, t).unwrap();
    [start.q, start.v].concat()
}

/// A time [s], parameters with other values, and what C says of a start with them.
type Case<'a> = (f64, &'a [(&'a str, f64)], f64);

/// Starts with other values and times: the runtime's where C has one.
fn assert_starts(compiled: &Compiled, cases: &[Case<'_>]) {
    let name = &compiled.mechanism.name;
    let description = compiled.description();
    for built in
        build(&format!("start_{name}"), compiled, &filled(include_str!("start.c"), compiled), &["-O2"])
    {
        for (t, changed, expected) in cases {
            let mut parameters = compiled.parameters();
            for (parameter, value) in *changed {
                let place = description.parameters.iter().position(|known| known.name == *parameter);
                parameters[place.expect("a parameter")] = *value;
            }
            let found = built.run(&[&[*t][..], &parameters].concat());
            assert_eq!(found[0], *expected, "{name}: {changed:?} at {t}");
            if *expected == DONE {
                let is_known = changed.is_empty() && *t == 0.0;
                let known = || compiled.start().unwrap().state;
                let wanted = if is_known { known() } else { assembled(compiled, &parameters, *t) };
                for (found, wanted) in found[1..].iter().zip(&wanted) {
                    // Both close loops to 1e-9 at most.
                    let off = (found - wanted).abs() / wanted.abs().max(1.0);
                    assert!(off < 1e-8, "{name}: {changed:?} at {t}: {found:?} {wanted:?}");
                }
            }
        }
    }
}

const SLIDE: &str = r#"
spec = 1
name = "slide"
gravity = [0, 0, 0]
[parameters]
x0 = { value = "2 N", tunable = true }
q0 = { value = "30 mm", tunable = true }
[points]
O = [0, 0, 0]
[bodies]
m = { mass = "1 kg", centre = "O", inertia = ["1e-3 kg m^2", "1e-3 kg m^2", "1e-3 kg m^2"] }
[joints]
s = { prismatic = ["ground", "m"], at = "O", axis = [0, 0, 1], force = "x" }
[states]
x = { initial = "x0", rate = "-x/(1 s)" }
[initial]
s = "q0"
"#;

const FOUR_BAR: &str = r#"
spec = 1
name = "four_bar"
gravity = [0, "-9.81 m/s^2", 0]
[parameters]
speed = { value = "4 Hz", tunable = true }
phase = { value = "4 deg", tunable = true }
x0 = { value = "2 N m", tunable = true }
[points]
O = [0, 0, 0]
A = ["40 mm", 0, 0]
B = ["120 mm", "110 mm", 0]
D = ["150 mm", 0, 0]
[bodies]
crank = { rod = ["O", "A"], radius = "6 mm", density = "7850 kg/m^3" }
coupler = { rod = ["A", "B"], radius = "6 mm", density = "7850 kg/m^3" }
rocker = { rod = ["D", "B"], radius = "6 mm", density = "7850 kg/m^3" }
[joints]
R1 = { revolute = ["ground", "crank"], at = "O", axis = [0, 0, 1], drive = "2*pi*speed*t + phase" }
R2 = { revolute = ["crank", "coupler"], at = "A", axis = [0, 0, 1] }
R3 = { revolute = ["coupler", "rocker"], at = "B", axis = [0, 0, 1] }
R4 = { revolute = ["ground", "rocker"], at = "D", axis = [0, 0, 1], cut = true }
[states]
x = { initial = "x0", rate = "-x/(0.2 s)" }
[forces]
brake = { torque = "rocker", components = [0, 0, "x"] }
"#;

/// A free loop, one of whose angles the file gives.
const FREE: &str = r#"R1 = { revolute = ["ground", "crank"], at = "O", axis = [0, 0, 1] }"#;

#[test]
fn starts_are_those_that_are_assembled_or_refused() {
    let same = (0.0, &[][..], DONE);
    assert_starts(
        &written("slide", SLIDE),
        &[same, (0.0, &[("x0", 5.0), ("q0", 0.1)], DONE), (2.0, &[("q0", -0.2)], DONE)],
    );
    let driven = written("four_bar", FOUR_BAR);
    let cases: &[Case<'_>] = &[
        same,
        (0.0, &[("phase", 0.5), ("x0", 3.0), ("speed", 20.0)], DONE),
        (0.0, &[("phase", -2.0)], DONE),
        (0.1, &[("speed", 3.0)], DONE),
    ];
    assert_starts(&driven, cases);
    // What is given moves where loops alone are closed.
    let begin = FOUR_BAR.find("R1 = {").expect("a joint");
    let end = begin + FOUR_BAR[begin..].find('\n').expect("a line");
    let free = format!("{}{FREE}{}\n[initial]\nR1 = \"phase\"\n", &FOUR_BAR[..begin], &FOUR_BAR[end..]);
    assert_starts(
        &written("free_four_bar", &free.replace("\"four_bar\"", "\"free_four_bar\"")),
        &[same, (0.0, &[("phase", 0.5)], OTHER_START), (0.0, &[("x0", 3.0)], DONE)],
    );
    // Speeds of a coupler that may turn about itself are the nearest ones.
    assert_starts(&shipped("rssr_rigid"), &[same, (0.0, &[("speed", 3.0)], DONE)]);
    // Journals rest elsewhere; forces alone move them by what they press in.
    let worn = shipped("rssr");
    let c0 = worn.description().parameters.iter().position(|known| known.name == "c0").expect("a clearance");
    let radial = 2.0 * worn.parameters()[c0];
    assert_starts(
        &worn,
        &[same, (0.0, &[("c0", radial)], OTHER_START), (0.0, &[("speed", 3.0)], OTHER_START)],
    );
}
